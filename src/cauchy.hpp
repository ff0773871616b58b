// Close evaluation of the double layer of one curve, spectrally accurate up to the curve.
//
// With the Cauchy integral C[tau](z) = (1/2 pi i) oint tau(zeta) d zeta / (zeta - z), the curve
// counter-clockwise and side s as in base.hpp, the double layer has the Goursat functions
//   phi = -(s/2) C[eta],   psi = (s/2) C[ conj(eta) + conj(zeta) eta' ],   eta' = eta_alpha/zeta_alpha,
// and phi' = -(s/2) C[eta']. The velocity u = phi - z conj(phi') - conj(psi) becomes
//   u = -(s/2) ( C[eta] + conj(C[conj(eta)]) - conj(C[conj(z - zeta) eta']) ).
// In this form z conj(phi') and psi no longer nearly cancel. Barycentric rational interpolation continues the boundary
// values of the Cauchy integrals to a target; one sum over the nodes computes and continues them. Pressure and
// velocity gradient are in close_flow.hpp.
#pragma once

#include <vector>

#include "curve.hpp"

namespace stokes {

// The side of the curve on which the fluid lies. The value is s of base.hpp.
enum class Side { exterior = -1, interior = +1 };

// The double layer is real-linear in the density: u = Sum_k ( real_part_k eta_k + conjugate_k conj(eta_k) ).
// Row i of either matrix belongs to target i. The factor of eta is always real.
struct VelocityRows {
  Matrix direct;            // targets x N, factor of eta_k
  ComplexMatrix conjugate;  // targets x N, factor of conj(eta_k)
};

class CloseEvaluation {
 public:
  // The origin is the centre of `curve` and must lie inside it. Products of the density with the curve have a larger
  // bandwidth than the density, so that it is oversampled by the factor `upsampling`. With 2 up to aspect ratio 3, and
  // 3 beyond, the accuracy depends on the resolution of the density alone. Cost O(upsampling^2 N^2), memory
  // O(upsampling N^2).
  CloseEvaluation(const Curve& curve, Side side, int upsampling);
  // `fine`: the same curve at a multiple of its nodes.
  CloseEvaluation(const Curve& curve, Curve fine, Side side);

  // Rows of the velocity at targets z (frame of the curve) in the fluid or on the curve. Cost O(upsampling N^2) per
  // target.
  VelocityRows velocity_rows(const std::vector<Target>& z) const;
  VelocityRows velocity_rows(const std::vector<Complex>& z) const;

 private:
  // C[tau](z) = Sum_k ( of_value_k tau_k + of_derivative_k tau_alpha,k ) over the fine nodes. of_value has a column for
  // each z. of_derivative has one for each z that is so close that the derivative is needed; `close` lists these.
  struct CauchyColumns {
    ComplexMatrix of_value, of_derivative;
    ComplexMatrix difference;  // zeta_k - z
    std::vector<Eigen::Index> close;
  };
  CauchyColumns cauchy_columns(const std::vector<Target>& z) const;

  Side side_;
  Curve fine_;
  Complex winding_;
  ComplexVector slope_, bend_;  // 1/zeta_alpha on the fine nodes and its derivative
  ComplexVector poles_;         // Sum_{j != k} zeta'_j/(zeta_k - zeta_j) on the fine nodes k
  // The transposed matrices that map eta to the fine values of eta, eta_alpha and eta_alpha,alpha.
  Matrix refine_, refine_derivative_, refine_second_;
};

// Rows of the plain trapezoid rule, which the fast sums compute, at targets z off the nodes.
VelocityRows trapezoid_rows(const Curve& curve, Side side, const std::vector<Target>& z);
VelocityRows trapezoid_rows(const Curve& curve, Side side, const std::vector<Complex>& z);
// The contribution of some of the nodes, a column for each.
VelocityRows trapezoid_rows(const Curve& curve, Side side, const std::vector<Complex>& z, const std::vector<int>& nodes);

// The curve with `upsampling` times as many nodes. They include its own.
Curve refined(const Curve& curve, int upsampling);

std::vector<Target> targets(const std::vector<Complex>& z);

// Terms zeta'_k/(zeta_k - z) of the trapezoid rule for Cauchy integrals at z.
struct PoleTerms {
  ComplexVector difference;  // zeta_k - z
  ComplexVector p;           // the terms, with 0 for the nearest node, whose term may be infinite
  Complex others;            // sum of p
  Eigen::Index nearest;      // the nearest node
  double distance;           // from z to the nearest node
};
PoleTerms pole_terms(const Curve& curve, const Target& z);

// Sum_k zeta'_k/zeta_k on the exterior side, 0 on the interior.
Complex winding(const Curve& curve, Side side);

// Barycentric weights of f(z) = Sum_k weight_k f_k, for the z of the terms, in the fluid or on the curve, and the boundary
// values f_k of a function f. The function is analytic in the fluid and, on the exterior side, vanishes at infinity. The
// origin must lie inside the curve. Cost O(N).
void barycentric_weights(const Curve& curve, Complex winding, const PoleTerms& terms,
                         Eigen::Ref<ComplexVector> weight);

}  // namespace stokes
