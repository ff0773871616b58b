// Section 4.4: ellipses of length 0.75 between cylinders of radii 5, at rest, and 10, rotating.
#pragma once

#include <string>
#include <vector>

#include "annulus.hpp"
#include "experiment.hpp"
#include "packing.hpp"
#include "rheology.hpp"

namespace stokes {

inline constexpr double couette_rotation = 2.0, couette_revolution = pi;  // of the outer cylinder
inline constexpr double couette_length = 0.75;                            // of every body

struct CouetteSuspension {
  int percent, lambda, count;  // area fraction, aspect ratio, bodies

  std::string name() const { return concat("phi", percent, "_lambda", lambda); }
  Shape shape() const { return {0.5 * couette_length, 0.5 * couette_length / lambda}; }
};

// Those of Tables 2 and 3.
inline const std::vector<CouetteSuspension> couette_suspensions = {
    {5, 1, 27}, {10, 1, 53}, {15, 1, 80}, {5, 3, 80}, {10, 3, 160}, {15, 3, 240}, {5, 6, 160}, {10, 6, 320}};

inline Annulus couette_annulus(int wall_points = 256) {
  Annulus annulus{5.0, 10.0, wall_points};
  annulus.outer_surface.angular_velocity = couette_rotation;
  return annulus;
}

// The smallest allowed gap: a tenth of the largest spacing of nodes, that of the outer wall.
inline constexpr double couette_separation = 0.0245;

// As in the paper, distances from the axis and angles uniform; rejected are not only bodies that touch, but all that
// are closer than the smallest allowed gap, which a single step could not part.
inline Suspension couette_bodies(const CouetteSuspension& suspension, std::uint64_t seed) {
  RandomPlacement placement{.shape = suspension.shape(), .count = suspension.count};
  placement.min_distance = couette_separation;
  placement.seed = seed;
  return random_annulus(couette_annulus(), placement);
}

// Finished runs are named suspension, "_seed", number, variant.
struct CouetteCase {
  CouetteSuspension suspension;
  int seed;
  std::string variant;  // empty, or what differs

  std::string name() const { return concat(suspension.name(), "_seed", seed, variant.empty() ? "" : "_", variant); }
};

// The seeds of a suspension whose runs are there.
inline std::vector<int> finished_seeds(const Results& runs, const CouetteSuspension& suspension) {
  std::vector<int> seeds;
  for (int seed = 1; seed <= 100; ++seed)
    if (runs.has(CouetteCase{suspension, seed, ""}.name())) seeds.push_back(seed);
  return seeds;
}

}  // namespace stokes
