// Velocity, pressure and gradient of the double layer close to its curve.
#include <doctest/doctest.h>

#include <cstdio>
#include <string>

#include "close_flow.hpp"
#include "discrete_shape.hpp"
#include "flow.hpp"
#include "flow_checks.hpp"

using namespace stokes;

namespace {

std::vector<PointFlow> values(const CloseFlow& flow, const std::vector<Complex>& z) {
  std::vector<PointFlow> result;
  for (Complex point : z) result.push_back(flow.at(point));
  return result;
}

// Compared with the direct sum over enough nodes, at least eight per distance, at points beside nodes and
// between them.
FlowErrors errors_at(const Boundary& boundary, Side side, int points, int upsampling, double distance) {
  const std::vector<Complex> z = points_beside(boundary(11 * points), side, distance, 11 * points / 13);
  const int fine = distance < 0.01 ? 65536 : 4096;
  const CloseFlow flow(boundary(points), side, upsampling, smooth_density(points));
  return flow_errors(values(flow, z), direct_flow(boundary(fine), side, smooth_density(fine), z));
}

}  // namespace

TEST_CASE("velocity, pressure and gradient keep their digits down to 1e-3 from discs and ellipses, on both sides") {
  std::string table =
      "relative errors of velocity, pressure and gradient on ellipses of semi-axes 1, 1/aspect:\n"
      "  aspect   N  distance  outside                  inside\n";
  for (const auto& [aspect, points] :
       {std::pair(1, 32), std::pair(2, 32), std::pair(3, 32), std::pair(3, 64), std::pair(6, 64)})
    for (double distance : {0.1, 0.02, 1e-3}) {
      const Boundary boundary = ellipse_boundary(1.0, 1.0 / aspect);
      const int upsampling = flow_upsampling(aspect, points);
      const FlowErrors outside = errors_at(boundary, Side::exterior, points, upsampling, distance);
      const FlowErrors inside = errors_at(boundary, Side::interior, points, upsampling, distance);
      char line[120];
      std::snprintf(line, sizeof line, "  %6d  %2d  %8g  %.1e %.1e %.1e  %.1e %.1e %.1e\n", aspect, points, distance,
                    outside.velocity, outside.pressure, outside.gradient, inside.velocity, inside.pressure,
                    inside.gradient);
      table += line;
      // Round-off of the sum's distances: eps/distance of the velocity, and of the kernel's 1/distance.
      const double round_off = 2e-16 / (distance * distance);
      for (const FlowErrors& error : {outside, inside}) {
        CHECK(error.velocity < 1e-13 + 1e-3 * round_off);
        CHECK(error.pressure < 1e-12 + round_off);
        CHECK(error.gradient < 1e-12 + round_off);
      }
    }
  MESSAGE(table);
}

TEST_CASE("with less upsampling the gradient suffers first") {
  const FlowErrors error = errors_at(ellipse_boundary(1.0, 1.0 / 3.0), Side::exterior, 64, 2, 0.02);
  CHECK(error.velocity < 1e-9);
  CHECK(error.gradient < 1e-6);
  CHECK(error.gradient > 100.0 * error.velocity);
}

TEST_CASE("a curve that is no ellipse and is not convex has all digits outside and inside") {
  for (Side side : {Side::exterior, Side::interior}) {
    CHECK(errors_at(three_lobed_curve, side, 128, 4, 0.02).largest() < 1e-10);
    CHECK(errors_at(three_lobed_curve, side, 128, 4, 1e-3).largest() < 1e-9);
  }
}

TEST_CASE("on a disc the accuracy does not depend on the distance, down to the curve itself") {
  // eta = c e^{-i alpha} + d e^{2 i alpha} on the unit circle: outside phi = -(c/2)/z and
  // psi = (conj(d)/z^2 - c/z^3)/2, inside phi = -(d/2) z^2 and psi = (conj(c) z + 2 d)/2.
  const Complex c(0.3, -0.8), d(-0.5, 0.4);
  const auto exact = [&](Side side, Complex z) {
    if (side == Side::interior)
      return goursat_flow(z, {-0.5 * d * z * z, -d * z, -d, 0.5 * std::conj(c) * z + d, 0.5 * std::conj(c)});
    const Complex w = 1.0 / z, w2 = w * w, w3 = w2 * w;
    return goursat_flow(z, {-0.5 * c * w, 0.5 * c * w2, -c * w3, 0.5 * (std::conj(d) * w2 - c * w3),
                            -std::conj(d) * w3 + 1.5 * c * w2 * w2});
  };
  const int points = 32;
  const Curve disc = Shape{}.curve(points);
  ComplexVector eta(points);
  for (int k = 0; k < points; ++k) {
    const Complex e = disc.position[k];
    eta[k] = c * std::conj(e) + d * e * e;
  }
  for (Side side : {Side::exterior, Side::interior}) {
    const CloseFlow flow(disc, side, flow_upsampling(1.0, points), eta);
    for (double distance : {1e3, 10.0, 0.9, 0.1, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-15, 0.0}) {
      if (side == Side::interior && distance >= 1.0) continue;
      const double radius = side == Side::interior ? 1.0 - distance : 1.0 + distance;
      double error = 0.0;
      // Opposite a node, all but opposite one, and between two.
      for (double node : {0.0, 3.0, 17.0, 5.0 + 1e-9, 5.0 + 1e-4, 8.5, 20.25}) {
        const Complex z = std::polar(radius, 2.0 * pi * node / points);
        const PointFlow difference = flow.at(z) - exact(side, z);
        error = std::max({error, std::abs(difference.velocity), std::abs(difference.pressure),
                          gradient_size(difference)});
      }
      INFO("distance ", distance, " error ", error);
      CHECK(error < 1e-13);
    }
  }
}

TEST_CASE("the limits at the nodes are the flow there, on a coarser curve between its nodes, and next to them") {
  for (const Boundary& boundary : {ellipse_boundary(1.0, 1.0 / 3.0), Boundary(three_lobed_curve)})
    for (Side side : {Side::exterior, Side::interior}) {
      const Curve curve = boundary(256);
      const CloseFlow fine(curve, side, 2, smooth_density(256)), coarse(boundary(128), side, 4, smooth_density(128));
      const std::vector<PointFlow> limits = fine.at_nodes();
      REQUIRE(limits.size() == 256);
      const auto at_distance = [&](const CloseFlow& flow, double distance) {
        return flow_errors(values(flow, points_beside(curve, side, distance)), limits);
      };
      CHECK(at_distance(fine, 0.0).largest() < 1e-13);
      CHECK(at_distance(coarse, 0.0).largest() < 2e-10);
      CHECK(at_distance(coarse, 1e-12).largest() < 2e-10);
      CHECK(at_distance(coarse, 1e-6).largest() < 1e-4);
      CHECK(at_distance(coarse, 1e-6).largest() > 1e-8);
    }
}

TEST_CASE("the velocity is that of the velocity rows") {
  const Curve curve = Shape{1.0, 0.5}.curve(64);
  const ComplexVector eta = smooth_density(64);
  for (Side side : {Side::exterior, Side::interior}) {
    const CloseEvaluation close(curve, side, 3);
    const CloseFlow flow(curve, side, 3, eta);
    for (double distance : {0.4, 1e-2, 1e-10, 0.0}) {
      const std::vector<Complex> z = points_beside(curve, side, distance, 5);
      const VelocityRows rows = close.velocity_rows(z);
      const ComplexVector u = rows.direct * eta + rows.conjugate * eta.conjugate();
      for (std::size_t i = 0; i < z.size(); ++i)
        CHECK(std::abs(flow.at(z[i]).velocity - u[static_cast<Eigen::Index>(i)]) < 1e-13);
    }
  }
}

TEST_CASE("close to the curve the flow solves the Stokes equations") {
  for (Side side : {Side::exterior, Side::interior}) {
    const Curve curve = three_lobed_curve(128);
    const CloseFlow flow(curve, side, 4, smooth_density(128));
    for (Complex z : points_beside(curve, side, 2e-2, 17)) {
      const StokesResidual residual = stokes_residual([&](Complex x) { return flow.at(x); }, z, 2e-3);
      CHECK(residual.gradient < 1e-8);
      CHECK(residual.divergence < 1e-13);
      CHECK(residual.momentum < 1e-6);
    }
  }
}

TEST_CASE("a rigid motion as density has no pressure and no stress") {
  const Curve curve = three_lobed_curve(128);
  const ComplexVector rigid = (Complex(0.6, -0.8) + 1.5 * imaginary_unit * curve.position.array()).matrix();
  for (Side side : {Side::exterior, Side::interior}) {
    const CloseFlow flow(curve, side, 4, rigid);
    for (double distance : {0.1, 1e-3, 1e-12, 0.0})
      for (Complex z : points_beside(curve, side, distance, 7)) {
        const PointFlow here = flow.at(z);
        CHECK(std::abs(here.pressure) < 1e-10);
        CHECK(std::abs(strain_rate(here)) < 1e-10);
        CHECK(std::abs(vorticity(here) - (side == Side::interior ? -3.0 : 0.0)) < 1e-10);
      }
  }
}

TEST_CASE("the traction of a double layer is the same on both sides of its curve, and no net force") {
  for (const Boundary& boundary : {ellipse_boundary(1.0, 0.5), Boundary(three_lobed_curve)}) {
    const Curve curve = boundary(128);
    const ComplexVector eta = smooth_density(128);
    // The sides' kernels have opposite normals, hence opposite signs.
    const auto outside = CloseFlow(curve, Side::exterior, 4, eta).at_nodes();
    const auto inside = CloseFlow(curve, Side::interior, 4, eta).at_nodes();
    Complex force = 0.0;
    double torque = 0.0, largest = 0.0;
    for (int k = 0; k < curve.size(); ++k) {
      const Complex n = -imaginary_unit * curve.tangent[k], f = traction(stress(outside[k]), n);
      CHECK(std::abs(f + traction(stress(inside[k]), n)) < 1e-10);
      force += curve.weight[k] * f, torque += curve.weight[k] * cross(curve.position[k], f);
      largest = std::max(largest, std::abs(f));
    }
    CHECK(std::abs(force) < 1e-11);
    CHECK(std::abs(torque) < 1e-11);
    CHECK(largest > 1.0);
  }
}

TEST_CASE("a discrete shape's flow close to it, by either scheme") {
  const Shape shape{1.0, 0.5};
  const int points = 64;
  const DiscreteShape cauchy(shape, {points, {}}, BoundaryKind::free, 1.0, NearSingular::cauchy);
  const DiscreteShape interpolation(shape, {points, {}}, BoundaryKind::free, 1.0, NearSingular::interpolation);
  const ComplexVector eta = smooth_density(points);
  for (double distance : {0.7, 0.2, 1e-2, 1e-3}) {
    const std::vector<Complex> z = points_beside(cauchy.curve, Side::exterior, distance, 3);
    const auto exact = direct_flow(shape.curve(65536), Side::exterior, smooth_density(65536), z);
    CHECK(flow_errors(cauchy.close_flow(eta, z), exact).largest() < 1e-9);
    const double near_error = flow_errors(interpolation.close_flow(eta, z), exact).largest();
    CHECK(near_error < 0.05);
    CHECK((near_error > 1e-6) == (distance < cauchy.curve.length() / points));
  }
}

TEST_CASE("beyond its near distance the plain sum has velocity, or pressure and gradient, to 1e-10 of the density") {
  for (const Shape& shape : {Shape{1.0, 1.0}, Shape{1.0, 0.5}, Shape{1.0, 1.0 / 6.0}})
    for (int points : {32, 64, 128}) {
      const DiscreteShape body(shape, {points, {}}, BoundaryKind::free, 1.0, NearSingular::cauchy);
      const auto largest = [&](double distance, const auto& size) {
        const auto z = points_beside(shape.curve(48), Side::exterior, distance);
        const auto exact = direct_flow(shape.curve(2048), Side::exterior, smooth_density(2048), z);
        const auto plain = direct_flow(body.curve, Side::exterior, smooth_density(points), z);
        double error = 0.0;
        for (std::size_t i = 0; i < z.size(); ++i) error = std::max(error, size(plain[i] - exact[i]));
        return error;
      };
      const auto velocity = [](const PointFlow& f) { return std::abs(f.velocity); };
      const auto rest = [](const PointFlow& f) { return std::max(std::abs(f.pressure), gradient_size(f)); };
      CHECK(largest(near_distance(body, 1e-10), velocity) < 1e-10);
      CHECK(largest(near_distance_of_gradient(body), rest) < 1e-10);
      CHECK(largest(0.3 * near_distance(body, 1e-10), rest) > 1e-6);
    }
}

TEST_CASE("around a free disc in a straining flow pressure and stress have their closed form up to the disc") {
  // u = E conj(z) far away: phi = -E/z, psi = -conj(E) z - E/z^3, which is at rest on |z| = 1.
  const Complex E(1.0, 0.0);
  const BackgroundFlow background{FlowKind::extension, 1.0};
  const DiscreteShape disc({1.0, 1.0}, {32, {}}, BoundaryKind::free, 1.0, NearSingular::cauchy);
  ComplexVector driven = -disc.curve.position.conjugate(), density(32);
  as_real(density) = disc.solve_own(as_real(driven));
  for (double distance : {0.5, 1e-2, 1e-3, 1e-8, 0.0}) {
    const std::vector<Complex> z = points_beside(Shape{}.curve(42), Side::exterior, distance);
    std::vector<PointFlow> flow = disc.close_flow(density, z), exact;
    for (std::size_t i = 0; i < z.size(); ++i) {
      flow[i] += background.flow(z[i]);
      const Complex w = 1.0 / z[i], w2 = w * w;
      exact.push_back(goursat_flow(z[i], {-E * w, E * w2, -2.0 * E * w2 * w, -std::conj(E) * z[i] - E * w2 * w,
                                          -std::conj(E) + 3.0 * E * w2 * w2}));
    }
    for (std::size_t i = 0; i < z.size(); ++i) {
      const Stress a = stress(flow[i]), b = stress(exact[i]);
      CHECK(std::abs(flow[i].velocity - exact[i].velocity) < 1e-13);
      CHECK(std::abs(flow[i].pressure - exact[i].pressure) < 1e-12);
      CHECK(std::max({std::abs(a.xx - b.xx), std::abs(a.xy - b.xy), std::abs(a.yy - b.yy)}) < 1e-12);
    }
  }
}
