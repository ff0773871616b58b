#include "region.hpp"

#include <cmath>

#include "annulus.hpp"
#include "container_gap.hpp"

namespace stokes {

double Region::area() const {
  switch (kind) {
    case RegionKind::box: return width * height;
    case RegionKind::disc: return pi * outer_radius * outer_radius;
    case RegionKind::annulus: return pi * (outer_radius - inner_radius) * (outer_radius + inner_radius);
  }
  return 0.0;
}

Complex Region::point(double u1, double u2) const {
  if (kind == RegionKind::box) return {width * (u1 - 0.5), height * (u2 - 0.5)};
  const double inner = kind == RegionKind::annulus ? inner_radius : 0.0;
  const double square = inner * inner + u1 * (outer_radius - inner) * (outer_radius + inner);
  return std::polar(std::sqrt(square), 2.0 * pi * u2);
}

std::vector<Gap> Region::wall_gaps(const Shape& shape, const Pose& pose) const {
  std::vector<Gap> gaps;
  if (kind == RegionKind::box) {
    for (const Complex normal : {Complex(1.0), Complex(-1.0), imaginary_unit, -imaginary_unit}) {
      const Support support = shape.support(std::conj(pose.axis()) * normal);
      const Complex point = pose.centre + pose.axis() * support.point;
      const double half = 0.5 * (normal.real() != 0.0 ? width : height);
      const double value = half - dot(normal, pose.centre) - support.height;
      gaps.push_back({value, normal, point, point + value * normal});
    }
    return gaps;
  }
  const Annulus walls{inner_radius, outer_radius};
  gaps.push_back(gap(shape, pose, outer_wall(walls)));
  if (kind == RegionKind::annulus) {
    const Body inner = inner_wall(walls);
    gaps.push_back(gap(shape, pose, inner.shape, inner.pose));
  }
  return gaps;
}

}  // namespace stokes
