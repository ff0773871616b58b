// Steps of bodies that meet the container, an inner wall or a fixed body.
#include <doctest/doctest.h>

#include <cmath>

#include "simulation.hpp"

using namespace stokes;

namespace {

Body body(double a, double b, Complex centre, Complex force = 0.0) { return {{a, b}, {centre, 0.0}, force, 0.0}; }

Body held(Body b) {
  b.fixed = true;
  return b;
}

}  // namespace

TEST_CASE("beside the container or a fixed body an adaptive step is as short as beside another body at rest") {
  // Pushed to the right, the wall or the fixed disc 0.3 ahead, then nothing within a width.
  for (const Complex centre : {Complex(2.2, 0.0), Complex(1.4, 0.0)}) {
    const bool beside = centre.real() > 2.0;
    Suspension wall = {body(0.6, 0.5, centre, 20.0)}, obstacle = {body(0.6, 0.5, 0.0, 20.0)};
    wall.container = Container{0.0, 3.1, 128, {}}, obstacle.container = Container{0.0, 6.0, 128, {}};
    obstacle.push_back(held(body(0.5, 0.5, beside ? 1.4 : 2.2)));
    for (const Suspension& bodies : {wall, obstacle}) {
      Stepper stepper(bodies, StepperOptions{});
      const double limit = stepper.geometric_step_limit(1.0);
      const StepOutcome outcome = stepper.attempt(1e-9, 1.0, {});
      REQUIRE(outcome.accepted);
      // Along the axis of symmetry nothing turns: it is the width, or there is no limit.
      CHECK(std::abs(outcome.velocity[0].omega) < 1e-6);
      if (beside)
        CHECK(std::abs(limit * outcome.velocity[0].velocity.real() - 0.5) < 1e-12);
      else
        CHECK(limit > 1e5 * 0.5 / outcome.velocity[0].velocity.real());
    }
  }
}
