#include "simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "interruption.hpp"
#include "neighbours.hpp"
#include "scales.hpp"
#include "text.hpp"

namespace stokes {

namespace {

constexpr double smallest_step = 1e-6;  // of time_step
// The self-mobility matrix takes a thousand iterations at gaps of a few per cent, the full one a few.
constexpr int fixed_step_ncp_limit = 50, self_mobility_ncp_limit = 5000, adaptive_ncp_limit = 10;

// When each step starts, how long it is and which way the flow is driven.
class Clock {
 public:
  explicit Clock(const SimulationOptions& options) : options_(options) {
    now_.dt = options.time_step;
    if (options.start) now_ = options.start->clock;
    steps_ = std::max(1L, std::lround(options.end_time / options.time_step));
  }

  const ClockState& now() const { return now_; }

  // Of the step from here. Exact counting forgives the rounding of k dt; accumulated does not.
  double driving() const {
    const double slack = options_.time_counting == TimeCounting::exact ? 1e-9 * options_.time_step : 0.0;
    return options_.reverse_at && now_.time >= *options_.reverse_at - slack ? -1.0 : 1.0;
  }

  bool done() const {
    const bool by_time = options_.adaptive || options_.time_counting == TimeCounting::accumulated;
    if (by_time) return !(now_.time < options_.end_time);
    return now_.step == steps_;
  }

  // The step to take from here: fixed, or the adaptive one cut at the end and at the reversal.
  double step(double limit) const {
    if (!options_.adaptive) {
      const bool last = options_.time_counting == TimeCounting::exact && now_.step + 1 == steps_;
      return last ? options_.end_time - now_.time : options_.time_step;
    }
    const double dt = std::min(now_.dt, limit);
    for (const std::optional<double>& stop : {options_.reverse_at, std::optional(options_.end_time)})
      if (stop && now_.time < *stop && now_.time + dt > *stop * (1.0 - 1e-12)) return *stop - now_.time;
    return dt;
  }

  void accept(double dt, int ncp_iterations) {
    ++now_.step;
    if (options_.adaptive) {
      // Land exactly on a stop that the step was cut at.
      const double reached = now_.time + dt;
      now_.time = reached;
      for (const std::optional<double>& stop : {options_.reverse_at, std::optional(options_.end_time)})
        if (stop && std::abs(reached - *stop) <= 1e-12 * *stop) now_.time = *stop;
      now_.easy_steps = ncp_iterations <= 2 ? now_.easy_steps + 1 : 0;
      ++now_.since_rejection;
      if (now_.easy_steps >= 3 && now_.since_rejection > 5) {
        now_.dt = std::min(options_.time_step, 1.5 * now_.dt);
        now_.easy_steps = 0;
      }
    } else if (options_.time_counting == TimeCounting::accumulated) {
      now_.time += dt;
    } else {
      now_.time = now_.step == steps_ ? options_.end_time : static_cast<double>(now_.step) * options_.time_step;
    }
  }

  // Halves the step; false when it is as small as it may get.
  bool reject(double dt) {
    now_.since_rejection = 0;
    now_.easy_steps = 0;
    now_.dt = 0.5 * dt;
    return options_.adaptive && now_.dt >= smallest_step * options_.time_step;
  }

 private:
  const SimulationOptions& options_;
  ClockState now_;
  long steps_;
};

NcpOptions ncp_options(const SimulationOptions& options) {
  NcpOptions ncp;
  ncp.demand_progress = options.adaptive;
  ncp.max_iterations = options.adaptive                                   ? adaptive_ncp_limit
                       : options.stepper.lcp_matrix == LcpMatrix::self ? self_mobility_ncp_limit
                                                                          : fixed_step_ncp_limit;
  return ncp;
}

// Finds the smallest gap; why a run cannot go on from there, or nothing.
std::string obstacle(const Suspension& bodies, ContactModel contact, ClosestPair& closest) {
  try {
    closest = smallest_gap(bodies);
  } catch (const NumericalError& error) {  // positions beyond all bounds
    closest.gap = std::numeric_limits<double>::quiet_NaN();
    return error.what();
  }
  if (const std::string why = lost_precision(bodies); !why.empty()) return why;
  if (!(closest.gap < 0.0)) return {};
  return concat(pair_name(closest.a, closest.b), " overlap by ", brief(-closest.gap), "; try a smaller time_step",
                contact == ContactModel::none ? ", or contact = gap" : "");
}

class Run {
 public:
  Run(const Suspension& initial, const SimulationOptions& options, const Observer& observe)
      : options_(options), observe_(observe), stepper_(initial, options.stepper), clock_(options) {
    if (!options.start) return;
    stepper_.restore(options.start->poses, options.start->memory);
    rejected_ = options.start->rejected;
  }

  RunSummary to_its_end() {
    remember();
    std::string failure = obstacle(stepper_.bodies(), options_.stepper.contact, closest_);
    // Bodies that overlap from the beginning may still be parted by the first step.
    if (!failure.empty() && (options_.start || !(closest_.gap < 0.0))) return finish(failure);
    while (!clock_.done()) {
      const Suspension start = stepper_.bodies();
      const StepOutcome outcome = step();
      if (!outcome.accepted) return finish(outcome.failure);
      observe_({clock_.now().step, clock_.now().time, start, closest_.gap, &outcome, clock_.driving()});
      clock_.accept(outcome.dt, outcome.ncp_iterations);
      remember();
      failure = obstacle(stepper_.bodies(), options_.stepper.contact, closest_);
      if (!failure.empty()) return finish(failure);
      tell(RunStage::under_way);
    }
    return finish("");
  }

  // Where the present step starts.
  void tell(RunStage stage) const {
    if (options_.observe_state) options_.observe_state(state_, stage);
  }

 private:
  // The step from here; not accepted, its failure says why the run ends.
  StepOutcome step() {
    const double driving = clock_.driving();
    const NcpOptions ncp = ncp_options(options_);
    StepOutcome outcome;
    try {
      const double limit = options_.adaptive ? stepper_.geometric_step_limit(driving) : 0.0;
      if (const double least = smallest_step * options_.time_step; options_.adaptive && !(limit >= least)) {
        outcome.failure = concat("bodies turn by 0.2 or close half a width in ", brief(limit),
                                 ", below the smallest step of ", least, "; try a smaller time_step");
        return outcome;
      }
      double dt = clock_.step(limit);
      outcome = stepper_.attempt(dt, driving, ncp);
      while (!outcome.accepted && clock_.reject(dt)) {
        ++rejected_;
        dt = clock_.step(dt);
        outcome = stepper_.attempt(dt, driving, ncp);
      }
      if (!outcome.accepted)
        outcome.failure += options_.adaptive ? "; the step cannot be halved further"
                                             : "; adaptive = yes would halve the step";
    } catch (const NumericalError& error) {
      outcome.failure = error.what();
    }
    return outcome;
  }

  void remember() {
    if (!options_.observe_state) return;
    state_ = {clock_.now(), {}, stepper_.memory(), rejected_};
    for (const Body& body : stepper_.bodies()) state_.poses.push_back(body.pose);
  }

  RunSummary finish(const std::string& failure) {
    const ClockState& now = clock_.now();
    if (!failure.empty()) tell(RunStage::failed);
    observe_({now.step, now.time, stepper_.bodies(), closest_.gap, nullptr, clock_.driving()});
    if (!failure.empty()) throw NumericalError(concat("step ", now.step, ", time ", now.time, ": ", failure));
    return {now.step, rejected_, stepper_.factorisations(), stepper_.shape_count()};
  }

  const SimulationOptions& options_;
  const Observer& observe_;
  Stepper stepper_;
  Clock clock_;
  RunState state_;
  ClosestPair closest_;
  long rejected_ = 0;
};

}  // namespace

RunSummary simulate(const Suspension& initial, const SimulationOptions& options, const Observer& observe) {
  Run run(initial, options, observe);
  try {
    return run.to_its_end();
  } catch (const Interruption&) {
    run.tell(RunStage::interrupted);
    throw;
  }
}

}  // namespace stokes
