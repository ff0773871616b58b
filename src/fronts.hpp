// Every boundary of a suspension with what it has in front of it.
#pragma once

#include <vector>

#include "suspension.hpp"

namespace stokes {

struct Front {
  int boundary, other;  // bodies, then the container
  double alpha;         // of the boundary's nearest point
  double width;         // W of the gap (facing.hpp)
  double gap, curvature;
};

// Of every boundary those within its `reach`, a length for each of the bodies and the container; negative: none. Ordered
// by pairs. Cost: a neighbour search and a facing for each pair found.
std::vector<Front> fronts(const Suspension& bodies, const std::vector<double>& reach);

// The shapes of the bodies and the container.
std::vector<Shape> boundary_shapes(const Suspension& bodies);

}  // namespace stokes
