// The verdict: the status of each result against its reference value, and the counts of each status.
#pragma once

#include <array>
#include <filesystem>
#include <numeric>
#include <string>
#include <vector>

#include "reference.hpp"

namespace stokes {

enum class Status { pass, measured, unexplained, fail, stale, missing, not_run };
inline const std::vector<std::string> status_names = {"PASS",  "KNOWN measured", "KNOWN unexplained", "FAIL",
                                                      "STALE", "MISSING",        "NOT RUN"};

inline const std::string& name_of(Status status) { return status_names[static_cast<std::size_t>(status)]; }
// Throws InputError for another name.
inline Status status_of(const std::string& name) {
  const auto at = std::find(status_names.begin(), status_names.end(), name);
  if (at == status_names.end()) throw InputError(concat("unknown verdict ", quote(name)));
  return static_cast<Status>(at - status_names.begin());
}

inline std::string name_of(Origin origin) {
  return origin == Origin::published ? "published" : origin == Origin::exact ? "exact" : "baselines";
}

struct Verdict {
  ReferenceRow reference;
  Status status;
  double got = std::nan("");
  double error = std::nan("");  // distance from the allowed value, over the tolerance; agrees if at most 1
  std::string problem = {};     // why there is no number although its case has been run

  bool has_number() const { return status != Status::missing && status != Status::not_run && problem.empty(); }
};

// A KNOWN row that agrees is stale, because its note is no longer true. NaN and infinity never agree.
inline void judge_number(Verdict& verdict, double got) {
  const ReferenceRow& r = verdict.reference;
  const double outside = std::isfinite(got) ? std::max({0.0, r.low - got, got - r.high}) : std::nan("");
  verdict.got = got;
  verdict.error = outside == 0.0 ? 0.0 : outside / r.tolerance;
  const bool agrees = verdict.error <= 1.0;
  if (r.deviation == Deviation::none) {
    verdict.status = agrees ? Status::pass : Status::fail;
  } else if (agrees) {
    verdict.status = Status::stale;
  } else if (r.known_low <= got && got <= r.known_high) {
    verdict.status = r.deviation == Deviation::measured ? Status::measured : Status::unexplained;
  } else {
    verdict.status = Status::fail;
  }
}

// `if_absent`: status of a row whose case has not been run and is not optional. A file of results that cannot be read, or
// has no such number, fails.
inline Verdict judge(const ReferenceRow& row, const std::filesystem::path& results, Status if_absent) {
  Verdict verdict{row, row.optional ? Status::not_run : if_absent};
  const std::filesystem::path file = results / row.experiment / (row.case_name + ".csv");
  if (!std::filesystem::exists(file)) return verdict;
  try {
    const Table table = read_csv(file);
    if (table.rows.empty()) throw InputError(concat(file.string(), ": no row"));
    judge_number(verdict, table.number(0, table.column(row.quantity)));
  } catch (const InputError& error) {
    verdict.status = Status::fail;
    verdict.problem = error.what();
  }
  return verdict;
}

// The number of rows of each status.
struct Count {
  std::array<int, 7> of{};

  void add(Status status) { ++of[static_cast<std::size_t>(status)]; }
  int operator[](Status status) const { return of[static_cast<std::size_t>(status)]; }
  int numbers() const { return std::accumulate(of.begin(), of.end(), 0); }
  // Cells of the table by object: numbers, agree, differ (measured), unexplained, fail or not run.
  std::array<int, 5> cells() const {
    const Count& n = *this;
    const int agree = n[Status::pass], measured = n[Status::measured], unexplained = n[Status::unexplained];
    return {numbers(), agree, measured, unexplained, numbers() - agree - measured - unexplained};
  }
};

// Counts of each origin and, of published numbers, each object. They are never added across origins.
struct Summary {
  std::array<Count, 3> of_origin;
  std::map<std::string, Count> of_object;
  std::vector<std::string> unexplained;  // places of published numbers

  void add(const ReferenceRow& row, Status status) {
    of_origin[static_cast<std::size_t>(row.origin)].add(status);
    if (row.origin != Origin::published) return;
    of_object[row.object].add(status);
    if (status == Status::unexplained) unexplained.push_back(row.locator);
  }
  const Count& operator[](Origin origin) const { return of_origin[static_cast<std::size_t>(origin)]; }
};

// "published: N numbers, A agree, D differ for a measured reason, U differ without one; exact: ...; baselines: ...;
// not run: ...". FAIL, STALE and MISSING follow where there are any. N includes the numbers under `not run`, so that it is
// the same for every run.
inline std::string summary_line(const Summary& summary) {
  std::string line, not_run;
  for (const Origin origin : {Origin::published, Origin::exact, Origin::baseline}) {
    const Count& count = summary[origin];
    const auto part = [&](Status status, const std::string& words) {
      const bool always = status == Status::pass || (origin == Origin::published && status < Status::fail);
      if (always || count[status] > 0) line += concat(", ", count[status], " ", words);
    };
    line += concat(name_of(origin), ": ", count.numbers(), " numbers");
    part(Status::pass, "agree");
    part(Status::measured, "differ for a measured reason");
    part(Status::unexplained, "differ without one");
    for (const Status status : {Status::fail, Status::stale, Status::missing}) part(status, name_of(status));
    line += "; ";
    if (const int n = count[Status::not_run]) not_run += concat(not_run.empty() ? "" : ", ", n, " ", name_of(origin));
  }
  return concat(line, "not run: ", not_run.empty() ? "none" : not_run);
}

// The table by object: calls row(name, cells) for each, and for all published numbers.
template <class Row>
void for_each_object(const Summary& summary, const Row& row) {
  for (const std::string& object : published_objects) {
    const auto at = summary.of_object.find(object);
    row(object, at == summary.of_object.end() ? Count{}.cells() : at->second.cells());
  }
  row("all published", summary[Origin::published].cells());
}

inline std::string summary_csv(const Summary& summary) {
  std::string text = "object,numbers,agree,differ_measured,unexplained,fail_or_not_run\n";
  for_each_object(summary, [&](const std::string& name, const std::array<int, 5>& numbers) {
    text += name;
    for (const int n : numbers) text += concat(",", n);
    text += "\n";
  });
  return text;
}

// The README's version, with its marks: the table, and every number that differs without a reason.
inline std::string summary_markdown(const Summary& summary) {
  std::string text = "<!-- verdict -->\n| | numbers | agree | differ (measured) | unexplained | fail or not run |\n"
                     "|---|---|---|---|---|---|\n";
  for_each_object(summary, [&](const std::string& name, const std::array<int, 5>& numbers) {
    text += concat("| ", name);
    for (const int n : numbers) text += concat(" | ", n);
    text += " |\n";
  });
  text += concat("\nUnexplained:", summary.unexplained.empty() ? " none." : "", "\n");
  for (const std::string& place : summary.unexplained) text += concat("* ", place, "\n");
  return text + "<!-- end of verdict -->\n";
}

// The summary of `make reproduce`, which leaves optional rows out, if nothing in it fails.
inline Summary expected_summary(const std::vector<ReferenceRow>& rows) {
  Summary summary;
  for (const ReferenceRow& row : rows)
    summary.add(row, row.optional                                ? Status::not_run
                     : row.deviation == Deviation::measured    ? Status::measured
                     : row.deviation == Deviation::unexplained ? Status::unexplained
                                                               : Status::pass);
  return summary;
}

}  // namespace stokes
