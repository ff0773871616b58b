// Bodies at random places between two concentric walls, by the rule that made the paper's initial configurations.
//
// Each try for one body draws three numbers u1, u2, u3, uniform in [0, 1): its centre is at the distance
// nearest + (farthest - nearest) u1 from the axis and at the polar angle 2 pi u2, its own angle is 2 pi u3 (drawn for
// discs, too). The try is rejected when the body is too close to a wall or to a body placed before.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "annulus.hpp"

namespace stokes {

// The 32-bit Mersenne Twister with doubles of 53 random bits, u = ((x >> 5) 2^26 + (y >> 6)) / 2^53 of two successive
// outputs x and y: MATLAB's rng(seed) and rand. The same bits with every compiler.
class UniformRandom {
 public:
  explicit UniformRandom(std::uint32_t seed) : generator_(seed) {}
  double operator()();  // in [0, 1)

 private:
  std::mt19937 generator_;
};

struct RandomPlacement {
  Shape shape;
  int count = 0;
  double nearest = 0.0, farthest = 0.0;  // distance of a centre from the axis
  double wall_clearance = 0.0;  // smallest gap to a wall; it must be larger than this
  double body_clearance = 0.0;  // smallest gap to another body, a held one included; it must be larger than this
  std::uint32_t seed = 0;
  int max_tries = 100000;  // for one body
};

struct PlacedBodies {
  std::vector<Body> bodies;  // in the order of placing
  int tries = 0;             // up to the last body placed
};

// Places the bodies of `placement` between the walls and away from the bodies `held`. Cost: tries times bodies.
// InputError unless 0 <= nearest <= farthest. NumericalError if max_tries tries found no place for a body.
PlacedBodies place_randomly(const RandomPlacement& placement, const Annulus& annulus, const std::vector<Body>& held = {});

// `count` copies of a body, their centres equally spaced on a circle around the origin, the first on the
// positive x axis, each turned with its polar angle.
std::vector<Body> ring(const Body& body, int count, double radius);

// Area of the free bodies over that of the annulus.
double area_fraction(const Suspension& bodies, const Annulus& annulus);

}  // namespace stokes
