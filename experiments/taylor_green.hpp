// Section 4.2: 48 free ellipses in the flow (cos x sin y, -sin x cos y), which fills the plane.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "simulation.hpp"

namespace stokes {

inline constexpr Shape taylor_green_ellipse{0.475, 0.1};
inline constexpr int taylor_green_points = 32;

// h of the paper, which the separation is given in: also where a run takes other points.
inline double taylor_green_spacing() { return taylor_green_ellipse.perimeter() / taylor_green_points; }

struct TaylorGreen {
  double time_step = 0.025, end_time = 30.0;
  int points = taylor_green_points;
  Refine refine = Refine::near;
  ContactModel contact = ContactModel::gap;
  Coupling coupling = Coupling::global;
  LcpMatrix lcp_matrix = LcpMatrix::full;
  PreconditionerKind preconditioner = PreconditionerKind::pair;
  double gmres_tolerance = 1e-6;
  bool adaptive = false;
};

// On a grid of 4 by 12 with y running fastest, all along x; the grid's half-width is 0.475 pi.
inline Suspension taylor_green_bodies() {
  constexpr int columns = 4, rows = 12;
  const double half = 0.475 * pi;
  Suspension bodies;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) {
      const Complex centre(-half + 2.0 * half * i / (columns - 1), -half + 2.0 * half * j / (rows - 1));
      bodies.push_back({.shape = taylor_green_ellipse, .pose = {centre, 0.0}});
    }
  return bodies;
}

// The body whose track Figure 4 shows, from (-0.497, 0.950).
inline constexpr int coloured_body = 21;

inline SimulationOptions taylor_green_options(const TaylorGreen& parameters) {
  SimulationOptions options;
  options.stepper.flow = {FlowKind::taylor_green};
  options.stepper.points_per_body = parameters.points;
  options.stepper.refine = parameters.refine;
  options.stepper.stokes.gmres_tolerance = parameters.gmres_tolerance;
  options.stepper.stokes.preconditioner = parameters.preconditioner;
  options.stepper.contact = parameters.contact;
  options.stepper.separation = 0.05 * taylor_green_spacing();
  options.stepper.coupling = parameters.coupling;
  options.stepper.lcp_matrix = parameters.lcp_matrix;
  options.time_step = parameters.time_step;
  options.end_time = parameters.end_time;
  options.adaptive = parameters.adaptive;
  return options;
}

// The state at the start of a step, and what moved it from there; the last one is the end of the run.
struct TaylorGreenStep {
  double time = 0.0, gap_over_h = 0.0;
  Pose coloured;
  bool moved = false;  // all below are of the step from here, and 0 at the end
  double dt = 0.0;
  int contacts = 0, ncp_iterations = 0, gmres_iterations = 0, background_iterations = 0;
  bool coloured_in_contact = false;
  double smallest_multiplier = std::numeric_limits<double>::infinity(), largest_multiplier = 0.0;
  double fastest = 0.0;  // largest |U| of a body
  double net_force = 0.0, net_torque = 0.0;  // of the contact forces, the torque about the origin
};

inline TaylorGreenStep describe(const StepRecord& record) {
  TaylorGreenStep step;
  step.time = record.time;
  step.gap_over_h = record.min_gap / taylor_green_spacing();
  step.coloured = record.bodies[coloured_body].pose;
  if (!record.outcome) return step;
  const StepOutcome& outcome = *record.outcome;
  step.moved = true;
  step.dt = outcome.dt;
  step.contacts = static_cast<int>(outcome.contacts.size());
  step.ncp_iterations = outcome.ncp_iterations;
  step.gmres_iterations = outcome.gmres_iterations;
  step.background_iterations = outcome.background_iterations;
  for (const ActiveContact& c : outcome.contacts) {
    step.coloured_in_contact |= c.constraint.a == coloured_body || c.constraint.b == coloured_body;
    step.smallest_multiplier = std::min(step.smallest_multiplier, c.multiplier);
    step.largest_multiplier = std::max(step.largest_multiplier, c.multiplier);
  }
  Complex force = 0.0;
  double torque = 0.0;
  for (std::size_t i = 0; i < record.bodies.size(); ++i) {
    const Wrench& w = outcome.contact_wrench[i];
    force += w.force;
    torque += w.torque + cross(record.bodies[i].pose.centre, w.force);
    step.fastest = std::max(step.fastest, std::abs(outcome.velocity[i].velocity));
  }
  step.net_force = std::abs(force);
  step.net_torque = std::abs(torque);
  return step;
}

struct TaylorGreenRun {
  std::vector<TaylorGreenStep> steps;
  RunSummary summary;   // of a run that reached its end
  std::string failure;  // why the run ended early, or empty
};

// A numerical failure ends the run and is told in `failure`. `observe` sees every state.
inline TaylorGreenRun run_taylor_green(const Suspension& start, const TaylorGreen& parameters,
                                       const Observer& observe = {}) {
  TaylorGreenRun run;
  try {
    run.summary = simulate(start, taylor_green_options(parameters), [&](const StepRecord& record) {
      run.steps.push_back(describe(record));
      if (observe) observe(record);
    });
  } catch (const NumericalError& error) {
    run.failure = error.what();
  }
  return run;
}

// Mean of a number of the steps that were taken.
template <class Function>
double mean_over_steps(const TaylorGreenRun& run, const Function& number) {
  double sum = 0.0, count = 0.0;
  for (const TaylorGreenStep& step : run.steps)
    if (step.moved) sum += static_cast<double>(number(step)), ++count;
  return count > 0.0 ? sum / count : 0.0;
}

}  // namespace stokes
