#include "simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "neighbours.hpp"
#include "text.hpp"

namespace stokes {

namespace {

constexpr double smallest_step = 1e-6;  // of time_step
// The self-mobility matrix takes a thousand iterations at gaps of a few per cent, the full one a few.
constexpr int fixed_step_ncp_limit = 50, self_mobility_ncp_limit = 5000, adaptive_ncp_limit = 10;

// When each step starts, how long it is and which way the flow is driven.
class Clock {
 public:
  explicit Clock(const SimulationOptions& options) : options_(options), dt_(options.time_step) {
    steps_ = std::max(1L, std::lround(options.end_time / options.time_step));
  }

  double time() const { return time_; }
  double driving() const { return driving_; }

  bool done() const {
    if (options_.adaptive || options_.time_counting == TimeCounting::accumulated) return !(time_ < options_.end_time);
    return step_ == steps_;
  }

  // Called at the start of each step. Exact counting forgives the rounding of k dt; accumulated does not.
  void begin_step() {
    const double slack = options_.time_counting == TimeCounting::exact ? 1e-9 * options_.time_step : 0.0;
    if (options_.reverse_at && time_ >= *options_.reverse_at - slack) driving_ = -1.0;
  }

  // The step to take from here: fixed, or the adaptive one cut at the end and at the reversal.
  double step(double limit) const {
    if (!options_.adaptive) {
      const bool last = options_.time_counting == TimeCounting::exact && step_ + 1 == steps_;
      return last ? options_.end_time - time_ : options_.time_step;
    }
    const double dt = std::min(dt_, limit);
    for (const std::optional<double>& stop : {options_.reverse_at, std::optional(options_.end_time)})
      if (stop && time_ < *stop && time_ + dt > *stop * (1.0 - 1e-12)) return *stop - time_;
    return dt;
  }

  void accept(double dt, int ncp_iterations) {
    ++step_;
    if (options_.adaptive) {
      // Land exactly on a stop that the step was cut at.
      const double reached = time_ + dt;
      time_ = reached;
      for (const std::optional<double>& stop : {options_.reverse_at, std::optional(options_.end_time)})
        if (stop && std::abs(reached - *stop) <= 1e-12 * *stop) time_ = *stop;
      easy_steps_ = ncp_iterations <= 2 ? easy_steps_ + 1 : 0;
      ++since_rejection_;
      if (easy_steps_ >= 3 && since_rejection_ > 5) {
        dt_ = std::min(options_.time_step, 1.5 * dt_);
        easy_steps_ = 0;
      }
    } else if (options_.time_counting == TimeCounting::accumulated) {
      time_ += dt;
    } else {
      time_ = step_ == steps_ ? options_.end_time : static_cast<double>(step_) * options_.time_step;
    }
  }

  // Halves the step; false when it is as small as it may get.
  bool reject(double dt) {
    since_rejection_ = 0;
    easy_steps_ = 0;
    dt_ = 0.5 * dt;
    return options_.adaptive && dt_ >= smallest_step * options_.time_step;
  }

 private:
  const SimulationOptions& options_;
  double dt_, time_ = 0.0, driving_ = 1.0;
  long step_ = 0, steps_;
  int easy_steps_ = 0, since_rejection_ = 6;
};

}  // namespace

RunSummary simulate(const Suspension& initial, const SimulationOptions& options, const Observer& observe) {
  Stepper stepper(initial, options.stepper);
  Clock clock(options);
  NcpOptions ncp;
  ncp.demand_progress = options.adaptive;
  ncp.max_iterations = options.adaptive                                   ? adaptive_ncp_limit
                       : options.stepper.lcp_matrix == LcpMatrix::self ? self_mobility_ncp_limit
                                                                          : fixed_step_ncp_limit;
  RunSummary summary;
  ClosestPair closest = smallest_gap(initial);

  const auto finish = [&](const std::string& failure) {
    observe({summary.steps, clock.time(), stepper.bodies(), closest.gap, nullptr});
    summary.factorisations = stepper.factorisations();
    summary.shapes = stepper.shape_count();
    if (!failure.empty())
      throw NumericalError(concat("step ", summary.steps, ", time ", clock.time(), ": ", failure));
    return summary;
  };

  while (!clock.done()) {
    clock.begin_step();
    const Suspension start = stepper.bodies();
    StepOutcome outcome;
    try {
      double dt = clock.step(options.adaptive ? stepper.geometric_step_limit(clock.driving()) : 0.0);
      outcome = stepper.attempt(dt, clock.driving(), ncp);
      while (!outcome.accepted && clock.reject(dt)) {
        ++summary.rejected;
        dt = clock.step(dt);
        outcome = stepper.attempt(dt, clock.driving(), ncp);
      }
    } catch (const NumericalError& error) {
      return finish(error.what());
    }
    if (!outcome.accepted)
      return finish(outcome.failure + (options.adaptive ? "; the step cannot be halved further" : "; adaptive = yes would halve the step"));
    observe({summary.steps, clock.time(), start, closest.gap, &outcome});
    clock.accept(outcome.dt, outcome.ncp_iterations);
    ++summary.steps;
    try {
      closest = smallest_gap(stepper.bodies());
    } catch (const NumericalError& error) {  // positions beyond all bounds
      closest.gap = std::numeric_limits<double>::quiet_NaN();
      return finish(error.what());
    }
    if (closest.gap < 0.0)
      return finish(concat("bodies ", closest.a, " and ", closest.b, " overlap by ", -closest.gap,
                           "; try a smaller time_step",
                           options.stepper.contact == ContactModel::none ? ", or contact = gap" : ""));
  }
  return finish("");
}

}  // namespace stokes
