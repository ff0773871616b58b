// Compares results with the reference values, number by number, and prints the verdict.
//
//   verify [results=DIR] [reference=DIR] [missing=fail|allow]
//
// Every reference_data/*.csv has the columns id, experiment, case, quantity, unit, value, check, abs_tol,
// rel_tol, source, locator, note; the number it speaks of stands in results/<experiment>/<case>.csv, first
// row, column <quantity>. With d = abs_tol + rel_tol |value|, the checks are
//   close           |got - value| <= d             at_most    got <= value + d
//   at_least, order_at_least   got >= value - d    interval   value is `low..high`, low - d <= got <= high + d
//   true            got = 1
// A row whose note starts with `KNOWN:` is a documented deviation: out of tolerance it counts apart, as
// KNOWN, not as a failure. One whose note starts with `OPTIONAL:` needs runs that are not made unless asked for;
// without them it is NOT RUN, which is no failure either; `KNOWN:` may follow later in such a note. The verdict also goes to results/verdict.csv.
// Exit status: 0 all pass or are known; 1 a FAIL, or a MISSING unless missing=allow; 2 wrong input.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>

#include "base.hpp"
#include "csv.hpp"
#include "on_results.hpp"

namespace {

using namespace stokes;
namespace fs = std::filesystem;

struct Verdict {
  std::string id, experiment, case_name, quantity, expected, source, locator, status, note;
  double got = std::nan("");
  double error = std::nan("");  // in units of the tolerance; at most 1 passes

  bool judged() const { return status != "MISSING" && status != "NOT RUN"; }
};

double required(const Table& table, int row, const std::string& column) {
  return table.finite_number(row, table.column(column));
}

// Distance from the allowed set over the tolerance; 0 inside an exact bound.
double error_in_tolerances(const Table& table, int row, double got) {
  const std::string check = table.text(row, table.column("check"));
  const std::string value = table.text(row, table.column("value"));
  double low, high;
  if (check == "interval") {
    const std::size_t dots = value.find("..");
    const auto first = parse_number(value.substr(0, dots));
    const auto second = dots == std::string::npos ? std::nullopt : parse_number(value.substr(dots + 2));
    if (!first || !second) throw InputError(concat(table.where(row), ": an interval is written low..high, not ", quote(value)));
    low = *first, high = *second;
  } else {
    low = high = required(table, row, "value");
    if (check == "true") low = high = 1.0;
  }
  const double tolerance = required(table, row, "abs_tol") + required(table, row, "rel_tol") * std::max(std::abs(low), std::abs(high));
  const bool bounded_below = check != "at_most", bounded_above = check != "at_least" && check != "order_at_least";
  if (check != "close" && check != "interval" && check != "true" && bounded_below && bounded_above)
    throw InputError(concat(table.where(row), ": unknown check ", quote(check)));
  double outside = 0.0;
  if (bounded_below) outside = std::max(outside, low - got);
  if (bounded_above) outside = std::max(outside, got - high);
  if (std::isnan(got)) outside = got;
  return outside == 0.0 ? 0.0 : outside / tolerance;
}

bool is_known(const std::string& note) {
  return note.starts_with("KNOWN:") || (note.starts_with("OPTIONAL:") && note.find("KNOWN:") != std::string::npos);
}

Verdict judge(const Table& table, int row, const fs::path& results) {
  const auto text = [&](const char* column) { return table.text(row, table.column(column)); };
  Verdict v{text("id"), text("experiment"), text("case"), text("quantity"), text("value"),
            text("source"), text("locator"), "MISSING", text("note"), std::nan(""), std::nan("")};
  if (v.note.starts_with("OPTIONAL:")) v.status = "NOT RUN";
  const fs::path file = results / v.experiment / (v.case_name + ".csv");
  if (!fs::exists(file)) return v;
  const Table result = read_csv(file);
  if (result.rows.empty() || !result.has_column(v.quantity)) return v;
  v.got = result.number(0, result.column(v.quantity));
  v.error = error_in_tolerances(table, row, v.got);
  v.status = v.error <= 1.0 ? "PASS" : is_known(v.note) ? "KNOWN" : "FAIL";
  return v;
}

std::string fixed(double value, int digits) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*g", digits, value);
  return buffer;
}

std::vector<Verdict> judge_all(const fs::path& reference, const fs::path& results) {
  if (!fs::is_directory(reference)) throw InputError(concat("no folder ", quote(reference.string()), " with reference values"));
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(reference))
    if (entry.path().extension() == ".csv") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<Verdict> verdicts;
  for (const fs::path& file : files) {
    const Table table = read_csv(file);
    for (int row = 0; row < static_cast<int>(table.rows.size()); ++row) verdicts.push_back(judge(table, row, results));
  }
  return verdicts;
}

void print(const std::vector<Verdict>& verdicts) {
  std::printf("%-34s %-28s %12s %12s %8s  %-12s %s\n", "case", "quantity", "got", "expected", "error", "source", "verdict");
  std::string experiment;
  for (const Verdict& v : verdicts) {
    if (v.experiment != experiment) std::printf("%s\n", (experiment = v.experiment).c_str());
    std::printf("  %-32s %-28s %12s %12s %8s  %-12s %s\n", v.case_name.c_str(), v.quantity.c_str(),
                v.judged() ? fixed(v.got, 6).c_str() : "-", v.expected.c_str(),
                v.judged() ? fixed(v.error, 2).c_str() : "-", v.source.c_str(), v.status.c_str());
  }
}

constexpr const char* usage = "usage: verify [results=DIR] [reference=DIR] [missing=fail|allow]";

int run(Arguments& options) {
  const std::vector<Verdict> verdicts = judge_all(options["reference"], options["results"]);
  print(verdicts);
  std::map<std::string, int> count;
  std::string csv = "id,experiment,case,quantity,got,expected,error_in_tolerances,source,locator,verdict,note\n";
  for (const Verdict& v : verdicts) {
    ++count[v.status];
    csv += concat(csv_field(v.id), ",", v.experiment, ",", csv_field(v.case_name), ",", v.quantity, ",", v.got, ",", csv_field(v.expected), ",",
                  v.error, ",", v.source, ",", csv_field(v.locator), ",", v.status, ",", csv_field(v.note), "\n");
  }
  fs::create_directories(options["results"]);
  write_file_atomically(fs::path(options["results"]) / "verdict.csv", csv);
  std::map<std::string, int> known;
  for (const Verdict& v : verdicts)
    if (v.status == "KNOWN") ++known[concat(v.experiment, ": ", known_reason(v.note))];
  for (const auto& [note, rows] : known) std::printf("KNOWN, %d rows, %s\n", rows, note.c_str());
  std::string line = "verdict:";
  for (const std::string& status : verdict_statuses) line += concat(line.back() == ':' ? " " : ", ", count[status], " ", status);
  std::printf("%s\n", line.c_str());
  return count["FAIL"] > 0 || (count["MISSING"] > 0 && options["missing"] == "fail") ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  const char* help =
      "Compares every number of DIR with the reference values, prints the verdict and writes it to\n"
      "DIR/verdict.csv. Exit status 1 if a number fails or, unless missing=allow, is missing.\n";
  return run_on_results("verify", usage, help,
                        {{"results", "results"}, {"reference", "reference_data"}},
                        argc, argv, run);
}
