// The contact problem of a step or of a stage of one. Given the fluid at a configuration X, with contact-free velocities
// v(X), mobility M(X) and the gradients G(X) of the gaps, base poses b and a length h > 0,
//   y = b + h w,   w = v(X) + M(X) G(X)^T lambda,   0 <= gap(y) - separation  perp  lambda >= 0.
// Forward Euler has X = b = x, the poses at the start of the step, and h = dt. The forces of a contact are opposite,
// collinear and free of torque at X, where the fluid is solved. Pairs that pass through each other on the way from x to y
// are found, too.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "contact_matrix.hpp"

namespace stokes {

struct ContactSolution {
  bool solved = false;
  std::string failure;                  // empty when solved
  std::vector<Pose> poses;              // y
  std::vector<RigidVelocity> velocity;  // w; of a fixed body that of its surface
  ComplexVector density;                // that belongs to it
  std::vector<ActiveContact> contacts;  // with a positive multiplier
  std::vector<Wrench> wrenches;         // contact force and torque on each body, fixed or not
  Wrench container_wrench;              // and on the container, about its centre
};

class ContactProblem {
 public:
  explicit ContactProblem(const StepperOptions& options);

  // From the bodies at the start of the step. NumericalError when GMRES fails.
  ContactSolution solve(const Suspension& start, Configuration& at, const std::vector<Pose>& base, double length,
                        const NcpOptions& ncp);

  // The response of the fluid to forces between the same bodies as `contacts`, of the same multipliers, along the normals
  // at this configuration.
  Response respond(Configuration& at, const std::vector<ActiveContact>& contacts);

  ContactMatrix& matrix() { return *matrix_; }
  const ContactMatrix& matrix() const { return *matrix_; }

 private:
  StepperOptions options_;
  std::unique_ptr<ContactMatrix> matrix_;
};

}  // namespace stokes
