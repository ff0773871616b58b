// Compares results with the reference values (reference.hpp), number by number, and prints the verdict.
//
//   verify [results=DIR] [reference=DIR] [missing=fail|allow] [rows=all|differing] [readme=FILE]
//
// PASS: within the tolerance. KNOWN: outside it, but within the interval of a documented deviation. STALE: a KNOWN row that
// is within the tolerance. FAIL: all others, also a result that is not a number, cannot be read or lacks the column.
// MISSING: the case has not been run; NOT RUN instead with missing=allow, and for OPTIONAL rows.
// The verdict also goes to results/verdict.csv, its table by object to results/verdict_summary.csv.
// Exit status: 0 all pass or are known; 1 a FAIL, STALE or MISSING, or a FILE whose table by object differs from that of
// this run (compared when nothing is missing); 2 wrong input.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>

#include "on_results.hpp"
#include "verdict.hpp"

namespace {

using namespace stokes;
namespace fs = std::filesystem;

std::string digits(double value, int count) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*g", count, value);
  return buffer;
}

bool differs(const Verdict& v) { return v.status != Status::pass && v.status != Status::not_run; }

void print_rows(const std::vector<Verdict>& verdicts) {
  if (verdicts.empty()) return;
  std::printf("%-34s %-28s %12s %12s %8s  %-12s %s\n", "case", "quantity", "got", "expected", "error", "source", "verdict");
  std::string experiment;
  for (const Verdict& v : verdicts) {
    const ReferenceRow& r = v.reference;
    if (r.experiment != experiment) std::printf("%s\n", (experiment = r.experiment).c_str());
    std::printf("  %-32s %-28s %12s %12s %8s  %-12s %s%s\n", r.case_name.c_str(), r.quantity.c_str(),
                v.has_number() ? digits(v.got, 6).c_str() : "-", r.value.c_str(),
                v.has_number() ? digits(v.error, 2).c_str() : "-", r.source.c_str(), name_of(v.status).c_str(),
                v.problem.empty() ? "" : concat(": ", v.problem).c_str());
  }
}

void print_reasons(const std::vector<Verdict>& verdicts) {
  std::map<std::string, int> rows;
  for (const Verdict& v : verdicts)
    if (v.status == Status::measured || v.status == Status::unexplained)
      ++rows[concat(name_of(v.status), ", ", v.reference.experiment, ": ", known_note(v.reference.note).reason)];
  for (const auto& [reason, count] : rows) std::printf("%d %s\n", count, reason.c_str());
}

void print_objects(const Summary& summary) {
  std::printf("%-20s %9s %9s %9s %13s %17s\n", "published", "numbers", "agree", "measured", "unexplained",
              "fail or not run");
  for_each_object(summary, [](const std::string& name, const std::array<int, 5>& n) {
    std::printf("%-20s %9d %9d %9d %13d %17d\n", name.c_str(), n[0], n[1], n[2], n[3], n[4]);
  });
}

void write(const fs::path& folder, const std::vector<Verdict>& verdicts, const Summary& summary) {
  fs::create_directories(folder);
  std::string csv = "id,experiment,case,quantity,got,expected,error_in_tolerances,source,locator,verdict,note\n";
  for (const Verdict& v : verdicts) {
    const ReferenceRow& r = v.reference;
    csv += concat(csv_field(r.id), ",", csv_field(r.experiment), ",", csv_field(r.case_name), ",", csv_field(r.quantity),
                  ",", v.got, ",", csv_field(r.value), ",", v.error, ",", r.source, ",", csv_field(r.locator), ",",
                  name_of(v.status), ",", csv_field(r.note), "\n");
  }
  write_file_atomically(folder / "verdict.csv", csv);
  write_file_atomically(folder / "verdict_summary.csv", summary_csv(summary));
}

// The README's table is that of `make reproduce`: optional rows count as not run.
bool has_table_of(const fs::path& readme, const std::vector<Verdict>& verdicts) {
  Summary summary;
  for (const Verdict& v : verdicts) summary.add(v.reference, v.reference.optional ? Status::not_run : v.status);
  const std::string table = summary_markdown(summary);
  if (read_text_file(readme, "the page with the table").find(table) != std::string::npos) return true;
  std::printf("%s: its table by object is not that of this run, which is\n%s", readme.c_str(), table.c_str());
  return false;
}

constexpr const char* usage =
    "usage: verify [results=DIR] [reference=DIR] [missing=fail|allow] [rows=all|differing] [readme=FILE]";

int run(Arguments& options) {
  if (options["rows"] != "all" && options["rows"] != "differing")
    throw InputError(concat("rows = all or differing, not ", quote(options["rows"])));
  const Status if_absent = options["missing"] == "allow" ? Status::not_run : Status::missing;
  std::vector<Verdict> verdicts;
  Summary summary;
  int failed = 0;
  for (const ReferenceRow& row : read_references(options["reference"])) {
    verdicts.push_back(judge(row, options["results"], if_absent));
    const Status status = verdicts.back().status;
    summary.add(row, status);
    failed += status == Status::fail || status == Status::stale || status == Status::missing;
  }
  write(options["results"], verdicts, summary);
  std::vector<Verdict> shown = verdicts;
  if (options["rows"] == "differing") std::erase_if(shown, [](const Verdict& v) { return !differs(v); });
  print_rows(shown);
  print_reasons(verdicts);
  print_objects(summary);
  const bool is_complete = std::none_of(verdicts.begin(), verdicts.end(),
                                        [](const Verdict& v) { return v.status == Status::missing; });
  const bool readme_fits = options["readme"].empty() || !is_complete || has_table_of(options["readme"], verdicts);
  std::printf("%s\n", summary_line(summary).c_str());
  return failed > 0 || !readme_fits ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  const char* help =
      "Compares every number of DIR with the reference values, prints the verdict and writes it to DIR/verdict.csv and,\n"
      "counted by table and figure of the paper, to DIR/verdict_summary.csv. Exit status 1 if a number fails or, unless\n"
      "missing=allow, is missing. rows=differing prints those alone that do not pass; readme=FILE compares the table by\n"
      "object in FILE with this run.\n";
  return run_on_results("verify", usage, help,
                        {{"results", "results"}, {"reference", "reference_data"}, {"rows", "all"}, {"readme", ""}},
                        argc, argv, run);
}
