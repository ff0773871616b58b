#include "case.hpp"

#include <algorithm>
#include <cmath>

#include "annulus.hpp"
#include "case_keys.hpp"
#include "scales.hpp"

namespace stokes {

namespace {

// Keys on which no result depends.
constexpr std::string_view without_effect[] = {"threads", "output", "overwrite", "checkpoint_every", "start_from"};

constexpr double standard_accuracy = 1e-4;  // without points_per_body

std::vector<std::string> key_names() {
  std::vector<std::string> names;
  for (const CaseKey& key : case_keys()) names.push_back(key.name);
  return names;
}

// The position where a value in double quotes ends, the closing quote included; a quote inside it is written twice. None if
// the text does not begin with a quote or has only that one.
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

// The value without its quotes, if it has any.
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

// The value with quotes, if a file needs them.
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

// All keys given; arguments replace the values of the file. `end` is the file's last line.
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
  const auto earlier = given.find("start_from");
  const bool is_continued = earlier != given.end() && earlier->second.text != "none";
  std::vector<std::string> missing;
  for (const CaseKey& key : case_keys())
    if (key.is_needed(result.geometry) && !given.contains(key.name) && !(is_continued && key.name == "bodies"))
      missing.push_back(key.name);
  if (!missing.empty()) {
    fail(end, given.empty() ? "the case file is empty" : "the case is not complete",
         "; add a line `key = value` for each of: ", join(missing, ", "), ".");
  }
  for (const CaseKey& key : case_keys()) set(key);
  if (is_continued) {
    result.earlier = earlier_state(result.start_from);
    result.start_time = result.earlier->time;
  } else {
    result.start_from.clear();
  }
  if (!given.contains("points_per_body") && !result.accuracy) result.accuracy = standard_accuracy;
  if (result.tolerance && result.integrator == IntegratorKind::rk3) {
    if (!given.contains("adaptive")) result.adaptive = true;
    if (!given.contains("points_per_body") && !given.contains("accuracy"))
      result.accuracy = std::max(1e-11, std::min(standard_accuracy, solver_part * *result.tolerance));
  }
  check_case(result, given);
  if (is_continued) {  // from here on, and in its record, it is a case like others
    result.bodies = result.earlier->file.string();
    result.start_from.clear();
  }
  return result;
}

BackgroundFlow Case::background() const {
  BackgroundFlow background{flow, rate};
  if (gradient.size() == 4) background.gradient = {gradient[0], gradient[1], gradient[2]};
  return background;
}

Suspension read_suspension(const Case& parameters) {
  if (parameters.earlier) return parse_suspension(parameters, parameters.earlier->bodies);
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
  if (why.empty()) why = out_of_scale(bodies, parameters.background());
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
  Suspension walls;
  walls.container = outer_wall(annulus);
  if (parameters.geometry == Geometry::annulus) walls.push_back(inner_wall(annulus));
  return checked(parse_bodies(content, name, walls), parameters);
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
    if (key.name == "start_time" && parameters.start_time == 0.0) continue;
    if (key.name == "sample_area" && !parameters.sample_area) continue;
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
