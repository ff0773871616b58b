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

// Pairs whose estimated error is above 0.1 and bodies whose is above 1e-3, the largest first. With the width w of a gap in a boundary's
// parameter and N equal steps, densities are resolved like exp(-N w), with a cluster of N_k nodes there like
// exp(-pi^2 N_k / (2 ln(8/w))); the error of the gap's rate, which is (gap/R)^1.5 small itself, is 1500 times that, as
// measured of discs at gaps of 1e-2 and 1e-3 of their radius; 1 and more means nothing of it is resolved. Of a body alone
// the error is that of ShapeResolution.
std::vector<Shortfall> shortfalls(const Suspension& bodies, const std::vector<Discretisation>& nodes, ShapeResolution& alone);

// "bodies 3 and 5 at a gap of 0.01: ..." with the estimated error and what to write instead.
std::string describe(const Shortfall& shortfall);

}  // namespace stokes
