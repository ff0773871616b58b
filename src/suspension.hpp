// Bodies and where they are.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "shape.hpp"

namespace stokes {

// Position of a rigid body: its centre and the angle of its first axis.
struct Pose {
  Complex centre{0.0, 0.0};
  double angle = 0.0;

  bool operator==(const Pose&) const = default;

  // Direction of the body's first axis; a vector v in the body frame is axis() * v in the laboratory's.
  Complex axis() const { return std::polar(1.0, angle); }
};

// Velocity of the surface of a wall or of a fixed body, c its centre:
//   u(x) = translation + angular_velocity perp(x - c) + source (x - c) / (2 pi |x - c|^2).
// A fixed body and its nodes move with the rigid part. A wall has no translation. The nodes of a rotating wall move with its
// surface, so that they stay beside the bodies that it carries along.
struct SurfaceMotion {
  double angular_velocity = 0.0;
  double source = 0.0;  // area of fluid per time, positive away from the centre
  Complex translation{0.0, 0.0};

  bool operator==(const SurfaceMotion&) const = default;

  Complex velocity(Complex from_centre) const {
    Complex u = translation + angular_velocity * perp(from_centre);
    if (source != 0.0) u += source / (2.0 * pi * std::norm(from_centre)) * from_centre;
    return u;
  }
};

// A rigid body that moves freely, a fixed body that is held or driven at a given velocity, or an inner wall of the domain.
struct Body {
  Shape shape;
  Pose pose;
  Complex force{0.0, 0.0};  // external force on the body
  double torque = 0.0;      // external torque on the body about its centre
  bool fixed = false;       // moves with its surface, whatever the force on it
  SurfaceMotion surface{};  // of a fixed body
  int points = 0;           // on its boundary; 0: as many as on every body

  // True for a fixed body, not a wall, whose pose changes.
  bool is_driven() const { return fixed && points == 0 && (surface.translation != 0.0 || surface.angular_velocity != 0.0); }
};

// A circular wall around the fluid.
struct Container {
  Complex centre{0.0, 0.0};
  double radius = 0.0;
  int points = 0;  // on its boundary
  SurfaceMotion surface{};
  double angle = 0.0;  // by which the surface has turned
};

// Stands for the container where a pair has the index of its second body. It is larger than any index of a body.
inline constexpr int container_index = std::numeric_limits<int>::max();

// "bodies 3 and 5" or "body 3 and the container".
inline std::string pair_name(int a, int b) {
  if (b == container_index) return "body " + std::to_string(a) + " and the container";
  return "bodies " + std::to_string(a) + " and " + std::to_string(b);
}

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

// The bodies, in order, and the wall around them; without one the fluid is unbounded.
struct Suspension : std::vector<Body> {
  using std::vector<Body>::vector;
  std::optional<Container> container;
};

inline Pose advance(const Pose& pose, const RigidVelocity& u, double dt) {
  return {pose.centre + dt * u.velocity, pose.angle + dt * u.omega};
}

}  // namespace stokes
