// When each step starts, how long it is, and which way the flow is driven.
#pragma once

#include <optional>
#include <vector>

#include "state_text.hpp"
#include "stepper.hpp"

namespace stokes {

enum class TimeCounting {
  exact,        // round(end_time / time_step) steps that start at k time_step, the last one ends at end_time
  accumulated,  // t += dt while t < end_time, in floating point: may overshoot by a step
};

struct TimeOptions {
  double time_step = 0.0;            // first and largest step when adaptive
  double end_time = 0.0;
  std::optional<double> reverse_at;  // driving changes sign at the first step that starts at or after it
  TimeCounting time_counting = TimeCounting::exact;
  bool adaptive = false;             // reject, halve and grow steps; steps are cut at reverse_at and end_time
};

class StepController {
 public:
  explicit StepController(const TimeOptions& options);

  long step() const { return step_; }
  double time() const { return time_; }
  bool done() const;

  // Of the step that starts now. Exact counting forgives the rounding of k dt; accumulated does not.
  double driving() const;

  // Steps below it end the run.
  double smallest_step() const;
  // The step to take from here, at most `limit` when adaptive.
  double propose(double limit) const;
  void accept(const StepOutcome& outcome);
  // False if the step cannot be tried again with a smaller one.
  bool reject(const StepOutcome& outcome);
  long rejected() const { return rejected_; }

  void save(StateWriter& writer) const;
  void restore(StateReader& reader);

 private:
  std::vector<double> stops() const;

  TimeOptions options_;
  long step_count_;  // of exact counting
  long step_ = 0, rejected_ = 0;
  double time_ = 0.0;
  double next_;                              // length of the next step, when adaptive
  int easy_steps_ = 0, since_rejection_ = 6;  // accepted ones, which decide when it may grow
};

}  // namespace stokes
