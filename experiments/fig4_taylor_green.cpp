// Figure 4: the Taylor-Green suspension to t = 30 for three time steps: snapshots, the track of one body, contacts
// and iterations. Beside the exact gap, nodes clustered near contacts: interference volumes (_stiv), 32 nodes
// at equal steps (_plain), 64 nodes, a tolerance of 1e-8, adaptive steps. A run that fails is a result: `completed` and
// the comment `ending` tell when and why.

#include <chrono>

#include "experiment.hpp"
#include "taylor_green.hpp"

namespace {

using namespace stokes;

const std::vector<std::string> time_steps = {"0.025", "0.0125", "0.00625"};
const std::vector<double> snapshot_times = {0.0, 15.0, 30.0};

struct Case {
  std::string name;
  TaylorGreen parameters;
};

std::vector<Case> all_cases() {
  std::vector<Case> all;
  for (const std::string& time_step : time_steps) {
    TaylorGreen parameters;
    parameters.time_step = *parse_number(time_step);
    all.push_back({concat("dt", time_step), parameters});
    parameters.contact = ContactModel::stiv;
    all.push_back({concat("dt", time_step, "_stiv"), parameters});
    parameters.contact = ContactModel::gap;
    parameters.refine = Refine::none;
    all.push_back({concat("dt", time_step, "_plain"), parameters});
  }
  TaylorGreen to_10;
  to_10.end_time = 10.0;
  all.push_back({"points64", to_10});
  all.back().parameters.points = 64;
  all.push_back({"tolerance1e-8", to_10});
  all.back().parameters.gmres_tolerance = 1e-8;
  all.push_back({"adaptive_dt0.1", {}});
  all.back().parameters.time_step = 0.1;
  all.back().parameters.adaptive = true;
  all.push_back({"quick", {}});
  all.back().parameters.end_time = 4.0;
  return all;
}

Quantities summarise(const TaylorGreenRun& run) {
  long ncp = 0, largest_ncp = 0, contact_steps = 0, steps = 0;
  double contact_time = 0.0, smallest_dt = run.steps[0].dt, gap = run.steps[0].gap_over_h;
  double smallest = std::numeric_limits<double>::infinity(), largest = 0.0, force = 0.0, torque = 0.0;
  double first_contact = std::nan("");
  for (const TaylorGreenStep& step : run.steps) {
    gap = std::min(gap, step.gap_over_h);
    if (!step.moved) continue;
    ++steps;
    ncp += step.ncp_iterations;
    largest_ncp = std::max<long>(largest_ncp, step.ncp_iterations);
    smallest_dt = std::min(smallest_dt, step.dt);
    smallest = std::min(smallest, step.smallest_multiplier);
    largest = std::max(largest, step.largest_multiplier);
    force = std::max(force, step.net_force);
    torque = std::max(torque, step.net_torque);
    if (step.contacts == 0) continue;
    if (contact_steps++ == 0) first_contact = step.time;
    contact_time += step.dt;
  }
  const double end = run.steps.back().time;
  const auto mean = [&](int TaylorGreenStep::*number) {
    return mean_over_steps(run, [number](const TaylorGreenStep& step) { return step.*number; });
  };
  return {{"completed", run.failure.empty() ? 1.0 : 0.0},
          {"end_time", end},
          {"steps", static_cast<double>(steps)},
          {"rejected", run.failure.empty() ? static_cast<double>(run.summary.rejected) : std::nan("")},
          {"smallest_step", smallest_dt},
          {"first_contact", first_contact},
          {"ncp_iterations", static_cast<double>(ncp)},
          {"largest_ncp_iterations", static_cast<double>(largest_ncp)},
          {"contact_share_of_steps", static_cast<double>(contact_steps) / static_cast<double>(std::max(steps, 1L))},
          {"contact_share_of_time", contact_time / end},
          {"gmres_iterations_per_step", mean(&TaylorGreenStep::gmres_iterations)},
          {"background_iterations_per_step", mean(&TaylorGreenStep::background_iterations)},
          {"smallest_gap_over_h", gap},
          {"smallest_multiplier", smallest},
          {"largest_multiplier", largest},
          {"net_force", force},
          {"net_torque", torque}};
}

void write_track(const std::string& name, const TaylorGreenRun& run, const Results& results) {
  std::vector<std::vector<double>> rows;
  for (const TaylorGreenStep& s : run.steps)
    rows.push_back({s.time, s.dt, s.coloured.centre.real(), s.coloured.centre.imag(), s.coloured.angle,
                    s.coloured_in_contact ? 1.0 : 0.0, static_cast<double>(s.contacts),
                    static_cast<double>(s.ncp_iterations), static_cast<double>(s.gmres_iterations),
                    static_cast<double>(s.background_iterations), s.gap_over_h});
  results.write(name + "_track",
                {"time", "dt", "x", "y", "theta", "in_contact", "contacts", "ncp_iterations", "gmres_iterations",
                 "background_iterations", "gap_over_h"},
                rows);
}

void run_case(const std::string& name, const Results& results) {
  const std::vector<Case> all = all_cases();
  const Case& chosen = *std::find_if(all.begin(), all.end(), [&](const Case& c) { return c.name == name; });
  std::vector<std::vector<double>> snapshots;
  std::vector<bool> in_contact(taylor_green_bodies().size());  // in the step that led here
  std::size_t next = 0;
  const auto observe = [&](const StepRecord& record) {
    if (next < snapshot_times.size() && record.time > snapshot_times[next] - 1e-9) {
      for (std::size_t i = 0; i < record.bodies.size(); ++i) {
        const Pose& pose = record.bodies[i].pose;
        snapshots.push_back({record.time, static_cast<double>(i), pose.centre.real(), pose.centre.imag(), pose.angle,
                             i == coloured_body ? 1.0 : 0.0, in_contact[i] ? 1.0 : 0.0});
      }
      ++next;
    }
    std::fill(in_contact.begin(), in_contact.end(), false);
    if (!record.outcome) return;
    for (const ActiveContact& c : record.outcome->contacts) in_contact[c.constraint.a] = in_contact[c.constraint.b] = true;
  };
  const auto start = std::chrono::steady_clock::now();
  const TaylorGreenRun run = run_taylor_green(taylor_green_bodies(), chosen.parameters, observe);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  write_track(name, run, results);
  results.write(name + "_snapshots", {"time", "body", "x", "y", "theta", "coloured", "in_contact"}, snapshots);
  results.write(name + "_timing", {{"seconds", seconds}});
  results.write(name, summarise(run), {{"ending", run.failure.empty() ? "end_time" : run.failure}});
}

// The centre of the coloured body: it moves linearly within a step.
class Track {
 public:
  explicit Track(const Table& table) : time_(table.numbers("time")), x_(table.numbers("x")), y_(table.numbers("y")) {}

  // NaN after the end.
  Complex at(double time) const {
    if (time > time_.back() + 1e-9) return {std::nan(""), 0.0};
    const auto after = std::lower_bound(time_.begin(), time_.end(), time - 1e-9) - time_.begin();
    if (after == 0) return {x_[0], y_[0]};
    const double tau = (time - time_[after - 1]) / (time_[after] - time_[after - 1]);
    return {x_[after - 1] + tau * (x_[after] - x_[after - 1]), y_[after - 1] + tau * (y_[after] - y_[after - 1])};
  }

 private:
  std::vector<double> time_, x_, y_;
};

struct Pair {
  std::string name, first, second;
};

// differences.csv: how far the coloured bodies of two runs are apart; summary.csv: the largest up to t = 10, and
// some later ones; table.csv: all runs, numbered in the order of the comment lines.
void collect(const Results& results) {
  std::vector<std::vector<double>> columns;
  std::vector<std::string> header = {"time"};
  Quantities row;
  const auto compare = [&](const Pair& pair) {
    if (!results.has(pair.first) || !results.has(pair.second)) return;
    const Track first(read_csv(results.path(pair.first + "_track"))), second(read_csv(results.path(pair.second + "_track")));
    header.push_back(pair.name);
    columns.emplace_back();
    double largest = 0.0;
    for (int k = 0; k <= 300; ++k) {
      const double apart = std::abs(first.at(0.1 * k) - second.at(0.1 * k));
      columns.back().push_back(apart);
      if (k <= 100 && !(apart <= largest)) largest = apart;
      for (int whole : {5, 10, 15, 20, 30})
        if (k == 10 * whole && !std::isnan(apart)) row.push_back({concat(pair.name, "_at_", whole), apart});
    }
    row.push_back({pair.name + "_up_to_10", largest});
  };
  for (const char* model : {"", "_stiv"}) {
    compare({concat("steps_1_2", model), concat("dt0.025", model), concat("dt0.0125", model)});
    compare({concat("steps_2_4", model), concat("dt0.0125", model), concat("dt0.00625", model)});
    compare({concat("steps_1_4", model), concat("dt0.025", model), concat("dt0.00625", model)});
  }
  compare({"points", "dt0.025", "points64"});
  compare({"tolerance", "dt0.025", "tolerance1e-8"});
  compare({"plain", "dt0.025", "dt0.025_plain"});
  compare({"stiv", "dt0.025", "dt0.025_stiv"});
  compare({"adaptive", "dt0.025", "adaptive_dt0.1"});
  if (columns.empty()) return;
  std::vector<std::vector<double>> rows;
  for (int k = 0; k <= 300; ++k) {
    rows.push_back({0.1 * k});
    for (const std::vector<double>& column : columns) rows.back().push_back(column[k]);
  }
  results.write("differences", header, rows);
  results.write("summary", row);
}

std::vector<std::string> cases() {
  std::vector<std::string> names;
  for (const Case& c : all_cases()) names.push_back(c.name);
  return names;
}

void collect_all(const Results& results) {
  collect(results);
  std::vector<std::string> header;
  std::vector<std::vector<double>> rows;
  Comments legend;
  for (const std::string& name : cases()) {
    if (!results.has(name)) continue;
    const Table table = read_csv(results.path(name));
    header = table.header;
    header.insert(header.begin(), "run");
    rows.push_back({static_cast<double>(rows.size() + 1)});
    for (int column = 0; column < static_cast<int>(table.header.size()); ++column)
      rows.back().push_back(table.number(0, column));
    legend.push_back({concat("run ", rows.size()), concat(name, ", ended by ", table.comment("ending"))});
  }
  results.write("table", header, rows, legend);
}

}  // namespace

int main(int argc, char** argv) { return run_experiment({"fig4_taylor_green", cases(), run_case, collect_all}, argc, argv); }
