// Circles' own equations in closed form, and walls whose nodes turn with their surface.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "couette_bodies.hpp"
#include "discrete_shape.hpp"
#include "point_sets.hpp"
#include "text.hpp"

using namespace stokes;

namespace {

// Random, interleaved.
Matrix right_hand_sides(int points, int columns) {
  std::mt19937_64 generator(17);
  Matrix data(2 * points, columns);
  for (int c = 0; c < columns; ++c) {
    const ComplexVector v = random_vectors(points, generator);
    for (int k = 0; k < points; ++k) data(2 * k, c) = v[k].real(), data(2 * k + 1, c) = v[k].imag();
  }
  return data;
}

// Bodies, some of them as close to the walls as the spacing of the walls' nodes.
Suspension bodies_beside_walls(int wall_points) {
  return between_cylinders({body_at({0.375, 0.375}, {9.3, 0.0}), body_at({0.375, 0.125}, {0.0, 5.5}, 0.2),
                            body_at({0.375, 0.125}, {-5.0, 6.0}, 1.0)},
                           wall_points);
}

std::vector<RigidVelocity> velocities(const Suspension& bodies) {
  ShapeCache shapes;
  return StokesSystem(bodies, 64, shapes, {1e-12}).solve({FlowKind::none, 1.0, 1.0}, {}).velocity;
}

}  // namespace

TEST_CASE("a circle's own equations are solved in closed form as by the dense block of an almost equal ellipse") {
  std::string table = "kind  points  radius  largest difference\n";
  for (const auto& [kind, name] : {std::pair(BoundaryKind::free, "free"), {BoundaryKind::fixed, "fixed"},
                                   {BoundaryKind::container, "container"}})
    for (const int points : {16, 64, 256})
      for (const double radius : {1.0, 10.0}) {
        const double log_length = 3.0;
        const DiscreteShape circle({radius, radius}, {points, {}}, kind, log_length, NearSingular::cauchy);
        const DiscreteShape ellipse({radius, radius * (1.0 + 1e-9)}, {points, {}}, kind, log_length, NearSingular::cauchy);
        REQUIRE(circle.is_circle());
        REQUIRE_FALSE(ellipse.is_circle());
        const Matrix data = right_hand_sides(points, 3), x = circle.solve_own(data), y = ellipse.solve_own(data);
        const double error = (x - y).cwiseAbs().maxCoeff() / y.cwiseAbs().maxCoeff();
        table += concat(name, "  ", points, "  ", radius, "  ", error, "\n");
        CHECK(error < 1e-8);
        // More than the factor -2 of most modes.
        CHECK((x + 2.0 * data).cwiseAbs().maxCoeff() > 0.01 * x.cwiseAbs().maxCoeff());
      }
  MESSAGE(table);
}

TEST_CASE("walls that turn have nodes that turn, forwards and backwards, and stay where they are") {
  Suspension bodies = bodies_beside_walls(128);
  bodies.back().surface.angular_velocity = -0.5;
  Stepper stepper(bodies, accurate_steps(32, 0.0));
  REQUIRE(stepper.step(0.02, 1.0, {}).accepted);
  REQUIRE(stepper.step(0.01, 1.0, {}).accepted);
  CHECK(std::abs(stepper.bodies().container->angle - 0.03 * outer_rotation) < 1e-15);
  CHECK(std::abs(stepper.bodies().back().pose.angle + 0.03 * 0.5) < 1e-15);
  CHECK(stepper.bodies().back().pose.centre == 0.0);

  ShapeCache shapes;
  const StokesSystem system(stepper.bodies(), 32, shapes, {});
  const PlacedShape &outer = system.boundaries().back(), &inner = system.boundaries()[3];
  for (const int k : {0, 1, 77}) {
    CHECK(std::abs(outer.node(k) - std::polar(10.0, 2.0 * pi * k / 128 + 0.06)) < 1e-13);
    CHECK(std::abs(inner.node(k) - std::polar(5.0, 2.0 * pi * k / 128 - 0.015)) < 1e-13);
  }
  REQUIRE(stepper.step(0.03, -1.0, {}).accepted);
  CHECK(std::abs(stepper.bodies().container->angle) < 1e-15);
  CHECK(std::abs(stepper.bodies().back().pose.angle) < 1e-15);
}

TEST_CASE("where the walls are resolved the bodies' velocities do not depend on how far they have turned") {
  std::vector<double> errors;
  for (const int wall_points : {64, 256, 1024}) {
    const Suspension bodies = bodies_beside_walls(wall_points);
    const std::vector<RigidVelocity> before = velocities(bodies);
    double largest = 0.0;
    for (const auto& [outer, inner] : {std::pair(0.013, 0.0), {0.4, -0.007}, {2.0, 1.3}}) {
      Suspension turned = bodies;
      turned.container->angle += outer;
      turned.back().pose.angle += inner;
      largest = std::max(largest, velocity_difference(velocities(turned), before, before.size()));
    }
    errors.push_back(largest);
  }
  MESSAGE("64, 256, 1024 wall points: ", errors[0], ", ", errors[1], ", ", errors[2]);
  CHECK(errors[0] > 1e-6);  // not resolved, so the equations do depend on the angle
  CHECK(errors[2] < 1e-8);
}
