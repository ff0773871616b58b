// The space between two concentric circular walls, as part of a suspension.
#pragma once

#include "suspension.hpp"

namespace stokes {

// Both walls are centred at 0; 0 < inner_radius < outer_radius.
struct Annulus {
  double inner_radius = 0.0, outer_radius = 0.0;
  int wall_points = 256;  // on each wall, even
  SurfaceMotion inner_surface{}, outer_surface{};
};

// The inner wall of a suspension, or null.
inline const Body* inner_wall_of(const Suspension& bodies) {
  return !bodies.empty() && bodies.back().points > 0 ? &bodies.back() : nullptr;
}

Container outer_wall(const Annulus& annulus);
Body inner_wall(const Annulus& annulus);

// The bodies between the walls: the outer wall is the suspension's container, the inner wall its last body.
Suspension between_walls(Suspension bodies, const Annulus& annulus);

}  // namespace stokes
