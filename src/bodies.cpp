#include "bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "container_gap.hpp"
#include "csv.hpp"
#include "gap.hpp"
#include "neighbours.hpp"
#include "text.hpp"

namespace stokes {

namespace {

constexpr double largest_length = 1e100, smallest_axis = 1e-100;  // squares and their products stay finite and positive

template <class... Parts>
[[noreturn]] void refuse(const std::string& where, const Parts&... parts) {
  throw InputError(concat(where, ": ", parts...));
}

struct Column {
  const char* name;
  bool is_required;
  const char* help;
};

constexpr Column columns[] = {
    {"a", true, "semi-axis along theta, length"},
    {"b", true, "semi-axis across it, length"},
    {"x", true, "centre, length"},
    {"y", true, "centre, length"},
    {"theta", true, "angle of the semi-axis a, radians, counter-clockwise"},
    {"force_x", false, "external force; the sum over the bodies is 0 in unbounded flow"},
    {"force_y", false, "external force"},
    {"torque", false, "external torque about the centre"},
    {"fixed", false, "1: held in place or driven, between walls only"},
    {"ux", false, "velocity of a fixed body, length/time; reversed with all driving"},
    {"uy", false, "velocity of a fixed body"},
    {"omega", false, "angular velocity of a fixed body, 1/time"},
};

// Refuses a table of another form, recognised by the first line that is no comment.
void check_form(std::string_view content, const std::string& file_name) {
  int number = 0;
  for (const std::string_view line : split(content, '\n')) {
    ++number;
    const std::string_view text = trim(line);
    if (text.empty() || text.front() == '#') continue;
    const auto has = [&](char c) { return text.find(c) != std::string_view::npos; };
    const std::string where = concat(file_name, ":", number);
    if (has(';')) refuse(where, "the columns are separated by semicolons; write commas, and points in decimal numbers.");
    if (!has(',') && (has('\t') || has(' ')))
      refuse(where, "the columns are separated by ", has('\t') ? "tabs" : "spaces", "; write commas.");
    const auto fields = split(text, ',');
    const auto is_number = [](std::string_view field) { return parse_number(trim(field)).has_value(); };
    if (std::all_of(fields.begin(), fields.end(), is_number))
      refuse(where, "the first line has numbers only; a line above it must name the columns, as in a,b,x,y,theta.");
    return;
  }
}

void check_columns(const Table& table) {
  std::vector<std::string> known, missing;
  for (const Column& column : columns) {
    known.push_back(column.name);
    if (column.is_required && !table.has_column(column.name)) missing.push_back(column.name);
  }
  for (const std::string& name : table.header) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    refuse(table.where_header(), "unknown column ", quote(name), "; ",
           suggestion(name, known), "the columns are ", join(known, ","), ".");
  }
  if (!missing.empty()) {
    refuse(table.where_header(), "the header lacks the required column", missing.size() > 1 ? "s " : " ",
         join(missing, ", "), "; it can be a,b,x,y,theta.");
  }
}

Body read_body(const Table& table, int row) {
  const auto value = [&](const char* name) {
    return table.has_column(name) ? table.finite_number(row, table.column(name)) : 0.0;
  };
  for (const char* axis : {"a", "b"}) {
    if (value(axis) > 0.0) continue;
    refuse(table.where(row), "the semi-axis ", axis, " = ", value(axis), " of body ", row,
         " must be greater than 0; give the half-length of the body.");
  }
  for (const char* name : {"a", "b", "x", "y"})
    if (std::abs(value(name)) > largest_length)
      refuse(table.where(row), name, " = ", value(name), " of body ", row, " is above ", largest_length,
             "; choose a larger unit of length.");
  for (const char* axis : {"a", "b"})
    if (value(axis) < smallest_axis)
      refuse(table.where(row), "the semi-axis ", axis, " = ", value(axis), " of body ", row, " is below ", smallest_axis,
             "; choose a smaller unit of length.");
  const double fixed = value("fixed");
  if (fixed != 0.0 && fixed != 1.0) {
    refuse(table.where(row), "fixed = ", fixed, " of body ", row,
         " must be 0 (free) or 1 (held in place).");
  }
  for (const char* name : {"ux", "uy", "omega"})
    if (fixed == 0.0 && value(name) != 0.0)
      refuse(table.where(row), name, " = ", value(name), " of body ", row, " is given, but a free body finds its own ",
             "velocity; set fixed to 1 to drive it, or ", name, " to 0.");
  return {Shape{value("a"), value("b")},
          Pose{{value("x"), value("y")}, value("theta")},
          {value("force_x"), value("force_y")},
          value("torque"),
          fixed == 1.0,
          {value("omega"), 0.0, {value("ux"), value("uy")}}};
}

Suspension read_table(const Table& table) {
  check_columns(table);
  if (table.rows.empty())
    refuse(table.where_header(), "there are no bodies; add a row below the header for each.");
  Suspension bodies;
  for (int row = 0; row < static_cast<int>(table.rows.size()); ++row)
    bodies.push_back(read_body(table, row));
  return bodies;
}

void check_all_free(const Table& table, const Suspension& bodies) {
  for (int i = 0; i < static_cast<int>(bodies.size()); ++i) {
    if (!bodies[i].fixed) continue;
    refuse(table.where(i), "body ", i, " is fixed, but in unbounded flow only free ",
         "bodies are possible: a held body exerts a net force, for which no bounded flow ",
         "exists in two dimensions; set fixed to 0.");
  }
}

// A net force in unbounded two-dimensional Stokes flow has no bounded solution.
void check_net_force(const Table& table, const Suspension& bodies) {
  double largest = 0.0;  // scales the sums, which could overflow otherwise
  for (const Body& body : bodies)
    largest = std::max({largest, std::abs(body.force.real()), std::abs(body.force.imag())});
  if (largest == 0.0) return;
  Complex net{0.0, 0.0};
  double magnitudes = 0.0;
  for (const Body& body : bodies) {
    const Complex scaled(body.force.real() / largest, body.force.imag() / largest);
    net += scaled;
    magnitudes += std::abs(scaled);
  }
  constexpr double tolerance = 1e-12;
  if (std::abs(net) <= tolerance * magnitudes) return;
  refuse(table.where_header(), "the external forces sum to (", brief(net.real() * largest), ", ",
       brief(net.imag() * largest), "), ", brief(std::abs(net) / magnitudes),
       " of the sum of their magnitudes against at most ", tolerance,
       " in unbounded flow, where a net force has no bounded flow; subtract the mean force "
       "from every body.");
}

[[noreturn]] void refuse_pair(const Table& table, const ClosestPair& pair, const char* which) {
  refuse(table.where(pair.b), "bodies ", pair.a, " and ", pair.b, " (counted from 0) ",
         pair.gap < 0.0 ? concat("overlap by ", brief(-pair.gap)) : std::string("touch"), which, "; move them apart.");
}

// A pile of many bodies, caused by a wrong unit of length or duplicated rows, has too many pairs to examine each. Two
// centres in one square whose diagonal is below two inradii overlap. If there are no such centres, no place has too many
// bodies for a search for the smallest gap.
void check_piles(const Table& table, const Suspension& bodies) {
  constexpr std::size_t few = 200;
  if (bodies.size() <= few) return;
  double inradius = std::numeric_limits<double>::infinity();
  for (const Body& body : bodies) inradius = std::min(inradius, body.shape.inradius());
  std::vector<std::tuple<double, double, int>> squares;
  for (int i = 0; i < static_cast<int>(bodies.size()); ++i) {
    const Complex centre = bodies[i].pose.centre;
    squares.emplace_back(std::floor(centre.real() / (1.4 * inradius)), std::floor(centre.imag() / (1.4 * inradius)), i);
  }
  std::sort(squares.begin(), squares.end());
  for (std::size_t k = 1; k < squares.size(); ++k) {
    const auto& [x, y, a] = squares[k - 1];
    const auto& [next_x, next_y, b] = squares[k];
    if (x != next_x || y != next_y) continue;
    const double value = gap(bodies[a], bodies[b]).value;
    if (value <= 0.0) refuse_pair(table, {a, b, value}, "");
  }
}

void check_overlaps(const Table& table, const Suspension& bodies) {
  check_piles(table, bodies);
  Suspension all = bodies;  // so that two fixed bodies count as well
  for (Body& body : all) body.fixed = false;
  const ClosestPair closest = smallest_gap(all);
  if (closest.gap <= 0.0) refuse_pair(table, closest, ", the smallest gap of all");
}

void check_walls(const Table& table, const Suspension& bodies, const Suspension& walls) {
  const Container& outer = *walls.container;
  const Body* const inner = inner_wall_of(walls);
  double smallest = std::numeric_limits<double>::infinity();
  int worst = 0;
  bool is_outer = false;
  for (int i = 0; i < static_cast<int>(bodies.size()); ++i) {
    const double outer_gap = gap(bodies[i], outer).value;
    const double inner_gap = inner ? gap(bodies[i], *inner).value : std::numeric_limits<double>::infinity();
    if (std::min(outer_gap, inner_gap) >= smallest) continue;
    smallest = std::min(outer_gap, inner_gap);
    worst = i;
    is_outer = outer_gap < inner_gap;
  }
  if (smallest > 0.0) return;
  const std::string wall = is_outer ? concat("the outer wall of radius ", outer.radius)
                                    : concat("the inner wall of radius ", inner->shape.a);
  const std::string depth = smallest == 0.0 ? concat("touches ", wall)
                            : is_outer      ? concat("reaches ", brief(-smallest), " beyond ", wall)
                                            : concat("overlaps ", wall, " by ", brief(-smallest));
  refuse(table.where(worst), "body ", worst, " (counted from 0) ", depth,
         ", the smallest distance to a wall of all; move it ", is_outer ? "inwards." : "outwards.");
}

}  // namespace

Suspension read_bodies(const std::filesystem::path& path) {
  return parse_bodies(read_text_file(path, "the bodies' file"), path.string());
}

Suspension parse_bodies(std::string_view content, const std::string& file_name) {
  check_form(content, file_name);
  const Table table = parse_csv(content, file_name);
  Suspension bodies = read_table(table);
  check_all_free(table, bodies);
  check_net_force(table, bodies);
  check_overlaps(table, bodies);
  return bodies;
}

Suspension parse_bodies(std::string_view content, const std::string& file_name, const Suspension& walls) {
  check_form(content, file_name);
  const Table table = parse_csv(content, file_name);
  Suspension bodies = read_table(table);
  check_walls(table, bodies, walls);
  check_overlaps(table, bodies);
  bodies.insert(bodies.end(), walls.begin(), walls.end());
  bodies.container = walls.container;
  return bodies;
}

std::string format_bodies(const Suspension& bodies) {
  const bool some_driven = std::any_of(bodies.begin(), bodies.end(), [](const Body& body) { return body.is_driven(); });
  std::string text = concat("a,b,x,y,theta,force_x,force_y,torque,fixed", some_driven ? ",ux,uy,omega\n" : "\n");
  for (const Body& body : bodies) {
    if (body.points != 0) continue;  // a wall
    text += concat(body.shape.a, ",", body.shape.b, ",", body.pose.centre.real(), ",", body.pose.centre.imag(), ",",
                   body.pose.angle, ",", body.force.real(), ",", body.force.imag(), ",", body.torque, ",",
                   body.fixed ? 1 : 0);
    const SurfaceMotion& given = body.surface;
    if (some_driven)
      text += concat(",", given.translation.real(), ",", given.translation.imag(), ",", given.angular_velocity);
    text += '\n';
  }
  return text;
}

std::string bodies_help() {
  std::string text =
      "The bodies' file is a CSV: a header line, a row for each body, columns in any order.\n\n";
  for (const Column& column : columns) {
    const auto needed = padded(column.is_required ? "required" : "0", 10);
    text += concat("  ", padded(column.name, 23), needed, column.help, "\n");
  }
  return text;
}

}  // namespace stokes
