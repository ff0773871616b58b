// Curves, densities, differences and sums that the tests of flows share.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "cauchy.hpp"
#include "direct_fields.hpp"
#include "point_flow.hpp"
#include "shape.hpp"

namespace stokes {

using Boundary = std::function<Curve(int)>;  // a curve at a number of points

inline Boundary ellipse_boundary(double a, double b) {
  return [=](int points) { return Shape{a, b}.curve(points); };
}

// r = 1 + 0.25 cos 3 alpha + 0.1 sin alpha: not convex, not symmetric about the centre.
inline Curve three_lobed_curve(int points) {
  ComplexVector nodes(points);
  for (int k = 0; k < points; ++k) {
    const double alpha = 2.0 * pi * k / points;
    nodes[k] = std::polar(1.0 + 0.25 * std::cos(3.0 * alpha) + 0.1 * std::sin(alpha), alpha);
  }
  return Curve::through(nodes);
}

// A smooth density of order 1, with all Fourier modes.
inline ComplexVector smooth_density(int points) {
  ComplexVector eta(points);
  for (int k = 0; k < points; ++k) {
    const double alpha = 2.0 * pi * k / points;
    eta[k] = {std::exp(std::cos(alpha) - 1.0), std::sin(2.0 * alpha + 0.3)};
  }
  return eta;
}

// `distance` into the fluid from each `stride`-th node.
inline std::vector<Complex> points_beside(const Curve& curve, Side side, double distance, int stride = 1) {
  std::vector<Complex> z;
  const double into_fluid = side == Side::interior ? distance : -distance;
  for (int k = 0; k < curve.size(); k += stride)
    z.push_back(curve.position[k] + into_fluid * perp(curve.tangent[k]));
  return z;
}

// The plain trapezoid rule for the double layer, by the direct sum of point sources.
inline std::vector<PointFlow> direct_flow(const Curve& curve, Side side, const ComplexVector& density,
                                          const std::vector<Complex>& z) {
  const double s = side == Side::interior ? 1.0 : -1.0;
  const int count = static_cast<int>(z.size());
  PointArray targets, sources, normal;
  targets.resize(count), sources.resize(curve.size()), normal.resize(curve.size());
  for (int i = 0; i < count; ++i) targets.set(i, z[i]);
  for (int k = 0; k < curve.size(); ++k) {
    sources.set(k, curve.position[k]);
    normal.set(k, -imaginary_unit * s * curve.tangent[k] * curve.weight[k]);
  }
  SourceStrengths strengths;
  strengths.weighted_normal = &normal, strengths.density = &density;
  FlowFields fields;
  direct_fields(targets, sources, strengths, FlowOutput::gradient, fields);
  std::vector<PointFlow> flows;
  for (int i = 0; i < count; ++i)
    flows.push_back({fields.velocity[i], fields.pressure[i], fields.velocity_x[i], fields.velocity_y[i]});
  return flows;
}

// Largest differences, each over the largest value of its kind among the expected.
struct FlowErrors {
  double velocity = 0.0, pressure = 0.0, gradient = 0.0;

  double largest() const { return std::max({velocity, pressure, gradient}); }
};
inline double gradient_size(const PointFlow& flow) {
  return std::max(std::abs(flow.velocity_x), std::abs(flow.velocity_y));
}
inline FlowErrors flow_errors(const std::vector<PointFlow>& got, const std::vector<PointFlow>& expected) {
  FlowErrors error, scale;
  for (std::size_t i = 0; i < got.size(); ++i) {
    const PointFlow difference = got[i] - expected[i];
    error.velocity = std::max(error.velocity, std::abs(difference.velocity));
    error.pressure = std::max(error.pressure, std::abs(difference.pressure));
    error.gradient = std::max(error.gradient, gradient_size(difference));
    scale.velocity = std::max(scale.velocity, std::abs(expected[i].velocity));
    scale.pressure = std::max(scale.pressure, std::abs(expected[i].pressure));
    scale.gradient = std::max(scale.gradient, gradient_size(expected[i]));
  }
  return {error.velocity / scale.velocity, error.pressure / scale.pressure, error.gradient / scale.gradient};
}

// Residuals of u_x and u_y after subtracting differences of the velocity, of div u, and of -lap u + grad p, by
// differences of sixth order. A flow for which all of them are small solves the Stokes equations.
struct StokesResidual {
  double gradient, divergence, momentum;
};
inline StokesResidual stokes_residual(const std::function<PointFlow(Complex)>& flow, Complex z, double step) {
  const auto along = [&](Complex e, const auto& value) {
    const auto difference = [&](double k) {
      return value(flow(z + k * step * e)) - value(flow(z - k * step * e));
    };
    return (45.0 * difference(1.0) - 9.0 * difference(2.0) + difference(3.0)) / (60.0 * step);
  };
  const auto velocity = [](const PointFlow& f) { return f.velocity; };
  const auto pressure = [](const PointFlow& f) { return f.pressure; };
  const auto velocity_x = [](const PointFlow& f) { return f.velocity_x; };
  const auto velocity_y = [](const PointFlow& f) { return f.velocity_y; };
  const PointFlow here = flow(z);
  const Complex laplacian = along(1.0, velocity_x) + along(imaginary_unit, velocity_y);
  return {std::max(std::abs(along(1.0, velocity) - here.velocity_x),
                   std::abs(along(imaginary_unit, velocity) - here.velocity_y)),
          std::abs(here.velocity_x.real() + here.velocity_y.imag()),
          std::abs(Complex(along(1.0, pressure), along(imaginary_unit, pressure)) - laplacian)};
}

}  // namespace stokes
