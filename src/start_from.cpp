#include "start_from.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base.hpp"
#include "csv.hpp"

namespace stokes {

namespace {

namespace fs = std::filesystem;

struct Wanted {
  fs::path folder;
  std::optional<double> time;
};

// A folder whose own name ends with a number is taken as it is.
Wanted parse(const std::string& text) {
  const std::size_t space = text.rfind(' ');
  if (space == std::string::npos || fs::exists(text)) return {text, {}};
  const auto time = parse_number(std::string_view(text).substr(space + 1));
  if (!time) return {text, {}};
  return {std::string(trim(text.substr(0, space))), time};
}

Table read_result(const fs::path& file) {
  if (!fs::exists(file))
    throw InputError(concat("start_from: there is no ", file.string(),
                            "; name the output folder of an earlier run, relative ", "to the working directory."));
  return read_csv(file);
}

// The first row of each state; every state has a row for every body.
std::vector<int> find_states(const Table& trajectory, int count) {
  const std::vector<double> step = trajectory.numbers("step"), body = trajectory.numbers("body");
  std::vector<int> first;
  for (int row = 0; row + count <= static_cast<int>(step.size()); row += count) {
    for (int k = 0; k < count; ++k)
      if (body[row + k] != k || step[row + k] != step[row])
        throw InputError(concat(trajectory.where(row + k), ": start_from: this is not the row of body ", k,
                                " of a state of ", count, " bodies; the file does not belong to the bodies.csv beside it."));
    first.push_back(row);
  }
  if (first.empty())
    throw InputError(concat(trajectory.file, ": start_from: there is no state of all ", count, " bodies."));
  return first;
}

int find_state(const Table& trajectory, const std::vector<int>& states, std::optional<double> wanted) {
  if (!wanted) return states.back();
  const int column = trajectory.column("time");
  const auto distance = [&](int row) { return std::abs(trajectory.finite_number(row, column) - *wanted); };
  const int nearest =
      *std::min_element(states.begin(), states.end(), [&](int a, int b) { return distance(a) < distance(b); });
  if (distance(nearest) > 1e-9 * std::max(1.0, std::abs(*wanted)))
    throw InputError(concat(trajectory.file, ": start_from: there is no state at time ", *wanted, "; the nearest is at ",
                            trajectory.text(nearest, column), "."));
  return nearest;
}

}  // namespace

EarlierState earlier_state(const std::string& text) {
  const Wanted wanted = parse(text);
  Table bodies = read_result(wanted.folder / "bodies.csv");
  const Table trajectory = read_result(wanted.folder / "trajectory.csv");
  const int count = static_cast<int>(bodies.rows.size());
  if (count == 0) throw InputError(concat(bodies.where_header(), ": start_from: there are no bodies."));
  const int row = find_state(trajectory, find_states(trajectory, count), wanted.time);

  EarlierState state;
  state.time = trajectory.finite_number(row, trajectory.column("time"));
  state.file = fs::absolute(wanted.folder / "bodies.csv");
  for (const char* name : {"x", "y", "theta"})
    for (int k = 0; k < count; ++k)
      bodies.rows[k].fields[bodies.column(name)] = trajectory.text(row + k, trajectory.column(name));
  state.bodies = join(bodies.header, ",") + "\n";
  for (const Table::Row& body : bodies.rows) state.bodies += join(body.fields, ",") + "\n";
  return state;
}

}  // namespace stokes
