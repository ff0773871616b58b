// Pressure and velocity gradient of the double layer of one curve, with the velocity, for a given density:
// spectrally accurate up to the curve and on it.
//
// The Goursat functions of cauchy.hpp and their derivatives are Cauchy integrals of the density and its
// derivatives ' with respect to zeta along the curve,
//   phi = -(s/2) C[eta],   phi' = -(s/2) C[eta'],   phi'' = -(s/2) C[eta''],
//   psi = (s/2) C[ conj(eta) + conj(zeta) eta' ],
//   psi' = (s/2) C[ (conj(eta))' + (conj(zeta))' eta' + conj(zeta) eta'' ].
// Each has boundary values of its own, continued by barycentric interpolation, so that nothing is
// differentiated across the curve and no digits are lost close to it.
#pragma once

#include <vector>

#include "cauchy.hpp"
#include "point_flow.hpp"

namespace stokes {

class CloseFlow {
 public:
  // `curve` relative to its centre 0, which must lie inside it, and a density with one value per node.
  // `upsampling` is the factor by which both are oversampled. The second derivatives ask for more than the
  // velocity does: on an ellipse with b/a = tanh(mu) round-off is reached once (upsampling - 1) N mu is
  // about 66, see flow_upsampling(). Cost O(upsampling^2 N^2).
  CloseFlow(const Curve& curve, Side side, int upsampling, const ComplexVector& density);

  // At z (same frame as the curve) in the fluid, at any distance, or on the curve. Cost O(upsampling N).
  PointFlow at(Complex z) const;

  // The limits from the fluid at the N nodes of the curve.
  std::vector<PointFlow> at_nodes() const;

 private:
  int upsampling_;
  Curve fine_;
  Complex winding_;
  Eigen::Matrix<Complex, 5, Eigen::Dynamic> boundary_;  // limits of phi, phi', phi'', psi, psi' at the fine nodes
};

// The upsampling that gives the flow of a density on N nodes of an ellipse of this aspect ratio (>= 1) to
// round-off, as far as the density itself is resolved: 2 for a disc, 3 for 3:1 at N = 128, 7 at N = 32.
int flow_upsampling(double aspect, int points);

// The plain trapezoid rule for a density at a target z off the nodes. Cost O(N).
PointFlow trapezoid_flow(const Curve& curve, Side side, const ComplexVector& density, Complex z);

}  // namespace stokes
