// Time integrators against the exact equation of an ellipse, the table of reversals, and the limits for two discs that
// slide past each other. The limits were found with steps refined to nine digits in the two-disc model with exact
// mobilities.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "neighbours.hpp"
#include "runge_kutta.hpp"
#include "simulation.hpp"

using namespace stokes;

namespace {

constexpr double spacing = pi / 32.0;  // h of discs of radius 1/2 with 32 nodes

Body disc(Complex centre) { return {{0.5, 0.5}, {centre, 0.0}, {}, 0.0}; }

SimulationOptions options(IntegratorKind integrator, double time_step, double end_time) {
  SimulationOptions how;
  how.stepper.flow = {FlowKind::shear, 2.0};
  how.stepper.stokes.gmres_tolerance = 1e-10;
  how.stepper.integrator = integrator;
  if (integrator != IntegratorKind::euler) how.stepper.contact_tolerance = 1e-6;
  how.time_step = time_step;
  how.end_time = end_time;
  return how;
}

void control_error(SimulationOptions& how, double tolerance) {
  how.adaptive = true;
  how.tolerance = how.stepper.tolerance = tolerance;
  how.stepper.stokes.gmres_tolerance = 0.01 * tolerance;
  how.stepper.contact_tolerance = std::min(1e-6, 0.1 * tolerance * 0.5 / how.stepper.separation);
}

struct Motion {
  Suspension end;
  double smallest_gap = 1e300, imbalance = 0.0;
  int solves = 0, rejected_by_error = 0, contact_steps = 0;
  std::vector<double> time, dt, multiplier;
};

Motion move(const Suspension& start, const SimulationOptions& how) {
  Motion motion;
  simulate(start, how, [&](const StepRecord& r) {
    motion.end = r.bodies;
    motion.smallest_gap = std::min(motion.smallest_gap, r.min_gap);
    if (!r.outcome) return;
    motion.solves += r.outcome->stokes_solves;
    motion.rejected_by_error += r.outcome->rejected_by_error;
    motion.contact_steps += !r.outcome->contacts.empty();
    motion.time.push_back(r.time), motion.dt.push_back(r.outcome->dt);
    motion.multiplier.push_back(r.outcome->contacts.empty() ? 0.0 : r.outcome->contacts[0].multiplier);
    Wrench sum;
    for (const Wrench& w : r.outcome->contact_wrench) sum.force += w.force, sum.torque += w.torque;
    motion.imbalance = std::max(motion.imbalance, std::abs(sum.force));
  });
  return motion;
}

// The run and error of Table 1: two discs in u = (2y, 0), which is reversed at t = 10.
Motion there_and_back(SimulationOptions how, double& error) {
  how.reverse_at = 10.0;
  const Suspension start = {disc({-8.0, 0.5}), disc({0.0, 0.0})};
  const Motion motion = move(start, how);
  double moved = 0.0, scale = 0.0;
  for (int i : {0, 1}) {
    moved += std::norm(motion.end[i].pose.centre - start[i].pose.centre);
    scale += std::norm(start[i].pose.centre);
  }
  error = std::sqrt(moved / scale);
  return motion;
}

// The distance by which two touching discs slide past each other, with the separation 2.5 h, from the angle -.6 in a time
// of .6.
Complex slide(IntegratorKind integrator, int steps) {
  SimulationOptions how = options(integrator, 0.6 / steps, 0.6);
  how.stepper.separation = 2.5 * spacing;
  const Complex half = 0.5 * (1.0 + how.stepper.separation) * std::polar(1.0, -0.6);
  const Motion motion = move({disc(-half), disc(half)}, how);
  CHECK(motion.contact_steps == steps);
  CHECK(motion.smallest_gap >= how.stepper.separation * (1.0 - 2.0 * how.stepper.contact_tolerance));
  CHECK(motion.imbalance < 1e-13);
  return motion.end[1].pose.centre - motion.end[0].pose.centre;
}

// A step from given bodies whose stages can be inspected.
class OneStep : public StepStart {
 public:
  OneStep(Suspension bodies, const StepperOptions& options)
      : bodies_(std::move(bodies)), fluid_(options), contacts_(options) {}

  const Suspension& bodies() const override { return bodies_; }
  std::shared_ptr<Configuration> configuration() override {
    if (!start_) start_ = std::make_shared<Configuration>(bodies_, 0.0, 1.0, fluid_, memory_);
    return start_;
  }
  std::shared_ptr<Configuration> configuration(const std::vector<Pose>& poses, double elapsed) override {
    return std::make_shared<Configuration>(at(poses), elapsed, 1.0, fluid_, memory_);
  }
  double path_after(double elapsed) const override { return elapsed; }
  bool continues() const override { return false; }
  double relative_gap(const std::vector<Pose>& poses) const override {
    return smallest_gap(at(poses)).gap / fluid_.options.separation;
  }
  ContactSolution solve(Configuration& at, const std::vector<Pose>& base, double length) override {
    return contacts_.solve(bodies_, at, base, length, {});
  }
  std::vector<RigidVelocity> contact_velocity(Configuration& at, const std::vector<ActiveContact>& contacts) override {
    return contacts_.respond(at, contacts).velocity;
  }

  Suspension at(const std::vector<Pose>& poses) const {
    Suspension bodies = bodies_;
    for (std::size_t i = 0; i < bodies.size(); ++i) bodies[i].pose = poses[i];
    return bodies;
  }

 private:
  Suspension bodies_;
  Fluid fluid_;
  FluidMemory memory_;
  ContactProblem contacts_;
  std::shared_ptr<Configuration> start_;
};

const std::map<std::string, IntegratorKind> of_second_order = {
    {"ab2", IntegratorKind::ab2}, {"rk3", IntegratorKind::rk3}, {"midpoint", IntegratorKind::midpoint}};

}  // namespace

TEST_CASE("the angle of an ellipse in shear has the errors of each scheme") {
  // u = (-5y, 0): theta' = 5 (a^2 sin^2 + b^2 cos^2) / (a^2 + b^2), from pi/2, at t = 1/8.
  const double a = 0.5, b = 0.125;
  const double exact = 0.5 * pi + std::atan(a / b * std::tan(0.625 * a * b / (a * a + b * b)));
  const std::map<IntegratorKind, std::vector<double>> expected = {
      {IntegratorKind::euler, {0.0301666846, 0.0153871543, 0.0077363440, 0.0038759068}},
      {IntegratorKind::ab2, {0.0185803702, 0.0045386335, 0.0011280710, 0.0002807827}},
      {IntegratorKind::rk3, {1.28155e-5, 3.1236e-6, 4.460e-7, 5.83e-8}},
      {IntegratorKind::midpoint, {0.0031763880, 0.0007899185, 0.0001972191, 0.0000492885}}};
  for (const auto& [integrator, errors] : expected)
    for (int k = 0; k < 4; ++k) {
      SimulationOptions how = options(integrator, 0.0625 / (1 << k), 0.125);
      how.stepper.flow.rate = -5.0;
      how.stepper.points_per_body = 96;
      how.stepper.stokes.gmres_tolerance = 1e-12;
      const Motion motion = move({{{a, b}, {0.0, 0.5 * pi}, {}, 0.0}}, how);
      CHECK(std::abs(std::abs(motion.end[0].pose.angle - exact) - errors[k]) < 4e-8);
    }
}

TEST_CASE("without contact a reversed flow takes the discs back as far as the order of the scheme allows") {
  const std::map<IntegratorKind, std::vector<double>> expected = {
      {IntegratorKind::euler, {0.24683, 0.13945}},
      {IntegratorKind::ab2, {1.152e-2, 1.394e-3}},
      {IntegratorKind::rk3, {8.505e-4, 1.081e-4}}};
  double error = 0.0;
  for (const auto& [integrator, errors] : expected)
    for (int k : {0, 1}) {
      there_and_back(options(integrator, 0.08 / (1 << k), 20.0), error);
      CHECK(std::abs(error / errors[k] - 1.0) < 1e-3);
    }
  for (const double tolerance : {1e-8, 1e-12}) {
    SimulationOptions how = options(IntegratorKind::midpoint, 0.08, 20.0);
    how.stepper.stokes.gmres_tolerance = tolerance;
    there_and_back(how, error);
    MESSAGE("midpoint, tolerance ", tolerance, " of GMRES: ", error);
    CHECK(error < 1e3 * tolerance);
  }
}

TEST_CASE("with contact the errors of a reversal tend to their limits") {
  double error = 0.0;
  for (const auto& [separation, limit] : {std::pair(2.0, 0.095364181), {3.0, 0.359264352}}) {
    SimulationOptions how = options(IntegratorKind::rk3, 0.2, 20.0);
    how.stepper.separation = separation * spacing;
    control_error(how, 1e-5);
    const Motion motion = there_and_back(how, error);
    MESSAGE(separation, " h: off the limit by ", error - limit, ", ", motion.solves, " solves, ", motion.rejected_by_error,
            " rejections");
    CHECK(std::abs(error - limit) < 5e-5);
    CHECK(motion.smallest_gap >= how.stepper.separation * (1.0 - 2.0 * how.stepper.contact_tolerance));
    CHECK(motion.solves < 1500);
  }
  const std::vector<double> of_ab2 = {5.00e-3, 1.49e-3};
  for (int k : {0, 1}) {
    SimulationOptions how = options(IntegratorKind::ab2, 0.04 / (1 << k), 20.0);
    how.stepper.separation = 2.0 * spacing;
    there_and_back(how, error);
    CHECK(std::abs((0.095364181 - error) / of_ab2[k] - 1.0) < 0.01);
  }
}

TEST_CASE("errors follow the tolerance, with contact") {
  double error = 0.0;
  for (const double tolerance : {1e-3, 1e-4, 1e-6}) {
    SimulationOptions how = options(IntegratorKind::rk3, 0.2, 20.0);
    how.stepper.separation = 3.0 * spacing;
    control_error(how, tolerance);
    there_and_back(how, error);
    const double ratio = std::abs(error - 0.359264352) / tolerance;
    MESSAGE("tolerance ", tolerance, ": error / tolerance ", ratio);
    CHECK(ratio > 0.1);
    CHECK(ratio < 10.0);
  }
}

TEST_CASE("discs that slide past each other converge at second order") {
  const Complex fine = slide(IntegratorKind::rk3, 320);
  for (const auto& [name, integrator] : of_second_order) {
    const double coarse = std::abs(slide(integrator, 20) - fine), half = std::abs(slide(integrator, 40) - fine);
    MESSAGE(name, ": errors ", coarse, " ", half, ", order ", std::log2(coarse / half));
    CHECK(std::log2(coarse / half) > 1.8);
  }
}

TEST_CASE("every stage keeps the separation, and its contact forces balance where the fluid is solved") {
  // A row of discs and nearly circular ellipses that is pressed together and sheared.
  StepperOptions options;
  options.flow = {FlowKind::shear, 1.0};
  options.separation = 0.05;
  options.contact_tolerance = 1e-6;
  options.stokes.gmres_tolerance = 1e-8;
  Suspension row;
  for (int i = 0; i < 5; ++i)
    row.push_back({{0.5, i % 2 ? 0.49 : 0.5}, {{1.051 * (i - 2), 0.02 * (i % 3)}, 0.05 * i}, {-40.0 * (i - 2), 0.0}, 0.0});
  for (const LcpMatrix matrix : {LcpMatrix::full, LcpMatrix::near}) {
    options.lcp_matrix = matrix;
    OneStep start(row, options);
    const Trial trial = RungeKutta(rk3_tableau()).attempt(start, 0.05);
    REQUIRE(trial.failure == "");
    REQUIRE(trial.stages.size() == 3);
    for (const Stage& stage : trial.stages) {
      CHECK(stage.solution.contacts.size() == 4);
      CHECK(start.relative_gap(stage.solution.poses) >= 1.0 - 2.0 * options.contact_tolerance);
      Wrench sum;
      double scale = 0.0;
      for (std::size_t i = 0; i < row.size(); ++i) {
        const Wrench& w = stage.solution.wrenches[i];
        sum.force += w.force;
        sum.torque += w.torque + cross(stage.at->bodies()[i].pose.centre, w.force);
        scale = std::max(scale, std::abs(w.force));
      }
      CHECK(std::abs(sum.force) <= 1e-14 * scale);
      CHECK(std::abs(sum.torque) <= 1e-14 * scale);
      for (const ActiveContact& c : stage.solution.contacts) CHECK(c.multiplier > 0.0);
    }
  }
}

TEST_CASE("the multiplier of a step is that of its middle, to second order, from its first steps on") {
  const auto multiplier_at = [](const Motion& motion, double t) {
    std::size_t k = 0;
    while (k + 1 < motion.time.size() && motion.time[k] + 0.5 * motion.dt[k] < t) ++k;
    const double t1 = motion.time[k] + 0.5 * motion.dt[k], t0 = motion.time[k - 1] + 0.5 * motion.dt[k - 1];
    return motion.multiplier[k - 1] + (t - t0) / (t1 - t0) * (motion.multiplier[k] - motion.multiplier[k - 1]);
  };
  const auto sliding = [](IntegratorKind integrator, int steps) {
    SimulationOptions how = options(integrator, 0.6 / steps, 0.6);
    how.stepper.separation = 2.5 * spacing;
    const Complex half = 0.5 * (1.0 + how.stepper.separation) * std::polar(1.0, -0.6);
    return move({disc(-half), disc(half)}, how);
  };
  const Motion fine = sliding(IntegratorKind::rk3, 320);
  for (const auto& [name, integrator] : of_second_order) {
    double errors[2];
    for (int k : {0, 1}) {
      const Motion motion = sliding(integrator, 20 << k);
      errors[k] = 0.0;
      for (std::size_t j = 2; j < motion.time.size(); ++j) {
        const double exact = multiplier_at(fine, motion.time[j] + 0.5 * motion.dt[j]);
        errors[k] = std::max(errors[k], std::abs(motion.multiplier[j] - exact) / exact);
      }
    }
    MESSAGE(name, ": relative errors of the multiplier ", errors[0], " ", errors[1]);
    CHECK(errors[0] < 0.02);
    CHECK(std::log2(errors[0] / errors[1]) > 1.7);
  }
}

TEST_CASE("bodies that start too close are parted by one step that the tolerance does not judge") {
  SimulationOptions how = options(IntegratorKind::rk3, 0.05, 1.0);
  how.stepper.separation = 2.0 * spacing;
  control_error(how, 1e-6);
  const Motion motion = move({disc({-0.55, 0.0}), disc({0.55, 0.1})}, how);
  CHECK(motion.time.size() < 400);
  CHECK(motion.contact_steps > 0);
  // With the velocities of the jump the second step of Adams and Bashforth would throw the discs apart.
  SimulationOptions ab2 = options(IntegratorKind::ab2, 0.01, 0.02), euler = options(IntegratorKind::euler, 0.01, 0.02);
  ab2.stepper.separation = euler.stepper.separation = 2.0 * spacing;
  const double after_ab2 = smallest_gap(move({disc({-0.52, 0.0}), disc({0.52, 0.0})}, ab2).end).gap;
  const double after_euler = smallest_gap(move({disc({-0.52, 0.0}), disc({0.52, 0.0})}, euler).end).gap;
  CHECK(std::abs(after_ab2 - after_euler) < 0.1 * spacing);
}

TEST_CASE("stages do not overlap where the end would not show it") {
  SimulationOptions how = options(IntegratorKind::rk3, 0.5, 10.0);
  how.stepper.accuracy = 1e-5;
  how.stepper.contact_tolerance = 1e-4;  // of a separation of 1e-7 radii
  const Motion motion = move({disc({-3.0, 0.05}), disc({0.0, 0.0})}, how);  // they meet nearly head on
  CHECK(motion.contact_steps > 0);
  CHECK(motion.smallest_gap > 0.0);
}

// At the middle of an implicit step the gap is smaller than at its ends; if it is much smaller, the step fails and says so.
TEST_CASE("a midpoint step whose middle comes too close is refused") {
  SimulationOptions how = options(IntegratorKind::midpoint, 0.6, 0.6);
  how.stepper.separation = 0.02;
  const Complex half = 0.51 * std::polar(1.0, -0.6);
  std::string failure;
  try {
    move({disc(-half), disc(half)}, how);
  } catch (const NumericalError& error) {
    failure = error.what();
  }
  CHECK(failure.find("middle of the step") != std::string::npos);
}
