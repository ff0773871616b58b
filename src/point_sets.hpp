// Point sets on which fast summation is timed and tested.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "base.hpp"
#include "direct_sum.hpp"

namespace stokes {

// uniform: random points in the unit square, random normals; discs: on circles that fill the unit square,
// about 64 points each; annulus: on circles that fill the annulus of radii 0.8 and 1.
enum class PointSet { uniform, discs, annulus };

struct NormalPoints {
  PointArray points, weighted_normal;  // weights: arc length on circles, 1/sqrt(count) for uniform points
};

namespace detail {

// Uniform in [0, 1), the same on every machine.
inline double unit_random(std::mt19937_64& generator) {
  return static_cast<double>(generator() >> 11) * 0x1p-53;
}

struct Circle {
  Complex centre;
  double radius;
};

inline std::vector<Circle> circles_in_square(int count, std::mt19937_64& generator) {
  const int side = std::max(1, static_cast<int>(std::ceil(std::sqrt(count))));
  const double spacing = 1.0 / side;
  std::vector<Circle> circles;
  for (int b = 0; b < count; ++b) {
    const double x = b % side + 0.425 + 0.15 * unit_random(generator);
    const double y = b / side + 0.425 + 0.15 * unit_random(generator);
    circles.push_back({spacing * Complex(x, y), 0.4 * spacing});
  }
  return circles;
}

inline std::vector<Circle> circles_in_annulus(int count, std::mt19937_64& generator) {
  constexpr double inner = 0.8, outer = 1.0;
  const double spacing = std::sqrt(pi * (outer * outer - inner * inner) / count);
  const int rings = std::max(1, static_cast<int>(std::lround((outer - inner) / spacing)));
  const double width = (outer - inner) / rings;
  std::vector<Circle> circles;
  double share = 0.0;  // of the bodies, up to the current ring
  for (int r = 0; r < rings; ++r) {
    const double radius = inner + (r + 0.5) * width, first = 2.0 * pi * unit_random(generator);
    share += 2.0 * radius * width / (outer * outer - inner * inner);
    const int in_ring = static_cast<int>(std::lround(share * count)) - static_cast<int>(circles.size());
    for (int b = 0; b < in_ring; ++b) {
      circles.push_back({std::polar(radius, first + 2.0 * pi * b / in_ring),
                         0.4 * std::min(width, 2.0 * radius * std::sin(pi / std::max(2, in_ring)))});
    }
  }
  return circles;
}

}  // namespace detail

inline NormalPoints make_points(PointSet set, int count, std::mt19937_64& generator) {
  using detail::unit_random;
  NormalPoints result;
  result.points.resize(count), result.weighted_normal.resize(count);
  if (set == PointSet::uniform) {
    for (int k = 0; k < count; ++k) {
      const double x = unit_random(generator);
      result.points.set(k, {x, unit_random(generator)});
      result.weighted_normal.set(k, std::polar(1.0 / std::sqrt(count), 2.0 * pi * unit_random(generator)));
    }
    return result;
  }
  const int bodies = std::max(1, count / 64);
  const auto circles = set == PointSet::discs ? detail::circles_in_square(bodies, generator)
                                              : detail::circles_in_annulus(bodies, generator);
  int k = 0;
  for (int b = 0; b < bodies; ++b) {
    const int nodes = count / bodies + (b < count % bodies ? 1 : 0);
    const double first = 2.0 * pi * unit_random(generator);
    for (int j = 0; j < nodes; ++j, ++k) {
      const Complex outward = std::polar(1.0, first + 2.0 * pi * j / nodes);
      result.points.set(k, circles[b].centre + circles[b].radius * outward);
      result.weighted_normal.set(k, -2.0 * pi * circles[b].radius / nodes * outward);
    }
  }
  return result;
}

// Components uniform in [-1, 1).
inline ComplexVector random_vectors(int count, std::mt19937_64& generator) {
  ComplexVector values(count);
  for (int k = 0; k < count; ++k) {
    const double x = 2.0 * detail::unit_random(generator) - 1.0;
    values[k] = {x, 2.0 * detail::unit_random(generator) - 1.0};
  }
  return values;
}

}  // namespace stokes
