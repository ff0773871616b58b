// The reference values: rows of reference_data/*.csv, and the checks for malformed rows.
//
// The columns are `reference_columns`. A row is about the number in results/<experiment>/<case>.csv, first row,
// column <quantity>.
// With d = abs_tol + rel_tol |value|, a number `got` agrees if
//   close           |got - value| <= d             at_most    got <= value + d
//   at_least, order_at_least   got >= value - d    interval   value is `low..high`, low - d <= got <= high + d
//   true            |got - 1| <= d
// Sources: paper_table, paper_text and paper_figure are published, the others are exact and own_baseline.
// The locator of a published row begins with its object: `Table 3, ...`, `Figure 7, ...` or `section 4.1 ...`.
// Notes:
//   KNOWN measured: reason, KNOWN unexplained: reason   the number differs, by a reason that was measured or without one;
//                       known_low <= got <= known_high is accepted in place of the tolerance
//   OPTIONAL: what      needs a run that is made only on request; a KNOWN may follow
// Malformed rows, and tables that name a number twice, are InputErrors with file and line.
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "base.hpp"
#include "csv.hpp"

namespace stokes {

inline const std::string reference_columns =
    "id,experiment,case,quantity,unit,value,check,abs_tol,rel_tol,known_low,known_high,source,locator,note";

// What published rows are about, in the order of the paper.
inline const std::string claims_of_the_text = "claims of the text";
inline const std::vector<std::string> published_objects = {
    "Table 1",  "Table 2",  "Table 3",  "Figure 2", "Figure 3",  "Figure 4",        "Figure 5",
    "Figure 6", "Figure 7", "Figure 8", "Figure 9", "Figure 10", claims_of_the_text};

enum class Origin { published, exact, baseline };
enum class Deviation { none, measured, unexplained };

struct ReferenceRow {
  std::string where;  // file:line
  std::string id, experiment, case_name, quantity, value, source, locator, note;
  double low, high;          // agree within the tolerance; infinite where there is no bound
  double tolerance;
  Origin origin;
  std::string object;        // of a published row, one of published_objects
  bool optional;
  Deviation deviation;
  double known_low, known_high;  // of a row with a deviation
};

// A KNOWN at the start of a note or after its OPTIONAL part.
struct KnownNote {
  Deviation deviation = Deviation::none;
  std::string reason;
};

inline bool is_optional(std::string_view note) { return note.starts_with("OPTIONAL:"); }

// Throws InputError for a KNOWN that does not say `measured:` or `unexplained:`, or gives no reason.
inline KnownNote known_note(std::string_view note) {
  const std::size_t at = is_optional(note) ? note.find("KNOWN") : note.starts_with("KNOWN") ? 0 : note.npos;
  if (at == note.npos) return {};
  std::string_view rest = trim(note.substr(at + 5));
  if (rest.starts_with(":")) rest = trim(rest.substr(1));
  for (const auto& [word, deviation] : {std::pair<std::string_view, Deviation>{"measured:", Deviation::measured},
                                        {"unexplained:", Deviation::unexplained}})
    if (rest.starts_with(word) && !trim(rest.substr(word.size())).empty())
      return {deviation, std::string(trim(rest.substr(word.size())))};
  throw InputError("a KNOWN row says `KNOWN measured: reason` or `KNOWN unexplained: reason`");
}

inline Origin origin_of(const std::string& source) {
  if (source == "paper_table" || source == "paper_text" || source == "paper_figure") return Origin::published;
  if (source == "exact") return Origin::exact;
  if (source == "own_baseline") return Origin::baseline;
  throw InputError(concat("unknown source ", quote(source),
                          "; it is paper_table, paper_text, paper_figure, exact or own_baseline"));
}

inline std::string object_of(const std::string& locator) {
  if (locator.starts_with("section ")) return claims_of_the_text;
  const std::size_t comma = locator.find(',');
  const std::string object = locator.substr(0, comma);
  const bool is_object = std::find(published_objects.begin(), published_objects.end(), object) != published_objects.end();
  if (comma == std::string::npos || !is_object || object == claims_of_the_text)
    throw InputError(concat("the locator of a published row begins with its object, as in 'Table 3, ...', 'Figure 7, ...' "
                            "or 'section 4.1 ...', not ", quote(locator)));
  return object;
}

// Reads one row of a table; errors have no place yet.
class ReferenceReader {
 public:
  ReferenceReader(const Table& table, int row) : table_(table), row_(row) {}

  ReferenceRow read() const {
    ReferenceRow r{};
    r.where = table_.where(row_);
    r.id = required("id"), r.experiment = required("experiment"), r.case_name = required("case");
    r.quantity = required("quantity"), r.value = required("value"), r.source = required("source");
    r.locator = required("locator"), r.note = text("note");
    read_bounds(r);
    r.origin = origin_of(r.source);
    if (r.origin == Origin::published) r.object = object_of(r.locator);
    r.optional = is_optional(r.note);
    r.deviation = known_note(r.note).deviation;
    if (r.deviation == Deviation::none) {
      if (text("known_low") + text("known_high") != "") throw InputError("known_low and known_high need a KNOWN note");
      return r;
    }
    r.known_low = number("known_low"), r.known_high = number("known_high");
    if (r.known_low > r.known_high) throw InputError("known_low is larger than known_high");
    return r;
  }

 private:
  std::string text(const char* column) const { return table_.text(row_, table_.column(column)); }
  std::string required(const char* column) const {
    if (text(column).empty()) throw InputError(concat("no ", column));
    return text(column);
  }
  static double number_of(const std::string& what, std::string_view token) {
    if (const auto value = parse_number(token)) return *value;
    throw InputError(concat(what, " is a finite number, not ", quote(token)));
  }
  double number(const char* column) const { return number_of(column, text(column)); }

  void read_bounds(ReferenceRow& r) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const std::string check = required("check");
    if (check == "interval") {
      const std::size_t dots = r.value.find("..");
      if (dots == std::string::npos) throw InputError(concat("an interval is written low..high, not ", quote(r.value)));
      r.low = number_of("low", r.value.substr(0, dots)), r.high = number_of("high", r.value.substr(dots + 2));
      if (r.low > r.high) throw InputError(concat("an interval is written low..high, not ", quote(r.value)));
    } else {
      r.low = r.high = number_of("value", r.value);
      if (check == "true" && r.low != 1.0) throw InputError(concat("the value of what shall be true is 1, not ", r.value));
    }
    const double absolute = number("abs_tol"), relative = number("rel_tol");
    if (absolute < 0.0 || relative < 0.0) throw InputError("a tolerance is not negative");
    r.tolerance = absolute + relative * std::max(std::abs(r.low), std::abs(r.high));
    if (check == "at_most") r.low = -infinity;
    else if (check == "at_least" || check == "order_at_least") r.high = infinity;
    else if (check != "close" && check != "interval" && check != "true")
      throw InputError(concat("unknown check ", quote(check)));
  }

  const Table& table_;
  int row_;
};

// Throws if two rows have one id, or if two published rows are about one number: by experiment, case and quantity,
// or by their place in the paper.
inline void require_each_once(const std::vector<ReferenceRow>& rows) {
  std::map<std::string, std::string> seen;
  const auto once = [&](const char* what, const std::string& name, const ReferenceRow& row) {
    const auto [at, is_new] = seen.emplace(concat(what, " ", name), row.where);
    if (!is_new) throw InputError(concat(row.where, ": ", what, " ", name, " is there twice, first in ", at->second));
  };
  for (const ReferenceRow& row : rows) {
    once("the id", row.id, row);
    if (row.origin != Origin::published) continue;
    once("a published value of", concat(row.experiment, "/", row.case_name, " ", row.quantity), row);
    once("the published number of", concat("'", row.locator, "'"), row);
  }
}

// In any order.
inline void require_columns(const Table& table) {
  std::vector<std::string> header = table.header, wanted;
  for (const std::string_view column : split(reference_columns, ',')) wanted.emplace_back(column);
  std::sort(header.begin(), header.end()), std::sort(wanted.begin(), wanted.end());
  if (header != wanted)
    throw InputError(concat(table.where_header(), ": the columns of reference values are ", reference_columns));
}

inline std::vector<ReferenceRow> read_references(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder))
    throw InputError(concat("no folder ", quote(folder.string()), " with reference values"));
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".csv") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<ReferenceRow> rows;
  for (const std::filesystem::path& file : files) {
    const Table table = read_csv(file);
    require_columns(table);
    for (int row = 0; row < static_cast<int>(table.rows.size()); ++row) try {
        rows.push_back(ReferenceReader(table, row).read());
      } catch (const InputError& error) {
        throw InputError(concat(table.where(row), ": ", error.what()));
      }
  }
  require_each_once(rows);
  return rows;
}

}  // namespace stokes
