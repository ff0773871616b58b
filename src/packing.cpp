#include "packing.hpp"

#include <cmath>

#include "container_gap.hpp"
#include "gap.hpp"
#include "text.hpp"

namespace stokes {

namespace {

// Initialisers in braces are evaluated in order, and with them the draws.
Body random_body(UniformRandom& random, const RandomPlacement& placement) {
  const double u[3] = {random(), random(), random()};
  const double distance = placement.nearest + (placement.farthest - placement.nearest) * u[0];
  return {placement.shape, {std::polar(distance, 2.0 * pi * u[1]), 2.0 * pi * u[2]}, {}, {}};
}

bool clear_of(const Body& body, const std::vector<Body>& others, double clearance) {
  for (const Body& other : others) {
    const double reach = body.shape.circumradius() + other.shape.circumradius() + clearance;
    if (std::norm(body.pose.centre - other.pose.centre) > reach * reach) continue;
    if (!(gap(body, other).value > clearance)) return false;
  }
  return true;
}

}  // namespace

double UniformRandom::operator()() {
  const std::uint32_t high = generator_() >> 5, low = generator_() >> 6;
  return (high * 0x1p26 + low) * 0x1p-53;
}

PlacedBodies place_randomly(const RandomPlacement& placement, const Annulus& annulus, const std::vector<Body>& held) {
  if (!(placement.nearest >= 0.0 && placement.farthest >= placement.nearest)) {
    throw InputError(concat("random placement: the centres cannot lie between the distances ", placement.nearest, " and ",
                            placement.farthest, " from the axis; give 0 <= nearest <= farthest."));
  }
  const std::vector<Body> inner = {inner_wall(annulus)};
  const Container outer = outer_wall(annulus);
  UniformRandom random(placement.seed);
  PlacedBodies placed;
  int tries = 0, of_this_body = 0;
  while (static_cast<int>(placed.bodies.size()) < placement.count) {
    if (of_this_body++ == placement.max_tries)
      throw NumericalError(concat("random placement: after ", placed.bodies.size(), " of ", placement.count,
                                  " bodies no place was found for another one in ", placement.max_tries,
                                  " tries (body_clearance = ", placement.body_clearance, ", wall_clearance = ",
                                  placement.wall_clearance, ", seed = ", placement.seed,
                                  "); try another seed, fewer or smaller bodies or smaller clearances."));
    const Body body = random_body(random, placement);
    ++tries;
    if (!clear_of(body, inner, placement.wall_clearance) || !(gap(body, outer).value > placement.wall_clearance) ||
        !clear_of(body, held, placement.body_clearance) || !clear_of(body, placed.bodies, placement.body_clearance))
      continue;
    placed.bodies.push_back(body);
    placed.tries = tries, of_this_body = 0;
  }
  return placed;
}

std::vector<Body> ring(const Body& body, int count, double radius) {
  std::vector<Body> bodies(count, body);
  for (int k = 0; k < count; ++k) {
    const double polar_angle = 2.0 * pi * k / count;
    bodies[k].pose = {std::polar(radius, polar_angle), body.pose.angle + polar_angle};
  }
  return bodies;
}

double area_fraction(const Suspension& bodies, const Annulus& annulus) {
  double sum = 0.0;
  for (const Body& body : bodies)
    if (!body.fixed) sum += body.shape.a * body.shape.b;
  const double inner = annulus.inner_radius, outer = annulus.outer_radius;
  return sum / ((outer - inner) * (outer + inner));
}

}  // namespace stokes
