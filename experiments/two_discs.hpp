// Section 4.1: two free discs of radius 0.5 in shear, 32 points each, the second one at the origin.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "simulation.hpp"

namespace stokes {

struct TwoDiscs {
  FlowKind flow = FlowKind::shear;
  double rate = 1.0;
  Complex first{-8.0, 0.5};          // start of the left disc
  Complex second{0.0, 0.0};          // and of the right one
  double separation_over_h = 0.0;    // delta / h, h = pi/32 the point spacing
  double time_step = 0.2, end_time = 40.0;
  std::optional<double> reverse_at;
  TimeCounting time_counting = TimeCounting::exact;
  bool adaptive = false;
  double accuracy = 0.0;             // in place of 32 points each, if positive
  ContactModel contact = ContactModel::gap;
  Coupling coupling = Coupling::global;
  LcpMatrix lcp_matrix = LcpMatrix::full;
  int stiv_vertices = 0;             // 0: four for each point
  StivGradient stiv_gradient = StivGradient::full;
  IntegratorKind integrator = IntegratorKind::euler;
  double tolerance = 0.0;            // of rk3, which then chooses the steps
  double gmres_tolerance = 1e-8;
};

struct TwoDiscRun {
  std::vector<double> time;
  std::vector<Complex> left, right;   // centres at the start of each step, and at the end
  std::vector<double> gap_over_h;
  std::vector<int> ncp_iterations;    // of each step
  std::vector<double> multiplier;     // contact force of each step, 0 without
  double worst_force_balance = 0.0;   // largest net contact force or torque (about the origin)
  long steps = 0, contact_steps = 0, gmres_iterations = 0, stokes_solves = 0, largest_ncp_iterations = 0;
  double smallest_gap_over_h = 0.0;
  long rejected = 0;
  int factorisations = 0;
  std::string failure;                // why the run ended early, or empty

  double mean_ncp_iterations() const {  // of the steps with contact
    long sum = 0, steps_with = 0;
    for (int n : ncp_iterations) sum += n, steps_with += n > 0;
    return steps_with ? static_cast<double>(sum) / static_cast<double>(steps_with) : 0.0;
  }
};

inline constexpr int disc_points = 32;
inline constexpr double disc_radius = 0.5;
inline constexpr double disc_spacing = 2.0 * pi * disc_radius / disc_points;  // h

// A numerical failure ends the run and is reported in `failure`.
inline TwoDiscRun run_two_discs(const TwoDiscs& parameters) {
  SimulationOptions options;
  options.stepper.flow = {parameters.flow, parameters.rate};
  options.stepper.points_per_body = disc_points;
  options.stepper.accuracy = parameters.accuracy;
  options.stepper.separation = parameters.separation_over_h * disc_spacing;
  options.time_step = parameters.time_step;
  options.end_time = parameters.end_time;
  options.reverse_at = parameters.reverse_at;
  options.time_counting = parameters.time_counting;
  options.adaptive = parameters.adaptive;
  options.stepper.contact = parameters.contact;
  options.stepper.coupling = parameters.coupling;
  options.stepper.lcp_matrix = parameters.lcp_matrix;
  options.stepper.stiv_vertices = parameters.stiv_vertices;
  options.stepper.stiv_gradient = parameters.stiv_gradient;
  options.stepper.integrator = parameters.integrator;
  options.stepper.stokes.gmres_tolerance = parameters.gmres_tolerance;
  if (parameters.integrator != IntegratorKind::euler) options.stepper.contact_tolerance = 1e-6;
  if (parameters.tolerance > 0.0) {
    options.adaptive = true;
    options.tolerance = options.stepper.tolerance = parameters.tolerance;
    options.stepper.contact_tolerance = std::min(1e-6, 0.1 * parameters.tolerance);
  }
  const Shape disc{disc_radius, disc_radius};

  TwoDiscRun run;
  const auto observe = [&](const StepRecord& record) {
    run.time.push_back(record.time);
    run.left.push_back(record.bodies[0].pose.centre);
    run.right.push_back(record.bodies[1].pose.centre);
    run.gap_over_h.push_back(record.min_gap / disc_spacing);
    if (!record.outcome) return;
    const StepOutcome& step = *record.outcome;
    run.ncp_iterations.push_back(step.ncp_iterations);
    run.multiplier.push_back(step.contacts.empty() ? 0.0 : step.contacts[0].multiplier);
    run.gmres_iterations += step.gmres_iterations;
    run.stokes_solves += step.stokes_solves;
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
  };
  try {
    const RunSummary summary =
        simulate({{disc, {parameters.first, 0.0}, {}, 0.0}, {disc, {parameters.second, 0.0}, {}, 0.0}}, options, observe);
    run.steps = summary.steps;
    run.rejected = summary.rejected;
    run.factorisations = summary.factorisations;
  } catch (const NumericalError& error) {
    run.failure = error.what();
    run.steps = static_cast<long>(run.ncp_iterations.size());
  }
  run.smallest_gap_over_h = *std::min_element(run.gap_over_h.begin(), run.gap_over_h.end());
  return run;
}

// The same for a run that must reach its end: a failure is thrown.
inline TwoDiscRun complete_two_discs(const TwoDiscs& parameters) {
  TwoDiscRun run = run_two_discs(parameters);
  if (!run.failure.empty()) throw NumericalError(run.failure);
  return run;
}

// Relative distance of both centres at the end from where they started, as in Table 1.
inline double reversal_error(const TwoDiscRun& run) {
  const double moved = std::norm(run.left.back() - run.left[0]) + std::norm(run.right.back() - run.right[0]);
  return std::sqrt(moved / (std::norm(run.left[0]) + std::norm(run.right[0])));
}

}  // namespace stokes
