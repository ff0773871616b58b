// Writes the numbers and tables of the report as LaTeX, from results and reference values alone.
//
//   report [results=DIR] [reference=DIR] [document=DIR] [errata=FILE] [missing=fail|allow]
//
// The document (all .tex files of its folder) requests a number by \result{EXPERIMENT/CASE}{COLUMN}{FORMAT}. It is in the
// first row of results/EXPERIMENT/CASE.csv, or in the row of a selection, as in table[phi=5,lambda=3]; FORMAT is that of
// tex_number. The document requests a published value by \published{ID}, the id of a row of the reference values. The
// definitions go to results/report/values.tex, the tables to files beside it. Exit status: 0; 1 for results that are
// missing or older than their sources, unless missing=allow, which writes \missing{} instead; 2 for wrong input.

#include <algorithm>
#include <cstdio>

#include "on_results.hpp"
#include "report_inputs.hpp"
#include "verdict.hpp"

namespace {

using namespace stokes;
namespace fs = std::filesystem;

// --- the parts of the report ----------------------------------------------------------------------------

std::string row_of(const std::vector<std::string>& cells) { return join(cells, " & ") + " \\\\\n"; }

std::string definition(const std::string& name, const std::string& value) {
  return concat("\\expandafter\\def\\csname ", name, "\\endcsname{", value, "}\n");
}

std::string values(Inputs& inputs, const std::string& document) {
  std::string text;
  for (const auto& r : requests_in(document, "result", 3))
    text += definition(concat("result/", join(r, "/")), inputs.tex(r[0], r[1], r[2]));
  for (const auto& r : requests_in(document, "published", 1))
    text += definition(concat("published/", r[0]), inputs.published(r[0]));
  return text;
}

// Calls visit(row) for each row of the verdict, with its columns by name; false if there is no verdict.
template <class Visit>
bool for_each_verdict(Inputs& inputs, const Visit& visit) {
  const Table* verdict = inputs.table("verdict");
  if (!verdict) return false;
  for (int row = 0; row < static_cast<int>(verdict->rows.size()); ++row)
    visit([&](const char* column) { return verdict->text(row, verdict->column(column)); });
  return true;
}

// Published numbers by table and figure of the paper, then exact ones and own baselines.
std::string verdict_table(Inputs& inputs) {
  Summary summary;
  const bool is_there = for_each_verdict(inputs, [&](const auto& text) {
    ReferenceRow row{};
    row.origin = origin_of(text("source"));
    if (row.origin == Origin::published) row.object = object_of(text("locator"));
    const Status status = status_of(text("verdict"));
    if (status == Status::missing)
      inputs.problem(concat("no result ", text("experiment"), "/", text("case"), " ", text("quantity")));
    summary.add(row, status);
  });
  if (!is_there) return row_of({missing_mark});
  std::string table;
  const auto add = [&](const std::string& name, const Count& count) {
    std::vector<std::string> cells = {tex_text(name)};
    for (const int n : count.cells()) cells.push_back(n ? format_number(n) : "");
    table += row_of(cells);
  };
  for (const std::string& object : published_objects) add(object, summary.of_object[object]);
  table += "\\midrule\n";
  for (const Origin origin : {Origin::published, Origin::exact, Origin::baseline}) add(name_of(origin), summary[origin]);
  return table;
}

// Rows of the verdict with one of these statuses: KNOWN ones once for each note, the others one by one.
std::string verdict_rows(Inputs& inputs, const std::vector<Status>& statuses) {
  std::map<std::pair<std::string, std::string>, int> groups;
  const bool is_there = for_each_verdict(inputs, [&](const auto& text) {
    const Status status = status_of(text("verdict"));
    if (std::find(statuses.begin(), statuses.end(), status) == statuses.end()) return;
    const std::string what = concat("\\texttt{", tex_text(concat(text("case"), " ", text("quantity"))), "}: ");
    const std::string reason = known_note(text("note")).reason;
    const std::optional<double> number = parse_number(text("got"));
    const std::string got = number ? tex_number(*number, "5g") : "--";
    const bool is_known = status == Status::measured || status == Status::unexplained;
    ++groups[{text("experiment"), is_known ? tex_prose(reason)
                                           : concat(what, got, ", expected ", tex_text(text("expected")))}];
  });
  if (!is_there) return row_of({missing_mark});
  std::string table;
  for (const auto& [group, count] : groups)
    table += row_of({concat("\\texttt{", tex_text(group.first), "}"), format_number(count), group.second});
  return table.empty() ? row_of({"none", "", ""}) : table;
}

// Four lines for each separation: published, and by three models of contact.
std::string table1(Inputs& inputs) {
  const std::vector<std::string> steps = {"0.04", "0.02", "0.01", "0.005", "0.0025"};
  const std::vector<std::pair<std::string, std::string>> models = {
      {"", "exact gap"}, {"_stiv", "volumes, 128 vertices"}, {"_stiv32", "volumes, 32 vertices"}};
  std::string table;
  for (const char* separation : {"0", "1", "2", "2.25", "2.5", "2.75", "3"}) {
    std::vector<std::string> line = {separation == std::string("0") ? "0" : concat("$", separation, "h$"), "published"};
    for (const std::string& step : steps) line.push_back(inputs.published(concat("t1-", separation, "h-", step)));
    table += concat(separation == std::string("0") ? "" : "\\addlinespace\n", row_of(line));
    for (const auto& [suffix, model] : models) {
      if (!suffix.empty() && *parse_number(separation) < 2.0) continue;  // no contact there
      line = {"", model};
      for (const std::string& step : steps)
        line.push_back(inputs.tex(concat("table1_reversibility/delta", separation, "h_dt", step, suffix),
                                  "reversal_error", "4f"));
      table += row_of(line);
    }
  }
  return table;
}

// The published mean, that from the paper's start, and mean and range over other starts.
std::string couette_table(Inputs& inputs, const std::string& name, bool order_parameter) {
  const Table* t = inputs.table(name + "/table");
  if (!t) return row_of({missing_mark});
  inputs.require_not_older(inputs.results() / name / "table.csv", inputs.results() / "couette_run");
  std::string table;
  for (int row = 0; row < static_cast<int>(t->rows.size()); ++row) {
    const auto number = [&](const char* column) { return t->number(row, t->column(column)); };
    const double lambda = number("lambda");
    const auto digits = [&](const char* column) { return tex_number(number(column), "3f"); };
    const bool others = number("seeds") > 0.0;
    std::vector<std::string> cells = {concat(number("phi"), "\\,\\%"),
                                      format_number(lambda),
                                      tex_number(number("published"), "4f"),
                                      tex_number(number("mean"), "4f"),
                                      others ? digits("mean_of_seeds") : "not run",
                                      others ? concat(digits("minimum"), " to ", digits("maximum")) : "",
                                      format_number(number("seeds"))};
    if (order_parameter) cells.push_back(tex_number((lambda - 1.0) / (lambda + 1.0), "3f"));
    table += row_of(cells);
  }
  return table;
}

// Published, with 32 nodes a body, with resolved velocities.
std::string resolved_table(Inputs& inputs) {
  const Table* t = inputs.table("resolved/table");
  if (!t) return row_of({missing_mark});
  inputs.require_not_older(inputs.results() / "resolved/table.csv", inputs.results() / "resolved");
  std::string table;
  for (int row = 0; row < static_cast<int>(t->rows.size()); ++row) {
    std::vector<std::string> cells;
    for (const char* column : {"object", "quantity"}) cells.push_back(tex_text(t->text(row, t->column(column))));
    for (const char* column : {"published", "points32", "accuracy1e-6"})
      cells.push_back(tex_number(t->number(row, t->column(column)), "4g"));
    table += row_of(cells);
  }
  return table;
}

std::string timing_table(Inputs& inputs) {
  std::string table;
  for (const fs::path& folder : folders(inputs.results()))
    for (const fs::path& file : files_in(folder, ".csv")) {
      const std::string stem = file.stem().string(), experiment = folder.filename().string();
      if (!stem.ends_with("_timing")) continue;
      const std::string name = stem.substr(0, stem.size() - 7);
      const Table* run = inputs.table(concat(experiment, "/", name));
      table += row_of({concat("\\texttt{", tex_text(experiment), "}"), tex_text(name),
                       run && run->has_column("steps") ? tex_number(run->number(0, run->column("steps")), "0f") : "",
                       inputs.tex(concat(experiment, "/", stem), "seconds", "0f")});
    }
  if (table.empty()) inputs.problem("no timings in the results");
  return table.empty() ? row_of({missing_mark}) : table;
}

// Kernels and steps, as `make bench` times them.
std::string bench_table(Inputs& inputs) {
  const Table* t = inputs.table("bench/bench");
  if (!t) return row_of({missing_mark});
  std::string table;
  for (int row = 0; row < static_cast<int>(t->rows.size()); ++row) {
    const auto text = [&](const char* column) { return tex_text(t->text(row, t->column(column))); };
    const std::string value = tex_number(t->number(row, t->column("value")), "3g");
    table += row_of({text("quantity"), text("size"), text("threads"), value, text("unit")});
  }
  return table;
}

// Rows of the first table of a Markdown file.
std::string errata(const std::string& markdown) {
  std::string table;
  int lines = 0;
  for (const std::string_view line : split(markdown, '\n')) {
    if (!line.starts_with("|") || ++lines <= 2) continue;  // header, rule
    std::vector<std::string> cells;
    const std::string_view inner = trim(line);
    for (const std::string_view cell : split(inner.substr(1, inner.size() - 2), '|')) cells.push_back(tex_prose(trim(cell)));
    table += row_of(cells);
  }
  if (table.empty()) throw InputError("no table of errata");
  return table;
}

std::string provenance(Inputs& inputs) {
  const Table* t = inputs.table("fig2_shear_separation/delta0h");
  std::string text;
  for (const char* key : {"version", "compiler"})
    text += concat("\\newcommand{\\", key, "}{", t ? tex_text(t->comment(key)) : missing_mark, "}\n");
  return text;
}

void require_fresh_verdict(Inputs& inputs, const fs::path& reference) {
  const fs::path verdict = inputs.results() / "verdict.csv";
  if (!fs::exists(verdict)) return;  // reported when it is read
  inputs.require_not_older(verdict, reference);
  for (const fs::path& folder : folders(inputs.results())) inputs.require_not_older(verdict, folder);
}

constexpr const char* usage =
    "usage: report [results=DIR] [reference=DIR] [document=DIR] [errata=FILE] [missing=fail|allow]";

int run(Arguments& options) {
  if (!fs::is_directory(options["results"])) throw InputError(concat("no results in ", quote(options["results"])));

  Inputs inputs(options["results"], options["reference"]);
  require_fresh_verdict(inputs, options["reference"]);
  std::string document;
  for (const fs::path& file : files_in(options["document"], ".tex")) document += read_text_file(file, "the report");
  if (document.empty()) throw InputError(concat("no report in ", quote(options["document"])));
  const std::map<std::string, std::string> parts = {
      {"values", provenance(inputs) + values(inputs, document)},
      {"verdict", verdict_table(inputs)},
      {"measured", verdict_rows(inputs, {Status::measured})},
      {"unexplained", verdict_rows(inputs, {Status::unexplained})},
      {"failed", verdict_rows(inputs, {Status::fail, Status::stale})},
      {"table1", table1(inputs)},
      {"table2", couette_table(inputs, "table2_order_parameter", true)},
      {"table3", couette_table(inputs, "table3_effective_viscosity", false)},
      {"resolved", resolved_table(inputs)},
      {"timing", timing_table(inputs)},
      {"bench", bench_table(inputs)},
      {"errata", errata(read_text_file(options["errata"], "the list of errata"))}};
  std::size_t told = 0;
  for (const std::string& problem : inputs.problems())
    if (++told <= 10) std::fprintf(stderr, "report: %s\n", problem.c_str());
  if (told > 10) std::fprintf(stderr, "report: and %zu more\n", told - 10);
  if (!inputs.problems().empty() && options["missing"] == "fail") return 1;
  fs::create_directories(inputs.results() / "report");
  for (const auto& [name, text] : parts) write_file_atomically(inputs.results() / "report" / (name + ".tex"), text);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const char* help =
      "Writes the numbers, tables and lists that the report asks for to DIR/report/*.tex. Exit status 1,\n"
      "and nothing is written, if one of them is missing, unless missing=allow.\n";
  return run_on_results("report", usage, help,
                        {{"results", "results"},
                         {"reference", "reference_data"},
                         {"document", "paper"},
                         {"errata", "paper/ERRATA.md"}},
                        argc, argv, run);
}
