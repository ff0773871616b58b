// When each step starts, how long it is, and in which direction the flow is driven. There are three rules for the length:
// fixed; halved on a failure (adaptive); or by the estimated error of the steps (tolerance). In the last, with
// e = error / tolerance:
//   a step is taken if e <= 1, or if it restores the separation of bodies that start too close;
//   the next one is .9 e^(-.7/3) e_before^(.4/3) times as long, between .2 and 3 times, not longer after a rejection;
//   a rejected one is tried again .9 e^(-1/3) times as long, at least a tenth, and from the second time on .9 e^(-1/2)
//   times, because the error is of second order if a contact begins or ends within the step. A failure halves it.
#pragma once

#include <optional>
#include <vector>

#include "state_text.hpp"
#include "stepper.hpp"

namespace stokes {

enum class TimeCounting {
  exact,        // round((end_time - start_time) / time_step) steps that start at start_time + k time_step, the last one
                // ends at end_time
  accumulated,  // t += dt while t < end_time, in floating point: may overshoot by a step
};

struct TimeOptions {
  double start_time = 0.0;
  double time_step = 0.0;            // first and largest step when adaptive
  double end_time = 0.0;
  std::optional<double> reverse_at;  // driving changes sign at the first step that starts at or after it
  TimeCounting time_counting = TimeCounting::exact;
  bool adaptive = false;             // reject, halve and grow steps; steps are cut at reverse_at and end_time
  double tolerance = 0.0;            // of the error of a step (StepOutcome::error), when adaptive; 0: failures decide alone
};

class StepController {
 public:
  explicit StepController(const TimeOptions& options);

  long step() const { return step_; }
  double time() const { return time_; }
  bool done() const;

  // For the step that starts now. Exact counting tolerates the rounding of k dt; accumulated counting does not.
  double driving() const;

  // Steps below it end the run.
  double smallest_step() const;
  // The step to take from here, at most `limit` when adaptive.
  double propose(double limit) const;
  // Whether an attempt is good enough.
  bool takes(const StepOutcome& outcome) const;
  void accept(const StepOutcome& outcome);
  // False if the step cannot be tried again with a smaller one.
  bool reject(const StepOutcome& outcome);
  long rejected() const { return rejected_; }
  // Counts of the attempts at the present step.
  int rejected_by_error() const { return rejected_by_error_; }
  int rejected_by_failure() const { return rejected_by_failure_; }

  void save(StateWriter& writer) const;
  void restore(StateReader& reader);

 private:
  std::vector<double> stops() const;
  double cut_at_stops(double dt) const;
  void adapt_to_failures(const StepOutcome& outcome);
  void adapt_to_error(const StepOutcome& outcome);

  TimeOptions options_;
  long step_count_;  // of exact counting
  long step_ = 0, rejected_ = 0;
  double time_ = 0.0;
  double next_;                              // length of the next step, when adaptive
  int easy_steps_ = 0, since_rejection_ = 6;  // accepted steps, which decide when the step may grow
  int rejected_by_error_ = 0, rejected_by_failure_ = 0;
  double error_before_ = 0.0;                 // of the latest accepted step, in tolerances; 0: none
};

}  // namespace stokes
