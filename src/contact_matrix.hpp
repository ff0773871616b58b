// The mobility M' in the matrix of the linear complementarity problems (ncp.hpp): how it is made, and what it keeps from
// one step to the next. One class for each LcpMatrix, and one for Coupling::local.
//
// Whatever the matrix, accepted poses satisfy the same contact conditions; it changes how many Stokes problems are solved
// on the way to them.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "configuration.hpp"
#include "ncp.hpp"

namespace stokes {

// Solves the contact problem of a step with given responses.
using ContactSolver = std::function<NcpResult(const ContactResponseFactory&, const NcpOptions&)>;

class ContactMatrix {
 public:
  virtual ~ContactMatrix() = default;

  // Solves the contact problem whose forces act on the fluid at this configuration.
  virtual NcpResult resolve(Configuration& at, const ContactSolver& solve, const NcpOptions& options) = 0;

  // The response to forces whose unit wrenches and multipliers are given, of full accuracy.
  virtual Response respond(Configuration& at, const std::vector<std::vector<Wrench>>& units,
                           const std::vector<double>& multipliers) = 0;

  // What was learnt since the latest accepted step is kept, or forgotten. `at`: the configurations of the accepted step.
  virtual void accept(const std::vector<const Configuration*>& at) = 0;
  virtual void reject() = 0;

  virtual void save(StateWriter& writer) const = 0;
  virtual void restore(StateReader& reader) = 0;
};

std::unique_ptr<ContactMatrix> make_contact_matrix(const StepperOptions& options);

}  // namespace stokes
