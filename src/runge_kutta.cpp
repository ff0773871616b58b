#include "runge_kutta.hpp"

#include <numeric>

namespace stokes {

Tableau euler_tableau() { return {{{1.0}}}; }

Tableau rk3_tableau() { return {{{1.0 / 2.0}, {0.0, 3.0 / 4.0}, {2.0 / 9.0, 1.0 / 3.0, 4.0 / 9.0}}}; }

Trial RungeKutta::attempt(StepStart& start, double dt) {
  Trial trial;
  start.configuration();  // what fails here fails for every step
  try {
    make_stages(start, dt, trial);
    if (trial.failure.empty() && estimates_) estimate(start, dt, trial);
  } catch (const NumericalError& error) {  // at a stage, which is nearer with a smaller step
    if (tableau_.a.size() == 1) throw;
    trial.failure = error.what();
  }
  return trial;
}

void RungeKutta::make_stages(StepStart& start, double dt, Trial& trial) const {
  const std::vector<double>& b = tableau_.a.back();
  const std::vector<Pose> first = poses_of(start.bodies());
  trial.poses = first;
  double elapsed = 0.0;
  for (std::size_t i = 0; i < tableau_.a.size(); ++i) {
    const std::vector<double>& weights = tableau_.a[i];
    Stage stage{b[i], i == 0 ? start.configuration() : start.configuration(trial.poses, elapsed), {}};
    std::vector<Pose> base = first;
    for (std::size_t j = 0; j < i; ++j)
      if (weights[j] != 0.0) base = advanced(base, weights[j] * dt, trial.stages[j].solution.velocity);
    stage.solution = start.solve(*stage.at, base, weights[i] * dt);
    trial.failure = stage.solution.failure;
    if (!stage.solution.solved) return;
    trial.poses = stage.solution.poses;
    elapsed = std::accumulate(weights.begin(), weights.end(), 0.0) * dt;
    trial.stages.push_back(std::move(stage));
  }
  trial.velocity = mean_velocity(trial.stages);
}

void RungeKutta::estimate(StepStart& start, double dt, Trial& trial) const {
  const ContactSolution embedded = start.solve(*trial.stages[1].at, poses_of(start.bodies()), dt);
  trial.failure = embedded.failure;
  if (embedded.solved) trial.error = error_norm(start.bodies(), trial.poses, embedded.poses);
}

}  // namespace stokes
