#include "case.hpp"

#include <algorithm>
#include <cmath>

#include "annulus.hpp"
#include "case_keys.hpp"
#include "recorder.hpp"
#include "scales.hpp"
#include "threads.hpp"

namespace stokes {

namespace {

// Keys on which no result depends.
constexpr std::string_view without_effect[] = {"threads", "output", "overwrite", "checkpoint_every"};

constexpr double standard_accuracy = 1e-4;  // without points_per_body
constexpr double solver_part = 0.1;         // of a tolerance of steps, the most that solutions may be off

std::vector<std::string> key_names() {
  std::vector<std::string> names;
  for (const CaseKey& key : case_keys()) names.push_back(key.name);
  return names;
}

// Where a value in double quotes ends, the closing quote included; a quote inside it is written twice. Nothing where the
// text does not begin with a quote, or has only that one.
std::size_t quoted_length(std::string_view text) {
  if (!text.starts_with('"')) return 0;
  for (std::size_t k = 1; k < text.size(); ++k) {
    if (text[k] != '"') continue;
    if (k + 1 == text.size() || text[k + 1] != '"') return k + 1;
    ++k;
  }
  return 0;
}

// A line of a case file up to its comment: a '#' that is not in quotes.
std::string_view without_comment(std::string_view line) {
  const std::size_t comment = line.find('#'), value = line.find_first_not_of(" \t=", line.find('='));
  if (comment <= value || value == std::string_view::npos) return trim(line.substr(0, comment));
  return trim(line.substr(0, line.find('#', value + quoted_length(line.substr(value)))));
}

// The value that is written in quotes; others as they are.
std::string unquoted(std::string_view text, const std::string& where) {
  if (!text.starts_with('"')) return std::string(text);
  if (quoted_length(text) != text.size())
    fail(where, quote(text), " begins with a quote that does not end it; write the whole value between two quotes.");
  std::string value;
  for (std::size_t k = 1; k + 1 < text.size(); ++k) {
    value += text[k];
    if (text[k] == '"') ++k;
  }
  return value;
}

// The reverse, where a file needs it.
std::string as_written(const std::string& value) {
  if (value == trim(value) && value.find_first_of("#\"") == std::string::npos) return value;
  std::string text = "\"";
  for (const char c : value) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + '"';
}

std::string_view without_dashes(std::string_view word) {
  return word.substr(std::min(word.find_first_not_of('-'), word.size()));
}

// Adds `key = value`; a key that `given` has already is an error.
void add_setting(std::string_view setting, const std::string& where, bool in_argument, GivenKeys& given) {
  for (const char c : setting) {
    if ((static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7F) {
      fail(where, "there is a control character in ", quote(setting),
           "; a case is plain text, one `key = value` a line.");
    }
  }
  const auto equals = setting.find('=');
  if (equals == std::string_view::npos)
    fail(where, quote(setting), " has no '='; write key = value.",
         setting.find(',') == std::string_view::npos ? "" : " A table is no case: name it there, as in bodies = FILE.csv.");
  const std::string key(trim(setting.substr(0, equals)));
  const std::string value = unquoted(trim(setting.substr(equals + 1)), where);
  const auto names = key_names();
  if (std::find(names.begin(), names.end(), key) == names.end()) {
    const std::string hint = hint_for(key);
    fail(where, "unknown key ", quote(key), "; ", key.starts_with('-') ? "keys have no dashes; " : "",
         hint.empty() ? suggestion(without_dashes(key), names) : hint, "--help lists the keys.");
  }
  if (value.empty()) fail(where, key, " has no value; write ", key, " = value.");
  const auto [entry, is_new] = given.try_emplace(key, GivenValue{value, where, in_argument});
  if (!is_new) {
    fail(where, key, " = ", quote(value), " is given twice; the first is ", quote(entry->second.text),
         " at ", entry->second.where, "; keep one.");
  }
}

// Everything given, arguments in the place of what the file says; `end` is the file's last line.
GivenKeys collect(std::string_view content, const std::filesystem::path& file, const std::vector<std::string>& overrides,
                  std::string& end) {
  if (content.ends_with('\n')) content.remove_suffix(1);
  GivenKeys in_file, in_arguments;
  int line_number = 0;
  for (const std::string_view line : split(content, '\n')) {
    end = concat(file.string(), ":", ++line_number);
    const std::string_view setting = without_comment(line);
    if (!setting.empty()) add_setting(setting, end, false, in_file);
  }
  for (const std::string& argument : overrides)
    add_setting(trim(argument), concat("argument ", quote(argument)), true, in_arguments);
  in_arguments.merge(in_file);
  return in_arguments;
}

// Ends the reading where a limit does not hold; the key must have been given then.
struct Limit {
  const GivenKeys& given;

  void operator()(bool holds, const std::string& key, std::string_view why) const {
    if (!holds) refuse(key, given.at(key), why);
  }
};

// A key that does nothing is refused, with two exceptions. A value in the file that an argument for another key leaves
// without effect is a warning: arguments try variants of one file. A default in a file says nothing wrong.
void check_effects(Case& c, const GivenKeys& given) {
  const Case defaults;
  for (const CaseKey& key : case_keys()) {
    const auto value = given.find(key.name);
    const Condition* const idle = value == given.end() ? nullptr : key.idle_for(c);
    if (!idle || (!value->second.in_argument && key.get(c) == key.get(defaults))) continue;
    const auto decider = given.find(idle->key);
    const bool by_argument = decider != given.end() && decider->second.in_argument && !value->second.in_argument;
    if (!by_argument) refuse(key.name, value->second, idle->otherwise);
    c.warnings.push_back(concat(value->second.where, ": ", key.name, " = ", quote(value->second.text), " has no effect: ",
                                decider->second.where));
  }
}

void check_geometry(const Case& c, const Limit& limit) {
  if (c.geometry == Geometry::unbounded) return;
  limit(c.flow == FlowKind::none, "flow",
        "is a flow of unbounded fluid, but in an annulus the walls drive the fluid; leave it out.");
  limit(c.inner_radius > 0.0, "inner_radius", "must be greater than 0.");
  limit(c.outer_radius <= 1e100, "outer_radius", "is above 1e100; choose a larger unit of length.");
  limit(c.outer_radius > c.inner_radius, "outer_radius",
        concat("must be greater than inner_radius = ", c.inner_radius, "; exchange them or move the walls apart."));
  limit(c.wall_points >= 16, "wall_points", "is below 16; try 256.");
  limit(c.wall_points % 2 == 0, "wall_points", "is odd; it must be even, try one more.");
  limit(c.wall_points <= 65536, "wall_points", "is above 65536; try 1024.");
}

// Nodes by an accuracy, or fixed ones.
void check_resolution(const Case& c, const Limit& limit) {
  if (!c.accuracy) {
    limit(c.points_per_body >= 8, "points_per_body", "is below 8; try 32.");
    limit(c.points_per_body % 2 == 0, "points_per_body", "is odd; it must be even, try one more.");
    // The block of one shape would need more than 100 GB.
    limit(c.points_per_body <= 65536, "points_per_body", "is above 65536; try 1024.");
    return;
  }
  limit(*c.accuracy >= 1e-11 && *c.accuracy <= 0.1, "accuracy", "must be between 1e-11 and 0.1; try 1e-4.");
  for (const char* key : {"points_per_body", "wall_points", "refine", "gmres_tolerance"})
    limit(!limit.given.contains(key), key, concat("is chosen by accuracy = ", *c.accuracy, "; keep one of them."));
  limit(c.coupling == Coupling::global, "coupling", "needs fixed nodes; give points_per_body instead of accuracy.");
  limit(c.near_singular == NearSingular::cauchy, "near_singular", "needs fixed nodes; give points_per_body instead of accuracy.");
  limit(c.min_separation == 0.0, "min_separation", "is in units of points_per_body; give min_separation_length.");
  limit(c.contact != ContactModel::stiv || c.stiv_vertices > 0, "contact",
        "has 4 vertices for each of points_per_body; give stiv_vertices, too.");
}

void check_output(const Case& c, const Limit& limit) {
  limit(c.output_every >= 1, "output_every", "must be at least 1, which writes every step.");
  std::string obstacle = why_not_writable(c.output);
  if (obstacle.empty() && c.vtk) obstacle = why_not_writable(std::filesystem::path(c.output) / "vtk");
  limit(obstacle.empty(), "output", concat("cannot be the output folder: ", obstacle, "; choose another one."));
  for (std::size_t k = 0; k < c.fields_at.size(); ++k) {
    const double time = c.fields_at[k];
    limit(time >= 0.0 && time <= c.end_time, "fields_at",
          concat("has the time ", time, ", which is not between 0 and end_time = ", c.end_time, "; leave it out."));
    limit(k == 0 || time > c.fields_at[k - 1], "fields_at", "must be in increasing order, each time once.");
  }
  limit(c.field_points >= 2, "field_points", "must be at least 2; try 200.");
  limit(c.field_points <= 10000, "field_points", "is above 10000, more than 1e8 points; try 200.");
  limit(c.checkpoint_every >= 0.0, "checkpoint_every", "must be at least 0; 0 makes none at intervals.");
}

void check_separation(const Case& c, const Limit& limit) {
  limit(c.min_separation >= 0.0, "min_separation", "must be at least 0.");
  limit(c.min_separation <= 1e100, "min_separation", "is above 1e100, more than any suspension has room for; try 1.");
  if (c.min_separation_length) {
    limit(*c.min_separation_length >= 0.0, "min_separation_length", "must be at least 0.");
    limit(*c.min_separation_length <= 1e100, "min_separation_length", "is above 1e100; choose a larger unit of length.");
    if (const auto other = limit.given.find("min_separation"); other != limit.given.end())
      limit(false, "min_separation_length",
            concat("and min_separation = ", quote(other->second.text), " (", other->second.where,
                   ") set the same thing; keep one of them."));
  }
}

// Others than forward Euler need the complete fluid and exact gaps; an error that is held needs solutions that are better.
void check_integrator(const Case& c, const Limit& limit) {
  if (c.integrator != IntegratorKind::euler) {
    limit(c.coupling == Coupling::global, "coupling", "needs integrator = euler: its densities lag one step behind.");
    limit(c.contact != ContactModel::stiv, "contact",
          "needs integrator = euler: interference volumes are measured along the way from the start of a step.");
  }
  if (!c.tolerance) return;
  limit(*c.tolerance >= 1e-10 && *c.tolerance <= 0.1, "tolerance", "must be between 1e-10 and 0.1; try 1e-4.");
  limit(c.adaptive, "adaptive", "contradicts tolerance, which chooses the steps; leave one of them out.");
  const double largest = solver_part * *c.tolerance * (1.0 + 1e-12);
  if (c.accuracy)
    limit(*c.accuracy <= largest, limit.given.contains("accuracy") ? "accuracy" : "tolerance",
          concat("must leave a tenth of tolerance = ", *c.tolerance, " to the solutions; try accuracy = ", solver_part * *c.tolerance, "."));
  else
    limit(c.gmres_tolerance <= largest, limit.given.contains("gmres_tolerance") ? "gmres_tolerance" : "tolerance",
          concat("must leave a tenth of tolerance = ", *c.tolerance, " to the solutions; try gmres_tolerance = ",
                 solver_part * *c.tolerance, "."));
}

// Limits of the values and of their combinations.
void check_case(Case& c, const GivenKeys& given) {
  const Limit limit{given};
  check_geometry(c, limit);
  check_resolution(c, limit);
  check_integrator(c, limit);
  limit(c.time_step > 0.0, "time_step", "must be greater than 0; a flow backwards has a negative rate.");
  limit(c.end_time > 0.0, "end_time", "must be greater than 0; a flow backwards has a negative rate.");
  // Steps are counted by an int.
  limit(c.end_time / c.time_step < 2e9, "time_step",
        concat("makes more than 2e9 steps to end_time = ", c.end_time, "; take a larger step."));
  if (c.reverse_at) limit(*c.reverse_at >= 0.0, "reverse_at", "must be at least 0, or none.");
  check_separation(c, limit);
  limit(c.gmres_tolerance > 0.0 && c.gmres_tolerance < 1.0, "gmres_tolerance",
        "must be greater than 0 and less than 1; try 1e-8.");
  limit(c.stiv_vertices == 0 || c.stiv_vertices >= 8, "stiv_vertices",
        "must be at least 8, or 0 for 4 points_per_body.");
  limit(c.stiv_vertices <= 65536, "stiv_vertices", "is above 65536; try 128.");
  // The sums' own error; below it, GMRES solves for what they are, not for the flow.
  limit(c.summation != Summation::fmm || c.gmres_tolerance >= 1e-11, "gmres_tolerance",
        "is below 1e-11, which multipole sums with their error of 1e-12 cannot serve; take summation = direct.");
  check_output(c, limit);
  if (c.threads) {
    limit(*c.threads >= 1, "threads", "must be at least 1; leave it out for all cores.");
    limit(*c.threads <= most_threads, "threads", concat("is above ", most_threads, "; leave it out for all cores."));
  }
  check_effects(c, given);
}

}  // namespace

Case read_case(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return parse_case(read_text_file(file, "the case file"), file, overrides);
}

Case parse_case(std::string_view content, const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  std::string end;
  const GivenKeys given = collect(content, file, overrides, end);
  Case result;
  result.file = file;
  const auto set = [&](const CaseKey& key) {
    if (const auto value = given.find(key.name); value != given.end()) key.set(result, value->second);
  };
  for (const CaseKey& key : case_keys())
    if (key.name == "geometry") set(key);  // first: it says which others are needed
  std::vector<std::string> missing;
  for (const CaseKey& key : case_keys())
    if (key.is_needed(result.geometry) && !given.contains(key.name)) missing.push_back(key.name);
  if (!missing.empty()) {
    fail(end, given.empty() ? "the case file is empty" : "the case is not complete",
         "; add a line `key = value` for each of: ", join(missing, ", "), ".");
  }
  for (const CaseKey& key : case_keys()) set(key);
  if (!given.contains("points_per_body") && !result.accuracy) result.accuracy = standard_accuracy;
  if (result.tolerance && result.integrator == IntegratorKind::rk3) {
    if (!given.contains("adaptive")) result.adaptive = true;
    if (!given.contains("points_per_body") && !given.contains("accuracy"))
      result.accuracy = std::max(1e-11, std::min(standard_accuracy, solver_part * *result.tolerance));
  }
  check_case(result, given);
  return result;
}

Suspension read_suspension(const Case& parameters) {
  const std::filesystem::path path = parameters.bodies_path(), beside = path.parent_path();
  if (!std::filesystem::exists(path))
    fail(path.string(), "cannot open the bodies' file: there is none; a relative name begins in the folder of the case file",
         beside.empty() ? "." : concat(", ", quote(beside.string()), "."),
         std::filesystem::exists(parameters.bodies)
             ? concat(" In the working directory there is one: write bodies = ",
                      std::filesystem::absolute(parameters.bodies).string())
             : "");
  return parse_suspension(parameters, read_text_file(path, "the bodies' file"));
}

namespace {

Suspension checked(Suspension bodies, const Case& parameters) {
  std::string why = lost_precision(bodies);
  if (why.empty()) why = out_of_scale(bodies, {parameters.flow, parameters.rate});
  if (!why.empty()) fail(parameters.bodies_path().string(), why);
  return bodies;
}

}  // namespace

Suspension parse_suspension(const Case& parameters, std::string_view content) {
  const std::string name = parameters.bodies_path().string();
  if (parameters.geometry == Geometry::unbounded) return checked(parse_bodies(content, name), parameters);
  Annulus annulus{parameters.inner_radius, parameters.outer_radius, parameters.wall_points};
  annulus.inner_surface = {parameters.inner_angular_velocity, parameters.injection_rate};
  annulus.outer_surface = {parameters.outer_angular_velocity, parameters.injection_rate};
  return checked(between_walls(parse_bodies(content, name, annulus), annulus), parameters);
}

double separation_length(const Case& parameters, const Suspension& bodies) {
  if (parameters.min_separation_length) return *parameters.min_separation_length;
  if (parameters.min_separation == 0.0) return 0.0;
  double longest = 0.0;
  for (const Body& body : bodies)
    if (body.points == 0) longest = std::max(longest, body.shape.perimeter());
  return parameters.min_separation * longest / parameters.points_per_body;
}

Comments describe(const Case& parameters) {
  Comments lines;
  for (const CaseKey& key : case_keys()) {
    if (std::find(std::begin(without_effect), std::end(without_effect), key.name) != std::end(without_effect)) continue;
    if (key.idle_for(parameters)) continue;
    if (key.name == "min_separation" && parameters.min_separation_length) continue;
    const bool of_fixed_nodes = key.name == "points_per_body" || key.name == "wall_points" || key.name == "refine" ||
                                key.name == "gmres_tolerance";
    if (parameters.accuracy ? of_fixed_nodes : key.name == "accuracy") continue;
    lines.emplace_back(key.name, key.get(parameters));
  }
  return lines;
}

std::string format_case(const Case& parameters) {
  std::string text;
  for (const auto& [key, value] : describe(parameters)) text += concat(key, " = ", as_written(value), "\n");
  return concat(text, "output = ", as_written(parameters.output), "\n");
}

std::string case_help() {
  const Case defaults;
  std::string text =
      "A case file has one `key = value` a line; `#` starts a comment. An argument key=value counts as\n"
      "if written in the file and replaces what it says; `#` is a part of it. A value may stand in double quotes.\n\n";
  for (const CaseKey& key : case_keys()) {
    const auto standard = padded(key.needed != Needed::never ? "required" : key.get(defaults), 10);
    text += concat("  ", padded(key.name, 23), standard, key.help, " (", key.kind, ")\n");
  }
  return text + "\n" + bodies_help();
}

}  // namespace stokes
