// Fixed boundaries: closed forms in circular domains, and manufactured solutions.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "average_stress.hpp"
#include "random_suspension.hpp"
#include "wall_flows.hpp"

using namespace stokes;

namespace {

Suspension annulus(double inner, double outer, int points) {
  Suspension s;
  s.push_back({{inner, inner}, {}, 0.0, 0.0, true, {}, points});
  s.container = Container{0.0, outer, points, {}};
  return s;
}

// Points of the annulus, from 1e-3 to a tenth of its width from either wall and in between.
std::vector<Complex> points_in_annulus(double inner, double outer, int count) {
  std::mt19937_64 generator(5);
  std::vector<Complex> points;
  for (int k = 0; k < count; ++k) {
    const double distance = std::pow(10.0, -3.0 + 2.0 * uniform(generator)) * (outer - inner);
    const double r = k % 3 == 0 ? inner + std::max(distance, 1e-3) : k % 3 == 1 ? outer - std::max(distance, 1e-3)
                     : inner + (outer - inner) * (0.1 + 0.8 * uniform(generator));
    points.push_back(std::polar(r, 2.0 * pi * uniform(generator)));
  }
  return points;
}

}  // namespace

TEST_CASE("Couette flow between cylinders: velocity, pressure, stress and torques to 1e-10 up to the walls") {
  for (const double inner : {5.0, 0.5}) {
    const double outer = 10.0, Omega = 2.0;
    Suspension bodies = annulus(inner, outer, inner > 1.0 ? 128 : 64);
    bodies.container->surface.angular_velocity = Omega;
    ShapeCache shapes;
    const StokesSystem system(bodies, 32, shapes, {1e-13, 1000});
    const BackgroundFlow driving{FlowKind::none, 1.0, 1.0};
    const StokesSolution s = system.solve(driving, {});
    const double A = Omega * outer * outer / (outer * outer - inner * inner), B = -A * inner * inner;
    const std::vector<Complex> points = points_in_annulus(inner, outer, 60);
    std::vector<PointFlow> exact;  // u = (A + B/r^2) perp(x)
    for (const Complex x : points) {
      const double r2 = std::norm(x), slope = -2.0 * B / (r2 * r2);
      exact.push_back({(A + B / r2) * perp(x), 0.0, (A + B / r2) * imaginary_unit + slope * x.real() * perp(x),
                       -(A + B / r2) + slope * x.imag() * perp(x)});
    }
    const WallFlowErrors e = wall_flow_errors(system.flow(points, s.density, driving, {}), exact);
    MESSAGE("inner radius " << inner << ": " << s.iterations << " iterations; u " << e.velocity << " p " << e.pressure
                            << " stress " << e.stress);
    CHECK(e.velocity < 1e-10);
    CHECK(e.pressure < 1e-10);
    CHECK(e.stress < 1e-9);
    CHECK(std::abs(s.reaction[0].torque - 4.0 * pi * B) < 1e-10 * std::abs(4.0 * pi * B));
    // The container's torque by the traction on it, and as the balance of the other torques.
    const std::vector<Complex> forces = node_forces(system, 1, s.density, driving, {});
    double torque = 0.0;
    for (std::size_t k = 0; k < forces.size(); ++k)
      torque += cross(system.boundaries()[1].node(static_cast<int>(k)), forces[k]);
    CHECK(std::abs(torque + 4.0 * pi * B) < 1e-10 * std::abs(4.0 * pi * B));
    CHECK(std::abs(system.container_wrench(s.density, {}).torque - torque) < 1e-9 * std::abs(torque));
  }
}

TEST_CASE("source flow through both walls of an annulus is radial and as accurate") {
  Suspension bodies = annulus(0.5, 10.0, 64);
  bodies[0].surface.source = bodies.container->surface.source = pi;
  ShapeCache shapes;
  const StokesSystem system(bodies, 32, shapes, {1e-13, 1000});
  const BackgroundFlow driving{FlowKind::none, 1.0, 1.0};
  const StokesSolution s = system.solve(driving, {});
  const std::vector<Complex> points = points_in_annulus(0.5, 10.0, 60);
  std::vector<PointFlow> exact;  // u = x/(2 |x|^2), harmonic: no pressure
  for (const Complex x : points) {
    const double r2 = std::norm(x);
    const Complex u = 0.5 * x / r2;
    exact.push_back({u, 0.0, 0.5 / r2 - 2.0 * x.real() / r2 * u, 0.5 * imaginary_unit / r2 - 2.0 * x.imag() / r2 * u});
  }
  const WallFlowErrors e = wall_flow_errors(system.flow(points, s.density, driving, {}), exact);
  MESSAGE(s.iterations << " iterations; u " << e.velocity << " p " << e.pressure << " stress " << e.stress);
  CHECK(e.velocity < 1e-10);
  CHECK(e.pressure < 1e-10);
  CHECK(e.stress < 1e-9);
  CHECK(std::abs(s.reaction[0].force) < 1e-10);
}

TEST_CASE("a disc pulled through the centre of a container moves as in the closed form") {
  // F = 4 pi U / (ln(R2/R1) - (R2^2-R1^2)/(R2^2+R1^2))
  for (const double radius : {0.5, 2.0}) {
    Suspension bodies{{{radius, radius}, {{1.0, -2.0}, 0.3}}};
    bodies.container = Container{{1.0, -2.0}, 4.0, 64, {}};
    ShapeCache shapes;
    const StokesSystem system(bodies, 64, shapes, {1e-13, 1000});
    const StokesSolution s = system.solve({}, {{{3.0, 4.0}, 0.0}});
    const double a2 = radius * radius, b2 = 16.0;
    const Complex expected = Complex(3.0, 4.0) * (std::log(4.0 / radius) - (b2 - a2) / (b2 + a2)) / (4.0 * pi);
    CHECK(std::abs(s.velocity[0].velocity - expected) < 1e-10 * std::abs(expected));
    CHECK(std::abs(s.velocity[0].omega) < 1e-12);
    // The same as a fixed body with a moving surface: the force that it takes.
    bodies[0].fixed = true;
    const StokesSystem held(bodies, 64, shapes, {1e-13, 1000});
    ComplexVector data = ComplexVector::Zero(128);
    data.head(64).setConstant(expected);
    CHECK(std::abs(held.solve_for_velocity(data).reaction[0].force - Complex(3.0, 4.0)) < 5e-10);
    // Turning: L = 4 pi omega R1^2 R2^2 / (R2^2 - R1^2).
    const double omega = system.solve({}, {{0.0, 2.0}}).velocity[0].omega;
    CHECK(std::abs(omega - 2.0 * (b2 - a2) / (4.0 * pi * a2 * b2)) < 1e-10 * omega);
  }
}

TEST_CASE("a manufactured flow among two inner walls, three ellipses and a container is found to 1e-8") {
  const ManufacturedFlow flow{{96, 64, 128, 256}};
  ShapeCache shapes;
  const StokesSystem system(flow.bodies, 128, shapes, {1e-12, 1000});
  const StokesSolution s = system.solve_for_velocity(flow.boundary_velocity(system));

  std::vector<Complex> points{{0.0, 0.0}};
  for (const double distance : {1e-3, 1e-2, 0.1, 0.3})
    for (const Complex x : flow.points_beside(distance, 6)) points.push_back(x);
  std::vector<PointFlow> exact;
  for (const Complex x : points) exact.push_back(flow.at(x));
  const WallFlowErrors e = wall_flow_errors(system.flow(points, s.density, {}, {}), exact);
  MESSAGE(s.iterations << " iterations; u " << e.velocity << " p " << e.pressure << " stress " << e.stress);
  CHECK(e.velocity < 1e-8);
  CHECK(e.pressure < 1e-8);
  CHECK(e.stress < 1e-8);
  for (std::size_t j = 0; j < flow.bodies.size(); ++j)  // the forces are those inside
    CHECK(std::abs(s.reaction[j].force - flow.force(j)) < 1e-8);
}
