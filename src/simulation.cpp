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

// The self-mobility matrix takes a thousand iterations at gaps of a few per cent, the full one a few.
constexpr int fixed_step_ncp_limit = 50, self_mobility_ncp_limit = 5000, adaptive_ncp_limit = 10;

NcpOptions ncp_options(const SimulationOptions& options) {
  NcpOptions ncp;
  ncp.demand_progress = options.adaptive;
  ncp.max_iterations = options.adaptive && options.tolerance == 0.0    ? adaptive_ncp_limit
                       : options.stepper.lcp_matrix == LcpMatrix::self ? self_mobility_ncp_limit
                                                                          : fixed_step_ncp_limit;
  return ncp;
}

// Finds the smallest gap and says why a run cannot continue from there; empty if it can.
std::string obstacle(const Suspension& bodies, ContactModel contact, ClosestPair& closest) {
  try {
    closest = smallest_gap(bodies);
  } catch (const NumericalError& error) {  // positions beyond all bounds
    closest.gap = std::numeric_limits<double>::quiet_NaN();
    return error.what();
  }
  if (const std::string why = lost_precision(bodies); !why.empty()) return why;
  if (!(closest.gap < 0.0)) return {};
  if (bodies[closest.a].fixed && (closest.b == container_index || bodies[closest.b].fixed))
    return concat(pair_name(closest.a, closest.b), " overlap by ", brief(-closest.gap),
                  ": both move as they are given; end the run before, or change ux, uy or omega");
  return concat(pair_name(closest.a, closest.b), " overlap by ", brief(-closest.gap), "; try a smaller time_step",
                contact == ContactModel::none ? ", or contact = gap" : "");
}

class Run : public RunState {
 public:
  Run(const Suspension& initial, const SimulationOptions& options, const Observer& observe)
      : options_(options), observe_(observe), stepper_(initial, options.stepper), controller_(options), at_start_(options) {
    if (options.start) {
      StateReader reader(options.start->text);
      controller_.restore(reader);
      stepper_.restore(reader);
    }
    at_start_ = controller_;
  }

  long step() const override { return at_start_.step(); }
  double time() const override { return at_start_.time(); }
  // The stepper stays where it is until a step is accepted.
  SavedRun save() const override {
    StateWriter writer;
    at_start_.save(writer);
    stepper_.save(writer);
    return {step(), time(), writer.text()};
  }

  RunSummary to_its_end() {
    std::string failure = obstacle(stepper_.bodies(), options_.stepper.contact, closest_);
    // The first step may still part bodies that overlap from the beginning.
    if (!failure.empty() && (options_.start || !(closest_.gap < 0.0))) return finish(failure);
    while (!controller_.done()) {
      const StepOutcome outcome = attempt();
      if (!outcome.accepted) return finish(outcome.failure);
      observe_({step(), time(), stepper_.bodies(), closest_.gap, &outcome, controller_.driving()});
      stepper_.accept();
      controller_.accept(outcome);
      at_start_ = controller_;
      failure = obstacle(stepper_.bodies(), options_.stepper.contact, closest_);
      if (!failure.empty()) return finish(failure);
      tell(RunStage::under_way);
    }
    return finish("");
  }

  void tell(RunStage stage) const {
    if (options_.observe_state) options_.observe_state(*this, stage);
  }

 private:
  // The step from here, of a length that succeeds. If it is not accepted, its failure says why the run ends.
  StepOutcome attempt() {
    const double driving = controller_.driving();
    const NcpOptions ncp = ncp_options(options_);
    StepOutcome outcome;
    try {
      const double limit = options_.adaptive ? stepper_.geometric_step_limit(driving) : 0.0;
      if (const double least = controller_.smallest_step(); options_.adaptive && !(limit >= least)) {
        outcome.failure = concat("bodies turn by 0.2 or close half a width in ", brief(limit),
                                 ", below the smallest step of ", least, "; try a smaller time_step");
        return outcome;
      }
      outcome = stepper_.attempt(controller_.propose(limit), driving, ncp);
      while (!controller_.takes(outcome) && controller_.reject(outcome))
        outcome = stepper_.attempt(controller_.propose(outcome.dt), driving, ncp);
      outcome.rejected_by_error = controller_.rejected_by_error();
      outcome.rejected_by_failure = controller_.rejected_by_failure();
      if (outcome.accepted && !controller_.takes(outcome)) {
        outcome.accepted = false;
        outcome.failure = concat("the error of the step is ", brief(*outcome.error), ", above the tolerance");
      }
      if (!outcome.accepted)
        outcome.failure += options_.adaptive ? "; the step cannot be halved further"
                                             : "; adaptive = yes would halve the step";
    } catch (const NumericalError& error) {
      outcome.accepted = false;
      outcome.failure = error.what();
    }
    return outcome;
  }

  RunSummary finish(const std::string& failure) {
    if (!failure.empty()) tell(RunStage::failed);
    observe_({step(), time(), stepper_.bodies(), closest_.gap, nullptr, controller_.driving()});
    if (!failure.empty()) throw NumericalError(concat("step ", step(), ", time ", time(), ": ", failure));
    return {step(), controller_.rejected(), stepper_.factorisations(), stepper_.shape_count()};
  }

  const SimulationOptions& options_;
  const Observer& observe_;
  Stepper stepper_;
  StepController controller_, at_start_;  // now, and at the start of the step under way
  ClosestPair closest_;
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
