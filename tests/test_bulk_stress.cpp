// Stresslets and bulk stress of suspensions in unbounded fluid.
#include <doctest/doctest.h>

#include <cmath>

#include "base.hpp"
#include "program.hpp"

using namespace stokes;

namespace {

double first(const Results& results, const char* column) { return results.step_column(column)[0]; }

// name_11 + i name_12 of a step.
Complex tensor(const Results& results, const std::string& name, int step = 0) {
  return {results.step_column(name + "_11")[step], results.step_column(name + "_12")[step]};
}

const std::string pressed_discs = "a,b,x,y,theta\n.5,.5,-.65,0,0\n.5,.5,.65,0,0\n";

}  // namespace

TEST_CASE("one disc has the stresslet 4 pi a^2 E, and with its share of an area the viscosity 1 + 2 phi") {
  const double a = 0.7, area = 12.0, phi = pi * a * a / area;
  const std::string disc = concat("a,b,x,y,theta\n", a, ",", a, ",3,-1,0.4\n");
  for (const char* flow : {"shear", "extension", "linear"}) {
    const bool is_shear = flow[0] == 's', is_linear = flow[0] == 'l';
    const std::string settings = concat("rate = -1.5\nreverse_at = 0.1\nsample_area = ", area, "\n");
    const Workspace here(case_text(flow, 32, 0.1, 0.2, settings + (is_linear ? "gradient = 1 2 0 -1\n" : "")), disc);
    REQUIRE(here.run({"case.txt"}).status == 0);
    const Results results = here.results();
    const Complex strain = -1.5 * (is_shear ? Complex(0.0, 0.5) : is_linear ? Complex(1.0, 1.0) : Complex(1.0, 0.0));
    const Complex stresslet = 4.0 * pi * a * a * strain;
    for (int step = 0; step < 2; ++step) {  // the second one is reversed
      const double sign = step == 0 ? 1.0 : -1.0;
      const auto value = [&](const char* column) { return results.step_column(column)[step]; };
      CHECK(std::abs(tensor(results, "stresslet_sum", step) - sign * stresslet) < 1e-9);
      CHECK(std::abs(tensor(results, "bulk_stress", step) - sign * (2.0 * strain + stresslet / area)) < 1e-9);
      CHECK(std::abs(value("effective_viscosity") - 1.0 - 2.0 * phi) < 1e-10);
      CHECK(value("contact_sum_11") == 0.0);
      CHECK(results.body_column(0, "stresslet_11")[step] == value("stresslet_sum_11"));
      CHECK(results.body_column(0, "stresslet_12")[step] == value("stresslet_sum_12"));
    }
  }
}

TEST_CASE("an ellipse has the stresslet of Jeffery's solution") {
  // In the frame of its axes, with no torque, S_11 = pi (a + b)^2 E_11 and S_12 = 2 pi (a + b)^2 a b / (a^2 + b^2) E_12;
  // both are 4 pi a^2 E for a disc.
  const double a = 1.2, b = 0.4;
  for (const double angle : {0.0, 0.6, 1.9}) {
    const Workspace here(case_text("shear", 96, 0.1, 0.1, "gmres_tolerance = 1e-12\n"),
                         concat("a,b,x,y,theta\n", a, ",", b, ",0,0,", angle, "\n"));
    REQUIRE(here.run({"case.txt"}).status == 0);
    const Complex strain(0.0, 0.5), turn = std::polar(1.0, 2.0 * angle), own = strain * std::conj(turn);
    const double along = pi * (a + b) * (a + b), across = 2.0 * along * a * b / (a * a + b * b);
    const Complex expected = turn * Complex(along * own.real(), across * own.imag());
    CHECK(std::abs(tensor(here.results(), "stresslet_sum") - expected) < 1e-8);
  }
}

TEST_CASE("two discs pressed together: the sum of their contact stress is -F d, and the viscosity counts it") {
  const Workspace here(case_text("extension", 64, 0.05, 0.1, "rate = -1\nmin_separation_length = 0.3\nsample_area = 50\n"),
                       pressed_discs);
  REQUIRE(here.run({"case.txt"}).status == 0);
  const Results results = here.results();
  const double force = results.body_column(0, "fx")[0], distance = 1.3;
  CHECK(force < 0.0);  // away from the other one
  CHECK(std::abs(first(results, "contact_sum_11") - 0.5 * force * distance) < 1e-9);
  CHECK(std::abs(first(results, "contact_sum_12")) < 1e-9);
  // In u = (-x, y) the rate of strain is -1 along x.
  const double stress = first(results, "stresslet_sum_11") + first(results, "contact_sum_11");
  CHECK(std::abs(first(results, "effective_viscosity") - (1.0 - stress / (2.0 * 50.0))) < 1e-9);
  CHECK(std::abs(first(results, "bulk_stress_11") - (-2.0 + stress / 50.0)) < 1e-9);
}

TEST_CASE("the stress of two discs with contact forces is that of the flow far away") {
  // The particle stress S delta(x) makes the pressure p = S_ij d_i d_j ln r / (2 pi) = -Re(conj(S) x^2) / (pi |x|^4).
  // A third body, too small to matter, makes the grid large.
  const std::string settings = "rate = -1\nmin_separation_length = 0.3\nfields_at = 0\nfield_points = 2\n";
  const Workspace here(case_text("extension", 64, 0.05, 0.05, settings), pressed_discs + ".001,.001,300,400,0\n");
  REQUIRE(here.run({"case.txt"}).status == 0);
  const Table field = read_csv(here.path() / "out/fields_0.csv");
  const Complex S = tensor(here.results(), "stresslet_sum") + tensor(here.results(), "contact_sum");
  CHECK(std::abs(tensor(here.results(), "contact_sum")) > 0.1 * std::abs(S));
  int tried = 0;
  for (int k = 0; k < 4; ++k) {
    const Complex x(field.number(k, field.column("x")), field.number(k, field.column("y")));
    if (std::abs(x) < 100.0 || std::abs(x - Complex(300.0, 400.0)) < 100.0) continue;
    const double expected = -(std::conj(S) * x * x).real() / (pi * std::norm(x) * std::norm(x));
    CHECK(std::abs(field.number(k, field.column("p")) / expected - 1.0) < 1e-3);
    ++tried;
  }
  CHECK(tried == 2);
}
