// Removes overlaps: bodies that are too close push each other, and walls push them, until all gaps are wide enough.
//
// Minimises E = (1/2) Sum over pairs and walls of max(0, wanted gap - gap)^2 over centres and angles by damped dynamics
// (FIRE: Bitzek, Koskinen, Gaehler, Moseler and Gumbsch, Phys. Rev. Lett. 97, 170201, 2006). Angles count as lengths, times
// the body's circumradius. Below the densest random packing, an area fraction of .84 for discs without walls, a minimum with
// E = 0 is found from nearly every start.
#pragma once

#include "packing.hpp"
#include "region.hpp"

namespace stokes {

struct Clearance {
  double bodies = 0.0, walls = 0.0;  // length
};

// Moves the bodies until each gap exceeds its clearance and returns true. If that takes more than 20000 steps, it tries
// again, four times at most, after random displacements of up to a tenth of the smallest semi-axis, and then returns false.
// The result depends only on the arguments. Cost: a few thousand evaluations of the gaps of neighbours.
bool relax(std::vector<Body>& bodies, const Region& region, const Clearance& clearance, UniformRandom& random);

}  // namespace stokes
