// Section 4.2: 48 free ellipses in the flow (cos x sin y, -sin x cos y), which fills the plane.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "run.hpp"

namespace stokes {

inline constexpr Shape taylor_green_ellipse{0.475, 0.1};
inline constexpr int taylor_green_points = 32;

// h of the paper, the unit of the separation, also where a run has another number of nodes.
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

// Bodies on a grid of 4 by 12, y fastest, all along x; the grid's half-width is 0.475 pi.
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

// All options but the preconditioner.
inline Case taylor_green_case(const TaylorGreen& parameters) {
  Case c;
  c.flow = FlowKind::taylor_green;
  c.points_per_body = parameters.points;
  c.refine = parameters.refine;
  c.gmres_tolerance = parameters.gmres_tolerance;
  c.contact = parameters.contact;
  c.min_separation_length = 0.05 * taylor_green_spacing();
  c.coupling = parameters.coupling;
  c.lcp_matrix = parameters.lcp_matrix;
  c.time_step = parameters.time_step;
  c.end_time = parameters.end_time;
  c.adaptive = parameters.adaptive;
  return c;
}

inline SimulationOptions taylor_green_options(const TaylorGreen& parameters) {
  SimulationOptions options = options_of(taylor_green_case(parameters), taylor_green_bodies());
  options.stepper.stokes.preconditioner = parameters.preconditioner;
  return options;
}

// The state at the start of a step, and the data of this step; the last state is the end of the run.
struct TaylorGreenStep {
  double time = 0.0, gap_over_h = 0.0;
  bool moved = false;  // all members below are of the step from here, and 0 at the end
  int contacts = 0, ncp_iterations = 0, gmres_iterations = 0, background_iterations = 0;
  double largest_multiplier = 0.0;
  double fastest = 0.0;  // largest |U| of a body
};

inline TaylorGreenStep describe(const StepRecord& record) {
  TaylorGreenStep step;
  step.time = record.time;
  step.gap_over_h = record.min_gap / taylor_green_spacing();
  if (!record.outcome) return step;
  const StepOutcome& outcome = *record.outcome;
  step.moved = true;
  step.contacts = static_cast<int>(outcome.contacts.size());
  step.ncp_iterations = outcome.ncp_iterations;
  step.gmres_iterations = outcome.gmres_iterations;
  step.background_iterations = outcome.background_iterations;
  for (const ActiveContact& c : outcome.contacts) step.largest_multiplier = std::max(step.largest_multiplier, c.multiplier);
  for (const RigidVelocity& u : outcome.velocity) step.fastest = std::max(step.fastest, std::abs(u.velocity));
  return step;
}

struct TaylorGreenRun {
  std::vector<TaylorGreenStep> steps;
  std::string failure;  // why the run ended early, or empty
};

// A numerical failure ends the run and is reported in `failure`. `observe` sees every state.
inline TaylorGreenRun run_taylor_green(const Suspension& start, const TaylorGreen& parameters,
                                       const Observer& observe = {}) {
  TaylorGreenRun run;
  try {
    simulate(start, taylor_green_options(parameters), [&](const StepRecord& record) {
      run.steps.push_back(describe(record));
      if (observe) observe(record);
    });
  } catch (const NumericalError& error) {
    run.failure = error.what();
  }
  return run;
}

// Mean of a quantity over the steps.
template <class Function>
double mean_over_steps(const TaylorGreenRun& run, const Function& number) {
  double sum = 0.0, count = 0.0;
  for (const TaylorGreenStep& step : run.steps)
    if (step.moved) sum += static_cast<double>(number(step)), ++count;
  return count > 0.0 ? sum / count : 0.0;
}

}  // namespace stokes
