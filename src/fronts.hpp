// The close neighbours of every boundary of a suspension.
#pragma once

#include <vector>

#include "suspension.hpp"

namespace stokes {

struct Front {          // a neighbour `other` in front of `boundary`
  int boundary, other;  // bodies, then the container
  double alpha;         // of the boundary's nearest point
  double width;         // W of the gap (facing.hpp)
  double gap, curvature;
};

// For every boundary the neighbours within its `reach`: one length for each body and the container, negative for none.
// Ordered by pairs. Cost: a neighbour search and a facing for each pair found.
std::vector<Front> fronts(const Suspension& bodies, const std::vector<double>& reach);

// The shapes of the bodies and the container.
std::vector<Shape> boundary_shapes(const Suspension& bodies);

}  // namespace stokes
