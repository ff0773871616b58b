// How the bodies respond to contact forces in the course of the iterations of ncp.hpp: the motion for given multipliers,
// and the rates at which unit multipliers change the values of the constraints, which are the matrix of the LCPs.
// One class, in a file of its own, for each way:
//   superposed  columns M f of the fluid itself, one solve for each contact; motions are sums of columns;
//   solved      columns M' f of an approximation M'; each motion is solved for with M;
//   learned     the same, with a matrix that learns from these solutions and passes from step to step.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "configuration.hpp"
#include "contact.hpp"
#include "known_contacts.hpp"
#include "suspension.hpp"

namespace stokes {

// A contact in the course of the iterations.
struct Candidate {
  ContactConstraint constraint;  // at the present poses
  GapGradient force;             // what a unit multiplier exerts
  Response column{};             // the response to that; empty until it is needed
  double multiplier = 0.0;       // unknown of the LCP
  double committed = 0.0;        // part of the force that is no longer unknown

  double total() const { return multiplier + committed; }
};
using Candidates = std::vector<Candidate>;  // sorted by pair and region

inline KnownContacts::Contact identity(const ContactConstraint& c) { return {c.a, c.b, c.region}; }

// The time step whose contacts are sought.
struct ContactStep {
  const Suspension& start;
  const Response& contact_free;
  double dt;

  // Rate of change of the value of c.
  double rate(const ContactConstraint& c, const GapGradient& gradient, const std::vector<RigidVelocity>& velocity) const;
};

// The response of the suspension to given forces and torques, zero for fixed bodies.
using MobilityFunction = std::function<Response(const std::vector<Wrench>&)>;

// The same, by a solve that starts from the density `guess`.
using ResponseFunction = std::function<Response(const std::vector<Wrench>&, const ComplexVector& guess)>;

class ContactResponse {
 public:
  ContactResponse(const ContactStep& step, MobilityFunction column);
  virtual ~ContactResponse() = default;

  // The columns are those of the fluid itself: symmetric and positive up to errors of discretisation.
  virtual bool exact() const = 0;

  // Contacts that take part from the start, sorted.
  virtual std::vector<KnownContacts::Contact> expected() const { return {}; }

  // The motion for the present multipliers. `wrenches`: their sum, on the fluid; `balanced`: it was changed, so that it is
  // no longer a sum of multiples of the candidates' forces.
  virtual Response motion(const Candidates& candidates, const std::vector<Wrench>& wrenches, bool balanced) = 0;

  // Takes note of the constraints at the poses where that motion led.
  virtual void observe(const Candidates&) {}

  // Begins an LCP: the values as they would be without the present multipliers. Makes the columns that are missing.
  virtual Vector values_without_forces(Candidates& candidates);

  // After values_without_forces, (l, k): rate of value l by a unit multiplier of k, with the gradients at the present
  // poses, or with those along the forces, between which the mobilities of a fluid are symmetric.
  virtual Matrix rates(const Candidates& candidates) const;
  virtual Matrix rates_along_forces(const Candidates& candidates) const;

  // The forces of this motion stay; from now on multipliers are what is added to them.
  virtual void commit(const Response&) {}

  // What the next step may begin with.
  virtual KnownContacts known(const Candidates&) { return {}; }

 protected:
  void find_column(Candidate& c) const;

  const ContactStep step_;
  const std::vector<int> fixed_;
  const MobilityFunction column_;
};

using ContactResponseFactory = std::function<std::unique_ptr<ContactResponse>(const ContactStep&)>;

ContactResponseFactory superposed(MobilityFunction column);
ContactResponseFactory solved(MobilityFunction column, ResponseFunction response);

// Begins with `known`. `answers`: the densities that belong to the columns of known.multipliers.
ContactResponseFactory learned(MobilityFunction column, ResponseFunction response, KnownContacts known,
                               std::vector<ComplexVector> answers);

// a + factor b. Velocities: nothing for the bodies that b does not have; responses: a has those of all bodies.
void add(std::vector<RigidVelocity>& a, double factor, const std::vector<RigidVelocity>& b);
void add(Response& a, double factor, const Response& b);

}  // namespace stokes
