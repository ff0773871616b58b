#include "annulus.hpp"

#include <algorithm>
#include <cmath>

namespace stokes {

Container outer_wall(const Annulus& annulus) {
  return {{0.0, 0.0}, annulus.outer_radius, annulus.wall_points, annulus.outer_surface};
}

Body inner_wall(const Annulus& annulus) {
  Body wall{{annulus.inner_radius, annulus.inner_radius}, {}, {}, {}};
  wall.fixed = true;
  wall.surface = annulus.inner_surface;
  wall.points = annulus.wall_points;
  return wall;
}

Suspension between_walls(Suspension bodies, const Annulus& annulus) {
  bodies.push_back(inner_wall(annulus));
  bodies.container = outer_wall(annulus);
  return bodies;
}

// The squared distance is a trigonometric polynomial of degree 2 in the ellipse's parameter: samples show each of
// its maxima, at most two, and golden sections find them.
double wall_gap(const Body& body, const Container& wall) {
  const Complex d = (body.pose.centre - wall.centre) * std::conj(body.pose.axis());
  const Shape& shape = body.shape;
  if (shape.a == shape.b) return wall.radius - std::abs(d) - shape.a;
  constexpr int samples = 64;
  constexpr double spacing = 2.0 * pi / samples, golden = 0.6180339887498949;
  const auto distance = [&](double alpha) {
    return std::abs(d + Complex(shape.a * std::cos(alpha), shape.b * std::sin(alpha)));
  };
  double largest = 0.0;
  for (int k = 0; k < samples; ++k) {
    double low = (k - 1) * spacing, high = (k + 1) * spacing;
    const double sample = distance(k * spacing);
    if (sample < distance(low) || sample < distance(high)) continue;
    while (high - low > 1e-9) {  // the distance is then within 1e-18 of its maximum, relatively
      const double left = high - golden * (high - low), right = low + golden * (high - low);
      (distance(left) < distance(right) ? low : high) = distance(left) < distance(right) ? left : right;
    }
    largest = std::max(largest, distance(0.5 * (low + high)));
  }
  return wall.radius - largest;
}

}  // namespace stokes
