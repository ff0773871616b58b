// Bodies at random places, none too close to another or to a wall.
#pragma once

#include <cstdint>
#include <vector>

#include "annulus.hpp"

namespace stokes {

// How the distance r of a body's centre from the origin is distributed.
enum class RadialDensity {
  uniform_radius,  // r uniform: the number of bodies per area falls like 1/r
  uniform_area,    // r^2 uniform: equally many bodies per area
};

// Equal ellipses (discs) with centres between two circles around the origin. Polar angle and orientation are
// uniform.
struct RandomPlacement {
  Shape shape;
  int count = 0;
  double inner_radius = 0.0, outer_radius = 0.0;  // of the centres
  RadialDensity density = RadialDensity::uniform_radius;
  double min_distance = 0.0;  // between two bodies, and between a body and a wall; touching is not apart
  std::uint64_t seed = 0;
  int max_tries = 100000;     // for one body
};

// Places the bodies one after the other, each tried until it is farther than min_distance from those placed
// before, from the bodies and walls of `surroundings` and from its container. The same for the same seed on
// every machine, up to the rounding of its arithmetic. Cost: the tries times the number of bodies there.
// InputError for radii out of order, NumericalError when max_tries did not find a place for a body.
std::vector<Body> random_bodies(const RandomPlacement& placement, const Suspension& surroundings = {});

// Random bodies between the walls of an annulus: placement.inner_radius and outer_radius are set to those of
// the walls, as in the paper, so that next to a wall only bodies along it find a place.
Suspension random_annulus(const Annulus& annulus, RandomPlacement placement);

// `count` copies of a body, their centres equally spaced on a circle around the origin, the first on the
// positive x axis, each turned with its polar angle.
std::vector<Body> ring(const Body& body, int count, double radius);

// Area of the free bodies over that of the annulus.
double area_fraction(const Suspension& bodies, const Annulus& annulus);

}  // namespace stokes
