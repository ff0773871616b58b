#include "integrator.hpp"

#include <algorithm>
#include <cmath>

#include "runge_kutta.hpp"

namespace stokes {

std::vector<RigidVelocity> mean_velocity(const std::vector<Stage>& stages) {
  std::vector<RigidVelocity> mean;
  for (const Stage& stage : stages) {
    const std::vector<RigidVelocity>& w = stage.solution.velocity;
    if (mean.empty()) mean.resize(w.size(), {{-0.0, -0.0}, -0.0});  // to which anything adds to itself
    for (std::size_t i = 0; i < w.size(); ++i) {
      mean[i].velocity += stage.weight * w[i].velocity;
      mean[i].omega += stage.weight * w[i].omega;
    }
  }
  return mean;
}

std::vector<Pose> poses_of(const Suspension& bodies) {
  std::vector<Pose> poses;
  for (const Body& body : bodies) poses.push_back(body.pose);
  return poses;
}

std::vector<Pose> advanced(const Suspension& bodies, const std::vector<Pose>& poses, double dt,
                           const std::vector<RigidVelocity>& velocity) {
  std::vector<Pose> result = poses;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (!bodies[i].fixed) result[i] = advance(poses[i], velocity[i], dt);
  return result;
}

double error_norm(const Suspension& bodies, const std::vector<Pose>& one, const std::vector<Pose>& other) {
  double largest = 0.0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].fixed) continue;
    const double moved = std::abs(one[i].centre - other[i].centre) / bodies[i].shape.circumradius();
    largest = std::max(largest, std::hypot(moved, one[i].angle - other[i].angle));
  }
  return largest;
}

std::unique_ptr<Integrator> make_integrator(const StepperOptions&) { return std::make_unique<RungeKutta>(euler_tableau()); }

}  // namespace stokes
