// Suspensions between cylinders of radii 5, at rest, and 10, rotating, for several tests.
#pragma once

#include <algorithm>
#include <cmath>

#include "annulus.hpp"
#include "rheology.hpp"

namespace stokes {

inline constexpr double outer_rotation = 2.0;

inline Suspension between_cylinders(const std::vector<Body>& bodies, int wall_points = 256) {
  Annulus annulus{5.0, 10.0, wall_points};
  annulus.outer_surface.angular_velocity = outer_rotation;
  Suspension suspension;
  suspension.assign(bodies.begin(), bodies.end());
  return between_walls(std::move(suspension), annulus);
}

inline Body body_at(Shape shape, Complex centre, double angle = 0.0, Complex force = 0.0) {
  return {shape, {centre, angle}, force};
}

// The suspension turned about the walls' centre, with the walls' nodes.
inline Suspension turned_about_axis(Suspension bodies, double angle) {
  const Complex turn = std::polar(1.0, angle);
  for (Body& body : bodies) {
    body.pose = {turn * body.pose.centre, body.pose.angle + angle};
    body.force *= turn;
  }
  bodies.container->angle += angle;
  return bodies;
}

// The suspension in a mirror: (x, y) becomes (x, -y), and the cylinders turn the other way.
inline Suspension mirrored(Suspension bodies) {
  for (Body& body : bodies) {
    body.pose = {std::conj(body.pose.centre), -body.pose.angle};
    body.force = std::conj(body.force);
    body.torque = -body.torque;
    body.surface.angular_velocity = -body.surface.angular_velocity;
  }
  bodies.container->angle = -bodies.container->angle;
  bodies.container->surface.angular_velocity = -bodies.container->surface.angular_velocity;
  return bodies;
}

inline StepperOptions accurate_steps(int points, double separation) {
  StepperOptions options;
  options.points_per_body = points;
  options.stokes.gmres_tolerance = 1e-11;
  options.separation = separation;
  return options;
}

// One accepted step from the given poses.
inline StepOutcome one_step(const Suspension& bodies, const StepperOptions& options, double dt = 1e-3,
                            double driving = 1.0) {
  return Stepper(bodies, options).step(dt, driving, {});
}

// Largest difference of velocities and angular velocities of the first bodies, over the largest of them.
inline double velocity_difference(const std::vector<RigidVelocity>& u, const std::vector<RigidVelocity>& v,
                                  std::size_t count) {
  double error = 0.0, scale = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    error = std::max({error, std::abs(u[i].velocity - v[i].velocity), std::abs(u[i].omega - v[i].omega)});
    scale = std::max({scale, std::abs(v[i].velocity), std::abs(v[i].omega)});
  }
  return error / scale;
}

}  // namespace stokes
