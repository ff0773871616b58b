// What fixed nodes do not resolve, from the geometry, before anything is solved.
#pragma once

#include <string>
#include <vector>

#include "resolution.hpp"

namespace stokes {

struct Shortfall {
  int a, b;      // a body and another, container_index, or, of a body alone, itself
  double gap;    // of a pair
  double error;  // estimated: of a pair relative to the rate of its gap; of a body alone of its velocities in units of rate and size
};

// Pairs whose estimated error is above 0.1 and bodies whose is above 1e-3, the largest first. Velocities that nodes resolve
// by a number of digits (refinement.hpp) have errors exp(-digits), and the rate of a gap, which under a force is the
// gap_mobility, has the relative error exp(-digits) / gap_mobility. Where that is 1 and more nothing of the rate is resolved.
// Of two discs at equal steps it is 1.5 to 3 times the error for 32 to 128 nodes where that passes 0.1. Of a body alone
// the error is that of ShapeResolution.
std::vector<Shortfall> shortfalls(const Suspension& bodies, const std::vector<Discretisation>& nodes,
                                  ShapeResolution& alone);

// "bodies 3 and 5 at a gap of 0.01: ..." with the estimated error and what to write instead.
std::string describe(const Shortfall& shortfall);

}  // namespace stokes
