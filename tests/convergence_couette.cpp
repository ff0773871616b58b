// Bodies between cylinders at increasing resolution, of bodies and walls together.
// An ellipse 0.425 from the outer wall needs more wall nodes: with 256 of them the error is 1.8e-8, with 1024 1e-13.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "couette_bodies.hpp"
#include "text.hpp"

using namespace stokes;

namespace {

struct Solved {
  std::vector<RigidVelocity> velocity;
  double inner_torque, outer_torque;
};

Solved solved(const std::vector<Body>& bodies, int points, int wall_points) {
  const Suspension suspension = between_cylinders(bodies, wall_points);
  ShapeCache shapes;
  const StokesSystem system(suspension, points, shapes, {1e-11});
  const StokesSolution s = system.solve({FlowKind::none, 1.0, 1.0}, {});
  return {s.velocity, s.reaction.back().torque, system.container_wrench(s.density, {}).torque};
}

// Errors relative to the largest velocity, the largest angular velocity and the torques.
struct Differences {
  double velocity = 0.0, omega = 0.0, inner_torque, outer_torque;

  Differences(const Solved& a, const Solved& b)
      : inner_torque(std::abs(a.inner_torque / b.inner_torque - 1.0)),
        outer_torque(std::abs(a.outer_torque / b.outer_torque - 1.0)) {
    double u = 0.0, w = 0.0;
    for (std::size_t i = 0; i < a.velocity.size(); ++i) {
      velocity = std::max(velocity, std::abs(a.velocity[i].velocity - b.velocity[i].velocity));
      omega = std::max(omega, std::abs(a.velocity[i].omega - b.velocity[i].omega));
      u = std::max(u, std::abs(b.velocity[i].velocity)), w = std::max(w, std::abs(b.velocity[i].omega));
    }
    velocity /= u, omega /= w;
  }
  double largest() const { return std::max({velocity, omega, inner_torque, outer_torque}); }
};

// 16, 32 and 64 points a body, with four times as many on the walls, against 128.
void check_convergence(const std::string& name, const std::vector<Body>& bodies) {
  const Solved reference = solved(bodies, 128, 512);
  std::string table = name + "\npoints  walls  velocity  omega  inner torque  outer torque\n";
  std::vector<double> errors;
  for (const int points : {16, 32, 64}) {
    const Differences d(solved(bodies, points, 4 * points), reference);
    table += concat(points, "  ", 4 * points, "  ", d.velocity, "  ", d.omega, "  ", d.inner_torque, "  ",
                    d.outer_torque, "\n");
    errors.push_back(d.largest());
  }
  MESSAGE(table);
  CHECK(errors[2] < 1e-8);
  // Spectral: twice the nodes square the error, down to that of GMRES.
  CHECK(errors[0] > 1e-8);
  CHECK(errors[1] < std::max(1e-9, 10.0 * errors[0] * errors[0]));
}

}  // namespace

TEST_CASE("a disc between cylinders: velocities and torques at 64 points are those at 128 to 1e-8") {
  check_convergence("disc of radius 0.375 at r = 7.5", {body_at({0.375, 0.375}, {7.5, 0.0})});
}

TEST_CASE("five ellipses between cylinders: velocities and torques at 64 points are those at 128 to 1e-8") {
  std::vector<Body> ellipses;
  const double radii[] = {6.2, 6.9, 7.5, 8.1, 8.8}, angles[] = {0.4, 2.0, -0.6, 1.1, 2.7};
  for (int k = 0; k < 5; ++k)
    ellipses.push_back(body_at({0.375, 0.125}, std::polar(radii[k], 0.2 + 0.35 * k), angles[k]));
  check_convergence("ellipses 3:1", ellipses);
}
