// The verdict of `verify` on right, wrong and broken results, and the rows of reference_data that it reads.
#include <doctest/doctest.h>

#include "program.hpp"
#include "verdict.hpp"

using namespace stokes;
namespace fs = std::filesystem;

namespace {

// A row of reference values about the number `error` of run/first, by its cells that matter here.
struct Row {
  std::string id = "r", quantity = "error", value = "2", check = "close", abs_tol = "0.1", source = "paper_table";
  std::string locator = "Table 1, first", known = ",", note = "";

  std::string line() const {
    return concat(id, ",run,first,", quantity, ",1,", value, ",", check, ",", abs_tol, ",0,", known, ",", source, ",",
                  csv_field(locator), ",", csv_field(note), "\n");
  }
};

Row known_row() {
  Row row;
  row.known = "2.4,2.6", row.note = "KNOWN measured: the step is coarse";
  return row;
}

// Folders of reference values and of results, in which the program runs.
class VerdictFolder {
 public:
  explicit VerdictFolder(const std::vector<Row>& rows) {
    for (const char* name : {"results/run", "reference_data"}) fs::create_directories(folder_.path() / name);
    std::string text = reference_columns + "\n";
    for (const Row& row : rows) text += row.line();
    write("reference_data/run.csv", text);
  }
  void write(const std::string& name, const std::string& text) const { write_file_atomically(path(name), text); }
  fs::path path(const std::string& name) const { return folder_.path() / name; }
  ProgramRun verify(const std::vector<std::string>& arguments = {}) const {
    return run_program(simulate_program().parent_path() / "verify", arguments, folder_.path());
  }
  // The verdict on a row in the latest run.
  std::string verdict(int row = 0) const {
    const Table table = read_csv(path("results/verdict.csv"));
    return table.text(row, table.column("verdict"));
  }

 private:
  TemporaryFolder folder_;
};

std::string last_line(const std::string& text) {
  const std::string_view whole = trim(text);
  return std::string(whole.substr(whole.rfind('\n') + 1));
}

// The verdict and the exit status for one row and one result file.
void check_verdict(const Row& row, const std::string& result, const std::string& expected, int status) {
  CAPTURE(row.line());
  CAPTURE(result);
  const VerdictFolder here({row});
  here.write("results/run/first.csv", result);
  const ProgramRun run = here.verify();
  CHECK(here.verdict() == expected);
  CHECK(run.status == status);
  CHECK(run.errors == "");
}

void check_malformed(const std::vector<Row>& rows, const std::string& expected) {
  CAPTURE(rows.back().line());
  const VerdictFolder here(rows);
  here.write("results/run/first.csv", "error,other\n2,2\n");
  const ProgramRun run = here.verify();
  CHECK(run.status == 2);
  CHECK(run.output == "");
  CHECK(run.errors.find(concat("run.csv:", rows.size() + 1, ": ")) != std::string::npos);
  CHECK(run.errors.find(expected) != std::string::npos);
  CHECK(!fs::exists(here.path("results/verdict.csv")));
}

}  // namespace

TEST_CASE("a number passes within its tolerance and fails beyond it") {
  check_verdict(Row{}, "error\n2.09\n", "PASS", 0);
  check_verdict(Row{}, "error\n2.11\n", "FAIL", 1);
  const auto bound = [](const std::string& check, const std::string& value) {
    Row row;
    row.check = check, row.value = value;
    return row;
  };
  check_verdict(bound("at_most", "2"), "error\n-5\n", "PASS", 0);
  check_verdict(bound("at_most", "2"), "error\n2.2\n", "FAIL", 1);
  check_verdict(bound("at_least", "2"), "error\n1.95\n", "PASS", 0);
  check_verdict(bound("order_at_least", "2"), "error\n1.85\n", "FAIL", 1);
  check_verdict(bound("interval", "2..3"), "error\n3.09\n", "PASS", 0);
  check_verdict(bound("interval", "2..3"), "error\n3.2\n", "FAIL", 1);
  check_verdict(bound("true", "1"), "error\n0\n", "FAIL", 1);
}

TEST_CASE("what is not a finite number fails, whatever the check") {
  for (const char* check : {"close", "at_most", "at_least"})
    for (const char* got : {"nan", "inf", "-inf"}) {
      Row row;
      row.check = check;
      check_verdict(row, concat("error\n", got, "\n"), "FAIL", 1);
    }
  check_verdict(known_row(), "error\nnan\n", "FAIL", 1);
}

TEST_CASE("a result that is there but has no such number fails") {
  for (const char* text : {"steps\n2\n", "error\n", "", "error\nfast\n", "error,steps\n2\n", "\"error\n2\n"}) {
    check_verdict(Row{}, text, "FAIL", 1);
    check_verdict(known_row(), text, "FAIL", 1);
  }
}

TEST_CASE("a known deviation is accepted within its interval only, and is stale where the number agrees") {
  check_verdict(known_row(), "error\n2.5\n", "KNOWN measured", 0);
  check_verdict(known_row(), "error\n2.4\n", "KNOWN measured", 0);
  check_verdict(known_row(), "error\n2.3\n", "FAIL", 1);
  check_verdict(known_row(), "error\n5\n", "FAIL", 1);  // twice as large
  check_verdict(known_row(), "error\n2.05\n", "STALE", 1);
  Row row = known_row();
  row.note = "KNOWN unexplained: none was found";
  check_verdict(row, "error\n2.5\n", "KNOWN unexplained", 0);
  row.note = "KNOWN: unexplained: none was found";
  check_verdict(row, "error\n2.5\n", "KNOWN unexplained", 0);
  row.note = "OPTIONAL: nine starts. KNOWN measured: the step is coarse";
  check_verdict(row, "error\n2.5\n", "KNOWN measured", 0);
  check_verdict(row, "error\n2\n", "STALE", 1);
}

TEST_CASE("a case that has not been run is missing, or not run where it need not be") {
  Row optional;
  optional.id = "s", optional.quantity = "other", optional.locator = "Table 1, other";
  optional.note = "OPTIONAL: nine starts";
  const VerdictFolder here({Row{}, optional});
  CHECK(here.verify().status == 1);
  CHECK(here.verdict(0) == "MISSING");
  CHECK(here.verdict(1) == "NOT RUN");
  CHECK(here.verify({"missing=allow"}).status == 0);
  CHECK(here.verdict(0) == "NOT RUN");
  here.write("results/run/first.csv", "error\n2\n");  // without the other one
  CHECK(here.verify().status == 1);
  CHECK(here.verdict(0) == "PASS");
  CHECK(here.verdict(1) == "FAIL");
}

TEST_CASE("malformed rows and doubled ones are refused with file and line") {
  const auto with = [](std::string Row::*cell, const std::string& text) {
    Row row;
    row.*cell = text;
    return row;
  };
  check_malformed({with(&Row::id, "")}, "no id");
  check_malformed({with(&Row::value, "two")}, "value is a finite number, not 'two'");
  check_malformed({with(&Row::abs_tol, "-1")}, "not negative");
  check_malformed({with(&Row::abs_tol, "")}, "abs_tol");
  check_malformed({with(&Row::check, "near")}, "unknown check 'near'");
  check_malformed({with(&Row::check, "interval")}, "low..high");
  check_malformed({with(&Row::check, "true")}, "is 1, not 2");
  check_malformed({with(&Row::source, "paper")}, "unknown source 'paper'");
  for (const char* locator : {"", "Table 1", "Table 11, first", "Figure 2: left", "sec. 4.1", "claims of the text, first"})
    check_malformed({with(&Row::locator, locator)}, "locator");
  for (const char* note : {"KNOWN: coarse", "KNOWN measured", "KNOWN measured: ", "OPTIONAL: nine starts. KNOWN: coarse"}) {
    Row row = known_row();
    row.note = note;
    check_malformed({row}, "`KNOWN measured: reason`");
  }
  check_malformed({with(&Row::known, "2.4,2.6")}, "need a KNOWN note");
  check_malformed({with(&Row::note, "KNOWN measured: coarse")}, "known_low");
  for (const char* interval : {"2.4,", ",2.6", "2.4,nan", "2.6,2.4"}) {
    Row row = known_row();
    row.known = interval;
    check_malformed({row}, "known_");
  }
  Row second;
  second.quantity = "other", second.locator = "Table 1, second";
  check_malformed({Row{}, second}, "the id r is there twice");
  second.id = "s", second.locator = Row{}.locator;
  check_malformed({Row{}, second}, "the published number of 'Table 1, first' is there twice");
  second.quantity = Row{}.quantity, second.locator = "Table 1, second";
  check_malformed({Row{}, second}, "a published value of run/first error is there twice");
  const VerdictFolder columns(std::vector<Row>{});
  columns.write("reference_data/run.csv", "id,value\nr,2\n");
  CHECK(columns.verify().status == 2);
}

TEST_CASE("an exact value may speak of a number that is published, too") {
  Row exact;
  exact.id = "s", exact.source = "exact", exact.locator = "closed form";
  const VerdictFolder here({Row{}, exact});
  here.write("results/run/first.csv", "error\n2\n");
  CHECK(here.verify().status == 0);
}

TEST_CASE("the summary counts published, exact and own numbers apart, and adds up") {
  std::vector<Row> rows;
  const std::vector<std::string> sources = {"paper_table", "paper_text", "paper_figure", "paper_figure", "paper_figure",
                                            "exact",       "exact",      "own_baseline", "paper_table"};
  const std::vector<std::string> places = {"Table 1, a",  "section 4.1, b", "Figure 10, c", "Figure 10, d", "Figure 10, e",
                                           "closed form", "closed form",    "earlier",      "Table 2, f"};
  std::string header, numbers;
  const std::vector<std::string> got = {"2", "2.5", "2.5", "2", "9", "2", "nan", "2"};
  for (std::size_t k = 0; k < sources.size(); ++k) {
    Row row = k == 1 || k == 2 || k == 3 ? known_row() : Row{};
    if (k == 2) row.note = "KNOWN unexplained: none was found";
    if (k == 8) row.note = "OPTIONAL: nine starts";
    row.id = row.quantity = concat("q", k), row.source = sources[k], row.locator = places[k];
    rows.push_back(row);
    if (k == 8) continue;
    header += concat(k ? "," : "", row.quantity), numbers += concat(k ? "," : "", got[k]);
  }
  const VerdictFolder here(rows);
  std::string reference = content_of(here.path("reference_data/run.csv"));
  const std::string last = "q8,run,first";
  reference.replace(reference.find(last), last.size(), "q8,run,second");
  here.write("reference_data/run.csv", reference);
  here.write("results/run/first.csv", header + "\n" + numbers + "\n");
  const ProgramRun run = here.verify();
  CHECK(run.status == 1);
  CHECK(last_line(run.output) ==
        "published: 6 numbers, 1 agree, 1 differ for a measured reason, 1 differ without one, 1 FAIL, 1 STALE; "
        "exact: 2 numbers, 1 agree, 1 FAIL; baselines: 1 numbers, 1 agree; not run: 1 published");
  const Table summary = read_csv(here.path("results/verdict_summary.csv"));
  CHECK(summary.rows.size() == published_objects.size() + 1);
  const auto cells = [&](const std::string& object) {
    for (const Table::Row& row : summary.rows)
      if (row.fields[0] == object) return join(row.fields, ",");
    return std::string("none");
  };
  CHECK(cells("Table 1") == "Table 1,1,1,0,0,0");
  CHECK(cells("Table 2") == "Table 2,1,0,0,0,1");
  CHECK(cells("Figure 5") == "Figure 5,0,0,0,0,0");
  CHECK(cells("Figure 10") == "Figure 10,3,0,0,1,2");
  CHECK(cells("claims of the text") == "claims of the text,1,0,1,0,0");
  CHECK(cells("all published") == "all published,6,1,1,1,3");
}

TEST_CASE("rows=differing prints what does not pass, rows=all everything") {
  Row second = known_row();
  second.id = "s", second.quantity = "other", second.locator = "Table 1, second";
  const VerdictFolder here({Row{}, second});
  here.write("results/run/first.csv", "error,other\n2,2.5\n");
  const auto count = [](const std::string& text, const std::string& word) {
    int n = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++n;
    return n;
  };
  const ProgramRun all = here.verify(), differing = here.verify({"rows=differing"});
  CHECK(count(all.output, "\n  first ") == 2);
  CHECK(count(differing.output, "\n  first ") == 1);
  CHECK(differing.output.find("KNOWN measured, run: the step is coarse") != std::string::npos);
  CHECK(last_line(all.output) == last_line(differing.output));
  CHECK(here.verify({"rows=some"}).status == 2);
}

TEST_CASE("a page whose table by object is not that of the run is told") {
  const VerdictFolder here({Row{}});
  here.write("results/run/first.csv", "error\n2\n");
  const std::string table = summary_markdown(expected_summary(read_references(here.path("reference_data"))));
  CHECK(table.find("| Table 1 | 1 | 1 | 0 | 0 | 0 |\n") != std::string::npos);
  here.write("page.md", "text\n\n" + table + "\ntext\n");
  CHECK(here.verify({"readme=page.md"}).status == 0);
  here.write("page.md", "text\n\n" + table.substr(0, table.size() / 2) + "\ntext\n");
  const ProgramRun other = here.verify({"readme=page.md"});
  CHECK(other.status == 1);
  CHECK(other.output.find(table) != std::string::npos);
  CHECK(here.verify({"readme=none.md"}).status == 2);
  fs::remove(here.path("results/run/first.csv"));  // nothing to compare with
  CHECK(here.verify({"readme=page.md"}).output.find("<!--") == std::string::npos);
}

TEST_CASE("the README's table by object is that of the reference values") {
  const std::string table = summary_markdown(expected_summary(read_references("reference_data")));
  CAPTURE(table);
  CHECK(content_of("README.md").find(table) != std::string::npos);
}
