// Flow of stresslets, Stokeslets and rotlets by direct summation: O(targets x sources), the oracle for the
// fast multipole method.
#pragma once

#include "base.hpp"
#include "direct_sum.hpp"

namespace stokes {

// Strengths of N point sources. A kind whose arrays are absent or empty is left out.
//   stresslets (nodes of a double layer): w_j n_j and eta_j, both or neither,
//     u = (1/pi) Sum_j (r.n_j)(r.eta_j) r/rho^4 w_j,
//     p = (1/pi) Sum_j [2 (r.n_j)(r.eta_j)/rho^4 - n_j.eta_j/rho^2] w_j
//   Stokeslets: u = (1/4 pi) Sum_j [-log(rho) F_j + (r.F_j) r/rho^2],   p = (1/2 pi) Sum_j F_j.r/rho^2
//   rotlets:    u = (1/4 pi) Sum_j L_j perp(r)/rho^2,                     p = 0
// with r = target - source_j, rho = |r|. Sources that coincide with a target are left out.
struct SourceStrengths {
  const PointArray* weighted_normal = nullptr;
  const ComplexVector* density = nullptr;
  const ComplexVector* force = nullptr;
  const Vector* torque = nullptr;
};

// gradient: velocity, pressure and velocity gradient.
enum class FlowOutput { velocity, gradient };

// One entry per target; empty where not asked for. velocity_x and velocity_y are the derivatives
// d(u_1 + i u_2)/dx and d(u_1 + i u_2)/dy.
struct FlowFields {
  ComplexVector velocity;
  Vector pressure;
  ComplexVector velocity_x, velocity_y;

  void resize(int count, FlowOutput output);
};

// Raises InputError unless every array of strengths has `source_count` entries (or none) and stresslets
// have both of theirs.
void check_strength_sizes(const SourceStrengths& strengths, int source_count);
// Raises NumericalError for a strength that is not finite.
void check_strengths_finite(const SourceStrengths& strengths);

// The sums above at all targets. Vectorised over targets and threaded; the result does not depend on the
// number of threads. Distances between points must lie between 1e-37 and 1e37, or be zero. Raises the errors
// of the two checks above.
void direct_fields(const PointArray& targets, const PointArray& sources, const SourceStrengths& strengths,
                   FlowOutput output, FlowFields& fields);

}  // namespace stokes
