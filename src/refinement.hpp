// More nodes where bodies are close to each other.
//
// Across a gap g between boundaries of curvature radii R_A and R_B the density varies over
//   w = sqrt(2 R g + g^2),   1/R = 1/R_A + 1/R_B   (R_B < 0 for a container),
// and two contacts as far apart as the bodies of a suspension are long are equally sharp. Instead of more nodes
// everywhere, a cluster of as many nodes as the body has is put where it is close: its spacing there is a fixed
// part of w. With 32 nodes, a cluster each on two ellipses 4.75:1, tip on flank, gives the normal mobility at
// gaps down to a thirtieth of the short semi-axis to better than 1 %; 128 equally spaced nodes miss it by half.
//
// Clusters do not help a slender body whose own equations N nodes do not resolve, which is an error in its mobility of
// about 0.15 exp(-N atanh(b/a)). It does not matter beside most mobilities, but it does along a flank, where a gap g of
// the curvature 1/R leaves (g/R)^1.5 / (3 sqrt(2) pi): where the error is more than a tenth of that, the body gets two or
// four times as many nodes. With larger errors the mobilities between several bodies pressed together are not symmetric,
// and iterations for the contact forces converge slowly or not at all.
#pragma once

#include <vector>

#include "suspension.hpp"

namespace stokes {

enum class Refine {
  none,  // every body has points_per_body nodes at equal steps
  near,  // and clusters where the nodes are too far apart for the gap to a neighbour
};

// Nodes of every body when all have `points`, or their own number.
std::vector<Discretisation> equal_nodes(const Suspension& bodies, int points);

// Nodes of every body, by the poses alone. `fineness` >= 1 divides the spacing wanted. Walls (bodies with nodes of
// their own) keep theirs. Cost: a neighbour search and a gap for each pair found.
std::vector<Discretisation> refined_nodes(const Suspension& bodies, int points, double fineness);

}  // namespace stokes
