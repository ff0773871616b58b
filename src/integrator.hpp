// Time integrators. Each makes a step from configurations of the fluid and contact problems, which it gets from a
// StepStart; nothing moves until the step is accepted. An integrator with a memory of earlier steps owns it.
//
// To add one, write an enumerator, its class in a file of its own, a line in make_integrator() (integrator.cpp) and a word
// in case_keys.cpp.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contact_problem.hpp"

namespace stokes {

// A configuration that takes part in a step, with its contact problem.
struct Stage {
  double weight;  // of its velocities, multipliers and wrenches in the means over the step
  std::shared_ptr<Configuration> at;
  ContactSolution solution;
};

// An attempted step.
struct Trial {
  std::string failure;                  // empty if the step was solved
  std::vector<Stage> stages;            // in the order of time
  std::vector<RigidVelocity> velocity;  // mean over the step: end = start + dt velocity
  std::vector<Pose> poses;              // at the end
  std::optional<double> error;          // estimated local error, with a tolerance (error_norm)
};

// Where a step starts, and the means to make it.
class StepStart {
 public:
  virtual ~StepStart() = default;

  virtual const Suspension& bodies() const = 0;
  virtual std::shared_ptr<Configuration> configuration() = 0;
  // The bodies at poses reached a time `elapsed` after the start, with the walls turned accordingly. Solves for the fluid
  // there; NumericalError where bodies overlap.
  virtual std::shared_ptr<Configuration> configuration(const std::vector<Pose>& poses, double elapsed) = 0;
  // The path (FluidMemory) that the step has reached after this time.
  virtual double path_after(double elapsed) const = 0;
  // True if the step continues the one before: it is driven in the same way, and that step did not restore the separation.
  virtual bool continues() const = 0;
  // Smallest distance of the bodies at other poses, in separations.
  virtual double relative_gap(const std::vector<Pose>& poses) const = 0;
  // The contact problem of this step (contact_problem.hpp).
  virtual ContactSolution solve(Configuration& at, const std::vector<Pose>& base, double length) = 0;
  // The velocities caused by forces between pairs of bodies along the normals at the configuration.
  virtual std::vector<RigidVelocity> contact_velocity(Configuration& at, const std::vector<ActiveContact>& contacts) = 0;
};

class Integrator {
 public:
  virtual ~Integrator() = default;

  // The trial reports a contact problem that was not solved. NumericalError when GMRES fails at the start.
  virtual Trial attempt(StepStart& start, double dt) = 0;
  // Remembers what the next step uses, if it continues() this one.
  virtual void accept(const Trial&, double /*dt*/) {}

  virtual void save(StateWriter&) const {}
  virtual void restore(StateReader&) {}
};

std::unique_ptr<Integrator> make_integrator(const StepperOptions& options);

// For save() and restore(): three numbers a body.
std::vector<double> numbers_of(const std::vector<RigidVelocity>& velocities);
std::vector<RigidVelocity> velocities_of(const std::vector<double>& numbers);

// Sum of the stages' velocities with their weights.
std::vector<RigidVelocity> mean_velocity(const std::vector<Stage>& stages);

std::vector<Pose> poses_of(const Suspension& bodies);
// poses + dt velocity.
std::vector<Pose> advanced(const std::vector<Pose>& poses, double dt, const std::vector<RigidVelocity>& velocity);

// max_i sqrt(|dc_i|^2 / a_i^2 + dtheta_i^2) of the difference of two sets of poses, a_i the largest semi-axis; mobile
// bodies only.
double error_norm(const Suspension& bodies, const std::vector<Pose>& one, const std::vector<Pose>& other);

}  // namespace stokes
