// Estimates from the geometry, before anything is solved, what fixed nodes do not resolve.
#pragma once

#include <string>
#include <vector>

#include "resolution.hpp"

namespace stokes {

struct Shortfall {
  int a, b;      // a body and another or container_index; for a body alone both are this body
  double gap;    // of a pair
  double error;  // estimated; of a pair: of the rate of its gap, relative; of a body: of its velocities, over rate and size
};

// Pairs with an estimated error above 0.1 and bodies with one above 1e-3, the largest first. Velocities that nodes resolve
// by a number of digits (refinement.hpp) have errors exp(-digits). The rate of a gap under a force is the gap_mobility, so
// its relative error is exp(-digits) / gap_mobility. If this is 1 or more, nothing of the rate is resolved. For two discs
// with 32 to 128 nodes at equal steps it is 1.5 to 3 times the actual error where it passes 0.1. The error of a body alone
// is that of ShapeResolution.
std::vector<Shortfall> shortfalls(const Suspension& bodies, const std::vector<Discretisation>& nodes,
                                  ShapeResolution& alone);

// "bodies 3 and 5 at a gap of 0.01: ..." with the estimated error and what to write instead.
std::string describe(const Shortfall& shortfall);

}  // namespace stokes
