#include "container_gap.hpp"

#include <algorithm>
#include <cmath>

namespace stokes {

namespace {

// The point (a cos, b sin) of an ellipse, a > b, that maximises |q + point|, for q in the first quadrant. The point is then
// in this quadrant, too. With a multiplier a^2 + m of the constraint cos^2 + sin^2 = 1,
//   cos = a q_1 / m,  sin = b q_2 / (m + a^2 - b^2),
// and the largest m that meets the constraint belongs to the maximum. There F(m) = cos^2 + sin^2 - 1 is convex and
// decreasing, so that Newton's iteration from a smaller m increases to the root and cannot pass it.
Complex farthest_in_quadrant(double a, double b, Complex q) {
  const double difference = (a - b) * (a + b);
  // A component below 1e-17 a changes no distance; this bound keeps the root away from m = 0.
  const double along = a * std::max(q.real(), 1e-17 * a), across = b * q.imag();
  double m = std::max(along, across - difference), c = 0.0, s = 0.0;
  // At worst, around the cusp of the evolute, m grows by half in each of some 35 iterations before it converges.
  for (int iteration = 0; iteration < 100; ++iteration) {
    c = along / m, s = across / (m + difference);
    const double excess = c * c + s * s - 1.0;
    if (!(excess > 1e-15)) break;
    m += 0.5 * excess / (c * c / m + s * s / (m + difference));
  }
  return Complex{a * c, b * s} / std::hypot(c, s);
}

// In the body frame, q being the body's centre relative to the container's.
Complex farthest_point(const Shape& shape, Complex q) {
  const Complex positive{std::abs(q.real()), std::abs(q.imag())};
  Complex point = positive;
  if (shape.a > shape.b) {
    point = farthest_in_quadrant(shape.a, shape.b, positive);
  } else {
    const Complex mirrored = farthest_in_quadrant(shape.b, shape.a, {positive.imag(), positive.real()});
    point = {mirrored.imag(), mirrored.real()};
  }
  return {std::copysign(point.real(), q.real()), std::copysign(point.imag(), q.imag())};
}

}  // namespace

Gap gap(const Shape& shape, const Pose& pose, const Container& container) {
  const Complex from_centre = pose.centre - container.centre;
  Complex arm, normal;
  double distance = std::abs(from_centre);
  if (shape.a == shape.b) {
    normal = distance > 0.0 ? from_centre / distance : Complex{1.0, 0.0};
    arm = shape.a * normal;
    distance += shape.a;
  } else {
    const Complex axis = pose.axis();
    arm = axis * farthest_point(shape, from_centre * std::conj(axis));
    distance = std::abs(from_centre + arm);
    normal = (from_centre + arm) / distance;
  }
  return {container.radius - distance, normal, pose.centre + arm, container.centre + container.radius * normal};
}

GapGradient gradient(const Gap& gap, const Pose& pose) {
  return {-gap.normal, gap.normal, -cross(gap.point_a - pose.centre, gap.normal), 0.0};
}

GapGradient push_from_wall(const Shape& shape, const Pose& pose, const Container& container, Complex normal) {
  const Complex axis = pose.axis();
  const Complex arm = axis * shape.support(normal * std::conj(axis)).point;
  return {-normal, normal, -cross(arm, normal), cross(pose.centre - container.centre + arm, normal)};
}

}  // namespace stokes
