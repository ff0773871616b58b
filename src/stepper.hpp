// A suspension that moves in time steps. An integrator (integrator.hpp) attempts a step without moving the bodies.
// Accepting the step moves them to its end.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "integrator.hpp"

namespace stokes {

// An attempted step. Velocities, multipliers, wrenches and stresslets are means over the step: those of its stages with
// the weights of the integrator, for forward Euler those at its start. Iterations count every attempt since the latest
// accepted step.
struct StepOutcome {
  bool accepted = false;
  std::string failure;  // empty when accepted
  double dt = 0.0, driving = 1.0;
  std::optional<double> error;    // estimated local error, with a tolerance (error_norm)
  int rejected_by_error = 0, rejected_by_failure = 0;  // attempts at this step before it
  bool restoring = false;         // bodies start closer than the separation: the step moves them apart, whatever its error
  int gmres_iterations = 0, ncp_iterations = 0;
  int background_iterations = 0;  // of GMRES, those of the contact-free solve at the start
  int stokes_solves = 0;          // with any forces
  std::vector<ActiveContact> contacts;
  std::vector<RigidVelocity> velocity;
  std::vector<Wrench> contact_wrench;  // on every body
  Wrench container_contact;            // on the container, about its centre
  std::vector<Wrench> reaction;        // of fixed bodies on the fluid
  Wrench container;                    // of the container on the fluid, about its centre
  std::vector<Complex> stresslets;     // of the bodies, S_11 + i S_12 about their centres
  double density_tail = 0.0;           // the largest of the stages
  double estimated_error = 0.0;        // of the velocities, with an accuracy; the largest of the stages
  int nodes = 0, clusters = 0;         // of all boundaries, at the start
  int most_nodes = 0;                  // of a boundary
  int unresolved = 0;                  // boundaries; of fixed nodes, the shortfalls
  std::vector<Shortfall> shortfalls;   // of fixed nodes
  // The fluid at the start of the step, and the density of everything that drives it there; none if no stage is there.
  std::shared_ptr<const Configuration> at_start;
  ComplexVector density;
};

class Stepper {
 public:
  Stepper(Suspension bodies, const StepperOptions& options);
  ~Stepper();

  const Suspension& bodies() const;
  int factorisations() const;
  int shape_count() const;

  // Attempts a step of size dt with everything that drives the fluid multiplied by `driving`. Nothing moves. Another
  // attempt from the same poses reuses what was solved there; its result does not depend on earlier attempts. The step
  // fails if a contact force does not part its bodies or mobilities are not symmetric, because the nodes are then too
  // sparse for the gap. NumericalError when GMRES fails.
  StepOutcome attempt(double dt, double driving, const NcpOptions& ncp);

  // Moves the bodies to the end of the latest attempt, which has not failed.
  void accept();

  // Attempts and accepts a step. After a failure the bodies stay where they are.
  StepOutcome step(double dt, double driving, const NcpOptions& ncp);

  // The largest step in which, by the contact-free velocities, no body turns by more than 0.2, no two neighbours
  // approach by more than half of their smaller width, and no body beside the container moves by more than half of
  // its own.
  double geometric_step_limit(double driving);

  // The state after the latest accepted step: the poses and every memory. A stepper of the same bodies and options that is
  // restored from it makes the same steps to the last bit.
  void save(StateWriter& writer) const;
  void restore(StateReader& reader);

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace stokes
