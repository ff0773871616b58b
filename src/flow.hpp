// What drives the fluid: a background flow, and walls whose surfaces move.
#pragma once

#include <cmath>

#include "base.hpp"

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
  double walls = 0.0;  // factor of the surface velocities of the walls

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
};

}  // namespace stokes
