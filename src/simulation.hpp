// Runs a suspension from time 0 to its end: time counting, reversal of the flow, adaptive steps.
#pragma once

#include <functional>
#include <optional>

#include "stepper.hpp"

namespace stokes {

enum class TimeCounting {
  exact,        // round(end_time / time_step) steps that start at k time_step, the last one ends at end_time
  accumulated,  // t += dt while t < end_time, in floating point: may overshoot by a step
};

struct SimulationOptions {
  StepperOptions stepper;
  double time_step = 0.0;            // first and largest step when adaptive
  double end_time = 0.0;
  std::optional<double> reverse_at;  // driving changes sign at the first step that starts at or after it
  TimeCounting time_counting = TimeCounting::exact;
  bool adaptive = false;             // reject, halve and grow steps; steps are cut at reverse_at and end_time
};

// State of a run at the start of a step, with what moved it from there; without for the last state.
struct StepRecord {
  long step;
  double time;
  const Suspension& bodies;
  double min_gap;              // smallest distance between two bodies, negative if they overlap
  const StepOutcome* outcome;  // null: the final configuration
};
using Observer = std::function<void(const StepRecord&)>;

struct RunSummary {
  long steps = 0, rejected = 0;
  int factorisations = 0, shapes = 0;
};

// Every state goes to the observer in order, the final one last, also when the run ends early with a
// NumericalError: bodies overlap (contact = none), the contact problem or GMRES fails (adaptive: at the
// smallest step, 1e-6 time_step). The message names step, time and cause.
RunSummary simulate(const Suspension& initial, const SimulationOptions& options, const Observer& observe);

}  // namespace stokes
