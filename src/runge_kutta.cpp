#include "runge_kutta.hpp"

#include <numeric>

namespace stokes {

Tableau euler_tableau() { return {{{1.0}}}; }

Trial RungeKutta::attempt(StepStart& start, double dt) {
  Trial trial;
  const std::vector<double>& b = tableau_.a.back();
  const std::vector<Pose> first = poses_of(start.bodies());
  trial.poses = first;
  double elapsed = 0.0;
  for (std::size_t i = 0; i < tableau_.a.size(); ++i) {
    const std::vector<double>& weights = tableau_.a[i];
    Stage stage{b[i], i == 0 ? start.configuration() : start.configuration(trial.poses, elapsed), {}};
    std::vector<Pose> base = first;
    for (std::size_t j = 0; j < i; ++j)
      base = advanced(start.bodies(), base, weights[j] * dt, trial.stages[j].solution.velocity);
    stage.solution = start.solve(*stage.at, base, weights[i] * dt);
    trial.failure = stage.solution.failure;
    if (!stage.solution.solved) return trial;
    trial.poses = stage.solution.poses;
    elapsed = std::accumulate(weights.begin(), weights.end(), 0.0) * dt;
    trial.stages.push_back(std::move(stage));
  }
  trial.velocity = mean_velocity(trial.stages);
  return trial;
}

}  // namespace stokes
