// The sources of the report: results and reference values, with a note of everything that is missing or out of date.
#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "csv.hpp"
#include "tex.hpp"

namespace stokes {

inline const std::string missing_mark = "\\missing{}";

// Files that an experiment makes from those of its cases.
inline bool is_collected(const std::filesystem::path& file) {
  const std::string name = file.stem().string();
  for (const char* start : {"table", "summary", "differences", "displacement"})
    if (name.starts_with(start)) return true;
  return false;
}

inline std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder, const char* extension) {
  std::vector<std::filesystem::path> files;
  if (std::filesystem::is_directory(folder))
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().extension() == extension) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

inline std::vector<std::filesystem::path> folders(const std::filesystem::path& root) {
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(root))
    if (entry.is_directory()) found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

// The sources of the report. `problems` lists everything that is missing or out of date.
class Inputs {
 public:
  Inputs(std::filesystem::path results, const std::filesystem::path& reference) : results_(std::move(results)) {
    for (const std::filesystem::path& file : files_in(reference, ".csv")) reference_.push_back(read_csv(file));
    if (reference_.empty()) throw InputError(concat("no reference values in ", quote(reference.string())));
  }

  const std::filesystem::path& results() const { return results_; }
  const std::set<std::string>& problems() const { return problems_; }
  void problem(const std::string& text) { problems_.insert(text); }

  // A file that is older than the results of a case in `folder` is a problem.
  void require_not_older(const std::filesystem::path& file, const std::filesystem::path& folder) {
    for (const std::filesystem::path& other : files_in(folder, ".csv"))
      if (!is_collected(other) && std::filesystem::last_write_time(other) > std::filesystem::last_write_time(file))
        problem(concat(file.string(), " is older than ", other.string()));
  }

  // A table of the results by its name without .csv; nothing if it is missing.
  const Table* table(const std::string& name) {
    const auto known = tables_.find(name);
    if (known != tables_.end()) return known->second ? &*known->second : nullptr;
    const std::filesystem::path file = results_ / (name + ".csv");
    auto& slot = tables_[name];
    if (!std::filesystem::exists(file)) {
      problem(concat("no ", file.string()));
      return nullptr;
    }
    if (is_collected(file)) require_not_older(file, file.parent_path());
    slot = read_csv(file);
    return &*slot;
  }

  // A value in the first row, or in the row of a selection after the name of the file: table[phi=5,lambda=3].
  std::optional<double> number(const std::string& file, const std::string& column) {
    const std::size_t bracket = std::min(file.find('['), file.size());
    const Table* found = table(file.substr(0, bracket));
    if (!found) return std::nullopt;
    for (int row = 0; row < static_cast<int>(found->rows.size()); ++row)
      if (found->has_column(column) && selected(*found, row, file.substr(bracket)))
        return found->number(row, found->column(column));
    problem(concat("no ", column, file.substr(bracket), " in ", found->file));
    return std::nullopt;
  }

  // The same as LaTeX, or the mark of a missing value.
  std::string tex(const std::string& file, const std::string& column, const std::string& format) {
    const std::optional<double> value = number(file, column);
    return value ? tex_number(*value, format) : missing_mark;
  }

  // The value of the reference row with this id, with the digits written there.
  std::string published(const std::string& id) {
    for (const Table& t : reference_)
      for (int row = 0; row < static_cast<int>(t.rows.size()); ++row)
        if (t.text(row, t.column("id")) == id) {
          const std::string& value = t.text(row, t.column("value"));
          return parse_number(value) ? tex_decimal(value) : value;
        }
    problem(concat("no reference value with the id ", quote(id)));
    return missing_mark;
  }

 private:
  // Rows selected by [column=number,...]; all rows if it is empty.
  static bool selected(const Table& t, int row, std::string_view selection) {
    if (selection.empty()) return true;
    if (selection.back() != ']') throw InputError(concat("a row is named like [phi=5,lambda=3], not ", quote(selection)));
    for (const std::string_view condition : split(selection.substr(1, selection.size() - 2), ',')) {
      const std::size_t equals = condition.find('=');
      const auto value = equals == std::string_view::npos ? std::nullopt : parse_number(condition.substr(equals + 1));
      if (!value) throw InputError(concat("a row is named like [phi=5,lambda=3], not ", quote(selection)));
      if (t.number(row, t.column(condition.substr(0, equals))) != *value) return false;
    }
    return true;
  }

  std::filesystem::path results_;
  std::vector<Table> reference_;
  std::map<std::string, std::optional<Table>> tables_;
  std::set<std::string> problems_;
};

}  // namespace stokes
