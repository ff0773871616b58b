// Tables 2 and 3 from the paper's starts with second-order steps (couette_run, _ab2_250 and _ab2_500) beside the paper's
// forward Euler. They show the printed means without the error of the time step, within the limits set by contacts, after
// which tracks separate.

#include "couette.hpp"

namespace {

using namespace stokes;

// table.csv: for each suspension and quantity (0: order parameter, 1: effective viscosity) the mean over the second
// revolution by forward Euler and by both step lengths. Also the largest difference of the two second-order curves, and of
// Euler's curve and the finer one, up to a quarter and up to one revolution. One file for each suspension, for `verify`, has
// the means of the finer run.
void collect(const Results& results) {
  const Results runs = couette_results(results);
  std::vector<std::vector<double>> rows;
  for (const CouetteSuspension& s : couette_suspensions) {
    const std::string euler = CouetteCase{s}.name(), coarse = euler + "_ab2_250", fine = euler + "_ab2_500";
    if (!runs.has(fine)) continue;
    Quantities means = {{"effective_viscosity", runs.quantity(fine, "effective_viscosity")}};
    if (s.lambda > 1) means.push_back({"order_parameter", runs.quantity(fine, "order_parameter")});
    results.write(s.name(), means);
    if (!runs.has(euler) || !runs.has(coarse)) continue;
    for (const int viscosity : {0, 1}) {
      const std::string quantity = viscosity ? "effective_viscosity" : "order_parameter";
      const auto mean = [&](const std::string& run) { return runs.quantity(run, quantity); };
      const auto largest = [&](const std::string& u, const std::string& v, double until) {
        double difference = 0.0;
        for (const double place : {0.0, 0.05, 0.1, 0.25, 0.5, 0.75, 1.0})
          if (place <= until) {
            const std::string at = concat(quantity, "_at_", place);
            difference = std::max(difference, std::abs(runs.quantity(u, at) - runs.quantity(v, at)));
          }
        return difference;
      };
      rows.push_back({static_cast<double>(s.percent), static_cast<double>(s.lambda), static_cast<double>(viscosity),
                      mean(euler), mean(coarse), mean(fine), largest(coarse, fine, 0.25), largest(coarse, fine, 1.0),
                      largest(euler, fine, 0.25), largest(euler, fine, 1.0)});
    }
  }
  results.write("table", {"phi", "lambda", "is_viscosity", "euler", "ab2_250", "ab2_500", "ab2_difference_quarter",
                          "ab2_difference_one", "euler_difference_quarter", "euler_difference_one"}, rows);
}

}  // namespace

int main(int argc, char** argv) {
  return stokes::run_experiment({"couette_step_limit", {}, {}, collect}, argc, argv);
}
