// What drives the fluid: a background flow, and walls and held bodies whose surfaces move.
#pragma once

#include <algorithm>
#include <cmath>

#include "base.hpp"
#include "point_flow.hpp"

namespace stokes {

enum class FlowKind {
  none,       // fluid at rest at infinity
  shear,      // u = (rate y, 0)
  extension,  // u = rate (x, -y)
  linear,     // u = rate (xx x + xy y, yx x - xx y), the coefficients a FlowGradient
  poiseuille,    // u = (rate y^2, 0), rate in 1 / (length time): between walls far away, driven by p = 2 rate x
  taylor_green,  // u = rate (cos x sin y, -sin x cos y); no Stokes flow: it needs a body force on the fluid
};

// Velocity gradient d u_i / d x_j of an incompressible flow: yy = -xx.
struct FlowGradient {
  double xx = 0.0, xy = 0.0, yx = 0.0;

  double largest() const { return std::max({std::abs(xx), std::abs(xy), std::abs(yx)}); }
};

struct BackgroundFlow {
  FlowKind kind = FlowKind::none;
  double rate = 1.0;
  double walls = 0.0;  // factor of the surface velocities of walls and fixed bodies
  FlowGradient gradient{};  // of FlowKind::linear, before the rate

  // The same flow with everything that drives the fluid multiplied by a factor.
  BackgroundFlow driven(double driving) const { return {kind, driving * rate, driving, gradient}; }

  bool has_uniform_gradient() const {
    return kind == FlowKind::shear || kind == FlowKind::extension || kind == FlowKind::linear;
  }

  // Velocity at the point x.
  Complex velocity(Complex x) const {
    switch (kind) {
      case FlowKind::shear: return {rate * x.imag(), 0.0};
      case FlowKind::extension: return rate * std::conj(x);
      case FlowKind::linear:
        return rate * Complex(gradient.xx * x.real() + gradient.xy * x.imag(),
                              gradient.yx * x.real() - gradient.xx * x.imag());
      case FlowKind::poiseuille: return {rate * x.imag() * x.imag(), 0.0};
      case FlowKind::taylor_green:
        return rate * Complex(std::cos(x.real()) * std::sin(x.imag()), -std::sin(x.real()) * std::cos(x.imag()));
      case FlowKind::none: break;
    }
    return 0.0;
  }

  // Velocity, its gradient and the pressure, which is 0 up to a constant except in Poiseuille flow. The Taylor-Green flow is
  // driven by a body force that is not a gradient. It has no pressure of a Stokes flow, and 0 is a convention: the stress
  // there is that of the disturbance and the background's rate of strain.
  PointFlow flow(Complex x) const {
    PointFlow result{velocity(x)};
    switch (kind) {
      case FlowKind::shear: result.velocity_y = rate; break;
      case FlowKind::extension: result.velocity_x = rate, result.velocity_y = Complex(0.0, -rate); break;
      case FlowKind::linear:
        result.velocity_x = rate * Complex(gradient.xx, gradient.yx);
        result.velocity_y = rate * Complex(gradient.xy, -gradient.xx);
        break;
      case FlowKind::poiseuille:
        result.velocity_y = 2.0 * rate * x.imag();
        result.pressure = 2.0 * rate * x.real();  // grad p = lap u
        break;
      case FlowKind::taylor_green: {
        const double along = rate * std::sin(x.real()) * std::sin(x.imag());
        const double across = rate * std::cos(x.real()) * std::cos(x.imag());
        result.velocity_x = {-along, -across}, result.velocity_y = {across, along};
        break;
      }
      case FlowKind::none: break;
    }
    return result;
  }
};

}  // namespace stokes
