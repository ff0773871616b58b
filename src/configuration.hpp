// The fluid at given poses: nodes, equations, the contact-free solution, and responses to forces. It knows nothing of time
// steps.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "fluid_memory.hpp"
#include "resolution.hpp"
#include "shortfall.hpp"
#include "step_options.hpp"

namespace stokes {

// Velocities with the density that belongs to them.
struct Response {
  std::vector<RigidVelocity> velocity;  // for a fixed body that of its surface, 0 in the response to a contact
  ComplexVector density;
};

// Work of all attempts since the latest accepted step.
struct Effort {
  int gmres_iterations = 0, ncp_iterations = 0;
  int stokes_solves = 0;  // with any forces
};

// What all configurations of a run share.
struct Fluid {
  explicit Fluid(const StepperOptions& step_options) : options(step_options), shapes(step_options.near_singular) {}

  StepperOptions options;
  ShapeCache shapes;
  ShapeResolution alone;
  Effort effort{};
};

// Nodes of the bodies and the container if no accuracy is given.
std::vector<Discretisation> given_nodes(const Suspension& bodies, const StepperOptions& options);

class Configuration {
 public:
  // Solves the contact-free problem, starting from the densities of the memory. Everything that drives the fluid is
  // multiplied by `driving`. `path`: the position of these poses along the way of the run (FluidMemory). NumericalError
  // when GMRES fails.
  Configuration(Suspension bodies, double path, double driving, Fluid& fluid, const FluidMemory& memory);

  const Suspension& bodies() const { return bodies_; }
  double path() const { return path_; }
  double driving() const { return driving_; }
  const std::vector<Discretisation>& nodes() const { return nodes_; }
  const StokesSystem& system() const { return *system_; }
  const Response& contact_free() const { return contact_free_; }
  int background_iterations() const { return background_iterations_; }
  double data_norm() const { return data_norm_; }  // of the contact-free problem

  // With an accuracy: the resolution that the boundaries needed, the estimated error of the velocities, and the number of
  // boundaries that miss the accuracy. With fixed nodes: what these do not resolve.
  const std::vector<Resolution>& resolution() const { return resolution_; }
  double estimated_error() const { return estimated_error_; }
  int unresolved() const { return unresolved_; }
  const std::vector<Shortfall>& shortfalls() const { return shortfalls_; }

  // The response of the suspension to wrenches, one per body. The solve starts from the density `guess`. A repeated call
  // returns the stored response. The tolerance is relative to the data or to `scale`, if given.
  const Response& respond(const std::vector<Wrench>& wrenches, const ComplexVector& guess, double scale = 0.0);
  // The response of the bodies around the wrenches, as if there were no others.
  Response respond_nearby(const std::vector<Wrench>& wrenches) const;
  // The response of each body as if it were alone. Its density is zero, since the completion flow is a rigid motion there.
  Response respond_alone(const std::vector<Wrench>& wrenches) const;

  // Every full response so far, the latest last.
  const std::vector<std::pair<std::vector<Wrench>, Response>>& answers() const { return answers_; }

  Effort& effort() { return fluid_.effort; }

 private:
  StokesSolution solve_contact_free(const FluidMemory& memory);

  Suspension bodies_;
  double path_, driving_;
  Fluid& fluid_;
  std::vector<Discretisation> nodes_;  // of the bodies and the container
  std::unique_ptr<StokesSystem> system_;
  Response contact_free_;
  int background_iterations_ = 0;
  double data_norm_ = 0.0;
  std::vector<Resolution> resolution_;
  double estimated_error_ = 0.0;
  int unresolved_ = 0;
  std::vector<Shortfall> shortfalls_;
  std::vector<std::pair<std::vector<Wrench>, Response>> answers_;
};

}  // namespace stokes
