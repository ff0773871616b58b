// Pairs of bodies that may touch, each other or the container, and the closest pair, without looking at all pairs.
#pragma once

#include <limits>
#include <utility>
#include <vector>

#include "suspension.hpp"

namespace stokes {

// All pairs (i, j), i < j, in increasing order, whose circles come within `distance` of each other while the
// centres move linearly and at the same time from `start` (tau = 0) to `end` (tau = 1):
//   min over tau of |c_j(tau) - c_i(tau)| - radius_i - radius_j <= distance.
// With circumradii these are all pairs that first_hit() can report for a threshold somewhat below
// `distance` (by its tolerance), and, for start = end, all pairs whose gap is at most `distance`.
// start, end, radius: one entry per body, radii and distance >= 0. Sizes and distances may differ by
// any factors. Cost: O(n) plus the pairs for bodies of similar size spread evenly, 0.1 s for 1e5 of them;
// O(n) more for each further power of two among the sizes (of the boxes swept).
// Raises InputError for arrays of different length and for a radius or distance that is negative or above
// 1e150, NumericalError for positions that are not finite.
std::vector<std::pair<int, int>> neighbour_pairs(const std::vector<Complex>& start,
                                                 const std::vector<Complex>& end,
                                                 const std::vector<double>& radius, double distance);

// What may touch in a step from the suspension's poses to `trial`: the pairs of bodies, not both fixed, whose
// circumscribed circles come within `distance`, and with (a, container_index) the mobile bodies a whose circle
// ends within `distance` of the container's wall, or across it. In increasing order.
// trial: one pose per body. Cost and errors as above.
std::vector<std::pair<int, int>> contact_candidates(const Suspension& start, const std::vector<Pose>& trial,
                                                    double distance);

struct ClosestPair {
  int a = -1, b = -1;
  double gap = std::numeric_limits<double>::infinity();
};

// The pair a < b of smallest signed gap, the first such pair in increasing order if several tie; b may be
// container_index. Two fixed bodies, or a fixed body and the container, are no pair; the defaults above if there is
// none. Cost: a few neighbour searches and a gap for each pair closer, as circles, than the smallest gap found
// before it. Raises NumericalError for a gap that is not a number.
ClosestPair smallest_gap(const Suspension& suspension);

}  // namespace stokes
