// Rheology of a suspension: alignment, effective viscosity, bulk stress.
//
// Between two cylinders everything refers to the bodies that move, in polar coordinates (r, theta) about the walls' common
// centre.
#pragma once

#include "stepper.hpp"

namespace stokes {

// Flow between concentric cylinders that rotate, without bodies: u_theta = A r + B / r.
struct CouetteFlow {
  double inner_radius, outer_radius;
  double inner_angular_velocity, outer_angular_velocity;

  double A() const;
  double B() const;
  double velocity(double r) const { return A() * r + B() / r; }
  double shear_rate(double r) const { return -2.0 * B() / (r * r); }  // r d(u_theta / r) / dr
  double inner_torque() const { return 4.0 * pi * B(); }              // of the inner cylinder on the fluid
};

// For a suspension made by between_walls(), whose last body is the inner wall.
CouetteFlow couette_flow(const Suspension& bodies);

// Mean of cos 2 (theta_j - phi_j - pi/2), phi_j the polar angle of the centre: 1 when all long axes lie along the
// circles around the walls' centre, -1 when all are radial, 0 for random directions. NaN without free bodies.
double order_parameter(const Suspension& bodies);

// Effective viscosity over the fluid's: the torque of the inner cylinder with the bodies over that without bodies.
// NaN if the cylinders rotate together.
double effective_viscosity(const Suspension& bodies, const StepOutcome& outcome);
// The same from the outer cylinder, whose torque is opposite to the inner one's if the bodies bear no torque.
double effective_viscosity_outer(const Suspension& bodies, const StepOutcome& outcome);

// The bodies' contribution to the mean stress in the annulus, per area between the walls.
struct BodyStress {
  double shear = 0.0;              // sigma_r_theta
  double normal_difference = 0.0;  // sigma_theta_theta - sigma_rr: along the flow less along its gradient
};

struct ParticleStress {
  BodyStress stresslets;  // of the bodies about their centres
  BodyStress contacts;    // sym(F (x) d): F on the first body of a contact, d from its centre to the second's, or to
                          // the place of contact on a wall
};
ParticleStress particle_stress(const Suspension& bodies, const StepOutcome& outcome);

// The same in unbounded fluid, as sums, not per area, in the laboratory frame: the parts without trace as T_11 + i T_12.
// External forces are not included.
struct StressSum {
  Complex stresslets;  // of the bodies about their centres
  Complex contacts;    // sym(F (x) d) as above

  Complex total() const { return stresslets + contacts; }
};
StressSum stress_sum(const Suspension& bodies, const StepOutcome& outcome);

// The part of the unbounded fluid that the bodies represent. Its stress without trace is
//   Sigma = 2 E + (sum of stresslets and contacts) / area,  E the background's rate of strain,
// and its viscosity Sigma:E / 2 E:E, NaN where E = 0. That is 1 + 2 phi for discs far apart, the area fraction being phi.
struct Sample {
  double area = 0.0;  // 0: none
  Complex strain_rate{0.0, 0.0};  // E_11 + i E_12 where the driving is 1

  Complex stress(const StressSum& sum, double driving) const { return 2.0 * driving * strain_rate + sum.total() / area; }
  double viscosity(const StressSum& sum, double driving) const;
};

}  // namespace stokes
