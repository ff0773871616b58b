#include "annulus.hpp"

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

}  // namespace stokes
