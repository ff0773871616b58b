// Closed-form close evaluation on circles against the general one and against the flow of a known density.
#include <random>

#include "circle_evaluation.hpp"
#include <doctest/doctest.h>
#include "point_sets.hpp"
#include "shape.hpp"

namespace stokes {
namespace {

ComplexVector velocity(const VelocityRows& rows, const ComplexVector& density) {
  return rows.direct * density + rows.conjugate * density.conjugate();
}

// Modes up to a quarter of the nodes, so that the general evaluation, with twice the nodes, represents its products.
ComplexVector smooth_density(int points, std::mt19937_64& generator) {
  ComplexVector density = ComplexVector::Zero(points);
  for (int m = -points / 4; m <= points / 4; ++m) {
    const Complex c = random_vectors(1, generator)[0] / (1.0 + std::abs(m));
    for (int k = 0; k < points; ++k) density[k] += c * std::polar(1.0, 2.0 * pi * m * k / points);
  }
  return density;
}

TEST_CASE("on circles the closed form agrees with the general close evaluation at any distance, inside and outside") {
  std::mt19937_64 generator(7);
  for (const Side side : {Side::interior, Side::exterior})
    for (const int points : {16, 32, 128}) {
      const double radius = 1.7;
      const Curve curve = Shape{radius, radius}.curve(points);
      const CircleEvaluation closed(radius, points, side);
      const CloseEvaluation general(curve, side, 2);
      const ComplexVector density = smooth_density(points, generator);
      std::vector<Complex> targets;
      for (const double distance : {1e-12, 1e-9, 1e-6, 1e-4, 1e-2, 0.1, 0.6, 1.6999}) {
        const double r = side == Side::interior ? radius - distance : radius + distance;
        for (const double angle : {0.0, 1e-8, 1e-3, 0.3, 2.0, 4.0, 2.0 * pi / points})
          targets.push_back(std::polar(r, angle));
      }
      const ComplexVector u = velocity(closed.velocity_rows(targets), density);
      const ComplexVector v = velocity(general.velocity_rows(targets), density);
      // Densities of modulus up to about 5; both carry the round-off of sums over the nodes.
      CHECK((u - v).cwiseAbs().maxCoeff() < 2e-12);

      const std::vector<Complex> series = CircleFlow(radius, side, density).velocity(targets);
      CHECK((u - ComplexVector::Map(series.data(), u.size())).cwiseAbs().maxCoeff() < 2e-12);
      // For any density, with the Nyquist mode.
      ComplexVector rough = random_vectors(points, generator);
      const std::vector<Complex> roughly = CircleFlow(radius, side, rough).velocity(targets);
      const ComplexVector w = velocity(closed.velocity_rows(targets), rough);
      CHECK((w - ComplexVector::Map(roughly.data(), w.size())).cwiseAbs().maxCoeff() < 1e-11);

      const std::vector<int> some = {0, 3, points - 1};
      const VelocityRows rows = closed.velocity_rows(targets), part = closed.velocity_rows(targets, some);
      CHECK(part.direct == rows.direct(Eigen::all, some));
      CHECK(part.conjugate == rows.conjugate(Eigen::all, some));
    }
}

// D[const] = -1 inside a wall, 0 outside a body; a body's rotation makes no flow outside of it either.
TEST_CASE("on circles rigid densities give the rigid velocity or none, to round-off, also on nodes") {
  const int points = 64;
  const double radius = 0.3;
  for (const Side side : {Side::interior, Side::exterior}) {
    const CircleEvaluation circle(radius, points, side);
    ComplexVector density(points);
    for (int k = 0; k < points; ++k)
      density[k] = Complex(0.4, -1.1) + 0.7 * perp(std::polar(radius, 2.0 * pi * k / points));
    for (const double distance : {0.0, 1e-10, 1e-3, 0.2}) {
      const Complex z = std::polar(side == Side::interior ? radius - distance : radius + distance, 6.0 * pi / points);
      const Complex u = velocity(circle.velocity_rows({z}), density)[0];
      const Complex expected = side == Side::interior ? -(Complex(0.4, -1.1) + 0.7 * perp(z)) : Complex(0.0);
      CHECK(std::abs(u - expected) < 1e-13);
    }
  }
}

}  // namespace
}  // namespace stokes
