// Section 4.3: fluid is injected through both walls of an annulus until t = 4 and drawn back until t = 8, past 50 free
// discs and a ring of 41 fixed ones.
#pragma once

#include "case_run.hpp"
#include "packing.hpp"

namespace stokes {

inline constexpr Shape injection_disc{0.25, 0.25};
inline constexpr int injection_points = 32;
inline constexpr int free_count = 50, ring_count = 41;  // bodies 0 to 49, then 50 to 90; the inner wall is the last

// h of the paper, which lengths are given in: also where a run takes other points.
inline double injection_spacing() { return injection_disc.perimeter() / injection_points; }

struct Injection {
  std::uint32_t seed = 1000;
  double separation_over_h = 2.0;
  ContactModel contact = ContactModel::gap;
  Refine refine = Refine::near;
  double time_step = 0.02, reverse_at = 4.0, end_time = 8.0;
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
                                              .seed = parameters.seed},
                                             annulus, held);
  Suspension bodies;
  bodies.assign(placed.bodies.begin(), placed.bodies.end());
  bodies.insert(bodies.end(), held.begin(), held.end());
  return between_walls(std::move(bodies), annulus);
}

inline Case injection_case(const Injection& parameters) {
  Case c = case_between(injection_annulus(parameters));
  c.points_per_body = injection_points;
  c.refine = parameters.refine;
  c.gmres_tolerance = 1e-6;
  c.contact = parameters.contact;
  c.min_separation_length = parameters.separation_over_h * injection_spacing();
  c.time_step = parameters.time_step;
  c.end_time = parameters.end_time;
  c.reverse_at = parameters.reverse_at;
  return c;
}

}  // namespace stokes
