// Velocity, pressure and velocity gradient of the double layer of one curve for a given density, spectrally accurate up
// to the curve and on it.
//
// The Goursat functions of cauchy.hpp and their derivatives are Cauchy integrals of the density and its
// derivatives ' with respect to zeta along the curve,
//   phi = -(s/2) C[eta],   phi' = -(s/2) C[eta'],   phi'' = -(s/2) C[eta''],
//   psi = (s/2) C[ conj(eta) + conj(zeta) eta' ],
//   psi' = (s/2) C[ (conj(eta))' + (conj(zeta))' eta' + conj(zeta) eta'' ].
// Barycentric interpolation continues the boundary values of each of the five. Nothing is differentiated across the
// curve, so that no digits are lost close to it.
#pragma once

#include <vector>

#include "cauchy.hpp"
#include "point_flow.hpp"

namespace stokes {

class CloseFlow {
 public:
  // The origin is the centre of `curve` and must lie inside it. The density has one value per node. Both are
  // oversampled by the factor `upsampling`. Second derivatives need a larger factor than the velocity: on an ellipse
  // with b/a = tanh(mu) the error is round-off once (upsampling - 1) N mu is about 66, see flow_upsampling(). Cost
  // O(upsampling^2 N^2).
  CloseFlow(const Curve& curve, Side side, int upsampling, const ComplexVector& density);
  // `fine`: the curve at a multiple of the density's nodes.
  CloseFlow(Curve fine, Side side, const ComplexVector& density);

  // The flow at z (frame of the curve) in the fluid, at any distance, or on the curve. Cost O(upsampling N).
  PointFlow at(Complex z) const;

  // The limits from the fluid at the N nodes of the curve.
  std::vector<PointFlow> at_nodes() const;

 private:
  int upsampling_;
  Curve fine_;
  Complex winding_;
  Eigen::Matrix<Complex, 5, Eigen::Dynamic> boundary_;  // limits of phi, phi', phi'', psi, psi' at the fine nodes
};

// The upsampling for a density on `points` nodes of an ellipse with this aspect ratio (>= 1). With it the flow has the
// accuracy of the density, down to round-off. It is 2 for a disc; for 3:1 it is 3 at N = 128 and 7 at N = 32.
int flow_upsampling(double aspect, int points);

// The plain trapezoid rule for a density at a target z off the nodes. Cost O(N).
PointFlow trapezoid_flow(const Curve& curve, Side side, const ComplexVector& density, Complex z);

}  // namespace stokes
