// Section 4.4: ellipses of length 0.75 between cylinders of radii 5, at rest, and 10, rotating.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "annulus.hpp"
#include "case_run.hpp"
#include "packing.hpp"
#include "rheology.hpp"

namespace stokes {

inline constexpr double couette_rotation = 2.0, couette_revolution = pi;  // of the outer cylinder
inline constexpr double couette_length = 0.75;                            // of every body

inline constexpr double couette_separation = 0.0245;  // smallest allowed gap: a tenth of the spacing on the outer wall

struct CouetteSuspension {
  int percent, lambda, count;  // area fraction, aspect ratio, bodies
  std::uint32_t paper_seed;
  double wall_clearance, body_clearance;  // at the start
  int steps_a_revolution;
  double revolutions = 2.0;  // after which the published curves end

  std::string name() const { return concat("phi", percent, "_lambda", lambda); }
  Shape shape() const { return {0.5 * couette_length, 0.5 * couette_length / lambda}; }
};

// The suspensions of Tables 2 and 3. With these clearances the published starts come out, body by body (seed 1000) or
// in their first order parameter and viscosity (seed 1001). They are half a body's length and about the spacing of the 32
// nodes on a body, .0522 (3:1) and .0486 (6:1); or the spacing of the 256 nodes on the outer wall, .245, and that of a
// disc, .0736.
inline const std::vector<CouetteSuspension> couette_suspensions = {
    {5, 1, 27, 1001, 0.0736, 0.0245, 250},   {10, 1, 54, 1001, 0.245, 0.0736, 250},
    {15, 1, 80, 1001, 0.245, 0.0736, 250},   {5, 3, 80, 1000, 0.375, 0.0518, 1000},
    {10, 3, 160, 1000, 0.375, 0.0518, 1000}, {15, 3, 240, 1001, 0.245, 0.0518, 250, 1.88},
    {5, 6, 160, 1000, 0.375, 0.0482, 1000},  {10, 6, 320, 1000, 0.375, 0.0482, 1000}};

inline const CouetteSuspension& couette_suspension(const std::string& name) {
  return *std::find_if(couette_suspensions.begin(), couette_suspensions.end(),
                       [&](const CouetteSuspension& s) { return s.name() == name; });
}

inline Annulus couette_annulus(int wall_points = 1024) {
  Annulus annulus{5.0, 10.0, wall_points};
  annulus.outer_surface.angular_velocity = couette_rotation;
  return annulus;
}

// Distances from the axis and angles are uniform.
inline PlacedBodies couette_placement(const CouetteSuspension& suspension, std::uint32_t seed) {
  const Annulus annulus = couette_annulus();
  return place_randomly({.shape = suspension.shape(),
                         .count = suspension.count,
                         .nearest = annulus.inner_radius,
                         .farthest = annulus.outer_radius,
                         .wall_clearance = suspension.wall_clearance,
                         .body_clearance = suspension.body_clearance,
                         .seed = seed},
                        annulus);
}

inline constexpr int couette_seeds = 9;  // other starts, at most, of each suspension

// One run: the paper's start, or another one by the same rule.
struct CouetteCase {
  CouetteSuspension suspension;
  int seed = 0;         // 0: the paper's
  std::string variant{};  // empty, or what differs

  std::string name() const {
    const std::string start = seed == 0 ? "paper" : concat("seed", seed);
    return concat(suspension.name(), "_", start, variant.empty() ? "" : "_", variant);
  }
  Suspension bodies() const {
    const std::uint32_t number = seed == 0 ? suspension.paper_seed : static_cast<std::uint32_t>(seed);
    const std::vector<Body> placed = couette_placement(suspension, number).bodies;
    return between_walls({placed.begin(), placed.end()}, couette_annulus());
  }
};

inline Case couette_case(const CouetteCase& chosen) {
  Case c = case_between(couette_annulus());
  c.points_per_body = chosen.variant == "points64" ? 64 : 32;
  c.time_step = couette_revolution / chosen.suspension.steps_a_revolution;
  if (chosen.variant == "halfstep") c.time_step /= 2.0;
  if (chosen.variant == "quarterstep") c.time_step /= 4.0;
  if (chosen.variant.starts_with("ab2_")) {
    c.integrator = IntegratorKind::ab2;
    c.time_step = couette_revolution / (chosen.variant == "ab2_250" ? 250 : 500);
  }
  c.end_time = (chosen.variant == "quick" ? 0.02 : chosen.suspension.revolutions) * couette_revolution;
  c.min_separation_length = couette_separation;
  c.contact = chosen.variant == "stiv" ? ContactModel::stiv : ContactModel::gap;
  c.lcp_matrix = LcpMatrix::near;
  c.refine = Refine::near;
  c.gmres_tolerance = 1e-5;
  c.output_every = 20;
  return c;
}

// The results of couette_run beside those of another experiment.
inline Results couette_results(const Results& other) { return {other.folder().parent_path(), "couette_run"}; }

// The existing runs from other starts of a suspension.
inline std::vector<std::string> finished_seeds(const Results& runs, const CouetteSuspension& suspension) {
  std::vector<std::string> names;
  for (int seed = 1; seed <= couette_seeds; ++seed)
    if (const std::string name = CouetteCase{suspension, seed, ""}.name(); runs.has(name)) names.push_back(name);
  return names;
}

// The same, after the run from the paper's start.
inline std::vector<std::string> finished_runs(const Results& runs, const CouetteSuspension& suspension) {
  std::vector<std::string> names = finished_seeds(runs, suspension);
  if (const std::string name = CouetteCase{suspension}.name(); runs.has(name)) names.insert(names.begin(), name);
  return names;
}

// A mean over the second revolution from the paper's start; NaN without that run.
inline double from_paper_start(const Results& runs, const CouetteSuspension& suspension, const std::string& quantity) {
  const std::string name = CouetteCase{suspension}.name();
  return runs.has(name) ? runs.quantity(name, quantity) : std::nan("");
}

// A table of the paper, of means over the second revolution: table.csv, with the spread over other starts, and one file for
// each suspension for `verify`.
inline void collect_table(const Results& results, const std::string& quantity, bool with_discs) {
  const Results runs = couette_results(results);
  const std::string experiment = results.folder().filename().string();
  std::vector<std::vector<double>> rows;
  for (const CouetteSuspension& s : couette_suspensions) {
    if (s.lambda == 1 && !with_discs) continue;
    const double mean = from_paper_start(runs, s, quantity);
    double sum = 0.0, minimum = std::nan(""), maximum = std::nan("");
    const std::vector<std::string> seeds = finished_seeds(runs, s);
    for (const std::string& name : seeds) {
      const double value = runs.quantity(name, quantity);
      sum += value, minimum = std::fmin(minimum, value), maximum = std::fmax(maximum, value);
    }
    const double count = static_cast<double>(seeds.size());
    rows.push_back({static_cast<double>(s.percent), static_cast<double>(s.lambda),
                    published_value(experiment, s.name(), "mean"), mean, count, sum / count, minimum, maximum});
    if (!std::isnan(mean)) results.write(s.name(), {{"mean", mean}});
  }
  results.write("table", {"phi", "lambda", "published", "mean", "seeds", "mean_of_seeds", "minimum", "maximum"}, rows);
}

}  // namespace stokes
