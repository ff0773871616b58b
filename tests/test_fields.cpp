// The flow on a grid, and in runs between walls: torques in steps.csv and the flow on a grid.
#include <doctest/doctest.h>

#include <cmath>

#include "annulus.hpp"
#include "fields.hpp"
#include "program.hpp"

using namespace stokes;

TEST_CASE("flow_on_grid covers its square row by row and draws back what the walls of an annulus inject") {
  Annulus annulus{0.5, 10.0, 128};
  annulus.inner_surface.source = annulus.outer_surface.source = pi;
  StepperOptions options;
  options.flow.kind = FlowKind::none;
  const std::vector<GridPoint> grid =
      flow_on_grid(between_walls({}, annulus), options, -1.0, {}, {{-1.0, -2.0}, 12.0}, 25).points;
  REQUIRE(grid.size() == 25 * 25);
  CHECK(grid.front().x == Complex(-1.0, -2.0));
  CHECK(grid[1].x == Complex(-0.5, -2.0));
  CHECK(grid.back().x == Complex(11.0, 10.0));
  for (const GridPoint& point : grid) {
    const double r2 = std::norm(point.x);
    if (std::abs(std::sqrt(r2) - 0.5) < 1e-9 || std::abs(std::sqrt(r2) - 10.0) < 1e-9) continue;  // on a wall
    CHECK(point.inside == (r2 < 0.25 || r2 > 100.0));
    if (point.inside) continue;
    CHECK(std::abs(point.flow.velocity + 0.5 * point.x / r2) < 1e-9);
    CHECK(std::abs(stress(point.flow).xy - 2.0 * point.x.real() * point.x.imag() / (r2 * r2)) < 1e-8);
  }
}

TEST_CASE("flow_on_grid gives the wrenches on the fluid: those given to a free body, that of a wall beside a Couette flow") {
  Annulus annulus{5.0, 10.0, 64};
  annulus.outer_surface.angular_velocity = 2.0;
  const Body free{{0.1, 0.1}, {{0.0, 7.0}, 0.0}, {1.0, -2.0}, 0.5};
  const Suspension bodies = between_walls({free}, annulus);
  StepperOptions options;
  options.points_per_body = 32;
  const auto wrenches = [&](double driving, const Wrench& contact) {
    return flow_on_grid(bodies, options, driving, {contact, {{7.0, 7.0}, 7.0}}, {{6.0, 0.0}, 1.0}, 2).wrenches;
  };
  const std::vector<Wrench> loaded = wrenches(1.0, {{0.5, 0.0}, -0.25}), unloaded = wrenches(0.0, {{0.5, 0.0}, -0.25});
  REQUIRE(loaded.size() == 2);
  CHECK(loaded[0].force == Complex(1.5, -2.0));
  CHECK(loaded[0].torque == 0.25);
  // Without bodies u_theta = A r + B/r, B = -200/3, and the inner wall exerts the torque 4 pi B; a disc of this size
  // changes it by the order of its area fraction, 1e-4.
  CHECK(std::abs((loaded[1].torque - unloaded[1].torque) / (-4.0 * pi * 200.0 / 3.0) - 1.0) < 1e-3);
  CHECK(unloaded[1].torque != 0.0);
}

TEST_CASE("simulate writes the Couette flow on a grid and balanced wall torques, the same for any number of threads") {
  const Workspace here(
      "bodies = bodies.csv\ngeometry = annulus\ninner_radius = 5\nouter_radius = 10\nwall_points = 64\n"
      "outer_angular_velocity = 2\npoints_per_body = 16\ntime_step = 0.01\nend_time = 0.02\noutput = out\n"
      "fields_at = 0 0.02\nfield_points = 21\n",
      "a,b,x,y,theta\n0.01,0.01,7.5,0,0\n");
  REQUIRE(here.run({"case.txt", "threads=1"}).status == 0);
  const Table steps = read_csv(here.path() / "out/steps.csv");
  const double torque = steps.number(0, steps.column("inner_torque"));
  CHECK(std::abs(torque / (-4.0 * pi * 200.0 / 3.0) - 1.0) < 1e-4);
  CHECK(std::abs(steps.number(0, steps.column("outer_torque")) + torque) < 1e-8 * std::abs(torque));
  const Table field = read_csv(here.path() / "out/fields_0.csv");
  REQUIRE(field.rows.size() == 21 * 21);
  int fluid = 0;
  for (int k = 0; k < 21 * 21; ++k) {
    const auto value = [&](const char* name) { return field.number(k, field.column(name)); };
    const Complex x(value("x"), value("y"));
    const double r2 = std::norm(x);
    CHECK((value("inside") == 1.0) == (std::sqrt(r2) < 5.0 || std::sqrt(r2) > 10.0 || std::abs(x - 7.5) < 0.01));
    if (value("inside") == 1.0) {
      CHECK(std::isnan(value("u")));
      continue;
    }
    ++fluid;
    if (std::abs(x - 7.5) < 1.5) continue;  // the body's own flow
    const Complex exact = (8.0 / 3.0 - 200.0 / 3.0 / r2) * perp(x);
    CHECK(std::abs(Complex(value("u"), value("v")) - exact) < 1e-3);
    const double shear = 400.0 / 3.0 / r2 * (x.imag() * x.imag() - x.real() * x.real()) / r2;
    CHECK(std::abs(value("sigma_xy") + shear) < 2e-3);
  }
  CHECK(fluid > 200);
  const std::string bytes = content_of(here.path() / "out/fields_0.02.csv"),
                    rows = content_of(here.path() / "out/steps.csv");
  REQUIRE(here.run({"case.txt", "threads=2"}).status == 0);
  CHECK(content_of(here.path() / "out/fields_0.02.csv") == bytes);
  CHECK(content_of(here.path() / "out/steps.csv") == rows);
}

// With lagged densities the flow of the step is not that of a new solution.
TEST_CASE("the flow of a step has its own nodes and densities: far away it is that of the step's stresslets") {
  Suspension discs{{{0.5, 0.5}, {{-0.55, 0.05}, 0.0}, {}, {}}, {{0.5, 0.5}, {{0.55, -0.05}, 0.0}, {}, {}}};
  StepperOptions options;
  options.flow.kind = FlowKind::extension;
  options.contact = ContactModel::none;
  options.coupling = Coupling::local;
  options.stokes.gmres_tolerance = 1e-10;
  Stepper stepper(discs, options);
  REQUIRE(stepper.step(0.01, 1.0, {}).accepted);
  discs = stepper.bodies();
  const StepOutcome outcome = stepper.attempt(0.01, -1.0, {});
  REQUIRE(outcome.accepted);
  CHECK(outcome.at_start->system().node_count() == outcome.nodes);
  const Complex S = outcome.stresslets[0] + outcome.stresslets[1];  // S_11 + i S_12
  const Square far{{70.0, 70.0}, 20.0};
  const auto missed = [&](const std::vector<GridPoint>& points) {
    double error = 0.0, scale = 0.0;
    for (const GridPoint& point : points) {
      const Complex r = point.x, disturbance = point.flow.velocity + std::conj(r);  // driven backwards
      const Complex expected = -dot(S, r * r / std::norm(r)) / (2.0 * pi * std::norm(r)) * r;
      error = std::max(error, std::abs(disturbance - expected)), scale = std::max(scale, std::abs(expected));
    }
    return error / scale;
  };
  const double own = missed(flow_on_grid({1, 0.01, discs, 0.0, &outcome, -1.0}, options, far, 5).points);
  const double anew = missed(flow_on_grid(discs, options, -1.0, {}, far, 5).points);
  MESSAGE("relative differences: of the step ", own, ", of a solution anew ", anew);
  CHECK(own < 1e-2);  // the next term falls like size / distance, once more by symmetry
  CHECK(anew > 3e-2);
}

TEST_CASE("fields are driven as the step from there, also where accumulated time has not quite reached the reversal") {
  const Workspace here(case_text("shear", 16, 0.1, 1.5,
                                 "time_counting = accumulated\nreverse_at = 1\nfields_at = 1 1.05 1.5\n"
                                 "field_points = 3\n"),
                       "a,b,x,y,theta\n.5,.5,0,2,0\n");
  REQUIRE(here.run({"case.txt"}).status == 0);
  const Results results = here.results();
  REQUIRE(results.step_column("time")[10] < 1.0);
  REQUIRE(results.body_column(0, "omega")[10] < 0.0);
  REQUIRE(results.body_column(0, "omega")[11] > 0.0);
  const auto along_top = [&](const std::string& file) {
    const Table field = read_csv(here.path() / "out" / file);
    return field.number(8, field.column("u"));  // the last corner, at y = 3.5
  };
  CHECK(along_top("fields_1.csv") > 2.5);
  CHECK(along_top("fields_1.05.csv") < -2.5);
  CHECK(along_top("fields_1.5.csv") < -2.5);
}
