// Explicit Runge-Kutta steps with contact at every stage. With weights a_ij and b_j, b being the row a_{s+1},
//   X_1 = x,   base_i = x + dt Sum_{j<i} a_{i+1,j} w_j,
//   (X_{i+1}, w_i) from the contact problem with the fluid at X_i, from base_i, over a_{i+1,i} dt;   x' = X_{s+1}.
// Multipliers >= 0 and gap >= separation hold at every stage, which requires a_{i+1,i} > 0.
#pragma once

#include "integrator.hpp"

namespace stokes {

struct Tableau {
  std::vector<std::vector<double>> a;  // row i has the i + 1 weights that lead to stage i + 1; the last row is b
};

Tableau euler_tableau();
// Third order, by Ralston; the first three stages of the pair of Bogacki and Shampine. c = 0, 1/2, 3/4.
Tableau rk3_tableau();

class RungeKutta : public Integrator {
 public:
  // With an estimate, the error is the distance (error_norm) from the explicit midpoint step. That step has a contact
  // problem of its own with the fluid at the second stage, over the whole step. Both ends keep the separation, so that the
  // jump of the velocity at the onset of a contact is in both and cancels.
  explicit RungeKutta(Tableau tableau, bool estimates = false) : tableau_(std::move(tableau)), estimates_(estimates) {}
  Trial attempt(StepStart& start, double dt) override;

 private:
  void make_stages(StepStart& start, double dt, Trial& trial) const;
  void estimate(StepStart& start, double dt, Trial& trial) const;

  Tableau tableau_;
  bool estimates_;
};

}  // namespace stokes
