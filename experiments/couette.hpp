// Section 4.4: ellipses of length 0.75 between cylinders of radii 5, at rest, and 10, rotating.
#pragma once

#include <cmath>
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

inline constexpr int couette_seeds = 9;  // at most, of each suspension

// Those of Tables 2 and 3.
inline const std::vector<CouetteSuspension> couette_suspensions = {
    {5, 1, 27}, {10, 1, 53}, {15, 1, 80}, {5, 3, 80}, {10, 3, 160}, {15, 3, 240}, {5, 6, 160}, {10, 6, 320}};

inline Annulus couette_annulus(int wall_points = 1024) {
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

// Results of couette_run beside those of another experiment.
inline Results couette_results(const Results& other) { return {other.folder().parent_path(), "couette_run"}; }

// The runs of a suspension that are there, one for each seed.
inline std::vector<std::string> finished_runs(const Results& runs, const CouetteSuspension& suspension) {
  std::vector<std::string> names;
  for (int seed = 1; seed <= couette_seeds; ++seed)
    if (const std::string name = CouetteCase{suspension, seed, ""}.name(); runs.has(name)) names.push_back(name);
  return names;
}

// A number of the runs with different starts of one suspension.
struct SeedSpread {
  int seeds = 0;
  double mean = std::nan(""), minimum = std::nan(""), maximum = std::nan("");
};

inline SeedSpread over_seeds(const Results& runs, const CouetteSuspension& suspension, const std::string& quantity) {
  SeedSpread spread;
  double sum = 0.0;
  for (const std::string& name : finished_runs(runs, suspension)) {
    const double value = runs.quantity(name, quantity);
    spread.minimum = std::fmin(spread.minimum, value), spread.maximum = std::fmax(spread.maximum, value);
    sum += value;
    ++spread.seeds;
  }
  if (spread.seeds > 0) spread.mean = sum / spread.seeds;
  return spread;
}

// A table of the paper from the means over the second revolution: table.csv, and for `verify` one file a suspension and
// a further one where there are at least three seeds, whose spread then says something.
inline void collect_table(const Results& results, const std::string& quantity, bool with_discs) {
  constexpr int enough = 3;
  const Results runs = couette_results(results);
  const std::string experiment = results.folder().filename().string();
  std::vector<std::vector<double>> rows;
  for (const CouetteSuspension& s : couette_suspensions) {
    if (s.lambda == 1 && !with_discs) continue;
    const SeedSpread spread = over_seeds(runs, s, quantity);
    const double published = published_value(experiment, s.name(), "mean");
    rows.push_back({static_cast<double>(s.percent), static_cast<double>(s.lambda), static_cast<double>(spread.seeds),
                    spread.mean, spread.minimum, spread.maximum, published});
    if (spread.seeds > 0) results.write(s.name(), {{"seeds", static_cast<double>(spread.seeds)}, {"mean", spread.mean}});
    if (spread.seeds >= enough)
      results.write(s.name() + "_spread", {{"minimum", spread.minimum}, {"maximum", spread.maximum}});
  }
  results.write("table", {"phi", "lambda", "seeds", "mean", "minimum", "maximum", "published"}, rows);
}

}  // namespace stokes
