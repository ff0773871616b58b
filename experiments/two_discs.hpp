// Section 4.1: two free discs of radius 0.5 in shear, 32 points each, the second one at the origin.
#pragma once

#include <algorithm>
#include <vector>

#include "simulation.hpp"

namespace stokes {

struct TwoDiscs {
  double rate = 1.0;                 // u = (rate y, 0)
  Complex first{-8.0, 0.5};          // start of the left disc
  double separation_over_h = 0.0;    // delta / h, h = pi/32 the point spacing; 0 with contact = none
  double time_step = 0.2, end_time = 40.0;
  std::optional<double> reverse_at;
  TimeCounting time_counting = TimeCounting::exact;
};

struct TwoDiscRun {
  std::vector<double> time;
  std::vector<Complex> left, right;   // centres at the start of each step, and at the end
  std::vector<double> gap_over_h;
  std::vector<int> ncp_iterations;    // of each step
  std::vector<double> multiplier;     // contact force of each step, 0 without
  double worst_force_balance = 0.0;   // largest net contact force or torque (about the origin)
  long steps = 0, contact_steps = 0, gmres_iterations = 0, largest_ncp_iterations = 0;
  double smallest_gap_over_h = 0.0;
  int factorisations = 0;
};

inline constexpr int disc_points = 32;
inline constexpr double disc_radius = 0.5;
inline constexpr double disc_spacing = 2.0 * pi * disc_radius / disc_points;  // h

inline TwoDiscRun run_two_discs(const TwoDiscs& parameters) {
  SimulationOptions options;
  options.stepper.flow = {FlowKind::shear, parameters.rate};
  options.stepper.points_per_body = disc_points;
  options.stepper.separation = parameters.separation_over_h * disc_spacing;
  options.time_step = parameters.time_step;
  options.end_time = parameters.end_time;
  options.reverse_at = parameters.reverse_at;
  options.time_counting = parameters.time_counting;
  const Shape disc{disc_radius, disc_radius};

  TwoDiscRun run;
  const RunSummary summary = simulate({{disc, {parameters.first, 0.0}}, {disc, {}}}, options, [&](const StepRecord& record) {
    run.time.push_back(record.time);
    run.left.push_back(record.bodies[0].pose.centre);
    run.right.push_back(record.bodies[1].pose.centre);
    run.gap_over_h.push_back(record.min_gap / disc_spacing);
    if (!record.outcome) return;
    const StepOutcome& step = *record.outcome;
    run.ncp_iterations.push_back(step.ncp_iterations);
    run.multiplier.push_back(step.contacts.empty() ? 0.0 : step.contacts[0].multiplier);
    run.gmres_iterations += step.gmres_iterations;
    run.contact_steps += !step.contacts.empty();
    run.largest_ncp_iterations = std::max<long>(run.largest_ncp_iterations, step.ncp_iterations);
    Complex force = 0.0;
    double torque = 0.0;
    for (int body : {0, 1}) {
      const Wrench& w = step.contact_wrench[body];
      force += w.force;
      torque += w.torque + cross(record.bodies[body].pose.centre, w.force);
    }
    run.worst_force_balance = std::max({run.worst_force_balance, std::abs(force), std::abs(torque)});
  });
  run.steps = summary.steps;
  run.factorisations = summary.factorisations;
  run.smallest_gap_over_h = *std::min_element(run.gap_over_h.begin(), run.gap_over_h.end());
  return run;
}

}  // namespace stokes
