// Where bodies are packed: a box, a disc or the space between two concentric circles, centred at 0.
#pragma once

#include <vector>

#include "gap.hpp"

namespace stokes {

enum class RegionKind { box, disc, annulus };

struct Region {
  RegionKind kind = RegionKind::box;
  double width = 0.0, height = 0.0;                // of a box, length
  double inner_radius = 0.0, outer_radius = 0.0;  // of an annulus; the outer one of a disc, length

  double area() const;

  // For two independent numbers, uniform in [0, 1), a point uniform over the region.
  Complex point(double u1, double u2) const;

  // The gaps of a body to all walls, the body as A: the normal points from it into the wall. Negative beyond the wall.
  std::vector<Gap> wall_gaps(const Shape& shape, const Pose& pose) const;
};

}  // namespace stokes
