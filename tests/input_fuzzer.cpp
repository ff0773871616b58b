#include "input_fuzzer.hpp"

#include <chrono>
#include <cmath>
#include <random>
#include <vector>

#include "case.hpp"
#include "container_gap.hpp"
#include "gap.hpp"

namespace stokes {

namespace {

using Random = std::mt19937_64;

struct Files {
  std::string case_file, bodies;
};

const std::vector<Files>& originals() {
  static const std::vector<Files> files = {
      {"bodies = b.csv\nflow = shear   # the simplest\npoints_per_body = 32\ntime_step = 0.1\nend_time = 2\noutput = out\n",
       "# n: 2\na,b,x,y,theta,force_x\n1,2,0,0,0.5,1e-1\n\"1\",1,5,0,-3,-0.1\n"},
      {"bodies = b.csv\r\nflow = extension\r\nrate = -2\npoints_per_body = 16\ntime_step = 1e-3\nend_time = 0.5\n"
       "output = a/b\nreverse_at = 0.25\nmin_separation = 0.5\ncontact = stiv\nstiv_vertices = 64\ncoupling = local\n"
       "lcp_matrix = near\nfields_at = 0 0.125 0.5\nfield_points = 20\nadaptive = yes\nvtk = yes\nthreads = 2\n",
       "theta,x,y,b,a\n0,0,0,.5,.5\n0,2,0,.5,.5\n1.5,0,2,.1,.475\n-1e-3,2,2,.25,.75\n"},
      {"geometry = annulus\nbodies = b.csv\ninner_radius = 1\nouter_radius = 10\nwall_points = 128\n"
       "outer_angular_velocity = 2\ninner_angular_velocity = -1\ninjection_rate = 3.5\npoints_per_body = 32\n"
       "time_step = 0.01\nend_time = 1\noutput = out\nmin_separation_length = 0.02\nrefine = near\nsummation = fmm\n",
       "a,b,x,y,theta,fixed,torque,force_y\n.25,.25,3,0,0,1,0,0\n"
       ".5,.25,-3,1,2,0,1,-2\n1,1,0,7,0,0,0,1\n.1,2,6,-3,.75,0,0,0\n"},
  };
  return files;
}

std::size_t below(Random& random, std::size_t limit) { return limit == 0 ? 0 : random() % limit; }

const std::string& any_of(Random& random, const std::vector<std::string>& choices) {
  return choices[below(random, choices.size())];
}

// Words and numbers that are difficult for a reader.
const std::vector<std::string>& hostile_tokens() {
  static const std::vector<std::string> tokens = {
      "nan", "-nan", "inf", "-inf", "infinity", "1e308", "-1e308", "1e309", "1e-308", "5e-324", "1e-400", "0", "-0", "0x10",
      "1e100", "1.0000001e100", "1e99", "1e-100", "1e-160", "1e15", "9007199254740993", "2147483647", "2147483648",
      "-2147483648", "9223372036854775808", "99999999999999999999999999", "1.", ".", "+", "-", "+-1", "++1", "1e", "1e+",
      "1_000", "1,5", "1 2", "none", "all", "auto", "yes", "\"", "\"\"", "\"1", "#", "=", "==", "= =", "\xEF\xBB\xBF",
      "\xC3\xA9", "\xF0\x9F\x90\x9F", "\xFF\xFE", "\xE2\x88\x92" "1", "\xD9\xA3", "\xE3\x80\x80", "..", "/", "~", "a/../b",
      "/dev/null", "%s%n", "$(x)", "a", "x", "theta", "fixed", "bodies", "annulus", "unbounded", "stiv", "65536", "65538"};
  return tokens;
}

// Where the pieces between separators begin and end.
std::vector<std::pair<std::size_t, std::size_t>> pieces_of(const std::string& text, const char* separators) {
  std::vector<std::pair<std::size_t, std::size_t>> pieces;
  for (std::size_t at = text.find_first_not_of(separators); at != std::string::npos;) {
    const std::size_t end = std::min(text.find_first_of(separators, at), text.size());
    pieces.emplace_back(at, end);
    at = text.find_first_not_of(separators, end);
  }
  return pieces;
}

void flip_byte(Random& random, std::string& text) {
  if (!text.empty()) text[below(random, text.size())] ^= static_cast<char>(1 << below(random, 8));
}

void edit_bytes(Random& random, std::string& text) {
  constexpr std::string_view bytes("\0\n\r\t,\"#= -+.e0123456789naifx_/\\\x7F\xFF\xEF\x80", 36);
  const std::size_t at = below(random, text.size() + 1), removed = below(random, 4);
  text.replace(at, std::min(removed, text.size() - at), below(random, 2), bytes[below(random, bytes.size())]);
}

void replace_token(Random& random, std::string& text) {
  const auto tokens = pieces_of(text, ",= \n\r");
  if (tokens.empty()) return;
  const auto [begin, end] = tokens[below(random, tokens.size())];
  text.replace(begin, end - begin, any_of(random, hostile_tokens()));
}

// A number that replaces a token: of any size, or a small change of a valid number.
void replace_number(Random& random, std::string& text) {
  const auto tokens = pieces_of(text, ",= \n\r");
  if (tokens.empty()) return;
  const auto [begin, end] = tokens[below(random, tokens.size())];
  const double mantissa = static_cast<double>(random() >> 11) * 0x1p-53 - (random() % 2 ? 0.5 : 0.0);
  const int exponent = random() % 3 ? static_cast<int>(below(random, 7)) - 3 : static_cast<int>(below(random, 660)) - 340;
  text.replace(begin, end - begin, concat(mantissa, "e", exponent));
}

void swap_pieces(Random& random, std::string& text, const char* separators) {
  const auto pieces = pieces_of(text, separators);
  if (pieces.size() < 2) return;
  auto first = pieces[below(random, pieces.size())], second = pieces[below(random, pieces.size())];
  if (first.first > second.first) std::swap(first, second);
  if (first.second > second.first) return;
  const std::string a = text.substr(first.first, first.second - first.first);
  const std::string b = text.substr(second.first, second.second - second.first);
  text.replace(second.first, b.size(), a);
  text.replace(first.first, a.size(), b);
}

void delete_line(Random& random, std::string& text) {
  const auto lines = pieces_of(text, "\n");
  if (lines.empty()) return;
  const auto [begin, end] = lines[below(random, lines.size())];
  text.erase(begin, end + 1 - begin);
}

void duplicate_line(Random& random, std::string& text) {
  const auto lines = pieces_of(text, "\n");
  if (lines.empty()) return;
  const auto [begin, end] = lines[below(random, lines.size())];
  std::string line = text.substr(begin, end - begin) + "\n", copies;
  const std::size_t count = below(random, 200) == 0 ? 1000 + below(random, 3000) : 1 + below(random, 3);
  for (std::size_t k = 0; k < count; ++k) copies += line;
  text.insert(begin, copies);
}

void lengthen(Random& random, std::string& text) {
  const std::size_t length = below(random, 100) == 0 ? 100'000 : 1 + below(random, 600);
  const char filling = "x90 ,#/\n\"="[below(random, 10)];
  text.insert(below(random, text.size() + 1), length, filling);
}

void cut_short(Random& random, std::string& text) { text.resize(below(random, text.size() + 1)); }

// Another row for a bodies' file with the five columns: often accepted.
void add_body(Random& random, std::string& text) {
  const auto small = [&random](double scale) { return scale * (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5); };
  const double a = std::abs(small(2.0)), b = std::abs(small(2.0)), x = small(20.0), y = small(20.0), theta = small(10.0);
  text += concat(a, ",", b, ",", x, ",", y, ",", theta, "\n");
}

void mutate(Random& random, std::string& text) {
  switch (below(random, 11)) {
    case 0: return flip_byte(random, text);
    case 1: return edit_bytes(random, text);
    case 2: return replace_token(random, text);
    case 3: case 4: return replace_number(random, text);
    case 5: return swap_pieces(random, text, ",= \n\r");
    case 6: return swap_pieces(random, text, "\n");
    case 7: return random() % 2 ? delete_line(random, text) : duplicate_line(random, text);
    case 8: return lengthen(random, text);
    case 9: return random() % 4 ? add_body(random, text) : cut_short(random, text);
    default: return replace_token(random, text);
  }
}

// Describes the defect of a case that was accepted; empty if it has none.
std::string judge(const Case& c) {
  for (const double value : {c.time_step, c.end_time, c.inner_radius, c.outer_radius, c.outer_angular_velocity,
                             c.inner_angular_velocity, c.injection_rate, c.rate, c.reverse_at.value_or(0.0),
                             c.min_separation, c.min_separation_length.value_or(0.0), c.gmres_tolerance, c.checkpoint_every})
    if (!std::isfinite(value)) return "a number is not finite";
  if (!c.accuracy && (c.points_per_body < 8 || c.points_per_body % 2 != 0)) return "points_per_body";
  if (!(c.time_step > 0.0) || !(c.end_time > 0.0) || c.end_time / c.time_step >= 2e9) return "time_step or end_time";
  if (c.min_separation < 0.0 || c.min_separation_length.value_or(0.0) < 0.0) return "the separation is negative";
  if (c.bodies.empty() || c.output.empty()) return "a name is empty";
  if (c.output_every < 1 || c.field_points < 2) return "output_every or field_points";
  double before = -1.0;
  for (const double time : c.fields_at) {
    if (!(time > before) || !(time <= c.end_time)) return "fields_at";
    before = time;
  }
  if (c.geometry == Geometry::annulus &&
      !(0.0 < c.inner_radius && c.inner_radius < c.outer_radius && c.wall_points >= 16 && c.flow == FlowKind::none))
    return "the annulus";
  return {};
}

std::string judge(const Case& c, const Suspension& bodies) {
  Complex net{0.0, 0.0};
  double scale = 0.0, sum = 0.0;
  for (const Body& body : bodies) scale = std::max({scale, std::abs(body.force.real()), std::abs(body.force.imag())});
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Body& body = bodies[i];
    for (const double value : {body.shape.a, body.shape.b, body.pose.centre.real(), body.pose.centre.imag(), body.pose.angle,
                               body.force.real(), body.force.imag(), body.torque})
      if (!std::isfinite(value)) return concat("body ", i, " has a number that is not finite");
    if (!(body.shape.a > 0.0) || !(body.shape.b > 0.0)) return concat("body ", i, " has no size");
    if (scale > 0.0) net += body.force / scale, sum += std::abs(body.force / scale);
    if (bodies.container && !(gap(body, *bodies.container).value > 0.0)) return concat("body ", i, " is in the outer wall");
    if (!bodies.container && body.fixed) return "a fixed body in unbounded flow";
    for (std::size_t j = 0; j < i; ++j)
      if (!(gap(bodies[j], body).value > 0.0)) return concat("bodies ", j, " and ", i, " overlap");
  }
  if (!bodies.container && std::abs(net) > 1e-11 * sum) return "there is a net force";
  const double separation = separation_length(c, bodies);
  return std::isfinite(separation) && separation >= 0.0 ? "" : concat("the separation is ", separation);
}

// Runs `read`; false if it refuses correctly. Any other outcome goes into the report.
template <class Read>
bool accepts(const Read& read, FuzzReport& report) {
  const auto start = std::chrono::steady_clock::now();
  bool accepted = false;
  try {
    read();
    accepted = true;
  } catch (const InputError& error) {
    const std::string message = error.what();
    if (message.empty() || message.find('\n') != std::string::npos)
      report.failure = concat("a message that is not one line: ", quote(message));
  } catch (const std::exception& error) {
    report.failure = concat("an exception that is no InputError: ", error.what());
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  report.slowest = std::max(report.slowest, seconds);
  if (seconds > 5.0) report.failure = concat("reading took ", seconds, " s");
  return accepted && report.failure.empty();
}

void try_files(const Files& files, FuzzReport& report) {
  Case c;
  if (!accepts([&] { c = parse_case(files.case_file, "case.txt"); }, report)) return;
  ++report.accepted_cases;
  report.failure = judge(c);
  Suspension bodies;
  if (!report.failure.empty() || !accepts([&] { bodies = parse_suspension(c, files.bodies); }, report)) return;
  ++report.accepted_suspensions;
  report.failure = judge(c, bodies);
}

}  // namespace

FuzzReport fuzz_input(long first, long count, std::uint64_t seed) {
  FuzzReport report;
  for (long number = first; number < first + count && report.failure.empty(); ++number) {
    Random random(seed * 0x9E3779B97F4A7C15u + static_cast<std::uint64_t>(number));
    Files files = originals()[below(random, originals().size())];
    std::string& text = below(random, 3) == 0 ? files.case_file : files.bodies;
    for (std::size_t edits = 1 + below(random, 4); edits > 0; --edits) mutate(random, text);
    try_files(files, report);
    ++report.mutations;
    if (!report.failure.empty())
      report.failure = concat("mutation ", number, ": ", report.failure, "\n--- case\n", files.case_file, "--- bodies\n",
                              files.bodies);
  }
  return report;
}

}  // namespace stokes
