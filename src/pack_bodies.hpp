// Random suspensions, up to dense ones: bodies of given shapes at random places in a region, with clearances.
#pragma once

#include <cstdint>
#include <vector>

#include "neighbours.hpp"
#include "region.hpp"
#include "relaxation.hpp"

namespace stokes {

struct ShapeShare {
  Shape shape;
  double share = 1.0;  // of the number of bodies; only ratios matter
};

struct PackingRequest {
  Region region;
  std::vector<ShapeShare> shapes;
  // At least one of these two. With both, every size is multiplied by the factor that gives the area fraction.
  int number = 0;              // 0: the number that comes nearest to the area fraction
  double area_fraction = 0.0;  // of the bodies in the region; 0: the one that the number gives
  double polydispersity = 0.0;  // standard deviation of the sizes of a shape over their mean; they are uniformly distributed
  Clearance clearance;          // every gap is larger
  std::uint32_t seed = 1;
};

struct Packing {
  std::vector<Body> bodies;  // the largest first
  double area_fraction = 0.0;
  bool relaxed = false;  // overlaps were removed; otherwise each body has a uniformly random place among the free ones
  ClosestPair closest;       // of two bodies
  double wall_gap = 0.0;     // the smallest
};

// Shapes of the requested bodies, the largest first. InputError for an impossible request: neither number nor
// area fraction, more than a million bodies, an area fraction of 1 or more, a polydispersity outside [0, .5].
std::vector<Shape> requested_shapes(const PackingRequest& request, UniformRandom& random);

// Places the bodies one after the other, the largest first, at the first of 1000 random places and angles where their gaps
// exceed the clearances; each try draws three numbers. If no try succeeds for some body, it and all later ones are put
// anywhere, and overlaps are removed (relaxation.hpp). All gaps are computed again at the end. The result depends
// only on the request. InputError as above; NumericalError if overlaps remain.
Packing pack_bodies(const PackingRequest& request);

}  // namespace stokes
