// The effect of 32 nodes per body on the paper's results: runs with them, at equal steps as in the paper (_points32), and
// the same runs with velocities to 1e-6 (_accuracy1e-6). Table 1 (some separations and steps), the Taylor-Green suspension
// to t = 10, the injection, and the 5 %, 3:1 suspension between cylinders for a quarter of a revolution.
//
// The folders of the long cases hold a case file and its bodies, which `simulate` can read, too. These cases continue after
// an interruption. table.csv: the published values and those of both runs.

#include <algorithm>
#include <cmath>
#include <map>

#include "couette.hpp"
#include "injection.hpp"
#include "taylor_green.hpp"
#include "two_discs.hpp"

namespace {

using namespace stokes;

constexpr double accuracy = 1e-6;
const std::vector<std::string> resolutions = {"points32", "accuracy1e-6"};
bool by_accuracy(const std::string& name) { return name.ends_with(resolutions[1]); }

struct Table1Case {
  std::string separation, time_step;  // delta / h
  std::string published() const { return concat("delta", separation, "h_dt", time_step); }
  std::string name() const { return concat("table1_", published()); }
};
std::vector<Table1Case> table1_cases() {
  std::vector<Table1Case> all;
  for (const char* time_step : {"0.04", "0.01"})
    for (const char* separation : {"0", "2", "3"}) all.push_back({separation, time_step});
  return all;
}

const std::vector<std::string> long_objects = {"taylor_green", "injection", "couette"};
const CouetteCase couette_start{couette_suspension("phi5_lambda3")};
const std::vector<double> couette_places = {0.05, 0.1, 0.25};  // revolutions
const std::vector<std::string> couette_quantities = {"order_parameter", "effective_viscosity"};

void run_table1(const Table1Case& chosen, const std::string& name, const Results& results) {
  TwoDiscs parameters;
  parameters.separation_over_h = *parse_number(chosen.separation);
  parameters.time_step = *parse_number(chosen.time_step);
  parameters.rate = 2.0, parameters.end_time = 20.0, parameters.reverse_at = 10.0;
  parameters.time_counting = TimeCounting::accumulated;
  if (by_accuracy(name)) parameters.accuracy = accuracy;
  results.write(name, {{"reversal_error", reversal_error(complete_two_discs(parameters))}});
}

// Statistics of any run: contacts, and what the nodes did not resolve.
Quantities common(const RecordedRun& run) {
  const std::vector<double> time = run.states("time"), contacts = run.steps("contacts"), ncp = run.steps("ncp_iterations");
  const std::vector<double> unresolved = run.steps("unresolved"), nodes = run.steps("most_nodes");
  const std::vector<double> gaps = run.states("min_gap");
  double first = std::nan(""), iterations = 0.0, touching = 0.0, missed = 0.0, most = 0.0, gap = gaps[0];
  for (std::size_t k = 0; k + 1 < time.size(); ++k) {
    if (contacts[k] > 0.0 && std::isnan(first)) first = time[k];
    touching += contacts[k] > 0.0, missed += unresolved[k] > 0.0;
    iterations += ncp[k], most = std::max(most, nodes[k]);
  }
  for (const double g : gaps) gap = std::min(gap, g);
  const double steps = static_cast<double>(time.size()) - 1.0;
  return {{"first_contact", first},        {"contact_share_of_steps", touching / steps}, {"ncp_iterations", iterations},
          {"unresolved_share_of_steps", missed / steps}, {"most_nodes", most},           {"smallest_gap", gap},
          {"end_time", time.back()}};
}

// Tracks of all free bodies, for comparison with the other run.
void write_tracks(const std::string& name, std::size_t bodies, const RecordedRun& run, const Results& results) {
  const std::vector<double> time = run.states("time");
  std::vector<std::vector<double>> rows;
  for (std::size_t k = 0; k < time.size(); ++k)
    for (std::size_t i = 0; i < bodies; ++i) {
      const Complex centre = run.bodies()[k][i].pose.centre;
      rows.push_back({time[k], static_cast<double>(i), centre.real(), centre.imag()});
    }
  results.write(name + "_tracks", {"time", "body", "x", "y"}, rows);
}

RecordedRun run_long(const std::string& name, Case c, const Suspension& bodies, const Results& results) {
  if (by_accuracy(name)) c.accuracy = accuracy;
  const Case written = write_case(name, c, bodies, results);
  simulate_case(written, name);
  return RecordedRun(written.output);
}

void run_taylor_green(const std::string& name, const Results& results) {
  TaylorGreen parameters;
  parameters.end_time = 10.0;
  parameters.refine = Refine::none;
  const Suspension bodies = taylor_green_bodies();
  const RecordedRun run = run_long(name, taylor_green_case(parameters), bodies, results);
  write_tracks(name, bodies.size(), run, results);
  results.write(name, common(run));
}

void run_injection(const std::string& name, const Results& results) {
  const RecordedRun run = run_long(name, injection_case({}), injection_bodies({}), results);
  write_tracks(name, free_count, run, results);
  Quantities row = common(run);
  const std::vector<std::size_t> frames = run.states_at(frame_times);
  for (std::size_t f = 0; f < frames.size(); ++f)
    row.push_back({concat("in_contact_at_", frame_times[f]), discs_in_contact(run, frames[f])});
  add_returns(distances_from_start(run, frames.back()), row);
  results.write(name, row);
}

void run_couette(const std::string& name, const Results& results) {
  Case c = couette_case(couette_start);
  c.refine = Refine::none;
  c.output_every = 1;
  c.end_time = couette_places.back() * couette_revolution + c.time_step;  // with a step from the last place
  const Suspension bodies = couette_start.bodies();
  const RecordedRun run = run_long(name, c, bodies, results);
  write_tracks(name, static_cast<std::size_t>(couette_start.suspension.count), run, results);
  Quantities row = common(run);
  for (const std::string& quantity : couette_quantities) {
    const std::vector<double> values = run.states(quantity.c_str());
    for (const double place : couette_places) {
      const std::size_t state = run.states_at({place * couette_revolution - 0.5 * c.time_step}).at(0);
      row.push_back({concat(quantity, "_at_", place), values[state]});
    }
  }
  results.write(name, row);
}

void run_case(const std::string& name, const Results& results) {
  for (const Table1Case& c : table1_cases())
    if (name.starts_with(c.name() + "_")) return run_table1(c, name, results);
  if (name.starts_with("taylor_green")) return run_taylor_green(name, results);
  if (name.starts_with("injection")) return run_injection(name, results);
  run_couette(name, results);
}

// Mean distance of the bodies of the two runs.
struct Apart {
  std::vector<double> time, mean;

  double at(double t) const {
    for (std::size_t k = 0; k < time.size(); ++k)
      if (time[k] >= t - 1e-9) return mean[k];
    return std::nan("");
  }
  double first_above(double limit) const {
    for (std::size_t k = 0; k < time.size(); ++k)
      if (mean[k] > limit) return time[k];
    return std::nan("");
  }
};
Apart apart(const std::string& object, const Results& results) {
  Apart result;
  std::vector<Table> tables;
  for (const std::string& resolution : resolutions) {
    const std::string name = concat(object, "_", resolution, "_tracks");
    if (!results.has(name)) return result;
    tables.push_back(read_csv(results.path(name)));
  }
  const std::vector<double> time = tables[0].numbers("time");
  const std::vector<double> x = tables[0].numbers("x"), y = tables[0].numbers("y");
  const std::vector<double> u = tables[1].numbers("x"), v = tables[1].numbers("y");
  double sum = 0.0, count = 0.0;
  for (std::size_t k = 0; k < std::min(x.size(), u.size()); ++k) {
    sum += std::hypot(x[k] - u[k], y[k] - v[k]), ++count;
    if (k + 1 < time.size() && time[k + 1] == time[k]) continue;
    result.time.push_back(time[k]), result.mean.push_back(sum / count);
    sum = count = 0.0;
  }
  return result;
}

// A row for each number: published, with 32 nodes, resolved; nan where there is none.
void collect(const Results& results) {
  std::string text = "object,quantity,published,points32,accuracy1e-6\n";
  const auto add = [&](const std::string& object, const std::string& quantity, double published) {
    text += concat(object, ",", quantity, ",", format_number(published));
    for (const std::string& resolution : resolutions) {
      const std::string name = concat(object, "_", resolution);
      text += concat(",", format_number(results.has(name) ? results.quantity(name, quantity) : std::nan("")));
    }
    text += "\n";
  };
  for (const Table1Case& c : table1_cases())
    add(c.name(), "reversal_error", published_value("table1_reversibility", c.published(), "reversal_error"));
  for (const std::string& object : long_objects)
    for (const char* quantity :
         {"first_contact", "ncp_iterations", "smallest_gap", "unresolved_share_of_steps", "most_nodes"})
      add(object, quantity, std::nan(""));
  for (const char* quantity : {"in_contact_at_1.92", "in_contact_at_3.92", "mean_return", "median_return", "largest_return"})
    add("injection", quantity, published_value("fig6_injection", "paper", quantity));
  for (const std::string& quantity : couette_quantities)
    for (const double place : couette_places) {
      const std::string at = concat(quantity, "_at_", place);
      const std::string figure = quantity == "order_parameter" ? "fig9_order_parameter" : "fig10_effective_viscosity";
      add("couette", at, published_value(figure, couette_start.name(), at));
    }
  const std::map<std::string, std::vector<double>> times = {
      {"taylor_green", {2.5, 5.0, 7.5, 10.0}}, {"injection", {3.92, 7.92}}, {"couette", {0.25 * couette_revolution}}};
  for (const auto& [object, at] : times) {
    const Apart distance = apart(object, results);
    for (const double t : at)
      text += concat(object, ",mean_distance_at_", t, ",nan,", format_number(distance.at(t)), ",0\n");
    text += concat(object, ",apart_by_0.01_from,nan,", format_number(distance.first_above(0.01)), ",nan\n");
  }
  write_file_atomically(results.path("table"), text);
}

std::vector<std::string> cases() {
  std::vector<std::string> names;
  for (const std::string& resolution : resolutions) {
    for (const Table1Case& c : table1_cases()) names.push_back(concat(c.name(), "_", resolution));
    for (const std::string& object : long_objects) names.push_back(concat(object, "_", resolution));
  }
  return names;
}

}  // namespace

int main(int argc, char** argv) { return run_experiment({"resolved", cases(), run_case, collect}, argc, argv); }
