#include "fronts.hpp"

#include <algorithm>
#include <cmath>

#include "facing.hpp"
#include "neighbours.hpp"

namespace stokes {

std::vector<Front> fronts(const Suspension& bodies, const std::vector<double>& reach) {
  std::vector<Complex> centres;
  std::vector<double> radii;
  for (const Body& body : bodies) {
    centres.push_back(body.pose.centre);
    radii.push_back(body.shape.circumradius());
  }
  std::vector<Front> result;
  const auto add = [&](int i, int j, const Body& a, const auto& b) {
    const Facing f = facing(a, b);
    if (f.gap > std::max(reach[i], reach[j])) return;
    const double width = contact_width(f, a, b);
    if (f.gap <= reach[i]) result.push_back({i, j, f.alpha_a, width, f.gap, f.curvature()});
    if (f.gap <= reach[j]) result.push_back({j, i, f.alpha_b, width, f.gap, f.curvature()});
  };
  const int count = static_cast<int>(bodies.size());
  const double farthest = count == 0 ? 0.0 : std::max(0.0, *std::max_element(reach.begin(), reach.begin() + count));
  for (const auto& [i, j] : neighbour_pairs(centres, centres, radii, farthest))
    if (std::abs(centres[i] - centres[j]) - radii[i] - radii[j] <= std::max(reach[i], reach[j]))
      add(i, j, bodies[i], bodies[j]);
  if (!bodies.container) return result;
  const Container& wall = *bodies.container;
  for (int i = 0; i < count; ++i)
    if (wall.radius - std::abs(centres[i] - wall.centre) - radii[i] <= std::max(reach[i], reach[count]))
      add(i, count, bodies[i], wall);
  return result;
}

std::vector<Shape> boundary_shapes(const Suspension& bodies) {
  std::vector<Shape> shapes;
  for (const Body& body : bodies) shapes.push_back(body.shape);
  if (bodies.container) shapes.push_back(wall_shape(*bodies.container));
  return shapes;
}

}  // namespace stokes
