// Figure 4: the Taylor-Green suspension to t = 30 for three time steps: snapshots, the track of one body, contacts
// and iterations. These runs have the exact gap and nodes clustered near contacts. Variants: interference volumes (_stiv),
// 32 nodes at equal steps (_plain), 64 nodes, a tolerance of 1e-8, adaptive steps. A run that fails is a result:
// `completed` and the comment `ending` tell when and why.
//
// The folder of a case holds a case file and its bodies, which `simulate` can read, too, and the run. An interrupted run
// continues from its checkpoint.

#include <chrono>
#include <numeric>

#include "case_run.hpp"
#include "checkpoint.hpp"
#include "taylor_green.hpp"

namespace {

using namespace stokes;

const std::vector<std::string> time_steps = {"0.025", "0.0125", "0.00625"};
const std::vector<double> snapshot_times = {0.0, 15.0, 30.0};

struct TaylorGreenCase {
  std::string name;
  TaylorGreen parameters;
};

std::vector<TaylorGreenCase> all_cases() {
  std::vector<TaylorGreenCase> all;
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

// Sum of the contact forces on all bodies; the torque is about the origin.
Wrench net_contact(const std::vector<RecordedBody>& bodies) {
  Wrench net;
  for (const auto& [pose, contact] : bodies) {
    net.force += contact.force;
    net.torque += contact.torque + cross(pose.centre, contact.force);
  }
  return net;
}

Quantities summarise(const RecordedRun& run, const RunSummary& ended, const std::string& failure) {
  const std::vector<double> time = run.states("time"), gaps = run.states("min_gap"), dt = run.steps("dt");
  const std::vector<double> contacts = run.steps("contacts"), ncp = run.steps("ncp_iterations");
  const std::vector<double> multipliers = run.steps("smallest_multiplier"), largest_ones = run.steps("largest_multiplier");
  const std::vector<double> gmres = run.steps("gmres_iterations");
  const std::size_t steps = time.size() - 1;
  double contact_steps = 0.0, contact_time = 0.0, smallest_dt = dt[0], force = 0.0, torque = 0.0, gap = gaps[0];
  double smallest = std::numeric_limits<double>::infinity(), largest = 0.0, first_contact = std::nan("");
  for (std::size_t k = 0; k < steps; ++k) {
    smallest_dt = std::min(smallest_dt, dt[k]);
    smallest = std::fmin(smallest, multipliers[k]), largest = std::fmax(largest, largest_ones[k]);
    const Wrench net = net_contact(run.bodies()[k]);
    force = std::max(force, std::abs(net.force)), torque = std::max(torque, std::abs(net.torque));
    if (contacts[k] == 0.0) continue;
    if (contact_steps++ == 0.0) first_contact = time[k];
    contact_time += dt[k];
  }
  for (const double g : gaps) gap = std::min(gap, g);
  const double taken = std::max<double>(steps, 1);
  return {{"completed", failure.empty() ? 1.0 : 0.0},
          {"end_time", time.back()},
          {"steps", static_cast<double>(steps)},
          {"rejected", failure.empty() ? static_cast<double>(ended.rejected) : std::nan("")},
          {"smallest_step", smallest_dt},
          {"first_contact", first_contact},
          {"ncp_iterations", std::accumulate(ncp.begin(), ncp.end(), 0.0)},
          {"largest_ncp_iterations", *std::max_element(ncp.begin(), ncp.end())},
          {"contact_share_of_steps", contact_steps / taken},
          {"contact_share_of_time", contact_time / time.back()},
          {"gmres_iterations_per_step", std::accumulate(gmres.begin(), gmres.end(), 0.0) / taken},
          {"smallest_gap_over_h", gap / taylor_green_spacing()},
          {"smallest_multiplier", smallest},
          {"largest_multiplier", largest},
          {"net_force", force},
          {"net_torque", torque}};
}

void write_track(const std::string& name, const RecordedRun& run, const Results& results) {
  const std::vector<double> time = run.states("time"), gaps = run.states("min_gap"), dt = run.steps("dt");
  const std::vector<double> contacts = run.steps("contacts"), ncp = run.steps("ncp_iterations");
  const std::vector<double> gmres = run.steps("gmres_iterations");
  std::vector<std::vector<double>> rows;
  for (std::size_t k = 0; k < time.size(); ++k) {
    const Pose& pose = run.bodies()[k][coloured_body].pose;
    rows.push_back({time[k], dt[k], pose.centre.real(), pose.centre.imag(), pose.angle,
                    run.in_contact(k, coloured_body) ? 1.0 : 0.0, contacts[k], ncp[k], gmres[k],
                    gaps[k] / taylor_green_spacing()});
  }
  results.write(name + "_track",
                {"time", "dt", "x", "y", "theta", "in_contact", "contacts", "ncp_iterations", "gmres_iterations",
                 "gap_over_h"},
                rows);
}

// in_contact: in the step that led there.
void write_snapshots(const std::string& name, const RecordedRun& run, const Results& results) {
  const std::vector<double> time = run.states("time");
  std::vector<std::vector<double>> rows;
  for (const std::size_t k : run.states_at(snapshot_times))
    for (std::size_t i = 0; i < run.bodies()[k].size(); ++i) {
      const Pose& pose = run.bodies()[k][i].pose;
      rows.push_back({time[k], static_cast<double>(i), pose.centre.real(), pose.centre.imag(), pose.angle,
                      i == coloured_body ? 1.0 : 0.0, run.was_in_contact(k, i) ? 1.0 : 0.0});
    }
  results.write(name + "_snapshots", {"time", "body", "x", "y", "theta", "coloured", "in_contact"}, rows);
}

// The seconds are those of a run that was not interrupted.
void run_case(const std::string& name, const Results& results) {
  const std::vector<TaylorGreenCase> all = all_cases();
  const TaylorGreenCase& chosen = *std::find_if(all.begin(), all.end(), [&](const auto& c) { return c.name == name; });
  const Case c = write_case(name, taylor_green_case(chosen.parameters), taylor_green_bodies(), results);
  const CheckpointFile checkpoint(c, read_suspension(c));
  const bool goes_on = checkpoint.read().has_value();
  RunSummary ended;
  std::string failure;
  const auto start = std::chrono::steady_clock::now();
  try {
    ended = simulate_case(c, name);
  } catch (const NumericalError& error) {
    failure = error.what();
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const RecordedRun run(c.output);
  if (!run.has_ended()) throw NumericalError(failure);  // its results could not be written
  write_track(name, run, results);
  write_snapshots(name, run, results);
  std::filesystem::remove(results.path(name + "_timing"));
  if (!goes_on) results.write(name + "_timing", {{"seconds", seconds}});
  results.write(name, summarise(run, ended, failure), {{"ending", failure.empty() ? "end_time" : failure}});
  checkpoint.remove();  // that of a failure, which is now reported
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

constexpr int compared_times = 301;  // every 0.1 up to t = 30

// Distance of the coloured bodies of two runs at these times.
std::vector<double> distances(const Pair& pair, const Results& results) {
  const Track first(read_csv(results.path(pair.first + "_track"))), second(read_csv(results.path(pair.second + "_track")));
  std::vector<double> apart;
  for (int k = 0; k < compared_times; ++k) apart.push_back(std::abs(first.at(0.1 * k) - second.at(0.1 * k)));
  return apart;
}

// Up to t = 10; NaN if one of the runs ended before.
double largest_up_to_10(const std::vector<double>& apart) {
  double largest = 0.0;
  for (int k = 0; k <= 100; ++k)
    if (!(apart[k] <= largest)) largest = apart[k];
  return largest;
}

// differences.csv, and for the pairs whose runs exist differences_<pair>.csv with the largest difference up to t = 10 and
// some later ones.
void collect_differences(const Results& results) {
  std::vector<Pair> pairs;
  for (const char* model : {"", "_stiv"}) {
    pairs.push_back({concat("steps_1_2", model), concat("dt0.025", model), concat("dt0.0125", model)});
    pairs.push_back({concat("steps_2_4", model), concat("dt0.0125", model), concat("dt0.00625", model)});
    pairs.push_back({concat("steps_1_4", model), concat("dt0.025", model), concat("dt0.00625", model)});
  }
  for (const auto& [name, other] : {std::pair("points", "points64"), std::pair("tolerance", "tolerance1e-8"),
                                    std::pair("plain", "dt0.025_plain"), std::pair("stiv", "dt0.025_stiv"),
                                    std::pair("adaptive", "adaptive_dt0.1")})
    pairs.push_back({name, "dt0.025", other});
  std::vector<std::string> header = {"time"};
  std::vector<std::vector<double>> rows(compared_times);
  for (int k = 0; k < compared_times; ++k) rows[k].push_back(0.1 * k);
  for (const Pair& pair : pairs) {
    if (!results.has(pair.first) || !results.has(pair.second)) continue;
    const std::vector<double> apart = distances(pair, results);
    header.push_back(pair.name);
    for (int k = 0; k < compared_times; ++k) rows[k].push_back(apart[k]);
    Quantities row = {{"up_to_10", largest_up_to_10(apart)}};
    for (int time : {5, 10, 15, 20, 30}) row.push_back({concat("at_", time), apart[10 * time]});
    results.write(concat("differences_", pair.name), row);
  }
  if (header.size() > 1) results.write("differences", header, rows);
}

// summary.csv: the three runs of Figure 4, once all exist.
void summarise_steps(const Results& results) {
  double iterations = 0.0, apart = 0.0;
  for (const std::string& time_step : time_steps) {
    if (!results.has("dt" + time_step)) return;
    iterations = std::max(iterations, results.quantity("dt" + time_step, "largest_ncp_iterations"));
  }
  for (const char* pair : {"steps_1_2", "steps_2_4", "steps_1_4"}) {
    const double largest = results.quantity(concat("differences_", pair), "up_to_10");
    if (!(largest <= apart)) apart = largest;
  }
  results.write("summary", {{"largest_ncp_iterations", iterations}, {"largest_difference_up_to_10", apart}});
}

std::vector<std::string> cases() {
  std::vector<std::string> names;
  for (const TaylorGreenCase& c : all_cases()) names.push_back(c.name);
  return names;
}

// Besides, table.csv: all runs, numbered in the order of the comment lines.
void collect(const Results& results) {
  collect_differences(results);
  summarise_steps(results);
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

int main(int argc, char** argv) { return run_experiment({"fig4_taylor_green", cases(), run_case, collect}, argc, argv); }
