#include "integrator.hpp"

#include <algorithm>
#include <cmath>

#include "adams_bashforth.hpp"
#include "implicit_midpoint.hpp"
#include "runge_kutta.hpp"

namespace stokes {

std::vector<double> numbers_of(const std::vector<RigidVelocity>& velocities) {
  std::vector<double> numbers;
  for (const RigidVelocity& u : velocities) numbers.insert(numbers.end(), {u.velocity.real(), u.velocity.imag(), u.omega});
  return numbers;
}

std::vector<RigidVelocity> velocities_of(const std::vector<double>& numbers) {
  std::vector<RigidVelocity> velocities;
  for (std::size_t k = 0; k + 2 < numbers.size(); k += 3)
    velocities.push_back({{numbers[k], numbers[k + 1]}, numbers[k + 2]});
  return velocities;
}

std::vector<RigidVelocity> mean_velocity(const std::vector<Stage>& stages) {
  std::vector<RigidVelocity> mean;
  for (const Stage& stage : stages) {
    const std::vector<RigidVelocity>& w = stage.solution.velocity;
    if (mean.empty()) mean.resize(w.size(), {{-0.0, -0.0}, -0.0});  // adding -0 changes no number
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

std::vector<Pose> advanced(const std::vector<Pose>& poses, double dt, const std::vector<RigidVelocity>& velocity) {
  std::vector<Pose> result = poses;
  for (std::size_t i = 0; i < poses.size(); ++i) result[i] = advance(poses[i], velocity[i], dt);
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

std::unique_ptr<Integrator> make_integrator(const StepperOptions& options) {
  switch (options.integrator) {
    case IntegratorKind::euler: break;
    case IntegratorKind::ab2: return std::make_unique<AdamsBashforth>();
    case IntegratorKind::rk3: return std::make_unique<RungeKutta>(rk3_tableau(), options.tolerance > 0.0);
    case IntegratorKind::midpoint: return std::make_unique<ImplicitMidpoint>(options);
  }
  return std::make_unique<RungeKutta>(euler_tableau());
}

}  // namespace stokes
