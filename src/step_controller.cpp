#include "step_controller.hpp"

#include <algorithm>
#include <cmath>

namespace stokes {

namespace {

constexpr double smallest_part = 1e-6;  // of time_step

// The step grows by half after three consecutive steps that found their contacts in two iterations, and at least five steps
// after the latest rejection.
constexpr int easy_iterations = 2, easy_steps_to_grow = 3, quiet_steps_to_grow = 5;
constexpr double growth = 1.5;

// Constants of the rule by error (step_controller.hpp).
constexpr double safety = 0.9, least_factor = 0.2, largest_factor = 3.0, least_retry = 0.1, least_error = 1e-4;

}  // namespace

StepController::StepController(const TimeOptions& options)
    : options_(options), step_count_(std::max(1L, std::lround((options.end_time - options.start_time) / options.time_step))),
      time_(options.start_time), next_(options.time_step) {}

bool StepController::done() const {
  const bool by_time = options_.adaptive || options_.time_counting == TimeCounting::accumulated;
  return by_time ? !(time_ < options_.end_time) : step_ == step_count_;
}

double StepController::driving() const {
  const double slack = options_.time_counting == TimeCounting::exact ? 1e-9 * options_.time_step : 0.0;
  return options_.reverse_at && time_ >= *options_.reverse_at - slack ? -1.0 : 1.0;
}

double StepController::smallest_step() const { return smallest_part * options_.time_step; }

std::vector<double> StepController::stops() const {
  return options_.reverse_at ? std::vector<double>{*options_.reverse_at, options_.end_time}
                             : std::vector<double>{options_.end_time};
}

double StepController::propose(double limit) const {
  if (!options_.adaptive) {
    const bool last = options_.time_counting == TimeCounting::exact && step_ + 1 == step_count_;
    return last ? options_.end_time - time_ : options_.time_step;
  }
  return cut_at_stops(std::min(next_, limit));
}

// In the rule by error, two steps share the rest before a stop, so that the last is not much smaller than the others.
double StepController::cut_at_stops(double dt) const {
  for (const double stop : stops()) {
    if (time_ >= stop) continue;
    if (time_ + dt > stop * (1.0 - 1e-12)) return stop - time_;
    if (options_.tolerance > 0.0 && time_ + 2.0 * dt > stop) return 0.5 * (stop - time_);
    break;
  }
  return dt;
}

bool StepController::takes(const StepOutcome& outcome) const {
  if (!outcome.accepted) return false;
  return options_.tolerance == 0.0 || outcome.restoring || !outcome.error || *outcome.error <= options_.tolerance;
}

void StepController::accept(const StepOutcome& outcome) {
  ++step_;
  if (options_.adaptive) {
    if (options_.tolerance > 0.0)
      adapt_to_error(outcome);
    else
      adapt_to_failures(outcome);
    const double driven = driving(), reached = time_ + outcome.dt;
    time_ = reached;
    for (const double stop : stops())  // reached but for the rounding
      if (std::abs(reached - stop) <= 1e-12 * stop) time_ = stop;
    if (driving() != driven) error_before_ = 0.0;
  } else if (options_.time_counting == TimeCounting::accumulated) {
    time_ += outcome.dt;
  } else {
    time_ = options_.start_time + static_cast<double>(step_) * options_.time_step;
    if (step_ == step_count_) time_ = options_.end_time;
  }
}

void StepController::adapt_to_failures(const StepOutcome& outcome) {
  easy_steps_ = outcome.ncp_iterations <= easy_iterations ? easy_steps_ + 1 : 0;
  ++since_rejection_;
  if (easy_steps_ >= easy_steps_to_grow && since_rejection_ > quiet_steps_to_grow) {
    next_ = std::min(options_.time_step, growth * next_);
    easy_steps_ = 0;
  }
}

void StepController::adapt_to_error(const StepOutcome& outcome) {
  const bool had_rejections = rejected_by_error_ + rejected_by_failure_ > 0;
  rejected_by_error_ = rejected_by_failure_ = 0;
  if (outcome.restoring || !outcome.error) {
    error_before_ = 0.0;
    return;
  }
  const double e = std::max(*outcome.error / options_.tolerance, least_error);
  double factor = error_before_ > 0.0 ? safety * std::pow(e, -0.7 / 3.0) * std::pow(error_before_, 0.4 / 3.0)
                                      : safety * std::pow(e, -1.0 / 3.0);
  factor = std::clamp(factor, least_factor, largest_factor);
  if (had_rejections) factor = std::min(factor, 1.0);
  const bool cut = outcome.dt < next_;  // at a stop or by the geometry, which does not concern the next step
  next_ = std::min(options_.time_step, cut ? std::max(next_, factor * outcome.dt) : factor * outcome.dt);
  error_before_ = e;
}

bool StepController::reject(const StepOutcome& outcome) {
  since_rejection_ = 0;
  easy_steps_ = 0;
  if (outcome.accepted && outcome.error) {
    const double e = *outcome.error / options_.tolerance;
    const double factor = rejected_by_error_ == 0 ? std::max(least_retry, safety * std::pow(e, -1.0 / 3.0))
                                                  : safety * std::pow(e, -1.0 / 2.0);
    next_ = factor * outcome.dt;
    ++rejected_by_error_;
  } else {
    next_ = 0.5 * outcome.dt;
    ++rejected_by_failure_;
  }
  const bool again = options_.adaptive && next_ >= smallest_step();
  rejected_ += again;
  return again;
}

void StepController::save(StateWriter& writer) const {
  writer.line("clock", step_, time_, next_, easy_steps_, since_rejection_, rejected_, error_before_);
}

void StepController::restore(StateReader& reader) {
  reader.begin("clock");
  step_ = reader.integer<long>();
  time_ = reader.number();
  next_ = reader.number();
  easy_steps_ = reader.integer<int>();
  since_rejection_ = reader.integer<int>();
  rejected_ = reader.integer<long>();
  error_before_ = reader.number();
}

}  // namespace stokes
