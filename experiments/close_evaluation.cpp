// Section 3.1: errors of the quadrature in the case that the paper's first author gives for it. The density
// (sin^2 alpha, sin^2 alpha) on the unit circle has the first velocity component -1/(4 y^4) at (0, y), y > 1. The
// published errors are those of the double layer without its factor 1/pi, hence of pi times this velocity.
//
// The case `circle` writes five errors for each N. At y = 1.0005: near_N of interpolation by NearRule::from_target,
// near_boundary_N by NearRule::from_boundary, near_cauchy_N of Cauchy integrals. For the trapezoid rule on N nodes:
// trapezoid_1.01_N at y = 1.01 and trapezoid_1.1_N at y = 1.1.

#include "cauchy.hpp"
#include "experiment.hpp"
#include "interpolation.hpp"
#include "shape.hpp"

namespace {

using namespace stokes;

// Error at (0, y) of the first component of the double layer without its factor 1/pi.
double error(const VelocityRows& rows, double y) {
  const Eigen::Index points = rows.direct.cols();
  ComplexVector eta(points);
  for (Eigen::Index k = 0; k < points; ++k) {
    const double sine = std::sin(2.0 * pi * static_cast<double>(k) / static_cast<double>(points));
    eta[k] = sine * sine * Complex(1.0, 1.0);
  }
  const Complex velocity = (rows.direct * eta + rows.conjugate * eta.conjugate())[0];
  return pi * std::abs(velocity.real() + 0.25 / std::pow(y, 4.0));
}

void run_case(const std::string& name, const Results& results) {
  constexpr double near = 1.0005;
  const std::vector<std::string> header = {"points",      "near",           "near_boundary",
                                           "near_cauchy", "trapezoid_1.01", "trapezoid_1.1"};
  Quantities row;
  std::vector<std::vector<double>> table;
  for (int n : {16, 32, 64, 128, 256, 512, 1024}) {
    const Curve curve = Shape{1.0, 1.0}.curve(n);
    const auto interpolation = [&](NearRule rule) {
      return error(InterpolationEvaluation(curve, Side::exterior, rule).velocity_rows({{0.0, near}}), near);
    };
    const auto trapezoid = [&](double y) {
      return error(trapezoid_rows(curve, Side::exterior, std::vector<Complex>{{0.0, y}}), y);
    };
    const CloseEvaluation cauchy(curve, Side::exterior, 2);
    table.push_back({static_cast<double>(n), interpolation(NearRule::from_target), interpolation(NearRule::from_boundary),
                     error(cauchy.velocity_rows(std::vector<Complex>{{0.0, near}}), near), trapezoid(1.01), trapezoid(1.1)});
    for (std::size_t k = 1; k < header.size(); ++k) row.push_back({concat(header[k], "_", n), table.back()[k]});
  }
  results.write(name, row);
  results.write(name + "_table", header, table);
}

}  // namespace

int main(int argc, char** argv) {
  return run_experiment({"close_evaluation", {"circle"}, run_case, [](const Results&) {}}, argc, argv);
}
