// Close evaluation of the double layer of one curve by interpolation from its boundary limit: the
// scheme of the published method, an alternative to the Cauchy integrals of cauchy.hpp.
//
// With N nodes, length l and h = l/N:
//   * far, distance >= h: the trapezoid rule, curve and density upsampled to N ceil(sqrt(N)) nodes;
//   * near: the polynomial of degree 6 in the distance d from the curve through
//       d = 0:                 the fluid-side limit (-1/2 I + D) eta at the closest point x0, found at
//                              the nodes and interpolated along the curve from the 7 around x0,
//       d = 1.1 h k, k = 1..6: the upsampled rule at x0 + d (normal into the fluid),
//     evaluated at the target.
// All is linear in the density, so a target has a row, exactly as in the Cauchy scheme. Which values
// are combined, the stencil, depends on the target only. Pressure and velocity gradient take the same stencil,
// for a given density, with the limits of boundary_limits.hpp at distance 0.
#pragma once

#include <array>
#include <vector>

#include "cauchy.hpp"
#include "point_flow.hpp"

namespace stokes {

class InterpolationEvaluation;

// The double layer of one density, near the curve or far from it. Refers to the InterpolationEvaluation it is
// made from, which must outlive it.
class InterpolationFlow {
 public:
  // At z (frame of the curve) in the fluid or on the curve. The order is that of the velocity, h^7. Relative to
  // their own size the pressure errs about as much as the velocity and the gradient up to ten times as much: 3e-4 on
  // a disc at N = 64, 1e-7 at N = 256. Cost O(N^1.5).
  PointFlow at(Complex z) const;

 private:
  friend class InterpolationEvaluation;
  InterpolationFlow(const InterpolationEvaluation& close, const ComplexVector& density);

  const InterpolationEvaluation* close_;
  ComplexVector fine_density_;
  std::vector<PointFlow> limits_;  // from the fluid, at the nodes
};

class InterpolationEvaluation {
 public:
  // `curve` has an even number N >= 8 of nodes, in any frame; otherwise InputError. Cost O(N^2).
  InterpolationEvaluation(const Curve& curve, Side side);

  // Rows of the velocity at targets z (frame of the curve) in the fluid or on the curve. Near targets
  // have an error of order h^7 once 6.6 h is less than the distance over which the flow varies: for
  // one to four waves on a disc 2e-6 to 1e-3 of the density at N = 64, 6e-10 to 6e-7 at N = 256. The
  // segment of length 6.6 h that leaves x0 along the normal must not cross this curve again, or the
  // error is O(1).
  // Cost O(N^1.5 log N) per target.
  VelocityRows velocity_rows(const std::vector<Complex>& z) const;

  // The flow of one density (N values). Cost O(N^2).
  InterpolationFlow flow(const ComplexVector& density) const { return InterpolationFlow(*this, density); }

 private:
  friend class InterpolationFlow;
  static constexpr int order = 7;  // values per interpolation

  // What is summed for one target: boundary limits at `order` successive nodes from first_node on
  // (modulo N) and upsampled trapezoid values at points in the fluid, each with its weight.
  struct Stencil {
    int first_node = 0;
    std::array<double, order> node_weight{};
    std::vector<Complex> points;
    Vector point_weight;
  };
  struct BoundaryPoint {
    double alpha;
    Complex position, derivative;
  };

  BoundaryPoint closest_point(Complex z, int fine_node) const;
  Stencil stencil(Complex z) const;
  ComplexVector restricted(const ComplexVector& fine_row) const;

  Side side_;
  Curve curve_, fine_;
  double h_;
  ComplexVector coefficients_;  // Fourier, of zeta
  VelocityRows limit_;          // -1/2 I + D at the nodes, N x N
};

}  // namespace stokes
