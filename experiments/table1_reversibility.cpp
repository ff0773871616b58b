// Table 1: two discs in u = (2y, 0), the flow reversed at t = 10; the distance of both centres at t = 20 from
// where they started, relative to the start, for several minimum separations delta and time steps.
//
// The published numbers accumulate time in floating point (t += dt; the flow reverses at the first step
// that starts with t >= 10, the run ends at the first t >= 20), which at the coarse steps makes the two
// halves unequal by one step; each case is run with that counting and with exact halves.

#include <cmath>

#include "experiment.hpp"
#include "two_discs.hpp"

namespace {

using namespace stokes;

const std::vector<std::string> separations = {"0", "1", "2", "2.25", "2.5", "2.75", "3"};  // delta / h
const std::vector<std::string> time_steps = {"0.04", "0.02", "0.01", "0.005", "0.0025"};

std::string case_name(const std::string& separation, const std::string& time_step) {
  return concat("delta", separation, "h_dt", time_step);
}

void run_case(const std::string& name, const Results& results) {
  for (const std::string& separation : separations)
    for (const std::string& time_step : time_steps) {
      if (case_name(separation, time_step) != name) continue;
      TwoDiscs parameters;
      parameters.rate = 2.0;
      parameters.separation_over_h = *parse_number(separation);
      parameters.time_step = *parse_number(time_step);
      parameters.end_time = 20.0;
      parameters.reverse_at = 10.0;
      const TwoDiscRun exact = complete_two_discs(parameters);
      parameters.time_counting = TimeCounting::accumulated;
      const TwoDiscRun run = complete_two_discs(parameters);
      results.write(name,
                    {{"separation_over_h", parameters.separation_over_h},
                     {"time_step", parameters.time_step},
                     {"reversal_error", reversal_error(run)},
                     {"reversal_error_exact_count", reversal_error(exact)},
                     {"smallest_gap_over_h", std::min(run.smallest_gap_over_h, exact.smallest_gap_over_h)},
                     {"force_balance", std::max(run.worst_force_balance, exact.worst_force_balance)},
                     {"steps", static_cast<double>(run.steps)},
                     {"contact_steps", static_cast<double>(run.contact_steps)},
                     {"largest_ncp_iterations", static_cast<double>(run.largest_ncp_iterations)},
                     {"gmres_iterations", static_cast<double>(run.gmres_iterations)},
                     {"factorisations", static_cast<double>(run.factorisations)}});
    }
}

// table.csv: a row for each separation, a column for each step, as in the paper; summary.csv: the observed
// order of the first row with exact counting between successive steps.
void collect(const Results& results) {
  std::vector<std::string> header = {"separation_over_h"};
  for (const std::string& time_step : time_steps) header.push_back("dt_" + time_step);
  for (const std::string& time_step : time_steps) header.push_back("exact_count_dt_" + time_step);
  std::vector<std::vector<double>> rows;
  for (const std::string& separation : separations) {
    std::vector<double> row = {*parse_number(separation)};
    for (const char* quantity : {"reversal_error", "reversal_error_exact_count"})
      for (const std::string& time_step : time_steps) {
        const std::string name = case_name(separation, time_step);
        row.push_back(results.has(name) ? results.quantity(name, quantity) : std::nan(""));
      }
    rows.push_back(row);
  }
  results.write("table", header, rows);

  Quantities orders;
  const std::size_t n = time_steps.size();
  double smallest = std::nan(""), largest = std::nan("");
  for (std::size_t k = 0; k + 1 < n; ++k) {
    const double order = std::log2(rows[0][1 + n + k] / rows[0][2 + n + k]);
    orders.push_back({concat("order_", time_steps[k], "_", time_steps[k + 1]), order});
    smallest = std::fmin(smallest, order), largest = std::fmax(largest, order);
  }
  orders.push_back({"smallest_order", smallest});
  orders.push_back({"largest_order", largest});
  results.write("summary", orders);
}

std::vector<std::string> cases() {
  std::vector<std::string> names;
  for (const std::string& separation : separations)
    for (const std::string& time_step : time_steps) names.push_back(case_name(separation, time_step));
  return names;
}

}  // namespace

int main(int argc, char** argv) { return run_experiment({"table1_reversibility", cases(), run_case, collect}, argc, argv); }
