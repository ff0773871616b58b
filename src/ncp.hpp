// The contact problem of one time step: with contact-free velocities u0, mobility M and start poses q,
//   q' = q + dt (u0 + M Sum_l lambda_l f_l),   0 <= value_l(q')  perp  lambda_l >= 0,
// solved as a sequence of linear complementarity problems for the TOTAL multipliers:
//   0 <= value_l - r_l + Sum_k B_lk lambda_k  perp  lambda_l >= 0,  B_lk = dt grad_l . M' f_k,
// where M' is M or an approximation of it and r_l = dt grad_l . M' (present contact forces): contact_response.hpp.
//
// Fixed bodies have no mobility: they move as contact_free says, and the forces on them and on the container do
// nothing to the fluid. They are reactions, only reported. Between obstacles a body may be jammed: then no forces
// solve the problem, which is a failure like others.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "contact_response.hpp"

namespace stokes {

struct ActiveContact {
  ContactConstraint constraint;  // value and gradient at the accepted poses
  double multiplier;             // > 0, a force
};

// Changes the contact wrenches of all bodies, given the pairs in contact and the fixed bodies (balance_clusters).
using BalanceFunction =
    std::function<void(const std::vector<std::pair<int, int>>&, std::vector<Wrench>&, const std::vector<int>&)>;

struct NcpOptions {
  int max_iterations = 50;
  bool demand_progress = false;  // give up when the worst violation is not halved in two iterations
  // From this iteration on keep the forces found and solve for non-negative additions to them: ends the cycles
  // of a value that jumps. For constraints that count as met once they are open (stiv).
  int increments_after = std::numeric_limits<int>::max();
  bool check_mobility = false;  // exact columns for symmetry: the forces are to be gradients at the start of the step
};

// Violated and tracked constraints at trial poses (GapCollector::collect).
using ConstraintFunction =
    std::function<std::vector<ContactConstraint>(const std::vector<Pose>&, const std::vector<std::pair<int, int>>&)>;

struct NcpResult {
  bool solved = false;
  std::string failure;                 // empty when solved
  bool unresolved = false;             // failed for mobilities that are not those of a fluid: too few nodes
  int iterations = 0;                  // LCPs solved
  std::vector<ActiveContact> contacts; // those with a positive multiplier
  std::vector<Pose> poses;             // at the end of the step
  Response motion;                     // what moves the bodies there
  std::vector<Wrench> wrenches;        // contact force and torque on each body, fixed or not
  Wrench container_wrench;             // and on the container, about its centre
  KnownContacts known;                 // of a learned response; the newest multipliers are those of the motion
};

// Accepted are poses at which no constraint is violated by more than its tolerance and every contact with
// a positive multiplier is met to its tolerance; a contact that is no longer found counts as open and met.
// `balance`, if any, is applied to the wrenches of every iterate, at the cost of a solve where it changes
// them by more than round-off. Failure is reported, with what was reached, not thrown; an Interruption when a signal asks
// for it is.
NcpResult resolve_contacts(const Suspension& start, const Response& contact_free, double dt,
                           const ConstraintFunction& constraints, const ContactResponseFactory& response,
                           const NcpOptions& options, const BalanceFunction& balance = {});

}  // namespace stokes
