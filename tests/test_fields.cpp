// simulate between walls: torques in steps.csv and the flow on a grid.
#include <doctest/doctest.h>

#include <cmath>

#include "program.hpp"

using namespace stokes;

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
  const std::string bytes = content_of(here.path() / "out/fields_0.02.csv"), rows = content_of(here.path() / "out/steps.csv");
  REQUIRE(here.run({"case.txt", "threads=2"}).status == 0);
  CHECK(content_of(here.path() / "out/fields_0.02.csv") == bytes);
  CHECK(content_of(here.path() / "out/steps.csv") == rows);
}
