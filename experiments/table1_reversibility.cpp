// Table 1: two discs in u = (2y, 0), the flow reversed at t = 10; the distance of both centres at t = 20 from
// where they started, relative to the start, for several minimum separations delta and time steps.
//
// The published runs accumulate time in floating point (t += dt; the flow reverses at the first step
// that starts with t >= 10, the run ends at the first t >= 20). At the coarse steps this makes the two
// halves unequal by one step. Each case is run with that counting and with exact halves. Contact by the exact
// gap, and by space-time interference volumes with four vertices per node or one (suffixes _stiv, _stiv32).

#include <cmath>

#include "experiment.hpp"
#include "two_discs.hpp"

namespace {

using namespace stokes;

struct Model {
  std::string suffix;  // of the case names and of the table
  ContactModel contact;
  int stiv_vertices;
};
const std::vector<Model> models = {{"", ContactModel::gap, 0},
                                   {"_stiv", ContactModel::stiv, 0},
                                   {"_stiv32", ContactModel::stiv, disc_points}};
const std::vector<std::string> separations = {"0", "1", "2", "2.25", "2.5", "2.75", "3"};  // delta / h
const std::vector<std::string> time_steps = {"0.04", "0.02", "0.01", "0.005", "0.0025"};

std::string case_name(const std::string& separation, const std::string& time_step, const Model& model) {
  return concat("delta", separation, "h_dt", time_step, model.suffix);
}

void run_parameters(TwoDiscs parameters, const std::string& name, const Results& results) {
  parameters.rate = 2.0;
  parameters.end_time = 20.0;
  parameters.reverse_at = 10.0;
  const TwoDiscRun exact = complete_two_discs(parameters);
  parameters.time_counting = TimeCounting::accumulated;
  const TwoDiscRun run = complete_two_discs(parameters);
  results.write(name, {{"separation_over_h", parameters.separation_over_h},
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

// Calls visit(separation, time step, model) for every case. Interference volumes matter from 2h on only.
template <class Visit>
void for_each_case(const Visit& visit) {
  for (const Model& model : models)
    for (const std::string& separation : separations)
      for (const std::string& time_step : time_steps)
        if (model.contact == ContactModel::gap || *parse_number(separation) >= 2.0) visit(separation, time_step, model);
}

void run_case(const std::string& name, const Results& results) {
  for_each_case([&](const std::string& separation, const std::string& time_step, const Model& model) {
    if (case_name(separation, time_step, model) != name) return;
    TwoDiscs parameters;
    parameters.separation_over_h = *parse_number(separation);
    parameters.time_step = *parse_number(time_step);
    parameters.contact = model.contact;
    parameters.stiv_vertices = model.stiv_vertices;
    run_parameters(parameters, name, results);
  });
}

// A row for each separation, a column for each step, as in the paper; nan where a case has not been run.
std::vector<std::vector<double>> table_of(const Model& model, const char* quantity, const Results& results) {
  std::vector<std::vector<double>> rows;
  for (const std::string& separation : separations) {
    std::vector<double> row = {*parse_number(separation)};
    for (const std::string& time_step : time_steps) {
      const std::string name = case_name(separation, time_step, model);
      row.push_back(results.has(name) ? results.quantity(name, quantity) : std::nan(""));
    }
    rows.push_back(row);
  }
  return rows;
}

// table*.csv, and, once all steps of the first row have been run, summary.csv: its observed orders with exact counting.
void collect(const Results& results) {
  std::vector<std::string> header = {"separation_over_h"};
  for (const std::string& time_step : time_steps) header.push_back("dt_" + time_step);
  for (const Model& model : models)
    results.write("table" + model.suffix, header, table_of(model, "reversal_error", results));
  const auto exact = table_of(models[0], "reversal_error_exact_count", results);
  results.write("table_exact_count", header, exact);

  Quantities orders;
  for (std::size_t k = 0; k + 1 < time_steps.size(); ++k) {
    const double order = std::log2(exact[0][1 + k] / exact[0][2 + k]);
    orders.push_back({concat("order_", time_steps[k], "_", time_steps[k + 1]), order});
  }
  orders.push_back({"finest_order", orders.back().second});
  if (std::none_of(orders.begin(), orders.end(), [](const auto& order) { return std::isnan(order.second); }))
    results.write("summary", orders);
}

std::vector<std::string> cases() {
  std::vector<std::string> names;
  for_each_case([&](const std::string& separation, const std::string& time_step, const Model& model) {
    names.push_back(case_name(separation, time_step, model));
  });
  return names;
}

}  // namespace

int main(int argc, char** argv) { return run_experiment({"table1_reversibility", cases(), run_case, collect}, argc, argv); }
