// The keys of a case file: name, parser, printer and help of each.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "case.hpp"

namespace stokes {

// A value as the user wrote it, and where: "file:line" or "argument 'key=value'".
struct GivenValue {
  std::string text;
  std::string where;
  bool in_argument = false;
};
using GivenKeys = std::map<std::string, GivenValue>;

// The geometries in which a key is required.
enum class Needed { always, unbounded, annulus, walls, never };

// A condition without which a key has no effect.
struct Condition {
  std::string key;  // the key that decides it
  std::function<bool(const Case&)> holds;
  std::string otherwise;  // the end of a sentence that begins with the key and its value
};

struct CaseKey {
  std::string name;
  Needed needed;
  std::vector<Condition> conditions;
  std::string kind;
  std::string help;
  std::function<void(Case&, const GivenValue&)> set;
  std::function<std::string(const Case&)> get;

  bool is_needed(Geometry geometry) const {
    switch (needed) {
      case Needed::always: return true;
      case Needed::unbounded: return geometry == Geometry::unbounded;
      case Needed::annulus: return geometry == Geometry::annulus;
      case Needed::walls: return geometry != Geometry::unbounded;
      case Needed::never: break;
    }
    return false;
  }
  // The first condition that does not hold, or none.
  const Condition* idle_for(const Case& c) const {
    for (const Condition& condition : conditions)
      if (!condition.holds(c)) return &condition;
    return nullptr;
  }
};

// Every key, in the order of --help.
const std::vector<CaseKey>& case_keys();

// Checks the values and their combinations. InputError where a limit does not hold; a value in the file that an argument
// leaves without effect becomes a warning of the case.
void check_case(Case& c, const GivenKeys& given);

// Of a tolerance of steps, the most that solutions may be off.
inline constexpr double solver_part = 0.1;

template <class... Parts>
[[noreturn]] void fail(const std::string& where, const Parts&... parts) {
  throw InputError(concat(where, ": ", parts...));
}

// Advice for a word that other programs use, as a sentence and a space. Empty for all other words.
std::string hint_for(std::string_view word);

// `where: key = 'value' why`.
[[noreturn]] inline void refuse(const std::string& key, const GivenValue& given, std::string_view why) {
  fail(given.where, key, " = ", quote(given.text), " ", why);
}

}  // namespace stokes
