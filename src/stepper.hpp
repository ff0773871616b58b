// Forward Euler steps: at each configuration the Stokes problem is solved, the bodies are moved with the
// resulting rigid velocities, and contact forces are found such that the moved bodies keep their minimum
// separation.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contact.hpp"
#include "flow.hpp"
#include "ncp.hpp"
#include "resolution.hpp"
#include "shortfall.hpp"
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
  full,  // the one that moves the bodies: a Stokes solve for each contact
  near,  // at first the bodies around each contact as if there were no others. Every iterate is moved with the full
         // mobility, one Stokes solve each, from which the matrix learns, in this step and for the next ones. Where
         // that does not converge, as full
  self,  // each body as if it were alone; every iterate is then moved with the full mobility. The same for
         // Coupling::local
};

struct StepperOptions {
  BackgroundFlow flow;
  // Of the bodies' velocities, in units of the rate and size of what drives them. Nodes, clusters and tolerances are then
  // chosen at every configuration, and points_per_body, refine, Container::points, Body::points and
  // stokes.gmres_tolerance are not read. 0: these are.
  double accuracy = 0.0;
  int points_per_body = 32;
  Refine refine = Refine::none;
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
  double dt = 0.0, driving = 1.0;
  int gmres_iterations = 0, ncp_iterations = 0;
  int background_iterations = 0;  // of GMRES, those of the latest contact-free solve
  int stokes_solves = 0;          // with any forces
  std::vector<ActiveContact> contacts;
  std::vector<RigidVelocity> velocity;
  std::vector<Wrench> contact_wrench;  // on every body
  Wrench container_contact;            // on the container, about its centre
  std::vector<Wrench> reaction;        // of fixed bodies on the fluid
  Wrench container;                    // of the container on the fluid, about its centre
  std::vector<Complex> stresslets;     // of the bodies, S_11 + i S_12 about their centres
  double density_tail = 0.0;
  double estimated_error = 0.0;  // of the velocities, with an accuracy
  int nodes = 0, clusters = 0;   // of all boundaries
  int most_nodes = 0;            // of a boundary
  int unresolved = 0;            // boundaries; of fixed nodes, the shortfalls
  std::vector<Shortfall> shortfalls;  // of fixed nodes
  std::shared_ptr<const StokesSystem> system;  // of an accepted step
  ComplexVector density;                       // of all that drives the fluid in it
};

// The nodes of the bodies and the container without an accuracy.
std::vector<Discretisation> given_nodes(const Suspension& bodies, const StepperOptions& options);

// What a step leaves to later ones beside the bodies: densities, in the body frames, from which the next solve
// starts or, locally coupled, which it takes for the present ones.
struct StepperMemory {
  struct Density {
    double path = 0.0;                  // where on the way through configurations: sum of driving times dt
    std::vector<Discretisation> nodes;  // one per boundary
    ComplexVector value;
  };
  double path = 0.0;
  std::vector<Density> background;  // of the latest steps per unit of driving, the newest last
  Density total;                    // of the latest step, contact forces included
  KnownContacts known;              // of the latest step, with LcpMatrix::near
  std::vector<Density> answers;     // those of known.multipliers, of contact forces alone
  // Answers to unit forces between the bodies that were in contact in the latest step, newest last.
  std::map<std::pair<int, int>, std::vector<Density>> contacts;
  std::vector<Resolution> resolution;  // of the boundaries, with an accuracy
};

class Stepper {
 public:
  Stepper(Suspension bodies, const StepperOptions& options);

  const Suspension& bodies() const { return bodies_; }
  const StepperMemory& memory() const { return memory_; }
  int factorisations() const { return shapes_.factorisations(); }
  int shape_count() const;

  // Takes over where another stepper of the same bodies and options was.
  void restore(const std::vector<Pose>& poses, StepperMemory memory);

  // Tries a step of size dt with everything that drives the fluid multiplied by `driving`. Accepted, it moves the
  // bodies; otherwise they stay as they are, bit for bit, and another attempt reuses what was solved.
  // A contact force that does not part its bodies, or mobilities that are not symmetric, mean nodes too sparse for
  // the gap: the step fails. NumericalError when GMRES fails.
  StepOutcome attempt(double dt, double driving, const NcpOptions& ncp);

  // The largest step in which, by the contact-free velocities, no body turns by more than 0.2, no two neighbours
  // approach by more than half of their smaller width, and no body beside the container moves by more than half of
  // its own.
  double geometric_step_limit(double driving);

 private:
  // What is known of the current configuration.
  struct Configuration {
    double driving = 1.0;
    std::vector<Discretisation> nodes;  // of the bodies and the container
    std::unique_ptr<StokesSystem> system;
    Response contact_free;
    std::vector<Resolution> resolution;
    double estimated_error = 0.0;
    int unresolved = 0;
    std::vector<Shortfall> shortfalls;
    double data_norm = 0.0;  // of its right-hand side
    int gmres_iterations = 0, background_iterations = 0, ncp_iterations = 0, stokes_solves = 0;
    std::vector<std::pair<std::vector<Wrench>, Response>> answers;  // to forces and torques
  };
  Configuration& configuration(double driving);
  BackgroundFlow driven(double driving) const;
  StokesSolution solve_contact_free(Configuration& now, const std::vector<Wrench>& external);
  ComplexVector extrapolated(const std::vector<StepperMemory::Density>& history, const std::vector<Discretisation>& nodes) const;
  Response respond(Configuration& now, const std::vector<Wrench>& wrenches, const ComplexVector& guess,
                   double scale = 0.0);
  Response respond_to_contact(Configuration& now, const std::vector<Wrench>& wrenches);
  Response respond_nearby(const Configuration& now, const std::vector<Wrench>& wrenches) const;
  Response respond_alone(const Configuration& now, const std::vector<Wrench>& wrenches) const;
  enum class Learnt { used, not_used };  // what other configurations have taught the matrix of LcpMatrix::near
  ContactMobility contact_mobility(Configuration& now, LcpMatrix matrix, Learnt learnt);
  NcpResult resolve(Configuration& now, double dt, const NcpOptions& ncp, LcpMatrix matrix, Learnt learnt = Learnt::used);
  NcpResult resolve_nearby(double dt, double driving, const NcpOptions& ncp);
  void remember(Configuration& now, ComplexVector total, KnownContacts known);
  void turn_walls(double way);
  void accept(Configuration& now, double dt, NcpResult& result, StepOutcome& outcome);

  Suspension bodies_;
  StepperOptions options_;
  ShapeCache shapes_;
  ShapeResolution alone_;
  std::optional<Configuration> now_;
  StepperMemory memory_;
};

}  // namespace stokes
