// Steps of bodies that meet the container, an inner wall or a fixed body.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "annulus.hpp"
#include "simulation.hpp"

using namespace stokes;

namespace {

Body body(double a, double b, Complex centre, Complex force = 0.0) { return {{a, b}, {centre, 0.0}, force, 0.0}; }

Body held(Body b) {
  b.fixed = true;
  return b;
}

// Statistics of a run of 1000 steps of a disc, body 0, in contact with a partner. It has few nodes and a loose GMRES
// tolerance, since the separation does not depend on how well the fluid is resolved.
struct Push {
  double smallest_gap = 1e300;
  int steps = 0, in_contact = 0;
  double imbalance = 0.0;        // of contact forces, and torques about 0, over the force
  double least_repulsion = 1.0;  // part of the contact force that parts the disc and the partner's centre
};
constexpr double separation = 0.06;

Push push(const Suspension& bodies, int partner) {
  SimulationOptions options;
  options.stepper.flow = {FlowKind::none, 1.0, 1.0};
  options.stepper.points_per_body = 16;
  options.stepper.refine = Refine::near;
  options.stepper.stokes.gmres_tolerance = 1e-3;
  options.stepper.separation = separation;
  options.time_step = 0.01, options.end_time = 10.0;
  Push seen;
  simulate(bodies, options, [&](const StepRecord& record) {
    seen.smallest_gap = std::min(seen.smallest_gap, record.min_gap);
    if (!record.outcome) return;
    ++seen.steps;
    const StepOutcome& outcome = *record.outcome;
    const Complex on_disc = outcome.contact_wrench[0].force;
    Complex sum = outcome.container_contact.force;
    double torque = outcome.container_contact.torque;
    for (std::size_t i = 0; i < record.bodies.size(); ++i) {
      const Wrench& w = outcome.contact_wrench[i];
      sum += w.force, torque += w.torque + cross(record.bodies[i].pose.centre, w.force);
    }
    for (const ActiveContact& contact : outcome.contacts) {
      if (contact.constraint.b != partner) continue;
      ++seen.in_contact;
      const bool wall = partner == container_index;
      const Complex on_partner = wall ? outcome.container_contact.force : outcome.contact_wrench[partner].force;
      const double size = std::abs(on_disc);
      CHECK(on_partner == -on_disc);
      CHECK(std::abs(size - contact.multiplier) < 1e-12 * size);
      seen.imbalance = std::max({seen.imbalance, std::abs(sum) / size, std::abs(torque) / size});
      const Complex from_partner = wall ? -record.bodies[0].pose.centre
                                        : record.bodies[0].pose.centre - record.bodies[partner].pose.centre;
      const double repulsion = dot(on_disc, from_partner) / (size * std::abs(from_partner));
      seen.least_repulsion = std::min(seen.least_repulsion, repulsion);
    }
  });
  return seen;
}

void check_separated(const Push& seen, int least_contacts) {
  MESSAGE(seen.in_contact << " of " << seen.steps << " steps in contact; smallest gap over separation less 1: "
                          << seen.smallest_gap / separation - 1.0 << ", imbalance " << seen.imbalance);
  CHECK(seen.steps == 1000);
  CHECK(seen.in_contact > least_contacts);
  CHECK(seen.smallest_gap >= separation * (1.0 - 1e-4));  // the tolerance of the complementarity problem
  CHECK(seen.imbalance < 1e-13);
  CHECK(seen.least_repulsion > 1.0 - 1e-12);  // of discs and circles: along the line of centres
}

// A disc between walls, through which fluid streams away from the centre (or towards it), the outer one turning.
Suspension disc_in_stream(double source) {
  Annulus annulus{1.0, 3.0, 48, {}, {}};
  annulus.inner_surface.source = annulus.outer_surface.source = source;
  annulus.outer_surface.angular_velocity = 1.0;
  return between_walls({body(0.5, 0.5, 2.0)}, annulus);
}

}  // namespace

TEST_CASE("a disc that a strong stream presses against the outer wall keeps its separation for 1000 steps") {
  check_separated(push(disc_in_stream(50.0), container_index), 900);
}

TEST_CASE("a disc that a strong stream presses against the inner wall keeps its separation for 1000 steps") {
  check_separated(push(disc_in_stream(-50.0), 1), 900);
}

TEST_CASE("a disc that a force pushes against a fixed disc slides around it at the separation within 1000 steps") {
  Suspension bodies{body(0.5, 0.5, {-1.2, 0.02}, 20.0), held(body(0.6, 0.6, 0.3))};
  bodies.container = Container{0.0, 3.0, 48, {}};
  check_separated(push(bodies, 1), 400);
}

TEST_CASE("beside the container or a fixed body an adaptive step is as short as beside another body at rest") {
  // Pushed to the right: first the wall or the fixed disc is 0.3 ahead, then nothing within a width.
  for (const Complex centre : {Complex(2.2, 0.0), Complex(1.4, 0.0)}) {
    const bool beside = centre.real() > 2.0;
    Suspension wall = {body(0.6, 0.5, centre, 20.0)}, obstacle = {body(0.6, 0.5, 0.0, 20.0)};
    wall.container = Container{0.0, 3.1, 128, {}}, obstacle.container = Container{0.0, 6.0, 128, {}};
    obstacle.push_back(held(body(0.5, 0.5, beside ? 1.4 : 2.2)));
    for (const Suspension& bodies : {wall, obstacle}) {
      Stepper stepper(bodies, StepperOptions{});
      const double limit = stepper.geometric_step_limit(1.0);
      const StepOutcome outcome = stepper.step(1e-9, 1.0, {});
      REQUIRE(outcome.accepted);
      // Along the axis of symmetry nothing turns: the limit is that of the width, or there is none.
      CHECK(std::abs(outcome.velocity[0].omega) < 1e-6);
      if (beside)
        CHECK(std::abs(limit * outcome.velocity[0].velocity.real() - 0.5) < 1e-12);
      else
        CHECK(limit > 1e5 * 0.5 / outcome.velocity[0].velocity.real());
    }
  }
}
