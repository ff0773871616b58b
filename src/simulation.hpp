// Runs a suspension from its start to its end: the loop of a StepController and a Stepper.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "step_controller.hpp"

namespace stokes {

// Everything that the rest of a run depends on, between two steps, as text (state_text.hpp). A run that starts from it
// makes the same steps, bit for bit, as the original run.
struct SavedRun {
  long step = 0;
  double time = 0.0;
  std::string text{};
};

// Where a run stands between two steps. It can be saved until the next observation.
class RunState {
 public:
  virtual ~RunState() = default;
  virtual long step() const = 0;
  virtual double time() const = 0;
  virtual SavedRun save() const = 0;
};

enum class RunStage {
  under_way,    // after an accepted step
  failed,       // the step from this state, or, if bodies overlap, this state itself ends the run
  interrupted,  // the step from this state was abandoned because of a signal, which ends the run
};
using StateObserver = std::function<void(const RunState&, RunStage)>;

struct SimulationOptions : TimeOptions {
  StepperOptions stepper;
  std::optional<SavedRun> start;  // to continue from, instead of starting at the beginning
  StateObserver observe_state;    // after the other observer; it may end the run with an exception
};

// State of a run at the start of a step, with the outcome of this step; the last state has none.
struct StepRecord {
  long step;
  double time;
  const Suspension& bodies;
  double min_gap;              // smallest distance between two bodies, negative if they overlap
  const StepOutcome* outcome;  // null: the final configuration
  double driving = 1.0;        // factor on the flow and the walls' velocities in the step from here
};
using Observer = std::function<void(const StepRecord&)>;

struct RunSummary {
  long steps = 0, rejected = 0;
  int factorisations = 0, shapes = 0;
};

// Passes every state to the observer in order, the final one last, also when the run ends early with a
// NumericalError: bodies overlap (contact = none), the contact problem or GMRES fails (adaptive: at the
// smallest step, 1e-6 time_step), or adaptive steps would have to be smaller than that. The message names step, time
// and cause. Throws an Interruption when a signal asks for it, after the state to continue from was observed.
RunSummary simulate(const Suspension& initial, const SimulationOptions& options, const Observer& observe);

}  // namespace stokes
