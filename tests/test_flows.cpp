// Background flows other than shear and extension, and the motion of a body in them.
#include <doctest/doctest.h>

#include <cmath>
#include <utility>

#include "average_stress.hpp"
#include "case.hpp"
#include "flow_checks.hpp"
#include "program.hpp"
#include "refusal.hpp"

using namespace stokes;

namespace {

constexpr double rate = 1.3;

struct Answer {
  RigidVelocity motion;
  Complex stresslet;
};

Answer answer(const Suspension& bodies, const BackgroundFlow& flow, int points = 64) {
  ShapeCache shapes;
  const StokesSystem system(bodies, points, shapes, {1e-13});
  const StokesSolution s = system.solve(flow, {});
  return {s.velocity[0], system.stresslets(s.density, {})[0]};
}

}  // namespace

TEST_CASE("a disc in Poiseuille flow moves by Faxen's law") {
  // U = u + (a^2/4) lap u, omega = half the vorticity, S = 4 pi a^2 E since lap E = 0: at (x, y) of u = (rate y^2, 0).
  const double a = 0.7;
  for (const Complex centre : {Complex(0.3, 0.0), Complex(-2.0, 1.4), Complex(5.0, -0.6)}) {
    const Answer got = answer({{{a, a}, {centre, 0.4}}}, {FlowKind::poiseuille, rate});
    const double y = centre.imag();
    CHECK(std::abs(got.motion.velocity - rate * (y * y + 0.5 * a * a)) < 1e-12);
    CHECK(std::abs(got.motion.omega + rate * y) < 1e-12);
    CHECK(std::abs(got.stresslet - Complex(0.0, 4.0 * pi * a * a * rate * y)) < 1e-11);
  }
}

TEST_CASE("an ellipse in Poiseuille flow moves by the mean over its eccentric angle and turns by the shear at its centre") {
  // The traction of a translating ellipse is uniform in the eccentric angle, so that by the reciprocal theorem U is the mean
  // of u over it. That of a turning one is odd, the quadratic part of u even: omega is Jeffery's in u = (2 rate y0 y, 0).
  const double a = 0.9, b = 0.3;
  for (const double angle : {0.0, 0.5, 1.2, 2.8}) {
    const double y = 0.8, s = std::sin(angle), c = std::cos(angle);
    const Answer got = answer({{{a, b}, {{-1.0, y}, angle}}}, {FlowKind::poiseuille, rate}, 96);
    const double mean_square = 0.5 * (a * a * s * s + b * b * c * c);
    CHECK(std::abs(got.motion.velocity - rate * (y * y + mean_square)) < 1e-11);
    CHECK(std::abs(got.motion.omega + 2.0 * rate * y * (a * a * s * s + b * b * c * c) / (a * a + b * b)) < 1e-11);
  }
}

TEST_CASE("the flow past an ellipse in Poiseuille flow solves the Stokes equations, sticks to it and exerts no force") {
  const Suspension bodies{{{0.9, 0.3}, {{0.4, 0.8}, 0.6}}};
  const BackgroundFlow background{FlowKind::poiseuille, rate};
  ShapeCache shapes;
  const StokesSystem system(bodies, 96, shapes, {1e-13});
  const StokesSolution s = system.solve(background, {});
  const auto flow = [&](Complex x) { return system.flow({x}, s.density, background, {})[0]; };
  for (const Complex x : {Complex(1.6, 0.9), Complex(-0.8, 1.9), Complex(0.3, -0.4)}) {
    const StokesResidual residual = stokes_residual(flow, x, 1e-2);
    CHECK(residual.gradient < 1e-9);
    CHECK(residual.divergence < 1e-10);
    CHECK(residual.momentum < 1e-8);
  }
  Complex force = 0.0;
  double torque = 0.0;
  const PlacedShape& b = system.boundaries()[0];
  const std::vector<Complex> forces = node_forces(system, 0, s.density, background, {});
  for (int k = 0; k < b.size(); ++k) {
    const Complex from_centre = b.node(k) - bodies[0].pose.centre;
    const Complex rigid = s.velocity[0].velocity + s.velocity[0].omega * perp(from_centre);
    CHECK(std::abs(flow(b.node(k)).velocity - rigid) < 1e-10);
    force += forces[k], torque += cross(from_centre, forces[k]);
  }
  // Without the background's pressure the force would be -2 rate area.
  CHECK(std::abs(force) < 1e-9);
  CHECK(std::abs(torque) < 1e-9);
  // Far away only the stresslet of the body remains.
  CHECK(std::abs(flow({0.0, 1e4}).pressure) < 1e-6);
  CHECK(flow({1e4, 0.0}).pressure == doctest::Approx(2.0 * rate * 1e4).epsilon(1e-8));
}

TEST_CASE("a linear flow is the sum of shear, extension and rotation, and so is what an ellipse does in it") {
  const Suspension bodies{{{0.9, 0.3}, {{0.4, 0.8}, 0.6}}};
  // (p x + q y, r x - p y) = p (x, -y) + (q + r) (y, 0) + r (-y, x)
  const double p = 0.7, q = -0.4, r = 1.1;
  const BackgroundFlow linear{FlowKind::linear, rate, 0.0, {p, q, r}};
  for (const Complex x : {Complex(0.3, -1.2), Complex(2.0, 0.5)}) {
    CHECK(std::abs(linear.velocity(x) - rate * Complex(p * x.real() + q * x.imag(), r * x.real() - p * x.imag())) < 1e-15);
    CHECK(linear.flow(x).velocity == linear.velocity(x));
    CHECK(linear.driven(-1.0).velocity(x) == -linear.velocity(x));
  }
  const Answer whole = answer(bodies, linear), strained = answer(bodies, {FlowKind::extension, rate * p}),
               sheared = answer(bodies, {FlowKind::shear, rate * (q + r)});
  const Complex turning = rate * r * perp(bodies[0].pose.centre);
  CHECK(std::abs(whole.motion.velocity - strained.motion.velocity - sheared.motion.velocity - turning) < 1e-12);
  CHECK(std::abs(whole.motion.omega - strained.motion.omega - sheared.motion.omega - rate * r) < 1e-12);
  CHECK(std::abs(whole.stresslet - strained.stresslet - sheared.stresslet) < 1e-11);
  CHECK(std::abs(whole.stresslet) > 0.1);
}

TEST_CASE("simulate runs linear and Poiseuille flows, and reverses them with their pressure") {
  const std::string body = "a,b,x,y,theta\n.5,.5,1,.6,0\n";
  const std::string settings = "rate = 2\nreverse_at = 0.1\nfields_at = 0 0.1\nfield_points = 9\n";
  const Workspace here(case_text("poiseuille", 32, 0.1, 0.2, settings), body);
  REQUIRE(here.run({"case.txt"}).status == 0);
  const std::vector<double> ux = here.results().body_column(0, "ux");
  CHECK(std::abs(ux[0] - 2.0 * (0.36 + 0.125)) < 1e-9);
  CHECK(std::abs(ux[1] + ux[0]) < 1e-9);  // y is the same
  REQUIRE(here.run({"case.txt", "reverse_at=0", "output=back"}).status == 0);
  const std::vector<double> forth = read_csv(here.path() / "out/fields_0.csv").numbers("p"),
                            back = read_csv(here.path() / "back/fields_0.csv").numbers("p");
  for (std::size_t k = 0; k < forth.size(); ++k)
    if (!std::isnan(forth[k])) CHECK(std::abs(forth[k] + back[k]) < 1e-12);
  CHECK(std::abs(forth.front()) > 1.0);

  // A shear along y: u = (0, x).
  const Workspace turned(case_text("linear", 32, 0.1, 0.1, "gradient = 0 0 1 0\n"), body);
  REQUIRE(turned.run({"case.txt"}).status == 0);
  CHECK(std::abs(turned.results().body_column(0, "uy")[0] - 1.0) < 1e-9);
  CHECK(std::abs(turned.results().body_column(0, "omega")[0] - 0.5) < 1e-9);
}

TEST_CASE("a gradient is four numbers without trace, of flow = linear") {
  const auto read = [](const std::string& settings, const std::string& flow) {
    return refusal([&] { parse_case(case_text(flow, 32, 0.1, 0.2, settings), "case.txt"); });
  };
  const auto contains = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  CHECK(read("gradient = 1 2 3 -1\n", "linear") == "accepted");
  CHECK(read("gradient = 0.1 0 0 -0.1\n", "linear") == "accepted");
  CHECK(contains(read("", "linear"), "needs gradient = a b c d"));
  CHECK(contains(read("gradient = 1 2 3\n", "linear"), "must be four numbers"));
  CHECK(contains(read("gradient = 1 2 3 1\n", "linear"), "a + d = 2"));
  CHECK(contains(read("gradient = 0 0 0 0\n", "linear"), "is zero"));
  CHECK(contains(read("gradient = 0 1 0 0\n", "shear"), "does nothing without flow = linear"));
  CHECK(contains(read("sample_area = 10\n", "poiseuille"), "needs a flow of uniform gradient"));
  CHECK(contains(read("sample_area = -1\n", "shear"), "must be greater than 0"));
}

TEST_CASE("in Poiseuille flow the warning of large steps knows that the rate grows with y") {
  const auto said = [](double y) {
    const Workspace here(case_text("poiseuille", 32, 0.1, 0.1), concat("a,b,x,y,theta\n.5,.5,0,", y, ",0\n"));
    return here.run({"case.txt"}).errors;
  };
  CHECK(said(0.0).find("warning") == std::string::npos);
  CHECK(said(4.0).find("the flow deforms by 0.9 ") != std::string::npos);
}
