// Implicit midpoint steps with contact, symmetric in time. Without contact a reversed flow brings the bodies back to the
// start, up to the tolerance of the iteration. With X = (x + x') / 2,
//   x' from the contact problem with the fluid at X, from x, over dt,
// iterated from X = x + (dt/2) w, with w extrapolated from the middles of the latest two steps. The ends keep the
// separation. At X the gap may be smaller by the sagitta of bodies that slide past each other, down to half the separation.
#pragma once

#include "integrator.hpp"

namespace stokes {

class ImplicitMidpoint : public Integrator {
 public:
  explicit ImplicitMidpoint(const StepperOptions& options);
  Trial attempt(StepStart& start, double dt) override;
  void accept(const Trial& trial, double dt) override;

  void save(StateWriter& writer) const override;
  void restore(StateReader& reader) override;

 private:
  void iterate(StepStart& start, double dt, Trial& trial) const;

  struct Middle {
    double path, driving;  // of the middle of an accepted step
    std::vector<RigidVelocity> velocity;
  };
  std::vector<RigidVelocity> expected_velocity(StepStart& start, double dt) const;

  double gmres_tolerance_;
  std::vector<Middle> latest_;  // at most two, of one driving, the newest last
};

}  // namespace stokes
