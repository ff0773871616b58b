#include "facing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "container_gap.hpp"

namespace stokes {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Distance of a boundary from its tangent at alpha, at the distance x along it; `way`: +1 or -1. Infinite beyond its end.
double depth(const Shape& shape, double alpha, int way, double x) {
  const Complex slope = shape.derivative(alpha), tangent = slope / std::abs(slope);
  double end = way * (shape.parameter(static_cast<double>(way) * tangent) - alpha);
  end -= 2.0 * pi * std::floor(end / (2.0 * pi));
  double low = 0.0, high = end, t = std::min(x / std::abs(slope), end);
  if (way * shape.offset(alpha, way * end).real() <= x) return infinity;
  for (int iteration = 0; iteration < 60; ++iteration) {
    const double excess = x - way * shape.offset(alpha, way * t).real();
    (excess > 0.0 ? low : high) = t;
    const double step = excess / dot(tangent, shape.derivative(alpha + way * t)), next = t + step;
    t = next > low && next < high ? next : 0.5 * (low + high);
    if (std::abs(excess) < 1e-3 * x) break;
  }
  return shape.offset(alpha, way * t).imag();
}

// `side`: -1 where the second boundary is a wall around the first.
double width(const Shape& a, const Shape& b, const Facing& f, double side) {
  const double g = std::max(f.gap, 1e-9 * std::min(a.inradius(), b.inradius()));
  double nearest = infinity;
  for (const int way : {-1, +1}) {
    // The parameter of a body in front runs in the opposite direction.
    const auto rise = [&](double x) {
      const double below = depth(a, f.alpha_a, way, x);
      return below == infinity ? infinity : below + side * depth(b, f.alpha_b, -static_cast<int>(side) * way, x);
    };
    const double curvature = std::max(f.curvature(), 1e-12 / a.circumradius());
    double low = std::sqrt(2.0 * g / curvature), high = low;
    if (rise(low) > g)
      while (rise(low) > g) high = low, low *= 0.5;
    else
      while (rise(high) <= g) low = high, high *= 2.0;
    while (high > 1.05 * low) {
      const double middle = std::sqrt(low * high);
      (rise(middle) > g ? high : low) = middle;
    }
    nearest = std::min(nearest, std::sqrt(low * high));
  }
  return std::hypot(nearest, g);
}

}  // namespace

Facing facing(const Body& a, const Body& b) {
  const Gap between = gap(a, b);
  const Complex n_a = std::conj(a.pose.axis()) * between.normal, n_b = -std::conj(b.pose.axis()) * between.normal;
  return {between.value, between.normal, a.shape.parameter(n_a), b.shape.parameter(n_b),
          1.0 / a.shape.support(n_a).curvature_radius, 1.0 / b.shape.support(n_b).curvature_radius};
}

Facing facing(const Body& a, const Container& b) {
  const Gap between = gap(a, b);
  const Shape wall = wall_shape(b);
  const Complex n_a = std::conj(a.pose.axis()) * between.normal, n_b = std::conj(wall_pose(b).axis()) * between.normal;
  return {between.value, between.normal, a.shape.parameter(n_a), wall.parameter(n_b),
          1.0 / a.shape.support(n_a).curvature_radius, -1.0 / b.radius};
}

double contact_width(const Facing& facing, const Body& a, const Body& b) { return width(a.shape, b.shape, facing, 1.0); }

double contact_width(const Facing& facing, const Body& a, const Container& b) {
  return width(a.shape, wall_shape(b), facing, -1.0);
}

}  // namespace stokes
