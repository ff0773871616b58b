// A container without an inner wall, and bodies driven at a given velocity.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "annulus.hpp"
#include "program.hpp"
#include "stokes_system.hpp"

using namespace stokes;

namespace {

constexpr double wall_radius = 3.0;

Suspension in_disc(const std::vector<Body>& bodies, const SurfaceMotion& wall = {}) {
  Suspension suspension(bodies.begin(), bodies.end());
  suspension.container = Container{0.0, wall_radius, 192, wall};
  return suspension;
}

StokesSolution solution(const Suspension& bodies) {
  ShapeCache shapes;
  return StokesSystem(bodies, 96, shapes, {1e-12}).solve({FlowKind::none, 1.0, 1.0}, {});
}

Body driven(const Shape& shape, Complex centre, Complex velocity, double omega) {
  Body body{shape, {centre, 0.0}};
  body.fixed = true;
  body.surface = {omega, 0.0, velocity};
  return body;
}

std::string disc_case(double end_time, const std::string& settings) {
  return concat("bodies = bodies.csv\ngeometry = disc\nouter_radius = 3\ntime_step = .05\noutput = out\n", "end_time = ",
                end_time, "\n", settings);
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("bodies in a disc that turns go round with it like a solid") {
  const double omega = 0.8;
  const Suspension bodies = in_disc({{{0.5, 0.5}, {{1.0, 0.7}, 0.0}}, {{0.8, 0.2}, {{-1.2, 0.3}, 0.5}}}, {omega, 0.0, {}});
  const StokesSolution s = solution(bodies);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    CHECK(std::abs(s.velocity[i].velocity - omega * perp(bodies[i].pose.centre)) < 1e-10);
    CHECK(std::abs(s.velocity[i].omega - omega) < 1e-10);
  }
}

TEST_CASE("a disc driven in the middle of a circular wall bears the exact force and torque") {
  const double a = 0.6, R = wall_radius;
  // Concentric cylinders: L = 4 pi omega a^2 R^2 / (R^2 - a^2), F = 4 pi U / (ln(R/a) - (R^2 - a^2)/(R^2 + a^2)).
  const StokesSolution turned = solution(in_disc({driven({a, a}, 0.0, 0.0, 0.9)}));
  CHECK(turned.velocity[0].omega == 0.9);
  CHECK(std::abs(turned.reaction[0].torque - 4.0 * pi * 0.9 * a * a * R * R / (R * R - a * a)) < 1e-9);
  CHECK(std::abs(turned.reaction[0].force) < 1e-9);
  const Complex velocity(0.4, -0.3);
  const StokesSolution pushed = solution(in_disc({driven({a, a}, 0.0, velocity, 0.0)}));
  CHECK(pushed.velocity[0].velocity == velocity);
  const Complex force = 4.0 * pi * velocity / (std::log(R / a) - (R * R - a * a) / (R * R + a * a));
  CHECK(std::abs(pushed.reaction[0].force - force) < 1e-9);
}

TEST_CASE("a driven body pushes a free one by the reciprocal theorem") {
  // First body 0 is driven at U and turns at .3, and body 1 is free and moves at V. Then body 0 is held, with the reactions
  // F and L, and the force f acts on body 1. Forces of one problem times velocities of the other make
  // F U + .3 L + f V = 0: the first problem's only force acts where the second has no velocity.
  const Complex at(0.9, 0.4), free_at(-0.8, -0.3), U(0.7, 0.2), f(-0.3, 1.1);
  Suspension bodies = in_disc({driven({0.5, 0.5}, at, U, 0.3), {{0.7, 0.4}, {free_at, 0.4}}});
  const StokesSolution moved = solution(bodies);
  ShapeCache shapes;
  const std::vector<Wrench> wrenches = {Wrench{}, Wrench{f, 0.0}};
  const StokesSolution held = StokesSystem(bodies, 96, shapes, {1e-12}).solve({}, wrenches);
  CHECK(held.velocity[0].velocity == 0.0);
  const double power = dot(held.reaction[0].force, U) + held.reaction[0].torque * 0.3;
  CHECK(std::abs(power + dot(f, moved.velocity[1].velocity)) < 1e-9);
  CHECK(std::abs(power) > 0.05);
}

TEST_CASE("driven bodies move as they are given, push free ones ahead at the separation, and come back") {
  const std::string settings = "min_separation_length = 0.15\nreverse_at = 0.5\npoints_per_body = 64\nwall_points = 128\n";
  const Workspace here(disc_case(1.0, settings + "refine = near\n"),
                       "a,b,x,y,theta,fixed,ux,uy,omega\n.4,.3,-1,0,0,1,1,0.2,-0.5\n.4,.4,0,0.05,0,0,0,0,0\n");
  const ProgramRun run = here.run({"case.txt"});
  CAPTURE(run.errors);
  REQUIRE(run.status == 0);
  const Results results = here.results();
  const auto driven_body = [&](const char* column) { return results.body_column(0, column); };
  const std::vector<double> time = results.step_column("time"), x = driven_body("x"), y = driven_body("y"),
                            theta = driven_body("theta"), ux = driven_body("ux");
  for (std::size_t k = 0; k < time.size(); ++k) {
    const double way = time[k] <= 0.5 ? time[k] : 1.0 - time[k];
    CHECK(std::abs(x[k] + 1.0 - way) < 1e-12);
    CHECK(std::abs(y[k] - 0.2 * way) < 1e-12);
    CHECK(std::abs(theta[k] + 0.5 * way) < 1e-12);
    if (k + 1 < time.size()) CHECK(ux[k] == (k < 10 ? 1.0 : -1.0));
  }
  const std::vector<double> gaps = results.step_column("min_gap"), contacts = results.step_column("contacts");
  CHECK(*std::min_element(gaps.begin(), gaps.end()) > 0.15 * (1.0 - 1e-3));
  CHECK(*std::max_element(contacts.begin(), contacts.end()) == 1.0);
  CHECK(contains(content_of(here.path() / "out/bodies.csv"), "fixed,ux,uy,omega\n"));
}

TEST_CASE("a driven body that meets a fixed one or a wall ends the run, which says so") {
  for (const char* other : {"", ".4,.4,.9,0,0,1,0,0,0\n"}) {
    const Workspace here(disc_case(5.0, "points_per_body = 32\nwall_points = 64\n"),
                         concat("a,b,x,y,theta,fixed,ux,uy,omega\n.4,.4,-1,0,0,1,1.03,0,0\n", other));
    const ProgramRun run = here.run({"case.txt"});
    CAPTURE(run.errors);
    CHECK(run.status == 3);
    CHECK(contains(run.errors, "both move as they are given"));
    CHECK(here.results().step_column("min_gap").back() < 0.0);
  }
}

TEST_CASE("velocities of free bodies and fixed bodies in unbounded fluid are refused") {
  const Workspace here(disc_case(1.0, ""), "a,b,x,y,theta,fixed,ux\n.4,.4,0,0,0,0,1\n");
  CHECK(contains(here.run({"case.txt"}).errors, "ux = 1 of body 0 is given, but a free body finds its own velocity"));
  const Workspace open(case_text("shear", 16, 0.1, 0.1), "a,b,x,y,theta,fixed,ux\n.4,.4,0,0,0,1,1\n");
  CHECK(contains(open.run({"case.txt"}).errors, "is fixed, but in unbounded flow only free bodies are possible"));
  const Workspace narrow(disc_case(1.0, ""), "a,b,x,y,theta\n.4,.4,2.7,0,0\n");
  CHECK(contains(narrow.run({"case.txt"}).errors, "beyond the outer wall of radius 3"));
  const Workspace keys(disc_case(1.0, "inner_radius = 1\n"), "a,b,x,y,theta\n.4,.4,0,0,0\n");
  CHECK(contains(keys.run({"case.txt"}).errors, "inner_radius = '1' belongs to an annulus"));
}

TEST_CASE("in a disc steps.csv has the torque of the wall, which balances that of a driven body") {
  const Workspace here(disc_case(0.1, "accuracy = 1e-8\n"),
                       "a,b,x,y,theta,fixed,ux,uy,omega\n.6,.6,0,0,0,1,0,0,0.9\n");
  REQUIRE(here.run({"case.txt"}).status == 0);
  const double torque = here.results().step_column("outer_torque")[0];
  CHECK(std::abs(torque + 4.0 * pi * 0.9 * 0.36 * 9.0 / (9.0 - 0.36)) < 1e-6);
  CHECK_FALSE(here.results().steps.has_column("inner_torque"));
}
