// Bodies and where they are.
#pragma once

#include <vector>

#include "shape.hpp"

namespace stokes {

// Position of a rigid body: its centre and the angle of its first axis.
struct Pose {
  Complex centre{0.0, 0.0};
  double angle = 0.0;

  // Direction of the body's first axis; a vector v in the body frame is axis() * v in the laboratory's.
  Complex axis() const { return std::polar(1.0, angle); }
};

struct Body {
  Shape shape;
  Pose pose;
  Complex force{0.0, 0.0};  // external force on the body
  double torque = 0.0;      // external torque on the body about its centre
};

// Translational and angular velocity of a body.
struct RigidVelocity {
  Complex velocity{0.0, 0.0};
  double omega = 0.0;
};

// Force and torque (about the centre) on a body.
struct Wrench {
  Complex force{0.0, 0.0};
  double torque = 0.0;
};

using Suspension = std::vector<Body>;

inline Pose advance(const Pose& pose, const RigidVelocity& u, double dt) {
  return {pose.centre + dt * u.velocity, pose.angle + dt * u.omega};
}

}  // namespace stokes
