#include "packing.hpp"

#include <cmath>
#include <random>

#include "container_gap.hpp"
#include "gap.hpp"
#include "text.hpp"

namespace stokes {

namespace {

// The standard library's distributions differ from one implementation to the next, its generators do not.
class Random {
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}

  // Uniform in [0, 1).
  double uniform() { return static_cast<double>(generator_() >> 11) * 0x1p-53; }

  Body body(const RandomPlacement& placement) {
    const double low = placement.inner_radius, high = placement.outer_radius, part = uniform();
    const double r = placement.density == RadialDensity::uniform_radius
                         ? low + part * (high - low)
                         : std::sqrt(low * low + part * (high - low) * (high + low));
    const double polar_angle = 2.0 * pi * uniform(), angle = 2.0 * pi * uniform();
    return {placement.shape, {std::polar(r, polar_angle), angle}, {}, {}};
  }

 private:
  std::mt19937_64 generator_;
};

bool apart(const Body& body, const std::vector<Body>& others, double distance) {
  for (const Body& other : others) {
    const double reach = body.shape.circumradius() + other.shape.circumradius() + distance;
    if (std::norm(body.pose.centre - other.pose.centre) > reach * reach) continue;
    if (!(gap(body, other).value > distance)) return false;
  }
  return true;
}

}  // namespace

std::vector<Body> random_bodies(const RandomPlacement& placement, const Suspension& surroundings) {
  if (!(placement.inner_radius >= 0.0 && placement.outer_radius >= placement.inner_radius)) {
    throw InputError(concat("random placement: the centres cannot lie between the radii ", placement.inner_radius,
                            " and ", placement.outer_radius, "; give 0 <= inner_radius <= outer_radius."));
  }
  Random random(placement.seed);
  std::vector<Body> bodies;
  while (static_cast<int>(bodies.size()) < placement.count) {
    bool placed = false;
    for (int tries = 0; tries < placement.max_tries && !placed; ++tries) {
      const Body body = random.body(placement);
      const double distance = placement.min_distance;
      placed = apart(body, bodies, distance) && apart(body, surroundings, distance) &&
               (!surroundings.container || gap(body, *surroundings.container).value > distance);
      if (placed) bodies.push_back(body);
    }
    if (placed) continue;
    throw NumericalError(concat("random placement: after ", bodies.size(), " of ", placement.count,
                                " bodies no place was found for another one in ", placement.max_tries,
                                " tries (min_distance = ", placement.min_distance, ", seed = ", placement.seed,
                                "); try another seed, fewer or smaller bodies or a smaller min_distance."));
  }
  return bodies;
}

Suspension random_annulus(const Annulus& annulus, RandomPlacement placement) {
  placement.inner_radius = annulus.inner_radius;
  placement.outer_radius = annulus.outer_radius;
  const std::vector<Body> bodies = random_bodies(placement, between_walls({}, annulus));
  return between_walls({bodies.begin(), bodies.end()}, annulus);
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
