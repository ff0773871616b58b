// Section 4.4: one suspension between rotating cylinders for two revolutions of the outer one: order parameter,
// effective viscosity, stress, contacts. Cases phi<percent>_lambda<aspect ratio>_paper, from the paper's start, and
// _seed<k>, from other starts by the same rule; and variants of some: _halfstep, _quarterstep, _points64, _stiv
// (interference volumes with balanced clusters) and the short _quick; _ab2_250 and _ab2_500, with second-order steps of
// pi/250 and pi/500.
//
// The folder of a case holds a case file and its bodies, which `simulate` can read, too, and the results of the run. An
// interrupted run continues from its checkpoint. <case>_series.csv has one row per step, <case>.csv the means over the
// second revolution and the values at the times where the published curves were read.

#include <cmath>

#include "couette.hpp"

namespace {

using namespace stokes;

// Revolutions at which the published curves were read.
const std::vector<double> curve_places = {0.0, 0.05, 0.1, 0.25, 0.5, 0.75, 1.0};

std::vector<CouetteCase> all_cases() {
  std::vector<CouetteCase> cases;
  for (const CouetteSuspension& s : couette_suspensions)
    for (int seed = 0; seed <= couette_seeds; ++seed) cases.push_back({s, seed, ""});
  for (const char* variant : {"stiv", "halfstep", "points64", "quick"})
    cases.push_back({couette_suspension("phi5_lambda3"), 0, variant});
  for (const CouetteSuspension& s : couette_suspensions)
    for (const char* variant : {"ab2_250", "ab2_500"}) cases.push_back({s, 0, variant});
  for (const char* variant : {"halfstep", "quarterstep"}) cases.push_back({couette_suspension("phi10_lambda1"), 0, variant});
  return cases;
}

// Mean over the steps from a time on.
struct Window {
  std::vector<double> time;
  double from;

  double mean(const std::vector<double>& values) const {
    double sum = 0.0, count = 0.0;
    for (std::size_t k = 0; k < time.size(); ++k)
      if (time[k] >= from && !std::isnan(values[k])) sum += values[k], ++count;
    return count > 0.0 ? sum / count : std::nan("");
  }
  double largest(const std::vector<double>& values, double sign = 1.0) const {
    double result = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < time.size(); ++k)
      if (time[k] >= from && sign * values[k] > result) result = sign * values[k];
    return sign * result;
  }
};

// The value of the step nearest to a time; NaN after the end.
double value_at(double t, const std::vector<double>& time, const std::vector<double>& values) {
  const auto after = std::upper_bound(time.begin(), time.end(), t + 0.5 * time[1]);
  return after == time.begin() || t > time.back() + 0.5 * time[1] ? std::nan("") : values[after - time.begin() - 1];
}

void summarise(const CouetteCase& chosen, const RunSummary& run, const Results& results) {
  const Table steps = read_csv(results.folder() / chosen.name() / "steps.csv");
  const std::vector<std::string> columns = {"order_parameter", "effective_viscosity", "contacts", "min_gap",
                                            "ncp_iterations", "gmres_iterations", "stokes_solves", "stresslet_shear",
                                            "stresslet_normal_difference", "contact_shear", "contact_normal_difference"};
  std::vector<double> time = steps.numbers("time");
  std::vector<std::vector<double>> rows;
  for (const double t : time) rows.push_back({t, t / couette_revolution});
  for (const std::string& column : columns) {
    const std::vector<double> values = steps.numbers(column);
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k].push_back(values[k]);
  }
  std::vector<std::string> header = {"time", "revolutions"};
  header.insert(header.end(), columns.begin(), columns.end());
  results.write(chosen.name() + "_series", header, rows);

  const Window all{time, 0.0}, second{time, couette_revolution - 1e-9};
  const auto values = [&](const char* column) { return steps.numbers(column); };
  const std::vector<double> inner = values("inner_torque"), outer = values("outer_torque");
  std::vector<double> unbalanced;
  for (std::size_t k = 0; k < inner.size(); ++k) unbalanced.push_back(std::abs(inner[k] + outer[k]) / std::abs(inner[k]));
  Quantities row = {{"order_parameter", second.mean(values("order_parameter"))},
                    {"smallest_order_parameter", second.largest(values("order_parameter"), -1.0)},
                    {"effective_viscosity", second.mean(values("effective_viscosity"))},
                    {"largest_effective_viscosity", second.largest(values("effective_viscosity"))},
                    {"smallest_effective_viscosity", second.largest(values("effective_viscosity"), -1.0)},
                    {"stresslet_shear", second.mean(values("stresslet_shear"))},
                    {"stresslet_normal_difference", second.mean(values("stresslet_normal_difference"))},
                    {"contact_shear", second.mean(values("contact_shear"))},
                    {"contact_normal_difference", second.mean(values("contact_normal_difference"))},
                    {"contacts", second.mean(values("contacts"))},
                    {"smallest_gap_over_separation",
                     Window{time, 0.5 * time[1]}.largest(values("min_gap"), -1.0) / couette_separation},
                    {"torque_imbalance", all.largest(unbalanced)},
                    {"ncp_iterations_per_step", all.mean(values("ncp_iterations"))},
                    {"largest_ncp_iterations", all.largest(values("ncp_iterations"))},
                    {"gmres_iterations_per_step", all.mean(values("gmres_iterations"))},
                    {"stokes_solves_per_step", all.mean(values("stokes_solves"))},
                    {"steps", static_cast<double>(run.steps)}};
  for (const char* quantity : {"order_parameter", "effective_viscosity"})
    for (const double place : curve_places)
      row.push_back({concat(quantity, "_at_", place), value_at(place * couette_revolution, time, values(quantity))});
  results.write(chosen.name(), row, {{"bodies", format_number(chosen.suspension.count)}});
}

void run(const std::string& name, const Results& results) {
  const std::vector<CouetteCase> cases = all_cases();
  const CouetteCase& chosen =
      *std::find_if(cases.begin(), cases.end(), [&](const CouetteCase& c) { return c.name() == name; });
  const RunSummary summary = simulate_case(write_case(name, couette_case(chosen), chosen.bodies(), results), name);
  summarise(chosen, summary, results);
}

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (const CouetteCase& c : all_cases()) result.push_back(c.name());
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  return run_experiment({"couette_run", names(), run, [](const Results&) {}}, argc, argv);
}
