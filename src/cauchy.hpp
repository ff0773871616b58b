// Close evaluation of the double layer of one curve, spectrally accurate up to the curve.
//
// With the Cauchy integral C[tau](z) = (1/2 pi i) oint tau(zeta) d zeta / (zeta - z), the curve
// counter-clockwise and side s as in base.hpp, the double layer has the Goursat functions
//   phi = -(s/2) C[eta],   psi = (s/2) C[ conj(eta) + conj(zeta) eta' ],   eta' = eta_alpha/zeta_alpha,
// and phi' = -(s/2) C[eta'], so that u = phi - z conj(phi') - conj(psi) becomes
//   u = -(s/2) ( C[eta] + conj(C[conj(eta)]) - conj(C[conj(z - zeta) eta']) ),
// in which the near-cancellation of z conj(phi') with psi is already done. Boundary values of the Cauchy integrals are
// continued to a target by barycentric rational interpolation, both in one sum over the nodes. Pressure and velocity
// gradient: close_flow.hpp.
#pragma once

#include <vector>

#include "curve.hpp"

namespace stokes {

enum class Side { exterior = -1, interior = +1 };  // of the curve on which the fluid lies

// The double layer is real-linear in the density: u = Sum_k ( real_part_k eta_k + conjugate_k conj(eta_k) ).
// Row i of either matrix belongs to target i; the factor of eta is always real.
struct VelocityRows {
  Matrix direct;            // targets x N, factor of eta_k
  ComplexMatrix conjugate;  // targets x N, factor of conj(eta_k)
};

class CloseEvaluation {
 public:
  // `curve` relative to its centre 0, which must lie inside it. `upsampling` is the factor by which
  // the density is oversampled, since its products with the curve have a larger bandwidth: 2 up to
  // aspect ratio 3, 3 beyond, gives spectral accuracy in the density alone. Cost O(upsampling^2 N^2), memory
  // O(upsampling N^2).
  CloseEvaluation(const Curve& curve, Side side, int upsampling);

  // Rows of the velocity at targets z (same frame as the curve) in the fluid or on the curve. Cost
  // O(upsampling N^2) per target.
  VelocityRows velocity_rows(const std::vector<Complex>& z) const;

 private:
  // C[tau](z) = Sum_k ( of_value_k tau_k + of_derivative_k tau_alpha,k ) on the fine nodes, a column for each z and
  // for each of those `close` enough to need the derivative.
  struct CauchyColumns {
    ComplexMatrix of_value, of_derivative;
    std::vector<Eigen::Index> close;
  };
  CauchyColumns cauchy_columns(const std::vector<Complex>& z) const;

  Side side_;
  Curve fine_;
  Complex winding_;
  ComplexVector slope_, bend_;  // 1/zeta_alpha on the fine nodes and its derivative
  ComplexVector poles_;         // Sum_{j != k} zeta'_j/(zeta_k - zeta_j) there
  // Fine values of eta, eta_alpha and eta_alpha,alpha from eta, transposed:
  Matrix refine_, refine_derivative_, refine_second_;
};

// Rows of the plain trapezoid rule at the same targets: what the fast sums compute.
VelocityRows trapezoid_rows(const Curve& curve, Side side, const std::vector<Complex>& z);
// The same for some of the nodes.
VelocityRows trapezoid_rows(const Curve& curve, Side side, const std::vector<Complex>& z, const std::vector<int>& nodes);

// The curve at `upsampling` times as many nodes, its own among them.
Curve refined(const Curve& curve, int upsampling);

// Terms zeta'_k/(zeta_k - z) of the trapezoid rule for Cauchy integrals at z. That of the nearest node, which may be
// infinite, is apart: `p` has 0 there.
struct PoleTerms {
  ComplexVector p;
  Complex others;  // their sum
  Eigen::Index nearest;
  double distance;  // of the nearest node
};
PoleTerms pole_terms(const Curve& curve, Complex z);

// Sum_k zeta'_k/zeta_k on the exterior side, 0 on the interior.
Complex winding(const Curve& curve, Side side);

// Weights at z, in the fluid or on the curve, of the boundary values f_k of a function f that is analytic in
// the fluid and, on the exterior side, vanishes at infinity: f(z) = Sum_k weight_k f_k. The curve is relative to a
// point inside it. Cost O(N).
void barycentric_weights(const Curve& curve, Complex winding, Complex z, const PoleTerms& terms,
                         Eigen::Ref<ComplexVector> weight);

}  // namespace stokes
