// Fixed boundaries against closed forms, and the convergence of the two close evaluations between them.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include "wall_flows.hpp"

using namespace stokes;

namespace {

struct TurningDisc {
  double torque, force;  // of the disc on the fluid; the force is normal to the line of centres
};

// A disc of radius a that turns with angular velocity omega, its centre held at x = -e, in a fixed circle of radius b
// around 0, 0 < e < b - a. In bipolar coordinates alpha, beta with their poles at a distance c to either side of
// the origin,
//   1/h = c/(cosh alpha - cos beta),
// the circles are alpha_1 = asinh(c/a) and alpha_2 = asinh(c/b), and the stream function psi with a single-valued
// pressure is
//   h psi = A0 cosh alpha + C0 sinh alpha + B alpha cosh alpha + D alpha sinh alpha
//           + (A1 cosh 2 alpha + B1 + C1 sinh 2 alpha - B alpha) cos beta.
// Its logarithms are those of a Stokeslet -4 pi D along y and of a rotlet 4 pi c (B + D) at the pole inside the disc.
// psi = 0 and d psi/dn = 0 on the outer circle, psi = const and d psi/dn = omega a on the disc leave, with
// s = alpha_1 - alpha_2 and everything but B and D eliminated,
//   B sinh(alpha_2) sinh(s)^2 / cosh(s) + D (s sinh(alpha_1) - sinh(alpha_2) sinh(s)) = 0,
//   B (sinh(alpha_2) sinh(s) + sinh(alpha_1) tanh(s)) + D (s cosh(alpha_1) + cosh(alpha_2) sinh(s)) = omega a.
// The pole is c (coth(alpha_1) - 1) from the disc's centre, about which the torque is 4 pi c (B + D coth(alpha_1)).
TurningDisc turning_disc(double a, double b, double e, double omega) {
  const double c_coth = (b * b - a * a - e * e) / (2.0 * e);  // c coth(alpha_1)
  const double c = std::sqrt(c_coth * c_coth - a * a);
  const double alpha1 = std::asinh(c / a), alpha2 = std::asinh(c / b), s = alpha1 - alpha2;
  const double ratio = -std::sinh(alpha2) * std::sinh(s) * std::tanh(s) /
                       (s * std::sinh(alpha1) - std::sinh(alpha2) * std::sinh(s));  // D/B
  const double B = omega * a /
                   (std::sinh(alpha2) * std::sinh(s) + std::sinh(alpha1) * std::tanh(s) +
                    ratio * (s * std::cosh(alpha1) + std::cosh(alpha2) * std::sinh(s)));
  return {4.0 * pi * B * (c + ratio * c_coth), -4.0 * pi * ratio * B};
}

// Force and torque on the fluid of a disc of radius 1 in unit motion, with its centre 1.5 from the wall of a container.
struct DiscAtWall {
  double parallel, normal, turning;  // force, force, torque
  double torque;                     // in parallel motion
};
DiscAtWall disc_at_wall(double container_radius, int container_points) {
  const int points = 64;
  Suspension bodies{{{1.0, 1.0}, {container_radius - 1.5, 0.0}, 0.0, 0.0, true}};
  bodies.container = Container{0.0, container_radius, container_points, {}};
  ShapeCache shapes;
  const StokesSystem system(bodies, points, shapes, {1e-11, 1000});
  const auto reaction = [&](const auto& velocity) {
    ComplexVector data = ComplexVector::Zero(system.node_count());
    for (int k = 0; k < points; ++k) data[k] = velocity(system.boundaries()[0].node(k) - bodies[0].pose.centre);
    return system.solve_for_velocity(data).reaction[0];
  };
  const Wrench parallel = reaction([](Complex) { return imaginary_unit; });
  const Wrench normal = reaction([](Complex) { return Complex(1.0); });
  const Wrench turning = reaction([](Complex x) { return perp(x); });
  return {parallel.force.imag(), normal.force.real(), turning.torque, parallel.torque};
}

}  // namespace

TEST_CASE("the bipolar solution of a turning disc has the concentric and the lubrication limits") {
  // Concentric: 4 pi omega a^2 b^2 / (b^2 - a^2), with a correction that is even in e.
  const double a = 1.0, b = 2.5, concentric = 4.0 * pi * a * a * b * b / (b * b - a * a);
  const auto excess = [&](double e) { return turning_disc(a, b, e, 1.0).torque / concentric - 1.0; };
  CHECK(std::abs(excess(1e-3)) < 1e-6);
  CHECK(std::abs(excess(0.02) / excess(0.01) - 4.0) < 1e-2);
  CHECK(std::abs(turning_disc(a, b, 0.02, 1.0).force / turning_disc(a, b, 0.01, 1.0).force - 2.0) < 1e-2);
  // A narrow gap, width c (1 + epsilon cos theta), by Reynolds' equation with Sommerfeld's full film:
  // torque 4 pi (1 + 2 epsilon^2)/(c q), force 12 pi epsilon/(c^2 q), q = (2 + epsilon^2) sqrt(1 - epsilon^2), to O(c).
  for (const double epsilon : {0.3, 0.8})
    for (const double clearance : {1e-2, 1e-3}) {
      const TurningDisc disc = turning_disc(1.0, 1.0 + clearance, epsilon * clearance, 1.0);
      const double q = (2.0 + epsilon * epsilon) * std::sqrt(1.0 - epsilon * epsilon);
      CHECK(std::abs(disc.torque * clearance * q / (4.0 * pi * (1.0 + 2.0 * epsilon * epsilon)) - 1.0) <
            1.5 * clearance);
      CHECK(std::abs(disc.force * clearance * clearance * q / (12.0 * pi * epsilon) - 1.0) < 1.5 * clearance);
    }
}

TEST_CASE("a disc turning in an eccentric container takes the torque and force of the bipolar solution to 1e-10") {
  // The smallest gap is 0.1 of the disc's radius; 256 nodes resolve it to round-off, GMRES is stopped at 1e-13.
  const double a = 1.0, b = 2.5;
  for (const double e : {0.1, 1.0, 1.4}) {
    for (const double turn : {0.0, 2.0}) {  // of the line of centres
      const Complex away = std::polar(1.0, turn), middle(0.7, -0.2);
      Suspension bodies{{{a, a}, {middle - e * away, 0.3}, 0.0, 0.0, true, {}, 256}};
      bodies[0].surface.angular_velocity = 1.5;
      bodies.container = Container{middle, b, 256, {}};
      ShapeCache shapes;
      const StokesSystem system(bodies, 256, shapes, {1e-13, 1000});
      const StokesSolution s = system.solve({FlowKind::none, 1.0, 1.0}, {});
      const TurningDisc exact = turning_disc(a, b, e, 1.5);
      CHECK(std::abs(s.reaction[0].torque - exact.torque) < 1e-10 * exact.torque);
      CHECK(std::abs(s.reaction[0].force - exact.force * imaginary_unit * away) < 1e-10 * exact.torque);
      // The container bears the rest.
      const Wrench wall = system.container_wrench(s.density, {});
      CHECK(std::abs(wall.torque + exact.torque - e * exact.force) < 1e-10 * exact.torque);
    }
  }
}

TEST_CASE("in growing containers a disc's resistance falls to that at a plane wall, by a first-order excess") {
  // With cosh al = d/a: parallel 4 pi/al, normal 4 pi/(al - tanh al), turning 4 pi coth al, no torque in parallel
  // motion. The container's nodes are a third of the gap apart or closer: errors of 1e-7 and less.
  const double al = std::acosh(1.5);
  const std::array<DiscAtWall, 3> at{disc_at_wall(10.0, 192), disc_at_wall(20.0, 384), disc_at_wall(40.0, 704)};
  const auto check = [&](const char* name, double DiscAtWall::*of, double exact, double tolerance) {
    const double scale = exact != 0.0 ? exact : 4.0 * pi;
    std::array<double, 3> value, excess;
    for (int k = 0; k < 3; ++k) value[k] = at[k].*of, excess[k] = (value[k] - exact) / scale;
    const double first = std::log2(excess[0] / excess[1]), order = std::log2(excess[1] / excess[2]);
    // Without the terms in 1/R_0 and 1/R_0^2 the remainder is of third order.
    const double extrapolated = (8.0 * value[2] - 6.0 * value[1] + value[0]) / 3.0;
    MESSAGE(std::string(name) << ": excess times R_0/a " << 10.0 * excess[0] << " " << 20.0 * excess[1] << " "
                              << 40.0 * excess[2] << ", order " << first << " " << order << ", extrapolated to "
                              << (extrapolated - exact) / scale);
    // The second term is a fraction of a/R_0 times a few of the first, a deviation of the order that halves.
    CHECK(std::abs(order - 1.0) < 0.1);
    CHECK(std::abs(order - 1.0) < 0.6 * std::abs(first - 1.0));
    CHECK(std::abs(extrapolated - exact) < tolerance * scale);
  };
  check("parallel", &DiscAtWall::parallel, 4.0 * pi / al, 4e-3);
  check("normal", &DiscAtWall::normal, 4.0 * pi / (al - std::tanh(al)), 1e-3);
  check("turning", &DiscAtWall::turning, 4.0 * pi / std::tanh(al), 1e-5);
  check("torque in parallel motion", &DiscAtWall::torque, 0.0, 4e-3);
}

TEST_CASE("between walls interpolation converges algebraically, Cauchy integrals spectrally and better at every N") {
  std::string table = "relative errors of velocity and pressure in a manufactured flow:\n"
                      "    N  distance  interpolation      Cauchy integrals\n";
  struct Largest {  // near the boundaries, over the distances at which both schemes are close evaluations
    double velocity = 0.0, pressure = 0.0;
  };
  std::map<int, Largest> interpolated, cauchy;
  for (const int points : {32, 64, 128, 256}) {
    const ManufacturedFlow flow{{points, points, points, 2 * points}};
    // GMRES is stopped far below the errors of interpolation.
    const StokesOptions options{1e-10, 1000};
    ShapeCache shapes(NearSingular::interpolation), cauchy_shapes(NearSingular::cauchy);
    const StokesSystem a(flow.bodies, points, shapes, options), b(flow.bodies, points, cauchy_shapes, options);
    const ComplexVector eta = a.solve_for_velocity(flow.boundary_velocity(a)).density;
    const ComplexVector cauchy_eta = b.solve_for_velocity(flow.boundary_velocity(b)).density;
    for (const double distance : {0.1, 0.03, 0.01, 1e-3}) {
      std::vector<Complex> x{{0.0, 0.0}};  // where pressures are set equal
      for (const Complex point : flow.points_beside(distance, 8)) x.push_back(point);
      std::vector<PointFlow> exact;
      for (const Complex point : x) exact.push_back(flow.at(point));
      const WallFlowErrors ea = wall_flow_errors(a.flow(x, eta, {}, {}), exact);
      const WallFlowErrors eb = wall_flow_errors(b.flow(x, cauchy_eta, {}, {}), exact);
      char line[100];
      std::snprintf(line, sizeof line, "  %3d  %8g  %.1e %.1e    %.1e %.1e\n", points, distance, ea.velocity,
                    ea.pressure, eb.velocity, eb.pressure);
      table += line;
      if (distance > 0.03) continue;
      // With 32 nodes the density itself has errors of 1e-3, so both pressures have about the same error.
      CHECK(eb.velocity < (points == 32 ? 0.7 : 0.2) * ea.velocity);
      if (points > 32) CHECK(eb.pressure < 0.5 * ea.pressure);
      for (const auto& [largest, error] : {std::pair(&interpolated[points], &ea), std::pair(&cauchy[points], &eb)}) {
        largest->velocity = std::max(largest->velocity, error->velocity);
        largest->pressure = std::max(largest->pressure, error->pressure);
      }
    }
  }
  MESSAGE(table);
  // The order rises towards seven: about four from 64 to 128 nodes, five from there to 256.
  for (const auto& [points, order] : {std::pair(128, 3.5), std::pair(256, 4.7)}) {
    CHECK(interpolated[points].velocity < std::pow(2.0, -order) * interpolated[points / 2].velocity);
    CHECK(interpolated[points].pressure < std::pow(2.0, -order) * interpolated[points / 2].pressure);
  }
  CHECK(interpolated[256].velocity > 1e-8);
  // Twice the nodes square the error, down to that of GMRES.
  CHECK(cauchy[64].velocity < 10.0 * std::pow(cauchy[32].velocity, 2.0));
  CHECK(cauchy[128].velocity < 1e-9);
  CHECK(cauchy[128].pressure < 1e-8);
}
