// Close evaluation of the double layer of a circle with nodes at equal steps, in closed form.
//
// With w = zeta/R and eta = Sum_m c_m w^m the Cauchy integrals of cauchy.hpp keep the modes that are analytic where
// the fluid is: with q = z/R, inside
//   C[eta] + conj(C[conj(eta)])     = Sum_{m>=0} c_m q^m + Sum_{m>=0} c_{-m} conj(q)^m,
//   C[conj(z - zeta) eta']          = conj(q) c_1 + (|q|^2 - 1) Sum_{m>=2} m c_m q^{m-2},
// and outside
//   C[eta] + conj(C[conj(eta)])     = -Sum_{m>=1} ( c_{-m} q^-m + c_m conj(q)^-m ),
//   C[conj(z - zeta) eta']          = c_1 / q + (|q|^2 - 1) q^-2 Sum_{m>=1} m c_{-m} q^-m.
// As rows on the nodal values these are geometric series. Exact for the trigonometric polynomial through the density.
#pragma once

#include "cauchy.hpp"
#include "simd.hpp"

namespace stokes {

class CircleEvaluation {
 public:
  // The circle around 0 with node k at the angle 2 pi k / points; `points` is even.
  CircleEvaluation(double radius, int points, Side side);

  // As CloseEvaluation::velocity_rows, for all nodes or some. Cost O(1) per target and node.
  VelocityRows velocity_rows(const std::vector<Complex>& z) const;
  VelocityRows velocity_rows(const std::vector<Complex>& z, const std::vector<int>& nodes) const;

 private:
  double radius_;
  Side side_;
  ComplexVector direction_;  // e^(i alpha) of the nodes
};

// The flow of one density, summed by the series. For large circles, whose rows would need too much memory.
class CircleFlow {
 public:
  CircleFlow(double radius, Side side, const ComplexVector& density);

  // At points z in the fluid. Vectorised over them; cost O(N) each.
  std::vector<Complex> velocity(const std::vector<Complex>& z) const;

 private:
  double radius_;
  Side side_;
  Complex first_;                // c_1
  std::vector<double> series_;   // real and imaginary parts of the coefficients of three series, power by power
};

}  // namespace stokes
