// Forward Euler steps: at each configuration the Stokes problem is solved, the bodies are moved with the
// resulting rigid velocities, and contact forces are found such that the moved bodies keep their minimum
// separation.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contact.hpp"
#include "flow.hpp"
#include "ncp.hpp"
#include "stiv.hpp"
#include "stokes_system.hpp"

namespace stokes {

enum class Coupling {
  global,  // the complete Stokes problem at every configuration
  local,   // each body's own block; the others' densities are those of the step before (the first: global),
           // and a contact force moves only the body it acts on
};

// The mobility in the matrix of the linear complementarity problems.
enum class LcpMatrix {
  full,  // the one that moves the bodies
  self,  // each body as if it were alone; every iterate is then moved with the full mobility. The same for
         // Coupling::local
};

struct StepperOptions {
  BackgroundFlow flow;
  int points_per_body = 32;
  StokesOptions stokes;
  NearSingular near_singular = NearSingular::cauchy;
  ContactModel contact = ContactModel::gap;
  double separation = 0.0;  // length
  Coupling coupling = Coupling::global;
  LcpMatrix lcp_matrix = LcpMatrix::full;
  int stiv_vertices = 0;    // of the polygons of ContactModel::stiv; 0: 4 points_per_body
  StivGradient stiv_gradient = StivGradient::full;
};

// An attempted step. Velocities and contact forces are those that move the bodies from the start of the
// step; iterations count every attempt made from the same configuration.
struct StepOutcome {
  bool accepted = false;
  std::string failure;  // empty when accepted
  double dt = 0.0;
  int gmres_iterations = 0, ncp_iterations = 0;
  std::vector<ActiveContact> contacts;
  std::vector<RigidVelocity> velocity;
  std::vector<Wrench> contact_wrench;
  double density_tail = 0.0;
};

class Stepper {
 public:
  Stepper(Suspension bodies, const StepperOptions& options);

  const Suspension& bodies() const { return bodies_; }
  int factorisations() const { return shapes_.factorisations(); }
  int shape_count() const;

  // Tries a step of size dt with the background flow multiplied by `driving`. Accepted, it moves the
  // bodies; otherwise they stay as they are, bit for bit, and another attempt reuses what was solved.
  // NumericalError when GMRES fails.
  StepOutcome attempt(double dt, double driving, const NcpOptions& ncp);

  // The largest step in which, by the contact-free velocities, no body turns by more than 0.2 and no two
  // neighbours approach by more than half of their smaller width.
  double geometric_step_limit(double driving);

 private:
  // What is known of the current configuration.
  struct Configuration {
    Configuration(const Suspension& bodies, const StepperOptions& options, ShapeCache& shapes, double driving_)
        : system(bodies, options.points_per_body, shapes, options.stokes), driving(driving_) {}

    StokesSystem system;
    double driving;
    Response contact_free;
    int gmres_iterations = 0, ncp_iterations = 0;
    std::vector<std::pair<std::vector<Wrench>, Response>> columns;  // answered mobility problems
  };
  Configuration& configuration(double driving);
  Response respond(Configuration& now, const std::vector<Wrench>& wrenches);
  NcpResult resolve(Configuration& now, double dt, const NcpOptions& ncp);
  Response respond_alone(const Configuration& now, const std::vector<Wrench>& wrenches) const;

  Suspension bodies_;
  StepperOptions options_;
  ShapeCache shapes_;
  std::optional<Configuration> now_;
  ComplexVector guess_;   // background density of the previous step, per unit of driving
  ComplexVector lagged_;  // total density of the previous step
};

}  // namespace stokes
