// Velocity, pressure and velocity gradient at a point, and the stress, vorticity and strain rate derived from them.
//
// The viscosity is 1: sigma = -p I + grad u + (grad u)^T, rate of strain E = (grad u + (grad u)^T)/2.
// In terms of Goursat functions phi and psi, analytic in z,
//   u = phi - z conj(phi') - conj(psi),   p = -4 Re phi',   vorticity = 4 Im phi',
//   E_11 + i E_12 = -z conj(phi'') - conj(psi').
#pragma once

#include "base.hpp"

namespace stokes {

struct PointFlow {
  Complex velocity{0.0, 0.0};
  double pressure = 0.0;
  Complex velocity_x{0.0, 0.0}, velocity_y{0.0, 0.0};  // d(u_1 + i u_2)/dx and /dy

  PointFlow& operator+=(const PointFlow& other) {
    velocity += other.velocity, pressure += other.pressure;
    velocity_x += other.velocity_x, velocity_y += other.velocity_y;
    return *this;
  }
  PointFlow& operator-=(const PointFlow& other) {
    velocity -= other.velocity, pressure -= other.pressure;
    velocity_x -= other.velocity_x, velocity_y -= other.velocity_y;
    return *this;
  }
};

inline PointFlow operator+(PointFlow a, const PointFlow& b) { return a += b; }
inline PointFlow operator-(PointFlow a, const PointFlow& b) { return a -= b; }
inline PointFlow operator*(double factor, const PointFlow& flow) {
  return {factor * flow.velocity, factor * flow.pressure, factor * flow.velocity_x, factor * flow.velocity_y};
}

// d u_2/dx - d u_1/dy
inline double vorticity(const PointFlow& flow) { return flow.velocity_x.imag() - flow.velocity_y.real(); }

// E_11 + i E_12; E_22 = -E_11.
inline Complex strain_rate(const PointFlow& flow) {
  const Complex x = flow.velocity_x, y = flow.velocity_y;
  return 0.5 * Complex(x.real() - y.imag(), x.imag() + y.real());
}

struct Stress {
  double xx, xy, yy;
};

inline Stress stress(const PointFlow& flow) {
  return {2.0 * flow.velocity_x.real() - flow.pressure, flow.velocity_x.imag() + flow.velocity_y.real(),
          2.0 * flow.velocity_y.imag() - flow.pressure};
}

// sigma n: the force per length that the fluid on the side to which n points exerts on the other.
inline Complex traction(const Stress& sigma, Complex n) {
  return {sigma.xx * n.real() + sigma.xy * n.imag(), sigma.xy * n.real() + sigma.yy * n.imag()};
}

// Transforms a flow from the frame of a body, whose first axis points along the unit vector `axis`, to the laboratory
// frame: u = axis u_body, with derivatives along the axes of the laboratory.
inline PointFlow turned(const PointFlow& flow, Complex axis) {
  const double c = axis.real(), s = axis.imag();
  return {axis * flow.velocity, flow.pressure, axis * (c * flow.velocity_x - s * flow.velocity_y),
          axis * (s * flow.velocity_x + c * flow.velocity_y)};
}

// Values of the Goursat functions and their derivatives at one point.
struct GoursatValues {
  Complex phi, dphi, ddphi, psi, dpsi;
};

inline PointFlow goursat_flow(Complex z, const GoursatValues& g) {
  const Complex strain = -z * std::conj(g.ddphi) - std::conj(g.dpsi);
  const double rotation = 2.0 * g.dphi.imag();
  return {g.phi - z * std::conj(g.dphi) - std::conj(g.psi), -4.0 * g.dphi.real(),
          strain + Complex(0.0, rotation), -imaginary_unit * strain - rotation};
}

// One node of a double layer, weighted normal w n, at the distance r = target - node:
//   u = (1/pi) (r.n)(r.eta) r/|r|^4 w,   p = (1/pi) [2 (r.n)(r.eta)/|r|^4 - n.eta/|r|^2] w,
// by phi = n eta/(4 pi r), psi = -n.eta/(2 pi r), relative to the node.
inline PointFlow stresslet_flow(Complex r, Complex weighted_normal, Complex density) {
  const Complex inverse = reciprocal(r);
  const Complex phi = weighted_normal * density / (4.0 * pi) * inverse, dphi = -phi * inverse;
  const Complex psi = -dot(weighted_normal, density) / (2.0 * pi) * inverse;
  return goursat_flow(r, {phi, dphi, -2.0 * dphi * inverse, psi, -psi * inverse});
}

}  // namespace stokes
