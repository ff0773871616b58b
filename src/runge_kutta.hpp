// Explicit Runge-Kutta steps with contact at every stage. With weights a_ij and b_j, b being the row a_{s+1},
//   X_1 = x,   base_i = x + dt Sum_{j<i} a_{i+1,j} w_j,
//   (X_{i+1}, w_i) from the contact problem with the fluid at X_i, from base_i, over a_{i+1,i} dt;   x' = X_{s+1}.
// The multipliers of every stage are not negative and gap >= separation holds at every stage, which takes a_{i+1,i} > 0.
#pragma once

#include "integrator.hpp"

namespace stokes {

struct Tableau {
  std::vector<std::vector<double>> a;  // row i has the i + 1 weights that lead to stage i + 1; the last row is b
};

Tableau euler_tableau();

class RungeKutta : public Integrator {
 public:
  explicit RungeKutta(Tableau tableau) : tableau_(std::move(tableau)) {}
  Trial attempt(StepStart& start, double dt) override;

 private:
  Tableau tableau_;
};

}  // namespace stokes
