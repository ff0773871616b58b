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

// Where a run stands in time between two steps.
struct ClockState {
  long step = 0;
  double time = 0.0;
  double dt = 0.0;                            // of the next step, when adaptive
  int easy_steps = 0, since_rejection = 6;  // accepted ones, which decide when dt may grow
};

// Everything that the rest of a run depends on, between two steps: a run that starts from it makes the same
// steps, bit for bit, as the one that it was taken from.
struct RunState {
  ClockState clock;
  std::vector<Pose> poses;
  StepperMemory memory;
  long rejected = 0;
};

enum class RunStage {
  under_way,    // after an accepted step
  failed,       // the step from this state, or, if bodies overlap, this state itself ends the run
  interrupted,  // the step from this state was given up for a signal, which ends the run
};
using StateObserver = std::function<void(const RunState&, RunStage)>;

struct SimulationOptions {
  StepperOptions stepper;
  double time_step = 0.0;            // first and largest step when adaptive
  double end_time = 0.0;
  std::optional<double> reverse_at;  // driving changes sign at the first step that starts at or after it
  TimeCounting time_counting = TimeCounting::exact;
  bool adaptive = false;             // reject, halve and grow steps; steps are cut at reverse_at and end_time
  std::optional<RunState> start;     // to go on from, instead of time 0
  StateObserver observe_state;       // after the other observer; it may end the run with an exception
};

// State of a run at the start of a step, with what moved it from there; without for the last state.
struct StepRecord {
  long step;
  double time;
  const Suspension& bodies;
  double min_gap;              // smallest distance between two bodies, negative if they overlap
  const StepOutcome* outcome;  // null: the final configuration
  double driving = 1.0;        // what the step from here multiplies the flow and the walls' velocities by
};
using Observer = std::function<void(const StepRecord&)>;

struct RunSummary {
  long steps = 0, rejected = 0;
  int factorisations = 0, shapes = 0;
};

// Every state goes to the observer in order, the final one last, also when the run ends early with a
// NumericalError: bodies overlap (contact = none), the contact problem or GMRES fails (adaptive: at the
// smallest step, 1e-6 time_step), or adaptive steps would have to be smaller than that. The message names step, time
// and cause. Interruption when a signal asks for it, after the state to go on from was observed.
RunSummary simulate(const Suspension& initial, const SimulationOptions& options, const Observer& observe);

}  // namespace stokes
