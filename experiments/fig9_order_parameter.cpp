// Figure 9: the order parameter over two revolutions from the series of couette_run, and the dashed curves, for bodies in a
// shear flow that do not interact and have uniform initial angles; and the claims of the text about S.

#include "couette.hpp"

namespace {

using namespace stokes;

constexpr double shear_rate = 4.0;

// Jeffery's orbit from the angle `start` to the flow: lambda tan(theta) turns like an angle that falls at the rate
// gamma lambda / (lambda^2 + 1).
double angle_at(double start, double time, double lambda) {
  const double phase =
      std::atan2(lambda * std::sin(start), std::cos(start)) - shear_rate * time * lambda / (lambda * lambda + 1.0);
  return std::atan2(std::sin(phase), lambda * std::cos(phase));
}

double single_body_order(double time, double lambda) {
  constexpr int angles = 2000;
  double sum = 0.0;
  for (int k = 0; k < angles; ++k) sum += std::cos(2.0 * angle_at(2.0 * pi * (k + 0.5) / angles, time, lambda));
  return sum / angles;
}

void run_single_body(const std::string&, const Results& results) {
  std::vector<std::vector<double>> rows;
  Quantities row;
  for (int k = 0; k <= 400; ++k) {
    const double revolutions = 0.005 * k;
    rows.push_back({revolutions});
    for (const double lambda : {3.0, 6.0})
      rows.back().push_back(single_body_order(revolutions * couette_revolution, lambda));
  }
  results.write("single_body", {"revolutions", "lambda3", "lambda6"}, rows);
  for (const double lambda : {3.0, 6.0}) {
    const double period = (pi / shear_rate) * (lambda + 1.0 / lambda);
    double largest = 0.0, end = 0.0;
    for (int k = 0; k <= 1000; ++k) {
      end = single_body_order(0.001 * k * period, lambda);
      largest = std::max(largest, end);
    }
    row.push_back({concat("period_error_lambda", lambda), std::abs(end - single_body_order(0.0, lambda))});
    row.push_back({concat("largest_lambda", lambda), largest});
  }
  results.write("orbit", row);
}

// claims.csv: S from the paper's starts against the claims of the text.
void collect(const Results& results) {
  const Results runs = couette_results(results);
  double slowest_rise = 0.0, least_excess = std::nan(""), least = std::nan("");
  for (const CouetteSuspension& s : couette_suspensions) {
    const std::string name = CouetteCase{s}.name();
    if (s.lambda == 1) continue;
    if (!runs.has(name)) return;
    const double single = (s.lambda - 1.0) / (s.lambda + 1.0);
    const Table series = read_csv(runs.path(name + "_series"));
    const std::vector<double> time = series.numbers("revolutions"), S = series.numbers("order_parameter");
    std::size_t risen = 0;
    while (risen < S.size() && !(S[risen] > single)) ++risen;
    slowest_rise = std::max(slowest_rise, risen < S.size() ? time[risen] : std::numeric_limits<double>::infinity());
    least_excess = std::fmin(least_excess, runs.quantity(name, "order_parameter") - single);
    least = std::fmin(least, runs.quantity(name, "smallest_order_parameter"));
  }
  Quantities row = {{"slowest_rise_revolutions", slowest_rise},
                    {"least_excess_over_single_body", least_excess},
                    {"smallest_in_second_revolution", least}};
  for (const int percent : {5, 10}) {
    const auto mean = [&](int lambda) {
      return from_paper_start(runs, couette_suspension(concat("phi", percent, "_lambda", lambda)), "order_parameter");
    };
    row.push_back({concat("slender_excess_phi", percent), mean(6) - mean(3)});
  }
  results.write("claims", row);
}

}  // namespace

int main(int argc, char** argv) {
  return run_experiment({"fig9_order_parameter", {"orbit"}, run_single_body, collect}, argc, argv);
}
