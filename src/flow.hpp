// What drives the fluid: a background flow, and walls whose surfaces move.
#pragma once

#include <cmath>

#include "base.hpp"
#include "point_flow.hpp"

namespace stokes {

enum class FlowKind {
  none,       // fluid at rest at infinity
  shear,      // u = (rate y, 0)
  extension,  // u = rate (x, -y)
  taylor_green,  // u = rate (cos x sin y, -sin x cos y); no Stokes flow: it needs a body force on the fluid
};

struct BackgroundFlow {
  FlowKind kind = FlowKind::none;
  double rate = 1.0;
  double walls = 0.0;  // factor of the walls' surface velocities

  // Velocity at the point x.
  Complex velocity(Complex x) const {
    switch (kind) {
      case FlowKind::shear: return {rate * x.imag(), 0.0};
      case FlowKind::extension: return rate * std::conj(x);
      case FlowKind::taylor_green:
        return rate * Complex(std::cos(x.real()) * std::sin(x.imag()), -std::sin(x.real()) * std::cos(x.imag()));
      case FlowKind::none: break;
    }
    return 0.0;
  }

  // Velocity, its gradient and the pressure, which is 0 up to a constant. The Taylor-Green flow is driven by a body
  // force that is not a gradient. It has no pressure of a Stokes flow, and 0 is a convention: the stress there is that
  // of the disturbance and the background's rate of strain.
  PointFlow flow(Complex x) const {
    PointFlow result{velocity(x)};
    switch (kind) {
      case FlowKind::shear: result.velocity_y = rate; break;
      case FlowKind::extension: result.velocity_x = rate, result.velocity_y = Complex(0.0, -rate); break;
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
