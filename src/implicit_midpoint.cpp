#include "implicit_midpoint.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stokes {

namespace {

constexpr int most_iterations = 30;
constexpr double least_gap = 0.5;        // of X, in separations
constexpr double solver_noise = 3.0;     // in tolerances of GMRES; smaller differences of iterates are meaningless
constexpr double round_off = 1e-14;

std::vector<Pose> halfway(const std::vector<Pose>& u, const std::vector<Pose>& v) {
  std::vector<Pose> middle(u.size());
  for (std::size_t i = 0; i < u.size(); ++i)
    middle[i] = {0.5 * (u[i].centre + v[i].centre), 0.5 * (u[i].angle + v[i].angle)};
  return middle;
}

}  // namespace

ImplicitMidpoint::ImplicitMidpoint(const StepperOptions& options)
    : gmres_tolerance_(options.accuracy > 0.0 ? options.accuracy : options.stokes.gmres_tolerance) {}

// Linear in the path, so that it also holds when the flow is reversed.
std::vector<RigidVelocity> ImplicitMidpoint::expected_velocity(StepStart& start, double dt) const {
  if (latest_.empty() || !start.continues()) return start.configuration()->contact_free().velocity;
  if (latest_.size() == 1) return latest_[0].velocity;
  const double path = start.path_after(0.5 * dt);
  const double t = (path - latest_[0].path) / (latest_[1].path - latest_[0].path);
  std::vector<RigidVelocity> w = latest_[1].velocity;
  for (std::size_t i = 0; i < w.size(); ++i) {
    w[i].velocity += (t - 1.0) * (latest_[1].velocity[i].velocity - latest_[0].velocity[i].velocity);
    w[i].omega += (t - 1.0) * (latest_[1].velocity[i].omega - latest_[0].velocity[i].omega);
  }
  return w;
}

Trial ImplicitMidpoint::attempt(StepStart& start, double dt) {
  Trial trial;
  try {
    iterate(start, dt, trial);
  } catch (const NumericalError& error) {  // at the middle, which is nearer with a smaller step
    trial.failure = error.what();
  }
  return trial;
}

void ImplicitMidpoint::iterate(StepStart& start, double dt, Trial& trial) const {
  const Suspension& bodies = start.bodies();
  const std::vector<Pose> first = poses_of(bodies);
  std::vector<Pose> middle = advanced(first, 0.5 * dt, expected_velocity(start, dt));
  double before = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    if (const double gap = start.relative_gap(middle); gap < least_gap) {
      trial.failure = concat("bodies come as close as ", brief(gap),
                             " separations in the middle of the step; integrator = rk3 ", "keeps the separation there, too");
      return;
    }
    Stage stage{1.0, start.configuration(middle, 0.5 * dt), {}};
    stage.solution = start.solve(*stage.at, first, dt);
    trial.failure = stage.solution.failure;
    if (!stage.solution.solved) return;
    const std::vector<Pose> next = halfway(first, stage.solution.poses);
    const double change = error_norm(bodies, next, middle);
    const double noise = solver_noise * gmres_tolerance_ * error_norm(bodies, next, first);
    trial.poses = stage.solution.poses;
    trial.stages.clear();
    trial.stages.push_back(std::move(stage));
    if (change <= std::max(round_off, noise) || (change >= before && change < 1e3 * noise)) {
      trial.velocity = trial.stages[0].solution.velocity;
      return;
    }
    before = change;
    middle = next;
  }
  trial.failure = concat("the middle of the step was not found in ", most_iterations, " iterations");
}

void ImplicitMidpoint::accept(const Trial& trial, double) {
  const Stage& stage = trial.stages.front();
  if (!latest_.empty() && latest_[0].driving != stage.at->driving()) latest_.clear();
  latest_.push_back({stage.at->path(), stage.at->driving(), stage.solution.velocity});
  if (latest_.size() > 2) latest_.erase(latest_.begin());
}

void ImplicitMidpoint::save(StateWriter& writer) const {
  writer.line("middles", latest_.size());
  for (const Middle& middle : latest_) {
    writer.line("middle", middle.path, middle.driving);
    writer.line("velocity", numbers_of(middle.velocity));
  }
}

void ImplicitMidpoint::restore(StateReader& reader) {
  latest_.clear();
  reader.begin("middles");
  latest_.resize(reader.integer<std::size_t>());
  for (Middle& middle : latest_) {
    reader.begin("middle");
    middle.path = reader.number();
    middle.driving = reader.number();
    middle.velocity = velocities_of(reader.numbers("velocity"));
  }
}

}  // namespace stokes
