// Signed gap between two convex bodies, its gradient, and the first contact during a rigid motion.
//
// With the support functions h of the bodies, d = c_B - c_A and a unit vector n,
//   s(n) = <n, d> - h_A(n) - h_B(-n)
// is the separation of the bodies along n, and their gap is its maximum over n. It is the distance of separated bodies. For
// overlapping bodies it is minus the penetration depth, the shortest translation that parts them. The gap is smooth through
// contact; in deep overlap it has kinks where two directions tie.
// A body is an ellipse or a disc of any aspect ratio.
#pragma once

#include <optional>

#include "suspension.hpp"

namespace stokes {

// point_b - point_a = value * normal; the points are on the boundaries, up to round-off.
struct Gap {
  double value;
  Complex normal;  // the maximising n, of unit length, from A to B
  Complex point_a, point_b;
};

// Derivatives of a gap with respect to the poses. As generalised forces they are those of a contact with
// unit multiplier: force -n on A at point_a, +n on B at point_b, on one line.
struct GapGradient {
  Complex centre_a, centre_b;
  double angle_a, angle_b;

  bool operator==(const GapGradient&) const = default;
};

// The gap to a few units of round-off of |d| plus the bodies' size. Where several directions attain the
// maximum, as for coincident centres, one of them is taken. Two discs need no search.
// Cost: about 15 ns for discs, 0.5 to 1 microseconds for ellipses, 8 where those are nearly circular and
// nearly concentric.
Gap gap(const Shape& shape_a, const Pose& a, const Shape& shape_b, const Pose& b);
inline Gap gap(const Body& a, const Body& b) { return gap(a.shape, a.pose, b.shape, b.pose); }

// The gap's gradient at the poses it was computed for:
//   d/dc_A = -n, d/dc_B = n, d/dtheta_A = -<perp(p_A - c_A), n>, d/dtheta_B = <perp(p_B - c_B), n>.
GapGradient gradient(const Gap& gap, const Pose& a, const Pose& b);

// Pose at tau between `start` (tau = 0) and `end` (tau = 1) when centre and angle move linearly.
inline Pose interpolate(const Pose& start, const Pose& end, double tau) {
  return {start.centre + tau * (end.centre - start.centre), start.angle + tau * (end.angle - start.angle)};
}

struct Hit {
  double tau;
  Gap gap;  // at tau
};

// The first tau in [0, 1] at which the gap falls to the threshold (>= 0) while both bodies move linearly in
// centre and angle; none if it stays above. Displacements and rotations need not be small: bodies that end apart after
// passing through each other are a hit.
//
// Within the tolerance e = max(1e-3 threshold, 1e-12 (circumradius_A + circumradius_B)):
//   * a hit has threshold <= gap <= threshold + e, and the gap was above the threshold before;
//   * without a hit the gap never is below the threshold.
// A pair that starts with a gap g0 <= threshold + e is a hit at tau = 0 if the initial rate of its gap would reduce the gap
// by more than e over the whole step. Otherwise it may separate. Until its gap exceeds threshold + e, g0 replaces the
// threshold (a hit then has g0 - 2e <= gap <= g0 - e). For g0 >= 0 this misses no pass-through either.
//
// No advance in tau can miss a hit: the separation along a frozen normal is at most the gap, and bounds on
// its first and second derivative limit the advance. If a motion grazes the threshold so closely that 200
// evaluations of the gap do not bring it past, the last tau is returned as a hit, with a gap still above threshold + e.
// Cost: 2 to 5 evaluations of the gap where the circumscribed circles meet, almost none elsewhere.
std::optional<Hit> first_hit(const Shape& shape_a, const Pose& a_start, const Pose& a_end,
                             const Shape& shape_b, const Pose& b_start, const Pose& b_end, double threshold);

// The separation <n, p_B - p_A> of two material points along a frozen normal. It replaces the gap as the constraint on the
// end of a step for bodies that have passed through each other: there the gap is positive and this separation negative.
struct SeparatingPlane {
  Complex normal;                  // laboratory frame, from A to B
  Complex material_a, material_b;  // points in the frames of their bodies
};

// The plane through a contact, given the poses it was computed for (interpolate() at a hit's tau).
SeparatingPlane separating_plane(const Gap& gap, const Pose& a, const Pose& b);

// Value and gradient with respect to the poses, at any poses.
double separation(const SeparatingPlane& plane, const Pose& a, const Pose& b);
GapGradient gradient(const SeparatingPlane& plane, const Pose& a, const Pose& b);

}  // namespace stokes
