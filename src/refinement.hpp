// Nodes concentrated where bodies are close to each other and to walls.
//
// Across a gap g between boundaries the density varies over the width W (facing.hpp) at the contact, and at a distance from
// the contact over this distance. A cluster of nodes (node_map.hpp) of that width on either boundary resolves it with nodes
// at equal steps of sigma = asinh(t/w), w = W/|zeta'|, in which the density is analytic for |Im sigma| < pi/2. The
// velocities of the bodies, smooth functionals of the density, have errors exp(-pi^2/D) at steps D = 2 ln(8/w)/N_k. A
// cluster therefore has
//   N_k = (2/pi^2) ln(8/w) ln(1/tolerance)
// nodes. None is needed where the N_0 equal steps resolve W by themselves, w > ln(1/tolerance)/N_0.
//
// Clusters do not help a slender body whose own equations N nodes do not resolve. The error of its mobility is then about
// 0.15 exp(-N atanh(b/a)). This is small beside most mobilities, but not along a flank, where a gap g of the curvature 1/R
// leaves the mobility (g/R)^1.5 / (3 sqrt(2) pi). If the error is more than a tenth of that, the body gets two or four
// times as many nodes. With larger errors the mobilities between several bodies pressed together are not symmetric, and
// iterations for the contact forces converge slowly or not at all.
#pragma once

#include <vector>

#include "fronts.hpp"
#include "suspension.hpp"

namespace stokes {

enum class Refine {
  none,  // every body has points_per_body nodes at equal steps
  near,  // and clusters where equal steps are too sparse for the gap to a neighbour
};

// Nodes of every body when all have `points`, or their own number.
std::vector<Discretisation> equal_nodes(const Suspension& bodies, int points);

// The tolerance of Refine::near: mobilities across gaps down to a hundredth of a body are right to 1 %.
inline constexpr double near_tolerance = 1e-6;

// Nodes of every body, by the poses alone. Walls (bodies with nodes of their own) keep theirs. Cost: a neighbour
// search and a facing for each pair found.
std::vector<Discretisation> refined_nodes(const Suspension& bodies, int points, double tolerance);

// Number of natural digits to which nodes resolve the flow between a boundary and a neighbour in front of it: velocities
// have errors exp(-digits). Equal steps give N_0 w digits, a cluster there pi^2 N_k / (2 ln(8/w)).
double resolved_digits(const Shape& shape, const Discretisation& nodes, const Front& front);
// Mobility across a gap in units of its radius of curvature: (g kappa)^1.5 / (3 sqrt(2) pi).
double gap_mobility(double relative_gap);
// The gap from which on W, which is at least the gap, is wide enough for equal steps.
double resolved_distance(const Shape& shape, int points, double tolerance);

// Nodes N_0 of a boundary, and a factor on the digits that a tolerance requires of it.
struct Resolution {
  int points;
  double factor = 1.0;
};

// The error of velocities at which the rate of a gap is known to about a hundredth; at least the round-off of rates. Under
// a force this rate is the gap_mobility times the rate without the other boundary.
double rate_tolerance(double relative_gap);

struct ClusteredNodes {
  std::vector<Discretisation> nodes;
  std::vector<double> relative_gap;  // the smallest gap of each boundary in units of its radius of curvature; 2 if none
};

// Circumradii of the bodies and the container in units of the smallest free body's, at least 1. A boundary R times as large
// makes velocities R times as large. Its effect on the smallest body has that body's accuracy if its own relative error is
// R times smaller.
std::vector<double> relative_sizes(const Suspension& bodies);
// That relative error, but not below round-off.
double own_tolerance(double accuracy, double relative_size);

// Nodes of every body and of the container, if there is one. Each boundary has the clusters that its resolution needs for
// the own_tolerance and for the rates of the gaps (rate_tolerance), but in clusters never below `least_of_clusters`. N_0 is
// larger where this saves more nodes of clusters.
ClusteredNodes clustered_nodes(const Suspension& bodies, const std::vector<Resolution>& resolution, double tolerance,
                               double least_of_clusters = 0.0);

}  // namespace stokes
