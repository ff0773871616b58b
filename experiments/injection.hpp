// Section 4.3: between two walls, fluid is injected until t = 4 and drawn back until t = 8, past 50 free
// discs and a ring of 41 fixed ones.
//
// The paper does not give the start, the step and the separation. They were inferred from its figures. The start is that of
// seed 1000: distances from the axis are uniform in [0.75, 4.75], gaps to the walls exceed a radius, and gaps to other
// discs and the ring exceed h. dt = 0.08, delta = 0.25h.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>

#include "case_run.hpp"
#include "packing.hpp"

namespace stokes {

inline constexpr Shape injection_disc{0.25, 0.25};
inline constexpr int injection_points = 32;
inline constexpr int free_count = 50, ring_count = 41;  // bodies 0 to 49, then 50 to 90; the inner wall is the last

// h of the paper, the unit of lengths.
inline double injection_spacing() { return injection_disc.perimeter() / injection_points; }

// The times of the published frames. Those of Figure 6 are labelled with the next multiple of 2 (but for t = 0).
inline const std::vector<double> frame_times = {0.0, 1.92, 3.92, 5.92, 7.92};
inline const std::vector<double> stress_times = {0.0, 2.0, 3.92, 4.08, 5.92, 7.92};  // of Figure 7

struct Injection {
  double separation_over_h = 0.25;
  ContactModel contact = ContactModel::gap;
  double time_step = 0.08, reverse_at = 4.0, end_time = 8.0;
  int wall_points = 128;
};

inline Annulus injection_annulus(const Injection& parameters) {
  Annulus annulus{0.5, 10.0, parameters.wall_points};
  annulus.inner_surface.source = annulus.outer_surface.source = pi;
  return annulus;
}

inline Suspension injection_bodies(const Injection& parameters) {
  const Annulus annulus = injection_annulus(parameters);
  const Body fixed{injection_disc, {}, 0.0, 0.0, true};
  const std::vector<Body> held = ring(fixed, ring_count, 5.0);
  const PlacedBodies placed = place_randomly({.shape = injection_disc,
                                              .count = free_count,
                                              .nearest = 0.75,
                                              .farthest = 4.75,
                                              .wall_clearance = injection_disc.a,
                                              .body_clearance = injection_spacing(),
                                              .seed = 1000},
                                             annulus, held);
  Suspension bodies;
  bodies.assign(placed.bodies.begin(), placed.bodies.end());
  bodies.insert(bodies.end(), held.begin(), held.end());
  return between_walls(std::move(bodies), annulus);
}

// The paper's interference volumes: polygons of the nodes, with frozen hit time.
inline Case injection_case(const Injection& parameters) {
  Case c = case_between(injection_annulus(parameters));
  c.points_per_body = injection_points;
  c.gmres_tolerance = 1e-6;
  c.contact = parameters.contact;
  if (c.contact == ContactModel::stiv) c.stiv_vertices = injection_points, c.stiv_gradient = StivGradient::frozen;
  c.min_separation_length = parameters.separation_over_h * injection_spacing();
  c.time_step = parameters.time_step;
  c.end_time = parameters.end_time;
  c.reverse_at = parameters.reverse_at;
  return c;
}

// Number of free discs in contact in the step from this state.
inline double discs_in_contact(const RecordedRun& run, std::size_t state) {
  double touching = 0.0;
  for (int i = 0; i < free_count; ++i) touching += run.in_contact(state, i);
  return touching;
}

// Distances of the free discs from their starts in a state.
inline std::vector<double> distances_from_start(const RecordedRun& run, std::size_t state) {
  std::vector<double> distance;
  for (int i = 0; i < free_count; ++i)
    distance.push_back(std::abs(run.bodies()[state][i].pose.centre - run.bodies()[0][i].pose.centre));
  return distance;
}

inline void add_returns(const std::vector<double>& distance, Quantities& row) {
  row.push_back({"mean_return", std::accumulate(distance.begin(), distance.end(), 0.0) / free_count});
  row.push_back({"median_return", median(distance)});
  row.push_back({"largest_return", *std::max_element(distance.begin(), distance.end())});
}

}  // namespace stokes
