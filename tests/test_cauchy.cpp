// Close evaluation by Cauchy integrals, and the plain trapezoid rule.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "cauchy.hpp"
#include "random_suspension.hpp"

using namespace stokes;

namespace {

using Boundary = std::function<Curve(int)>;  // a curve at a number of points

Boundary ellipse(double a, double b) {
  return [=](int points) { return Shape{a, b}.curve(points); };
}

// r = 1 + 0.25 cos 3 alpha + 0.1 sin alpha: not convex, not symmetric about the centre.
Curve three_lobed(int points) {
  ComplexVector nodes(points);
  for (int k = 0; k < points; ++k) {
    const double alpha = 2.0 * pi * k / points;
    nodes[k] = std::polar(1.0 + 0.25 * std::cos(3.0 * alpha) + 0.1 * std::sin(alpha), alpha);
  }
  return Curve::through(nodes);
}

// A smooth density of order 1, with all Fourier modes.
ComplexVector density(int points) {
  ComplexVector eta(points);
  for (int k = 0; k < points; ++k) {
    const double alpha = 2.0 * pi * k / points;
    eta[k] = {std::exp(std::cos(alpha) - 1.0), std::sin(2.0 * alpha + 0.3)};
  }
  return eta;
}

ComplexVector velocity(const VelocityRows& rows, const ComplexVector& eta) {
  return rows.direct * eta + rows.conjugate * eta.conjugate();
}

double largest(const ComplexVector& v) { return v.cwiseAbs().maxCoeff(); }

// The sum (1/pi) Sum (r.n)(r.eta) r/|r|^4 w, written out.
Complex trapezoid(const Curve& curve, Side side, const ComplexVector& eta, Complex z) {
  double x = 0.0, y = 0.0;
  const double s = side == Side::interior ? 1.0 : -1.0;
  for (int k = 0; k < curve.size(); ++k) {
    const double rx = z.real() - curve.position[k].real(), ry = z.imag() - curve.position[k].imag();
    const double nx = s * curve.tangent[k].imag(), ny = -s * curve.tangent[k].real();
    const double rr = rx * rx + ry * ry;
    const double f = (rx * nx + ry * ny) * (rx * eta[k].real() + ry * eta[k].imag()) / (rr * rr * pi);
    x += f * rx * curve.weight[k], y += f * ry * curve.weight[k];
  }
  return {x, y};
}

// `distance` into the fluid from each `stride`-th node.
std::vector<Complex> beside_nodes(const Curve& curve, Side side, double distance, int stride = 1) {
  std::vector<Complex> z;
  const double into_fluid = side == Side::interior ? distance : -distance;
  for (int k = 0; k < curve.size(); k += stride)
    z.push_back(curve.position[k] + into_fluid * perp(curve.tangent[k]));
  return z;
}

// Largest error relative to the largest velocity, at targets opposite and between the nodes, against the
// trapezoid rule on 8192.
double error_at_distance(const Boundary& boundary, Side side, int points, int upsampling, double distance) {
  const std::vector<Complex> z = beside_nodes(boundary(256), side, distance, 3);
  const CloseEvaluation close(boundary(points), side, upsampling);
  const ComplexVector u = velocity(close.velocity_rows(z), density(points));
  const Curve fine = boundary(8192);
  const ComplexVector eta = density(8192);
  double error = 0.0, scale = 0.0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    const Complex exact = trapezoid(fine, side, eta, z[i]);
    error = std::max(error, std::abs(u[i] - exact)), scale = std::max(scale, std::abs(exact));
  }
  return error / scale;
}

// Limit from the fluid: (-1/2 I + D) eta at the nodes, with the diagonal -s kappa/(2 pi) t (t . eta).
ComplexVector boundary_limit(const Curve& curve, Side side, const ComplexVector& eta) {
  const double s = side == Side::interior ? 1.0 : -1.0;
  ComplexVector u(curve.size());
  for (int j = 0; j < curve.size(); ++j) {
    Complex sum = -0.5 * eta[j];
    for (int k = 0; k < curve.size(); ++k) {
      if (k == j) continue;
      const Complex normal = -imaginary_unit * s * curve.tangent[k];
      const Complex r = curve.position[j] - curve.position[k];
      sum += dot(r, normal) * dot(r, eta[k]) * r / (pi * std::norm(r) * std::norm(r)) * curve.weight[k];
    }
    const Complex t = curve.tangent[j];
    u[j] = sum - s * curve.curvature[j] / (2.0 * pi) * curve.weight[j] * dot(t, eta[j]) * t;
  }
  return u;
}

}  // namespace

TEST_CASE("upsampling gives the known accuracy at a distance of 0.02 for each aspect ratio") {
  struct Row {
    double aspect;
    int points, upsampling;
    double known;
  };
  std::string table =
      "largest relative error of u at a distance of 0.02 from an ellipse of semi-axes 1, 1/aspect:\n"
      "  aspect    N  upsampling  known    outside  inside\n";
  for (const Row& row : {Row{1, 32, 1, 7e-15}, Row{2, 32, 1, 2e-4}, Row{2, 32, 2, 1.5e-8},
                         Row{2, 32, 3, 1.4e-12}, Row{3, 64, 1, 1e-5}, Row{3, 64, 2, 1e-10},
                         Row{3, 64, 3, 2e-14}, Row{6, 64, 1, 2e-3}, Row{6, 64, 2, 9e-6},
                         Row{6, 64, 3, 3e-8}, Row{6, 128, 2, 1e-10}}) {
    const Boundary boundary = ellipse(1.0, 1.0 / row.aspect);
    const double outside = error_at_distance(boundary, Side::exterior, row.points, row.upsampling, 0.02);
    const double inside = error_at_distance(boundary, Side::interior, row.points, row.upsampling, 0.02);
    char line[100];
    std::snprintf(line, sizeof line, "  %6g  %3d  %10d  %.1e  %.1e  %.1e\n", row.aspect, row.points,
                  row.upsampling, row.known, outside, inside);
    table += line;
    // Round-off of the reference: 8192 terms of size 1/distance.
    CHECK(outside < 3.0 * row.known + 1e-13);
    CHECK(inside < 3.0 * row.known + 1e-13);
  }
  MESSAGE(table);
}

TEST_CASE("the velocity at 1e-3 to 1e-12 from the curve is its limit on the curve, without loss of digits") {
  // Targets beside 256 nodes, of which every fourth or second carries a density value.
  struct Row {
    Boundary boundary;
    int points, upsampling;
  };
  for (const Row& row : {Row{ellipse(1.0, 1.0), 64, 1}, Row{ellipse(1.0, 0.5), 64, 2},
                         Row{ellipse(1.0, 1.0 / 3.0), 128, 2}, Row{three_lobed, 128, 2}})
    for (Side side : {Side::exterior, Side::interior}) {
      const Curve fine = row.boundary(256);
      const ComplexVector limit = boundary_limit(fine, side, density(256));
      const CloseEvaluation close(row.boundary(row.points), side, row.upsampling);
      for (double distance : {1e-3, 1e-6, 1e-9, 1e-12}) {
        const auto rows = close.velocity_rows(beside_nodes(fine, side, distance));
        const double error = largest(velocity(rows, density(row.points)) - limit);
        INFO("N = ", row.points, " distance ", distance, " error ", error);
        CHECK(error < 30.0 * distance + 1e-11);  // the velocity's gradient, and round-off
      }
    }
}

TEST_CASE("the accuracy at fixed digits of the position does not depend on the distance") {
  // On the unit circle C[e^{i m alpha}](z) = z^m inside (m >= 0) and -z^m outside (m < 0). With
  // eta = c e^{-i alpha} + d e^{2 i alpha}: outside phi = -(c/2)/z and
  // psi = -(1/2) C[conj(c) e^{i alpha} + conj(d) e^{-2 i alpha} - c e^{-3 i alpha} + 2 d].
  const Complex c(0.3, -0.8), d(-0.5, 0.4);
  const auto exact = [&](Complex z) {
    const Complex phi = -0.5 * c / z, dphi = 0.5 * c / (z * z);
    const Complex psi = 0.5 * (std::conj(d) / (z * z) - c / (z * z * z));
    return phi - z * std::conj(dphi) - std::conj(psi);
  };
  const int points = 32;
  const Curve disc = Shape{1.0, 1.0}.curve(points);
  const CloseEvaluation close(disc, Side::exterior, 1);
  ComplexVector eta(points);
  for (int k = 0; k < points; ++k) {
    const Complex e = disc.position[k];
    eta[k] = c * std::conj(e) + d * e * e;
  }
  for (double distance : {1e3, 10.0, 1.0, 0.1, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    std::vector<Complex> z;
    // Opposite a node, all but opposite one, and between two.
    for (double node : {0.0, 3.0, 17.0, 5.0 + 1e-9, 5.0 + 1e-4, 8.5, 20.25})
      z.push_back(std::polar(1.0 + distance, 2.0 * pi * node / points));
    const ComplexVector u = velocity(close.velocity_rows(z), eta);
    double error = 0.0;
    for (std::size_t i = 0; i < z.size(); ++i) error = std::max(error, std::abs(u[i] - exact(z[i])));
    INFO("distance ", distance, " error ", error);
    CHECK(error < 2e-14);
  }
}

TEST_CASE("a curve that is no ellipse and is not convex is as accurate outside and inside") {
  for (Side side : {Side::exterior, Side::interior}) {
    CHECK(error_at_distance(three_lobed, side, 128, 2, 0.02) < 1e-8);
    CHECK(error_at_distance(three_lobed, side, 256, 1, 0.02) < 1e-8);
    CHECK(error_at_distance(three_lobed, side, 256, 2, 0.02) < 1e-12);
  }
}

TEST_CASE("at moderate distance the trapezoid rule agrees and its rows are the kernel") {
  for (const Boundary& boundary : {ellipse(1.0, 0.5), Boundary(three_lobed)}) {
    CHECK(error_at_distance(boundary, Side::exterior, 128, 2, 0.3) < 1e-12);
    CHECK(error_at_distance(boundary, Side::exterior, 128, 2, 40.0) < 1e-12);
  }
  const Curve curve = three_lobed(24);
  const ComplexVector eta = density(24);
  const std::vector<Complex> z{{3.0, 1.0}, {-1.5, 2.0}, {0.05, -0.1}};
  for (Side side : {Side::exterior, Side::interior}) {
    const ComplexVector u = velocity(trapezoid_rows(curve, side, z), eta);
    for (int i = 0; i < 3; ++i) {
      const Complex expected = trapezoid(curve, side, eta, z[i]);
      CHECK(std::abs(u[i] - expected) < 1e-14 * (1.0 + std::abs(expected)));
    }
  }
}

TEST_CASE("the limits from the two sides differ by the density") {
  // A body's limit outside it is -eta/2 + D eta. With the fluid inside the normal, hence D, has the other
  // sign: the limit there is -eta/2 - D eta.
  for (const Boundary& boundary : {ellipse(1.0, 0.5), Boundary(three_lobed)}) {
    const Curve curve = boundary(128);
    const ComplexVector eta = density(128);
    const CloseEvaluation body(curve, Side::exterior, 2), wall(curve, Side::interior, 2);
    const auto z_outside = beside_nodes(curve, Side::exterior, 1e-12);
    const auto z_inside = beside_nodes(curve, Side::interior, 1e-12);
    const ComplexVector outside = velocity(body.velocity_rows(z_outside), eta);
    const ComplexVector inside = velocity(wall.velocity_rows(z_inside), eta);
    CHECK(largest(outside + inside + eta) < 1e-10);
    CHECK(largest(outside - inside) > 0.1);
  }
}

TEST_CASE("a constant density gives 1 inside and 0 outside a body, -1 inside and 0 outside a wall") {
  const Curve curve = three_lobed(256);
  const ComplexVector constant = ComplexVector::Constant(256, Complex(0.6, -0.8));
  const std::vector<Complex> inside{{0.0, 0.0}, {0.3, -0.2}}, outside{{2.5, 0.5}, {-3.0, 1.0}};
  const auto value = [&](Side side, const std::vector<Complex>& z) {
    return velocity(trapezoid_rows(curve, side, z), constant);
  };
  CHECK(largest(value(Side::exterior, inside) - constant.head(2)) < 1e-13);
  CHECK(largest(value(Side::interior, inside) + constant.head(2)) < 1e-13);
  CHECK(largest(value(Side::exterior, outside)) < 1e-13);
  CHECK(largest(value(Side::interior, outside)) < 1e-13);
  const CloseEvaluation body(curve, Side::exterior, 1), wall(curve, Side::interior, 1);
  for (double distance : {0.1, 1e-3, 1e-8, 1e-12}) {
    const auto near_body = beside_nodes(curve, Side::exterior, distance, 5);
    const auto near_wall = beside_nodes(curve, Side::interior, distance, 5);
    CHECK(largest(velocity(body.velocity_rows(near_body), constant)) < 1e-12);
    const ComplexVector u = velocity(wall.velocity_rows(near_wall), constant);
    CHECK((u.array() + Complex(0.6, -0.8)).abs().maxCoeff() < 1e-12);
  }
}

TEST_CASE("a rigid rotation as density gives no velocity outside a body and minus itself inside a wall") {
  const Curve curve = three_lobed(128);
  const ComplexVector rotation = imaginary_unit * curve.position;
  const CloseEvaluation body(curve, Side::exterior, 2), wall(curve, Side::interior, 2);
  for (double distance : {0.1, 1e-3, 1e-8, 1e-12}) {
    const std::vector<Complex> near_body = beside_nodes(curve, Side::exterior, distance);
    CHECK(largest(velocity(body.velocity_rows(near_body), rotation)) < 1e-11);
    const std::vector<Complex> z = beside_nodes(curve, Side::interior, distance);
    const ComplexVector u = velocity(wall.velocity_rows(z), rotation);
    double error = 0.0;
    for (std::size_t i = 0; i < z.size(); ++i) error = std::max(error, std::abs(u[i] + perp(z[i])));
    CHECK(error < 1e-11);
  }
}

TEST_CASE("the velocity close to the curve is free of divergence") {
  const Curve curve = three_lobed(128);
  const ComplexVector eta = density(128);
  const CloseEvaluation close(curve, Side::exterior, 2);
  const double step = 1e-5;
  for (Complex z : beside_nodes(curve, Side::exterior, 1e-3, 17)) {
    const ComplexVector u = velocity(
        close.velocity_rows({z + step, z - step, z + imaginary_unit * step, z - imaginary_unit * step}), eta);
    const double ux = (u[0] - u[1]).real() / (2.0 * step), vy = (u[2] - u[3]).imag() / (2.0 * step);
    CHECK(std::abs(ux + vy) < 1e-6);
  }
}
