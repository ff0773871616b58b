// Runs by the library: time counting, reversal, adaptive steps, and conditions after every step.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "neighbours.hpp"
#include "random_suspension.hpp"
#include "simulation.hpp"
#include "threads.hpp"

using namespace stokes;

namespace {

Body body(double a, double b, Complex centre, double angle = 0.0, Complex force = 0.0) {
  return {{a, b}, {centre, angle}, force, 0.0};
}

const Suspension one_disc = {body(0.5, 0.5, {0.0, 2.0})};

SimulationOptions options(FlowKind flow, double rate, int points, double time_step, double end_time) {
  SimulationOptions result;
  result.stepper.flow = {flow, rate};
  result.stepper.points_per_body = points;
  result.time_step = time_step;
  result.end_time = end_time;
  return result;
}

// The states that the observer saw, the final configuration last.
struct Run {
  std::vector<long> step;
  std::vector<double> time, min_gap;
  std::vector<Suspension> bodies;
  std::vector<StepOutcome> outcomes;
  int finals = 0;
  RunSummary summary;
  std::string failure;

  std::vector<double> steps() const {
    std::vector<double> dt;
    for (const StepOutcome& outcome : outcomes) dt.push_back(outcome.dt);
    return dt;
  }
  double driving(int k) const { return -2.0 * outcomes[k].velocity[0].omega; }  // of a disc in unit shear
};
Run observe(const Suspension& initial, const SimulationOptions& how) {
  Run run;
  try {
    run.summary = simulate(initial, how, [&run](const StepRecord& record) {
      run.step.push_back(record.step);
      run.time.push_back(record.time);
      run.min_gap.push_back(record.min_gap);
      run.bodies.push_back(record.bodies);
      if (record.outcome) run.outcomes.push_back(*record.outcome);
      run.finals += record.outcome == nullptr;
    });
  } catch (const NumericalError& error) {
    run.failure = error.what();
  }
  return run;
}

bool same_bits(const Suspension& u, const Suspension& v) {
  return std::equal(u.begin(), u.end(), v.begin(), v.end(), [](const Body& a, const Body& b) {
    return a.pose.centre == b.pose.centre && a.pose.angle == b.pose.angle;
  });
}

bool same_bits(const StepOutcome& u, const StepOutcome& v) {
  bool same = u.velocity.size() == v.velocity.size();
  for (std::size_t i = 0; same && i < u.velocity.size(); ++i)
    same = u.velocity[i].velocity == v.velocity[i].velocity && u.velocity[i].omega == v.velocity[i].omega &&
           u.contact_wrench[i].force == v.contact_wrench[i].force &&
           u.contact_wrench[i].torque == v.contact_wrench[i].torque;
  return same;
}

// Two discs that a strain presses together, closer than the given separation.
const Suspension pressed = {body(0.5, 0.5, {0.0, -0.52}, 0.3), body(0.5, 0.5, {0.01, 0.52}, -1.0)};
StepperOptions pressing() {
  StepperOptions result;
  result.flow = {FlowKind::extension, 2.0};
  result.points_per_body = 48;
  result.separation = 0.06;
  return result;
}

// Too little work to share: waiting threads would cost more than they save.
struct OneThread {
  int before = thread_count();
  OneThread() { set_thread_count(1); }
  ~OneThread() { set_thread_count(before); }
};

}  // namespace

TEST_CASE("the observer sees every state once and in order, the final one without an outcome") {
  const Run run = observe(one_disc, options(FlowKind::shear, 1.0, 16, 0.1, 0.5));
  CHECK(run.failure == "");
  CHECK(run.step == std::vector<long>{0, 1, 2, 3, 4, 5});
  CHECK(run.outcomes.size() == 5);
  CHECK(run.finals == 1);
  CHECK(run.summary.steps == 5);
  CHECK(run.summary.rejected == 0);
  CHECK(same_bits(run.bodies.front(), one_disc));
  for (int k = 0; k < 5; ++k) {
    Suspension moved = run.bodies[k];
    moved[0].pose = advance(moved[0].pose, run.outcomes[k].velocity[0], run.outcomes[k].dt);
    CHECK(same_bits(moved, run.bodies[k + 1]));
  }
}

TEST_CASE("a run factorises each distinct shape once") {
  const Run run = observe(six_ellipses(), options(FlowKind::shear, 1.0, 16, 0.02, 0.1));
  CHECK(run.summary.shapes == 3);
  CHECK(run.summary.factorisations == 3);
}

TEST_CASE("a reversed run of one body comes back to where it began") {
  for (const TimeCounting counting : {TimeCounting::exact, TimeCounting::accumulated}) {
    SimulationOptions how = options(FlowKind::shear, 1.0, 16, 0.125, 2.0);  // a step without rounding
    how.reverse_at = 1.0;
    how.time_counting = counting;
    const Run run = observe(one_disc, how);
    REQUIRE(run.outcomes.size() == 16);
    for (int k = 0; k < 16; ++k) CHECK(std::abs(run.driving(k) - (k < 8 ? 1.0 : -1.0)) < 1e-12);
    CHECK(std::abs(run.bodies[8][0].pose.centre - Complex(2.0, 2.0)) < 1e-12);
    CHECK(std::abs(run.bodies.back()[0].pose.centre - one_disc[0].pose.centre) < 1e-12);
    CHECK(std::abs(run.bodies.back()[0].pose.angle) < 1e-12);
  }
}

TEST_CASE("reversal reverses the flow only: an external torque keeps its direction") {
  Suspension turned = one_disc;
  turned[0].torque = 1.0;
  SimulationOptions how = options(FlowKind::none, 1.0, 16, 0.25, 1.0);
  how.reverse_at = 0.5;
  const Run run = observe(turned, how);
  for (const StepOutcome& outcome : run.outcomes) CHECK(std::abs(outcome.velocity[0].omega - 1.0 / pi) < 1e-12);
}

TEST_CASE("adaptive steps that nothing limits are the fixed ones, without a sliver at the end") {
  for (double end_time : {1.0, 0.3, 0.7, 2.1, 12.3}) {  // none is a sum of tenths in floating point
    SimulationOptions how = options(FlowKind::shear, 1.0, 16, 0.1, end_time);
    how.adaptive = true;
    const Run run = observe(one_disc, how);
    CHECK(static_cast<long>(run.outcomes.size()) == std::lround(end_time / 0.1));
    CHECK(run.time.back() == end_time);
    for (double dt : run.steps()) CHECK(std::abs(dt - 0.1) < 1e-12);
  }
}

TEST_CASE("adaptive steps are cut at reverse_at and at end_time and reach both exactly") {
  for (const TimeCounting counting : {TimeCounting::exact, TimeCounting::accumulated}) {
    SimulationOptions how = options(FlowKind::shear, 1.0, 16, 0.3, 1.7);
    how.adaptive = true;
    how.reverse_at = 0.77;
    how.time_counting = counting;
    const Run run = observe(one_disc, how);
    const auto at = std::find(run.time.begin(), run.time.end(), 0.77);
    REQUIRE(at != run.time.end());
    CHECK(run.time.back() == 1.7);
    for (int k = 0; k < static_cast<int>(run.outcomes.size()); ++k) {
      CHECK(std::abs(run.driving(k) - (k < at - run.time.begin() ? 1.0 : -1.0)) < 1e-12);
      CHECK(run.outcomes[k].dt <= 0.3);
      CHECK(std::abs(run.time[k] + run.outcomes[k].dt - run.time[k + 1]) < 1e-14);
    }
  }
}

TEST_CASE("no adaptive step turns a body by more than 0.2 or brings neighbours closer by half their width") {
  SimulationOptions how = options(FlowKind::shear, 10.0, 16, 1.0, 1.0);
  how.adaptive = true;
  const Run turning = observe({body(0.5, 0.5, 0.0)}, how);
  REQUIRE(turning.outcomes.size() > 20);
  for (const StepOutcome& outcome : turning.outcomes)
    CHECK(std::abs(outcome.velocity[0].omega) * outcome.dt <= 0.2 * (1.0 + 1e-12));

  how.stepper.flow.kind = FlowKind::none;
  const Suspension meeting = {body(0.5, 0.3, -0.6, 0.0, 40.0), body(0.5, 0.2, 0.6, 0.0, -40.0)};
  Stepper stepper(meeting, how.stepper);
  const double limit = stepper.geometric_step_limit(1.0);
  const std::vector<RigidVelocity> u = stepper.step(1e-9, 1.0, {}).velocity;
  CHECK(std::abs(limit * std::abs(u[1].velocity - u[0].velocity) - 0.2) < 1e-12);
  CHECK(stepper.bodies()[1].pose.centre.real() < 0.6);  // they do approach
}

TEST_CASE("a rejected step is halved, down to 1e-6 of time_step and not below") {
  // In the step that the geometry allows the discs pass each other; a quarter of it is resolved.
  const Suspension shot = {body(0.5, 0.5, -2.0, 0.0, 100.0), body(0.5, 0.5, {2.0, 0.3}, 0.0, -100.0)};
  SimulationOptions how = options(FlowKind::none, 1.0, 64, 1.0, 0.5);
  how.stepper.separation = 0.02;
  how.adaptive = true;
  Stepper stepper(shot, how.stepper);
  const double allowed = std::min(0.5, stepper.geometric_step_limit(1.0));
  const Run run = observe(shot, how);
  REQUIRE(run.failure == "");
  CHECK(run.summary.rejected >= 1);
  const double halvings = std::log2(allowed / run.outcomes.front().dt);
  CHECK(halvings > 0.5);
  CHECK(std::abs(halvings - std::round(halvings)) < 1e-12);

  // The geometry allows more than the .5 of the first step, of which a half is taken, and .025 in the second.
  how.time_step = 1e4;
  CHECK(observe(shot, how).failure == "");
  how.time_step = 1e6;
  CHECK(observe(shot, how).failure.find("halved further") != std::string::npos);
  how.time_step = 1e7;
  CHECK(observe(shot, how).failure.find("below the smallest step") != std::string::npos);
}

TEST_CASE("a rejected attempt leaves the bodies bit for bit, and a later one does not depend on it") {
  const NcpOptions none_allowed{0, false}, usual{};
  Stepper disturbed(pressed, pressing()), untouched(pressed, pressing());
  for (int step = 0; step < 3; ++step) {
    const Suspension before = disturbed.bodies();
    const StepOutcome rejected = disturbed.step(0.2, 1.0, none_allowed);
    CHECK_FALSE(rejected.accepted);
    CHECK(rejected.failure.find("bodies 0 and 1") != std::string::npos);
    CHECK(same_bits(disturbed.bodies(), before));
    const StepOutcome later = disturbed.step(0.1, 1.0, usual), alone = untouched.step(0.1, 1.0, usual);
    REQUIRE(later.accepted);
    REQUIRE(alone.accepted);
    CHECK_FALSE(later.contacts.empty());
    CHECK(same_bits(later, alone));
    CHECK(same_bits(disturbed.bodies(), untouched.bodies()));
    CHECK_FALSE(same_bits(disturbed.bodies(), before));
    CHECK(later.gmres_iterations == alone.gmres_iterations);  // what was solved is used again
  }
}

TEST_CASE("iterations count all attempts from one configuration") {
  Suspension askew = pressed;  // rolls over the other disc: one linearisation is not enough
  askew[1].pose.centre = {0.2, 0.52};
  askew[0].force = {0.0, 60.0}, askew[1].force = {0.0, -60.0};
  Stepper stepper(askew, pressing());
  const StepOutcome failed = stepper.step(0.1, 1.0, {1, false});
  const StepOutcome accepted = stepper.step(0.1, 1.0, {});
  REQUIRE(accepted.accepted);
  Stepper fresh(askew, pressing());
  const StepOutcome alone = fresh.step(0.1, 1.0, {});
  CHECK(failed.accepted == false);
  CHECK(accepted.ncp_iterations == failed.ncp_iterations + alone.ncp_iterations);
  CHECK(failed.ncp_iterations == 1);

  StepperOptions contact_free = pressing();
  contact_free.contact = ContactModel::none;
  const int background = Stepper(askew, contact_free).step(0.1, 1.0, {}).gmres_iterations;
  CHECK(background > 0);
  CHECK(alone.gmres_iterations > background);  // the contact's own solve is counted
}

TEST_CASE("what no step resolves ends an adaptive run at the smallest step, with the state as it was") {
  // Two slender bodies nearly side by side: 16 points give them a contact mobility of the wrong sign.
  const Suspension slender = {body(0.6, 0.1, 0.0), body(0.6, 0.1, {0.3, 0.201})};
  SimulationOptions how = options(FlowKind::shear, 1.0, 16, 0.1, 1.0);
  how.stepper.separation = 0.01;
  how.adaptive = true;
  const Run run = observe(slender, how);
  CAPTURE(run.failure);
  CHECK(run.failure.find("step 0, time 0: ") == 0);
  CHECK(run.failure.find("step 0", 1) == std::string::npos);
  CHECK(run.failure.find("bodies 0 and 1") != std::string::npos);
  CHECK(run.failure.find("halved") != std::string::npos);
  CHECK(run.finals == 1);
  REQUIRE(run.step == std::vector<long>{0});
  CHECK(same_bits(run.bodies.back(), slender));
}

TEST_CASE("bodies that overlap without a contact model end the run after the state that shows it") {
  SimulationOptions how = options(FlowKind::extension, 2.0, 32, 0.8, 8.0);
  how.stepper.contact = ContactModel::none;
  const Run run = observe({body(0.5, 0.5, {0.0, -1.0}), body(0.5, 0.5, {0.0, 1.0})}, how);
  CAPTURE(run.failure);
  CHECK(run.failure.find("bodies 0 and 1 overlap") != std::string::npos);
  CHECK(run.finals == 1);
  CHECK(run.step.size() == run.outcomes.size() + 1);
  CHECK(run.min_gap.back() < 0.0);
  CHECK(run.min_gap[run.min_gap.size() - 2] > 0.0);
  CHECK(run.min_gap.back() == gap(run.bodies.back()[0], run.bodies.back()[1]).value);
}

// Two free unit discs in u = (y, 0) from relative position (-10, y0): exact smallest gaps.
TEST_CASE("the smallest gap of two discs that pass in shear converges to the exact one at first order") {
  for (const auto& [y0, exact] : {std::pair(1.0, 0.3264257148), {0.5, 0.1969463920}}) {
    std::vector<double> smallest;
    for (double dt : {0.04, 0.02, 0.01}) {
      SimulationOptions how = options(FlowKind::shear, 1.0, 48, dt, 12.0 / y0);
      how.stepper.stokes.gmres_tolerance = 1e-10;
      how.stepper.contact = ContactModel::none;
      const Run run = observe({body(1.0, 1.0, {-10.0, y0}), body(1.0, 1.0, 0.0)}, how);
      REQUIRE(run.failure == "");
      const auto least = std::min_element(run.min_gap.begin(), run.min_gap.end());
      REQUIRE(least + 1 < run.min_gap.end());
      // Between the steps: the parabola through the smallest and its neighbours.
      const double before = least[-1], after = least[1], slope = 0.5 * (after - before);
      smallest.push_back(*least - 0.5 * slope * slope / (before + after - 2.0 * *least));
    }
    const double order = std::log2((smallest[0] - smallest[1]) / (smallest[1] - smallest[2]));
    const double first = 2.0 * smallest[1] - smallest[0], second = 2.0 * smallest[2] - smallest[1];
    const double limit = (4.0 * second - first) / 3.0;
    MESSAGE("y0 ", y0, ": smallest gap ", smallest[0], " ", smallest[1], " ", smallest[2], ", order ", order,
            ", limit off by ", limit - exact);
    CHECK(std::abs(order - 1.0) < 0.2);
    CHECK(std::abs(limit - exact) < 1e-4);
    CHECK(std::abs(std::log2((smallest[1] - exact) / (smallest[2] - exact)) - 1.0) < 0.2);
  }
}

TEST_CASE("interference volumes part bodies that are in contact from the first step on") {
  StepperOptions options;
  options.contact = ContactModel::stiv;
  options.separation = 0.05;
  options.stokes.summation = Summation::fmm;  // which refuses what is not finite
  Stepper stepper({body(1.0, 0.3, {-1.02, 0.1}, 0.1, 10.0), body(1.0, 0.3, {0.32, 0.0}, 0.5 * pi, -10.0)}, options);
  for (int step = 0; step < 3; ++step) {
    const StepOutcome outcome = stepper.step(0.1, 1.0, {});
    REQUIRE_MESSAGE(outcome.accepted, outcome.failure);
    CHECK(outcome.ncp_iterations >= 2);  // each with answers to forces of its own
    CHECK(outcome.contacts.size() == 1);
  }
}

TEST_CASE("every step of dense random drops keeps the separation with balanced repulsive contacts") {
  const OneThread alone;
  std::mt19937_64 generator(20240611);
  long contacts = 0, states = 0;
  double worst_force = 0.0, worst_torque = 0.0;
  for (const auto& [flow, count, separation] :
       {std::tuple(FlowKind::extension, 10, 0.08), {FlowKind::shear, 12, 0.1}, {FlowKind::extension, 14, 0.12},
        {FlowKind::shear, 20, 0.15}}) {
    const Suspension initial = random_drop(generator, count, std::sqrt(count), separation);
    SimulationOptions how = options(flow, 1.0, 48, 0.1, 1.0);
    how.stepper.separation = separation;
    const Run run = observe(initial, how);
    CHECK(run.failure == "");
    CHECK(run.outcomes.size() == 10);
    for (std::size_t k = 0; k < run.bodies.size(); ++k, ++states) {
      const Suspension& now = run.bodies[k];
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < now.size(); ++i)
        for (std::size_t j = i + 1; j < now.size(); ++j) least = std::min(least, gap(now[i], now[j]).value);
      CHECK(least >= separation * (1.0 - 1e-4));  // false for nan
      CHECK(run.min_gap[k] == least);
      if (k == run.outcomes.size()) break;
      Complex force = 0.0;
      double torque = 0.0, forces = 1e-300, torques = 1e-300;
      for (std::size_t i = 0; i < now.size(); ++i) {
        const Wrench& w = run.outcomes[k].contact_wrench[i];
        force += w.force;
        torque += w.torque + cross(now[i].pose.centre, w.force);
        forces += std::abs(w.force);
        torques += std::abs(w.torque) + std::abs(now[i].pose.centre) * std::abs(w.force);
        const RigidVelocity& u = run.outcomes[k].velocity[i];
        CHECK(std::isfinite(std::abs(u.velocity) + u.omega));
      }
      worst_force = std::max(worst_force, std::abs(force) / forces);
      worst_torque = std::max(worst_torque, std::abs(torque) / torques);
      for (const ActiveContact& contact : run.outcomes[k].contacts) {
        CHECK(contact.multiplier > 0.0);
        const Body &a = run.bodies[k + 1][contact.constraint.a], &b = run.bodies[k + 1][contact.constraint.b];
        CHECK(std::abs(gap(a, b).value - separation) <= 1e-4 * separation);
      }
      contacts += static_cast<long>(run.outcomes[k].contacts.size());
    }
  }
  MESSAGE(contacts, " contacts in ", states, " steps; forces sum to ", worst_force, ", torques to ",
          worst_torque);
  CHECK(contacts > 20);
  CHECK(worst_force < 1e-12);
  CHECK(worst_torque < 1e-12);
}
