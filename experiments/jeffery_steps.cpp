// An ellipse of semi-axes 1/2 and 1/8 in u = (-5y, 0), from the angle pi/2 to t = 1/8: the error of its angle with 2, 4, 8
// and 16 steps of each integrator, against the exact solution of Jeffery's equation,
//   theta(t) = pi/2 + atan((a/b) tan(5 t a b / (a^2 + b^2))).

#include "experiment.hpp"
#include "simulation.hpp"

namespace {

using namespace stokes;

constexpr double a = 0.5, b = 0.125, shear_rate = -5.0, end_time = 0.125;
const std::vector<int> step_counts = {2, 4, 8, 16};

const std::vector<std::pair<std::string, IntegratorKind>> integrators = {{"euler", IntegratorKind::euler},
                                                                         {"ab2", IntegratorKind::ab2},
                                                                         {"rk3", IntegratorKind::rk3},
                                                                         {"midpoint", IntegratorKind::midpoint}};

double error_of(IntegratorKind integrator, int steps) {
  SimulationOptions options;
  options.stepper.flow = {FlowKind::shear, shear_rate};
  options.stepper.points_per_body = 96;
  options.stepper.stokes.gmres_tolerance = 1e-12;
  options.stepper.integrator = integrator;
  options.time_step = end_time / steps;
  options.end_time = end_time;
  double angle = 0.0;
  simulate({{{a, b}, {0.0, 0.5 * pi}, {}, 0.0}}, options, [&](const StepRecord& r) { angle = r.bodies[0].pose.angle; });
  const double exact = 0.5 * pi + std::atan(a / b * std::tan(-shear_rate * end_time * a * b / (a * a + b * b)));
  return std::abs(angle - exact);
}

void run_case(const std::string& name, const Results& results) {
  for (const auto& [integrator, kind] : integrators) {
    if (integrator != name) continue;
    Quantities row;
    for (const int steps : step_counts) row.push_back({concat("error_", steps), error_of(kind, steps)});
    results.write(name, row);
  }
}

std::vector<std::string> cases() {
  std::vector<std::string> names;
  for (const auto& integrator : integrators) names.push_back(integrator.first);
  return names;
}

}  // namespace

int main(int argc, char** argv) {
  return run_experiment({"jeffery_steps", cases(), run_case, [](const Results&) {}}, argc, argv);
}
