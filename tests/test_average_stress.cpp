// Tractions on walls and bodies: forces, dissipation, average stress.
#include <doctest/doctest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "annulus.hpp"
#include "average_stress.hpp"

using namespace stokes;

namespace {

// Ten free ellipses of aspect ratios up to 2 between a wall of radius 1 at rest and one of radius 4 that turns.
Suspension stirred_ellipses() {
  Annulus annulus{1.0, 4.0, 192, {}, {}};
  annulus.outer_surface.angular_velocity = 0.5;
  Suspension bodies;
  for (int j = 0; j < 10; ++j) {
    const double radius = (j % 2 ? 3.05 : 2.0) + 0.02 * (j % 3);
    bodies.push_back({{0.3, j % 3 ? 0.15 : 0.25}, {std::polar(radius, 0.2 * pi * j), 0.9 * j}});
  }
  return between_walls(std::move(bodies), annulus);
}

// Nodes and weights of Gauss and Legendre's quadrature on [low, high], by Newton's method on Legendre's polynomial.
std::vector<std::pair<double, double>> gauss_legendre(int count, double low, double high) {
  std::vector<std::pair<double, double>> rule;
  for (int k = 0; k < count; ++k) {
    double x = std::cos(pi * (k + 0.75) / (count + 0.5)), slope = 0.0;
    for (int iteration = 0; iteration < 10; ++iteration) {
      double before = 1.0, value = x;
      for (int n = 2; n <= count; ++n) before = std::exchange(value, ((2 * n - 1) * x * value - (n - 1) * before) / n);
      slope = count * (x * value - before) / (x * x - 1.0);
      x -= value / slope;
    }
    rule.emplace_back(0.5 * (low + high) + 0.5 * (high - low) * x, (high - low) / ((1.0 - x * x) * slope * slope));
  }
  return rule;
}

// Elliptic coordinates around a body, z = A w + B/w with w = e^{rho + i theta}: rho = 0 on it.
struct Layer {
  Pose pose;
  double A, B, focus;

  explicit Layer(const Body& body)
      : pose(body.pose), A(0.5 * (body.shape.a + body.shape.b)), B(0.5 * (body.shape.a - body.shape.b)),
        focus(2.0 * std::sqrt(A * B)) {}
  double rho(Complex x) const {
    const Complex z = (x - pose.centre) * std::conj(pose.axis());
    return std::log(std::abs(z + std::sqrt(z - focus) * std::sqrt(z + focus)) / (2.0 * A));
  }
  Complex point(Complex w) const { return pose.centre + pose.axis() * (A * w + B / w); }
  double jacobian(Complex w) const { return std::norm(A * w - B / w); }  // of rho, theta
};

constexpr double layer_width = 1.15;
// 1 on the body, 0 from layer_width on, to 2e-8; in between a Gauss function's integral, which a grid resolves.
double weight_in_layer(double rho) { return 0.5 * std::erfc(3.9 * (2.0 * rho / layer_width - 1.0)); }

// Points and areas of a quadrature over the fluid: with the weights chi_j of the bodies' layers the part chi_j on
// elliptic grids around each body and the rest, 1 - Sum chi_j, which vanishes with all derivatives on the bodies, on
// a polar grid over the whole annulus.
struct AreaQuadrature {
  std::vector<Complex> point;
  std::vector<double> area;
};
AreaQuadrature fluid_quadrature(const Suspension& bodies) {
  constexpr int across = 32, around = 48, radial = 88, angular = 320;
  AreaQuadrature rule;
  std::vector<Layer> layers;
  for (const Body& body : bodies)
    if (!body.fixed) layers.emplace_back(body);
  for (const Layer& layer : layers)
    for (const auto& [rho, weight] : gauss_legendre(across, 0.0, layer_width))
      for (int k = 0; k < around; ++k) {
        const Complex w = std::polar(std::exp(rho), 2.0 * pi * k / around);
        rule.point.push_back(layer.point(w));
        rule.area.push_back(weight_in_layer(rho) * weight * layer.jacobian(w) * 2.0 * pi / around);
      }
  for (const auto& [r, weight] : gauss_legendre(radial, bodies.back().shape.a, bodies.container->radius))
    for (int k = 0; k < angular; ++k) {
      const Complex x = std::polar(r, 2.0 * pi * k / angular);
      double share = 1.0;
      bool inside = false;
      for (const Layer& layer : layers) {
        const double rho = layer.rho(x);
        inside = inside || rho < 0.0;
        share -= weight_in_layer(rho);
      }
      if (inside) continue;
      rule.point.push_back(x);
      rule.area.push_back(share * weight * r * 2.0 * pi / angular);
    }
  return rule;
}

double sum_of_torques(const PlacedShape& b, const std::vector<Complex>& forces) {
  double torque = 0.0;
  for (int k = 0; k < b.size(); ++k) torque += cross(b.node(k), forces[k]);
  return torque;
}

}  // namespace

TEST_CASE("ten ellipses in an annulus: the fluid dissipates the power of the boundaries, and the torques balance") {
  const Suspension bodies = stirred_ellipses();
  ShapeCache shapes;
  const StokesSystem system(bodies, 96, shapes, {1e-12, 1000});
  const BackgroundFlow driving{FlowKind::none, 1.0, 1.0};
  const StokesSolution s = system.solve(driving, {});

  double power = 0.0;
  std::vector<double> torque;
  for (int j = 0; j <= system.body_count(); ++j) {
    const PlacedShape& b = system.boundaries()[j];
    const std::vector<Complex> forces = node_forces(system, j, s.density, driving, {});
    torque.push_back(sum_of_torques(b, forces));
    std::vector<Complex> nodes;
    for (int k = 0; k < b.size(); ++k) nodes.push_back(b.node(k));
    const std::vector<PointFlow> flow = system.flow(nodes, s.density, driving, {});
    Complex force = 0.0;
    for (int k = 0; k < b.size(); ++k) power += dot(flow[k].velocity, forces[k]), force += forces[k];
    if (j >= system.body_count() - 1) continue;
    CHECK(std::abs(force) < 1e-8);  // free bodies; the walls' torques are of order 10
    CHECK(std::abs(torque.back()) < 1e-8);
  }
  const double inner = torque[torque.size() - 2], outer = torque.back();
  MESSAGE("torques " << inner << " and " << outer << ", sum " << inner + outer << ", less those of the densities "
                     << inner - s.reaction.back().torque << " and "
                     << outer - system.container_wrench(s.density, {}).torque);
  // GMRES is stopped at 1e-12, and 96 and 192 nodes resolve bodies a diameter and more apart.
  CHECK(std::abs(inner + outer) < 1e-8 * outer);
  CHECK(std::abs(inner - s.reaction.back().torque) < 1e-8 * outer);
  CHECK(std::abs(outer - system.container_wrench(s.density, {}).torque) < 1e-8 * outer);
  CHECK(std::abs(power - 0.5 * outer) < 1e-8 * power);  // only the outer wall moves against its force

  const AreaQuadrature rule = fluid_quadrature(bodies);
  const std::vector<PointFlow> flow = system.flow(rule.point, s.density, driving, {});
  double dissipation = 0.0, area = 0.0, exact_area = pi * (16.0 - 1.0);
  for (std::size_t i = 0; i < flow.size(); ++i) {
    dissipation += 4.0 * std::norm(strain_rate(flow[i])) * rule.area[i];  // 2 E:E
    area += rule.area[i];
  }
  for (const Body& body : bodies)
    if (!body.fixed) exact_area -= pi * body.shape.a * body.shape.b;
  MESSAGE(flow.size() << " points: relative errors of dissipation " << dissipation / power - 1.0 << ", area "
                      << area / exact_area - 1.0);
  // The weights are cut off at 2e-8, and the grids resolve them to about as much of a layer's part.
  CHECK(std::abs(dissipation / power - 1.0) < 1e-7);
  CHECK(std::abs(area / exact_area - 1.0) < 1e-6);
}

TEST_CASE("the average stress is twice the mean strain rate, the stresslets and the contacts, to 1e-10") {
  // Three free ellipses, two of which press each other apart, and a held one; the wall strains the fluid.
  const Complex centre(0.8, -0.3);
  for (const bool obstacle : {false, true}) {
    Suspension bodies{{{0.6, 0.3}, {centre + Complex(-1.0, 0.6), 0.4}}, {{0.5, 0.4}, {centre + Complex(1.2, 0.9), 1.9}},
                      {{0.4, 0.4}, {centre + Complex(0.3, -1.1), 0.0}}};
    if (obstacle) bodies.push_back({{0.5, 0.3}, {centre + Complex(-1.6, -1.2), 0.7}, 0.0, 0.0, true});
    bodies.container = Container{centre, 3.5, 192, {}};
    const Complex push = bodies[1].pose.centre - bodies[0].pose.centre;
    std::vector<Wrench> wrenches(bodies.size());
    wrenches[0].force = -2.0 * push, wrenches[1].force = 2.0 * push;  // on the line of centres: no torque

    ShapeCache shapes;
    const StokesSystem system(bodies, 96, shapes, {1e-13, 1000});
    const PlacedShape& wall = system.boundaries().back();
    ComplexVector data = ComplexVector::Zero(system.node_count());
    double area = pi * 3.5 * 3.5;
    if (obstacle) area -= pi * 0.5 * 0.3;
    Complex strain = 0.0;  // <E_11 + i E_12> = (1/2V) oint n u ds, as a complex product; nothing moves on the obstacle
    for (int k = 0; k < wall.size(); ++k) {
      const Complex x = wall.node(k) - centre;
      data[wall.offset + k] = Complex(0.7, 0.4) * std::conj(x) + 0.1 * std::conj(x * x) + 0.3 * perp(x);
      strain += 0.5 / area * wall.axis * wall.shape->weighted_normal(k) * data[wall.offset + k];
    }
    const ComplexVector density =
        system.solve({}, wrenches).density + system.solve_for_velocity(data).density;

    const std::vector<Complex> stresslets = system.stresslets(density, wrenches);
    // The parts without trace as complex numbers: that of sym(F (x) d) is F d / 2.
    Complex expected = 2.0 * strain + 0.5 * wrenches[0].force * push / area;
    for (int j = 0; j < 3; ++j) expected += stresslets[j] / area;
    const Stress average = average_stress(system, density, {}, wrenches);
    const Complex deviator(0.5 * (average.xx - average.yy), average.xy);
    MESSAGE("deviator " << deviator << ", error " << std::abs(deviator - expected));
    // An identity of the densities, whatever the error of the solution: only quadrature and round-off are left.
    CHECK(std::abs(deviator - expected) < 1e-10 * std::abs(expected));
    // Each of the parts is needed.
    CHECK(std::abs(expected - 2.0 * strain) > 0.01);
    CHECK(std::abs(push * wrenches[0].force / area) > 0.1);
  }
}

TEST_CASE("there is no average stress without a container") {
  const Suspension bodies{{{0.5, 0.5}, {}}};
  ShapeCache shapes;
  const StokesSystem system(bodies, 32, shapes, {});
  CHECK_THROWS_AS(average_stress(system, ComplexVector::Zero(32), {}, {}), InputError);
}
