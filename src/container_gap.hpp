// Signed gap between a convex body and the circular wall around the fluid.
//
// With the container's centre o and radius R, the gap is R - max |p - o| over the points p of the body. It is the distance
// from the wall if the body is inside. Otherwise it is minus the distance of its farthest outside point from the wall.
//
// One point represents the contact. A body whose radii of curvature are all below R (for semi-axes a > b: a^2 < b R) can
// only touch the wall at one point. A flatter body may touch with both ends at once. The value is right there, too, but
// the gradient refers to one end and jumps where the other end takes over.
//
// No search in time is needed. Let the centre move and the angle turn by w, both linearly. The
// farthest distance plus (a^2 - b^2) / a (w tau)^2 / 2 is a convex function of tau in [0, 1], because the second
// derivative of a support function with respect to the angle is at least -(a^2 - b^2) / a. So meanwhile
//   gap(tau) >= min(gap(0), gap(1)) - (a^2 - b^2) / a w^2 / 8.
#pragma once

#include "gap.hpp"
#include "suspension.hpp"

namespace stokes {

// The gap with the container as B: point_a is the body's farthest point p, point_b the wall's nearest to it,
// and the normal (p - o) / |p - o| points from the body into the wall. Of several farthest points one is taken.
// Accurate to a few units of round-off of R + |c - o| + a. Cost: 10 ns for discs, about 50 ns for ellipses.
Gap gap(const Shape& shape, const Pose& pose, const Container& container);
inline Gap gap(const Body& body, const Container& container) { return gap(body.shape, body.pose, container); }

// The gap's gradient at the pose it was computed for, dg/dc = -n and dg/dtheta = -<perp(p - c), n>. As
// generalised forces they are those of a contact with unit multiplier; B's are the wall's, +n and the torque about
// its centre, which is zero.
GapGradient gradient(const Gap& gap, const Pose& pose);

// The same for any normal: force -n on the body where it reaches farthest along n, and +n on the wall on the same
// line, with its torque about the container's centre.
GapGradient push_from_wall(const Shape& shape, const Pose& pose, const Container& container, Complex normal);

}  // namespace stokes
