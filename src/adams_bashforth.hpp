// Second-order Adams-Bashforth steps with contact, of variable length, at the cost of forward Euler. With
// r = dt / dt_before and c = M G^T lambda_before at x minus the same at the start of the step before,
//   x' from the contact problem with the fluid at x, from x + dt (r/2) (v - v_before + c), over dt.
// The first of the two terms of c comes from the fluid at x: the forces of the step before, along the present normals. The
// multiplier is therefore that of the middle of the step, and right from the first full step in contact on.
// A step that does not continue the one before has r = 0, which is forward Euler.
#pragma once

#include "integrator.hpp"

namespace stokes {

class AdamsBashforth : public Integrator {
 public:
  Trial attempt(StepStart& start, double dt) override;
  void accept(const Trial& trial, double dt) override;

  void save(StateWriter& writer) const override;
  void restore(StateReader& reader) override;

 private:
  // Quantities of the latest accepted step, at its start.
  struct Before {
    double dt = 0.0;                              // 0: none
    std::vector<RigidVelocity> free, by_contact;  // v and M G^T lambda
    std::vector<ActiveContact> contacts;          // bodies and multipliers; the other members are not used
  };
  Before before_;
};

}  // namespace stokes
