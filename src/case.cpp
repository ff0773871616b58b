#include "case.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <type_traits>

#include "base.hpp"
#include "bodies.hpp"
#include "recorder.hpp"

namespace stokes {

namespace {

template <class Value>
using Words = std::vector<std::pair<std::string, Value>>;

Words<FlowKind> words_of(FlowKind) {
  return {{"shear", FlowKind::shear},
          {"extension", FlowKind::extension},
          {"taylor_green", FlowKind::taylor_green},
          {"none", FlowKind::none}};
}
Words<ContactModel> words_of(ContactModel) {
  return {{"gap", ContactModel::gap}, {"stiv", ContactModel::stiv}, {"none", ContactModel::none}};
}
Words<Coupling> words_of(Coupling) {
  return {{"global", Coupling::global}, {"local", Coupling::local}};
}
Words<LcpMatrix> words_of(LcpMatrix) { return {{"full", LcpMatrix::full}, {"self", LcpMatrix::self}}; }
Words<StivGradient> words_of(StivGradient) {
  return {{"full", StivGradient::full}, {"frozen", StivGradient::frozen}};
}
Words<NearSingular> words_of(NearSingular) {
  return {{"cauchy", NearSingular::cauchy}, {"interpolation", NearSingular::interpolation}};
}
Words<TimeCounting> words_of(TimeCounting) {
  return {{"accumulated", TimeCounting::accumulated}, {"exact", TimeCounting::exact}};
}
Words<bool> words_of(bool) { return {{"yes", true}, {"no", false}}; }

template <class Value>
std::vector<std::string> names_of(const Words<Value>& words) {
  std::vector<std::string> names;
  for (const auto& word : words) names.push_back(word.first);
  return names;
}

// A value as the user gave it, and where: "file:line" or "argument 'key=value'".
struct Given {
  std::string text;
  std::string where;
};
using GivenKeys = std::map<std::string, Given>;

template <class... Parts>
[[noreturn]] void fail(const std::string& where, const Parts&... parts) {
  throw InputError(concat(where, ": ", parts...));
}

[[noreturn]] void refuse(const std::string& key, const Given& given, std::string_view why) {
  fail(given.where, key, " = ", quote(given.text), " ", why);
}

template <class Value>
Value parse_value(const std::string& key, const Given& given) {
  if constexpr (std::is_same_v<Value, std::string>) {
    return given.text;
  } else if constexpr (std::is_same_v<Value, double>) {
    if (const auto number = parse_number(given.text)) return *number;
    refuse(key, given, "is not a finite number; write it like 0.25 or 1e-3.");
  } else if constexpr (std::is_same_v<Value, int>) {
    constexpr long long limit = std::numeric_limits<int>::max();
    const auto number = parse_integer(given.text);
    if (number && *number >= -limit && *number <= limit) return static_cast<int>(*number);
    refuse(key, given, concat("is not a whole number of at most ", limit, "; write it like 32."));
  } else {
    const auto words = words_of(Value{});
    for (const auto& [name, value] : words)
      if (name == given.text) return value;
    const auto names = names_of(words);
    refuse(key, given,
           concat("is unknown: it can be ", join(names, " or "), "; did you mean ",
                  quote(nearest_name(given.text, names)), "?"));
  }
}

template <class Value>
std::string text_of(const Value& value) {
  if constexpr (std::is_same_v<Value, std::string>) {
    return value;
  } else if constexpr (std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool>) {
    return format_number(value);
  } else {
    for (const auto& [name, known] : words_of(value))
      if (known == value) return name;
    throw std::logic_error("a value of the case has no word");
  }
}

template <class Value>
std::string kind_of() {
  if constexpr (std::is_same_v<Value, std::string>)
    return "name";
  else if constexpr (std::is_same_v<Value, double>)
    return "number";
  else if constexpr (std::is_same_v<Value, int>)
    return "whole number";
  else
    return join(names_of(words_of(Value{})), " | ");
}

struct Key {
  std::string name;
  bool is_required;
  std::string kind;
  std::string help;
  std::function<void(Case&, const Given&)> set;
  std::function<std::string(const Case&)> get;
};

template <class Value>
Key optional(std::string name, Value Case::*member, std::string help) {
  const auto set = [=](Case& c, const Given& given) { c.*member = parse_value<Value>(name, given); };
  const auto get = [=](const Case& c) { return text_of(c.*member); };
  return {name, false, kind_of<Value>(), std::move(help), set, get};
}

template <class Value>
Key required(std::string name, Value Case::*member, std::string help) {
  Key key = optional(std::move(name), member, std::move(help));
  key.is_required = true;
  return key;
}

// A key that need not have a value: `unset` is the word for that.
template <class Value>
Key optional(std::string name, std::optional<Value> Case::*member, std::string unset, std::string help) {
  const auto set = [=](Case& c, const Given& given) {
    c.*member = given.text == unset ? std::nullopt : std::optional(parse_value<Value>(name, given));
  };
  const auto get = [=](const Case& c) { return c.*member ? text_of(*(c.*member)) : unset; };
  return {name, false, kind_of<Value>() + " | " + unset, std::move(help), set, get};
}

const std::vector<Key>& keys() {
  static const std::vector<Key> table = {
      required("bodies", &Case::bodies, "CSV of the bodies, its path relative to the case file"),
      required("flow", &Case::flow, "background: shear (rate y, 0), extension rate (x, -y), taylor_green rate (cos x sin y, -sin x cos y)"),
      required("points_per_body", &Case::points_per_body, "nodes on each body, even, at least 8"),
      required("time_step", &Case::time_step, "length of a step, time"),
      required("end_time", &Case::end_time, "when to stop, time"),
      required("output", &Case::output, "folder of the results, relative to the working directory"),
      optional("rate", &Case::rate, "of the flow, 1/time; may be negative"),
      optional("reverse_at", &Case::reverse_at, "none", "time from which every driving is reversed"),
      optional("min_separation", &Case::min_separation,
               "in units of h = longest perimeter / points_per_body"),
      optional("min_separation_length", &Case::min_separation_length, "none",
               "length, instead of min_separation"),
      optional("contact", &Case::contact, "model that keeps bodies apart"),
      optional("coupling", &Case::coupling, "between the bodies in a step"),
      optional("lcp_matrix", &Case::lcp_matrix, "mobility in the contact problem's matrix"),
      optional("stiv_vertices", &Case::stiv_vertices, "of each polygon with contact = stiv, at least 8; 0: 4 points_per_body"),
      optional("stiv_gradient", &Case::stiv_gradient, "of the interference volume; frozen holds the hit time fixed"),
      optional("near_singular", &Case::near_singular, "evaluation close to a boundary"),
      optional("gmres_tolerance", &Case::gmres_tolerance, "relative true residual, between 0 and 1"),
      optional("adaptive", &Case::adaptive, "reject and halve time steps that fail"),
      optional("output_every", &Case::output_every, "steps between rows of trajectory.csv"),
      optional("threads", &Case::threads, "all", "at most 1024"),
      optional("time_counting", &Case::time_counting, "exact: the last step ends at end_time"),
  };
  return table;
}

std::vector<std::string> key_names() {
  std::vector<std::string> names;
  for (const Key& key : keys()) names.push_back(key.name);
  return names;
}

// Adds `key = value`; a key that `given` has already is an error.
void add_setting(std::string_view setting, const std::string& where, GivenKeys& given) {
  for (const char c : setting) {
    if ((static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7F) {
      fail(where, "there is a control character in ", quote(setting),
           "; a case is plain text, one `key = value` a line.");
    }
  }
  const auto equals = setting.find('=');
  if (equals == std::string_view::npos) fail(where, quote(setting), " has no '='; write key = value.");
  const std::string key(trim(setting.substr(0, equals)));
  const std::string_view value = trim(setting.substr(equals + 1));
  const auto names = key_names();
  if (std::find(names.begin(), names.end(), key) == names.end()) {
    fail(where, "unknown key ", quote(key), "; did you mean ", quote(nearest_name(key, names)),
         "? --help lists the keys.");
  }
  if (value.empty()) fail(where, key, " has no value; write ", key, " = value.");
  const auto [entry, is_new] = given.try_emplace(key, Given{std::string(value), where});
  if (!is_new) {
    fail(where, key, " = ", quote(value), " is given twice; the first is ", quote(entry->second.text),
         " at ", entry->second.where, "; keep one.");
  }
}

std::string_view without_comment(std::string_view line) { return trim(line.substr(0, line.find('#'))); }

// Everything given, arguments in the place of what the file says; `end` is the file's last line.
GivenKeys collect(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                  std::string& end) {
  std::string content = read_text_file(file, "the case file");
  if (content.ends_with('\n')) content.pop_back();
  GivenKeys in_file, in_arguments;
  int line_number = 0;
  for (const std::string_view line : split(content, '\n')) {
    end = concat(file.string(), ":", ++line_number);
    const std::string_view setting = without_comment(line);
    if (!setting.empty()) add_setting(setting, end, in_file);
  }
  for (const std::string& argument : overrides)
    add_setting(without_comment(argument), concat("argument ", quote(argument)), in_arguments);
  in_arguments.merge(in_file);
  return in_arguments;
}

// Limits of the values and of their combinations.
void check_case(const Case& c, const GivenKeys& given) {
  const auto limit = [&given](bool holds, const char* key, std::string_view why) {
    if (!holds) refuse(key, given.at(key), why);
  };
  limit(c.points_per_body >= 8, "points_per_body", "is below 8; try 32.");
  limit(c.points_per_body % 2 == 0, "points_per_body", "is odd; it must be even, try one more.");
  // The block of one shape would need more than 100 GB.
  limit(c.points_per_body <= 65536, "points_per_body", "is above 65536; try 1024.");
  limit(c.time_step > 0.0, "time_step", "must be greater than 0; a flow backwards has a negative rate.");
  limit(c.end_time > 0.0, "end_time", "must be greater than 0; a flow backwards has a negative rate.");
  // Steps are counted by an int.
  limit(c.end_time / c.time_step < 2e9, "time_step",
        concat("makes more than 2e9 steps to end_time = ", c.end_time, "; take a larger step."));
  if (c.reverse_at) limit(*c.reverse_at >= 0.0, "reverse_at", "must be at least 0, or none.");
  limit(c.min_separation >= 0.0, "min_separation", "must be at least 0.");
  if (c.min_separation_length) {
    limit(*c.min_separation_length >= 0.0, "min_separation_length", "must be at least 0.");
    if (const auto other = given.find("min_separation"); other != given.end())
      limit(false, "min_separation_length",
            concat("and min_separation = ", quote(other->second.text), " (", other->second.where,
                   ") set the same thing; keep one of them."));
  }
  limit(c.gmres_tolerance > 0.0 && c.gmres_tolerance < 1.0, "gmres_tolerance",
        "must be greater than 0 and less than 1; try 1e-8.");
  limit(c.stiv_vertices == 0 || c.stiv_vertices >= 8, "stiv_vertices", "must be at least 8, or 0 for 4 points_per_body.");
  limit(c.output_every >= 1, "output_every", "must be at least 1, which writes every step.");
  const std::string obstacle = why_not_writable(c.output);
  limit(obstacle.empty(), "output", concat("cannot be the output folder: ", obstacle, "; choose another one."));
  if (c.threads) {
    limit(*c.threads >= 1, "threads", "must be at least 1; leave it out for all cores.");
    limit(*c.threads <= 1024, "threads", "is above 1024; leave it out for all cores.");
  }
}

}  // namespace

Case read_case(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  std::string end;
  const GivenKeys given = collect(file, overrides, end);
  std::vector<std::string> missing;
  for (const Key& key : keys())
    if (key.is_required && !given.contains(key.name)) missing.push_back(key.name);
  if (!missing.empty()) {
    fail(end, given.empty() ? "the case file is empty" : "the case is not complete",
         "; add a line `key = value` for each of: ", join(missing, ", "), ".");
  }
  Case result;
  result.file = file;
  for (const Key& key : keys())
    if (const auto value = given.find(key.name); value != given.end()) key.set(result, value->second);
  check_case(result, given);
  return result;
}

double separation_length(const Case& parameters, const Suspension& bodies) {
  if (parameters.min_separation_length) return *parameters.min_separation_length;
  double longest = 0.0;
  for (const Body& body : bodies) longest = std::max(longest, body.shape.perimeter());
  return parameters.min_separation * longest / parameters.points_per_body;
}

Comments describe(const Case& parameters) {
  Comments lines;
  for (const Key& key : keys()) {
    if (key.name == "threads" || key.name == "output") continue;
    if (key.name == "min_separation" && parameters.min_separation_length) continue;
    lines.emplace_back(key.name, key.get(parameters));
  }
  return lines;
}

std::string case_help() {
  const Case defaults;
  std::string text =
      "A case file has one `key = value` a line; `#` starts a comment. An argument key=value counts as\n"
      "if written in the file and replaces what it says.\n\n";
  for (const Key& key : keys()) {
    const auto standard = padded(key.is_required ? "required" : key.get(defaults), 10);
    text += concat("  ", padded(key.name, 23), standard, key.help, " (", key.kind, ")\n");
  }
  return text + "\n" + bodies_help();
}

}  // namespace stokes
