// Close evaluation of the double layer of one curve by interpolation from its limit on the boundary: the scheme of
// the published method, an alternative to the Cauchy integrals of cauchy.hpp.
//
// The curve has N nodes, length l and spacing h = l/N. A target z is far if its distance d from the curve is at
// least h. Its velocity is the trapezoid rule with curve and density upsampled to N ceil(sqrt(N)) nodes.
// The velocity at a near target is that of a polynomial of degree 6 along the normal at the closest point x0. Its
// seven values are, by NearRule,
//   from_boundary  the limit (-1/2 I + D) eta from the fluid at x0, and the upsampled rule at x0 + 1.1 h k n for
//                  k = 1..6, with the normal n into the fluid;
//   from_target    the same limit, the upsampled rule at z + 1.1 h k n for k = 1..5, and 0 at the foot of the
//                  perpendicular from the origin to the line of the others. On a disc around the origin that is a
//                  polynomial without a constant term in the distance from the centre.
// The limit at x0 is interpolated along the curve from the limits at the seven nodes around x0.
//
// Both rules are linear in the density, so a target has a row, exactly as in the Cauchy scheme. The stencil, which
// values are combined with which weights, depends on the target only. Pressure and velocity gradient use the same
// stencil, for a given density, with the limits of boundary_limits.hpp at x0.
#pragma once

#include <array>
#include <vector>

#include "cauchy.hpp"
#include "point_flow.hpp"

namespace stokes {

// from_target is the rule whose errors the paper's first author gives for a circle around the origin. It depends on
// the origin of the frame, so that simulations use from_boundary.
enum class NearRule { from_boundary, from_target };

class InterpolationEvaluation;

// The double layer of one density, near the curve or far from it. It refers to the InterpolationEvaluation that made
// it, which must outlive it.
class InterpolationFlow {
 public:
  // At z (frame of the curve) in the fluid or on the curve. The order is that of the velocity, h^7. Relative to its
  // own size the pressure has about the error of the velocity, the gradient up to ten times that: 3e-4 on a disc at
  // N = 64, 1e-7 at N = 256. Cost O(N^1.5).
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
  // `curve` has an even number N >= 8 of nodes, otherwise InputError. Its frame is arbitrary with the rule
  // from_boundary; with from_target no tangent of the curve may pass through the origin. Cost O(N^2).
  InterpolationEvaluation(const Curve& curve, Side side, NearRule rule = NearRule::from_boundary);

  // Rows of the velocity at targets z (frame of the curve) in the fluid or on the curve. With the rule
  // from_boundary near targets have an error of order h^7 once 6.6 h is less than the distance over which the flow
  // varies. With two waves of modulus 1 on a disc the largest error is 5.8e-5 at N = 64 and 2.2e-8 at N = 256.
  // The segment of length 6.6 h that leaves x0 along the normal must not cross this curve again, or the error is
  // O(1). Cost O(N^1.5 log N) per target.
  VelocityRows velocity_rows(const std::vector<Complex>& z) const;

  // The flow of one density (N values). Cost O(N^2).
  InterpolationFlow flow(const ComplexVector& density) const { return InterpolationFlow(*this, density); }

 private:
  friend class InterpolationFlow;
  static constexpr int order = 7;  // values of one interpolation

  // The sum for one target: boundary limits at `order` successive nodes from first_node on (modulo N) and
  // upsampled trapezoid values at points in the fluid, each with its weight.
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
  NearRule rule_;
  Curve curve_, fine_;
  double h_;
  ComplexVector coefficients_;  // Fourier, of zeta
  VelocityRows limit_;          // -1/2 I + D at the nodes, N x N
};

}  // namespace stokes
