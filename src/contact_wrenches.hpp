// Contact forces and torques on the bodies, and the rate at which motions change the values of constraints.
#pragma once

#include <vector>

#include "contact.hpp"
#include "suspension.hpp"

namespace stokes {

// Contact force and torque on every body and on the container.
struct ContactWrenches {
  std::vector<Wrench> bodies;
  Wrench container;

  void add(const ContactConstraint& c, const GapGradient& force, double factor) {
    Wrench &on_a = bodies[c.a], &on_b = c.b == container_index ? container : bodies[c.b];
    on_a.force += factor * force.centre_a, on_a.torque += factor * force.angle_a;
    on_b.force += factor * force.centre_b, on_b.torque += factor * force.angle_b;
  }

  // The wrenches that act on the fluid: fixed bodies bear theirs themselves.
  std::vector<Wrench> on_all_but(const std::vector<int>& fixed) const {
    std::vector<Wrench> result = bodies;
    for (const int i : fixed) result[i] = {};
    return result;
  }
};

inline std::vector<int> fixed_bodies(const Suspension& bodies) {
  std::vector<int> result;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (bodies[i].fixed) result.push_back(static_cast<int>(i));
  return result;
}

// Rate of change of a value with the given gradient when the mobile bodies move with `velocity`.
inline double rate_of(const Suspension& bodies, const ContactConstraint& c, const GapGradient& gradient,
                      const std::vector<RigidVelocity>& velocity) {
  double sum = 0.0;
  const auto add = [&](int body, Complex centre, double angle) {
    if (body == container_index || bodies[body].fixed) return;
    sum += dot(centre, velocity[body].velocity);
    sum += angle * velocity[body].omega;
  };
  add(c.a, gradient.centre_a, gradient.angle_a);
  add(c.b, gradient.centre_b, gradient.angle_b);
  return sum;
}

}  // namespace stokes
