// Cases in an annulus: their keys, their bodies' files and the suspension made of both.
#include <doctest/doctest.h>

#include <cmath>

#include "case.hpp"
#include "program.hpp"
#include "refusal.hpp"

using namespace stokes;

namespace {

const std::string complete =
    "bodies = bodies.csv\ngeometry = annulus\ninner_radius = 5\nouter_radius = 10\npoints_per_body = 32\n"
    "time_step = 0.1\nend_time = 2\noutput = out\n";
const std::string unbounded =
    "bodies = bodies.csv\nflow = shear\npoints_per_body = 32\ntime_step = 0.1\nend_time = 2\noutput = out\n";
const std::string disc = "a,b,x,y,theta\n.5,.5,7,0,0\n";

Case read(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const Workspace here(text, disc);
  return read_case(here.path() / "case.txt", overrides);
}

void check_contains(const std::string& message, const std::string& part) {
  CHECK_MESSAGE(message.find(part) != std::string::npos, message, " lacks ", part);
  CHECK_MESSAGE(message.find('\n') == std::string::npos, "one paragraph");
}

// The message that refuses an argument to a case.
void check_refused(const std::string& text, const std::string& argument, const std::string& part) {
  check_contains(refusal([&] { read(text, {argument}); }), concat("argument '", argument, "': ", part));
}

Suspension suspension(const std::string& bodies, const std::vector<std::string>& overrides = {}) {
  const Workspace here(complete, bodies);
  return read_suspension(read_case(here.path() / "case.txt", overrides));
}

void check_bodies(const std::string& rows, const std::string& part) {
  check_contains(refusal([&] { suspension("a,b,x,y,theta,fixed\n" + rows); }), concat("bodies.csv:", part));
}

}  // namespace

TEST_CASE("an annulus needs its radii but no flow, and has the defaults of the other keys") {
  const Case c = read(complete);
  CHECK(c.geometry == Geometry::annulus);
  CHECK(c.flow == FlowKind::none);
  CHECK(c.inner_radius == 5.0);
  CHECK(c.outer_radius == 10.0);
  CHECK(c.wall_points == 256);
  CHECK(c.outer_angular_velocity == 0.0);
  CHECK(c.inner_angular_velocity == 0.0);
  CHECK(c.injection_rate == 0.0);
  CHECK(read(complete, {"flow=none"}).flow == FlowKind::none);
  CHECK(read(unbounded).geometry == Geometry::unbounded);
  CHECK(describe(read(unbounded, {"geometry=unbounded"})) == describe(read(unbounded)));
}

TEST_CASE("keys for every geometry have their defaults, and every new key sets its member") {
  const Case standard = read(unbounded);
  CHECK(standard.refine == Refine::none);
  CHECK(standard.summation == Summation::automatic);
  CHECK(standard.fields_at.empty());
  CHECK(standard.field_points == 200);
  CHECK(standard.checkpoint_every == 60.0);
  const Case c = read(complete, {"wall_points=64", "outer_angular_velocity=2", "inner_angular_velocity=-1",
                                 "injection_rate=3.5", "refine=near", "summation=fmm", "fields_at= 0  0.5 2",
                                 "field_points=50", "checkpoint_every=0"});
  CHECK(c.wall_points == 64);
  CHECK(c.outer_angular_velocity == 2.0);
  CHECK(c.inner_angular_velocity == -1.0);
  CHECK(c.injection_rate == 3.5);
  CHECK(c.refine == Refine::near);
  CHECK(c.summation == Summation::fmm);
  CHECK(c.fields_at == std::vector<double>{0.0, 0.5, 2.0});
  CHECK(c.field_points == 50);
  CHECK(c.checkpoint_every == 0.0);
  CHECK(read(complete, {"fields_at=none"}).fields_at.empty());
  CHECK(read(complete, {"summation=direct"}).summation == Summation::direct);
}

TEST_CASE("a case in an annulus without its radii names what is missing, and not the flow") {
  for (const char* key : {"inner_radius", "outer_radius"}) {
    std::string text = complete;
    text.insert(text.find(concat(key, " =")), 1, '#');
    check_contains(refusal([&] { read(text); }), concat("case.txt:8: the case is not complete; add a line "
                                                        "`key = value` for each of: ", key, "."));
  }
  check_contains(refusal([&] { read("geometry = annulus\n"); }),
                 "for each of: bodies, time_step, end_time, output, inner_radius, outer_radius.");
  check_contains(refusal([&] { read("geometry = unbounded\n"); }),
                 "for each of: bodies, flow, time_step, end_time, output.");
}

TEST_CASE("a key of the wrong geometry is refused") {
  for (const char* argument : {"inner_radius=5", "outer_radius=10", "wall_points=64", "outer_angular_velocity=0",
                               "inner_angular_velocity=1", "injection_rate=1"}) {
    const std::string key = std::string(argument).substr(0, std::string(argument).find('='));
    check_refused(unbounded, argument, key + " = ");
    check_refused(unbounded, argument, concat(key, " = '", argument + key.size() + 1, "' belongs to an annulus"));
  }
  for (const char* flow : {"shear", "extension", "poiseuille", "taylor_green"})
    check_refused(complete, concat("flow=", flow), concat("flow = '", flow, "' is a flow of unbounded fluid"));
  check_refused(complete, "geometry=anulus",
                "geometry = 'anulus' is unknown: it can be unbounded or disc or annulus; did you mean 'annulus'?");
}

TEST_CASE("values of the new keys out of their limits are refused") {
  check_refused(complete, "inner_radius=0", "inner_radius = '0' must be greater than 0");
  check_refused(complete, "inner_radius=-5", "inner_radius = '-5' must be greater than 0");
  check_refused(complete, "outer_radius=5", "outer_radius = '5' must be greater than inner_radius = 5");
  check_refused(complete, "outer_radius=-1", "outer_radius = '-1' must be greater than inner_radius = 5");
  check_refused(complete, "outer_radius=1e200", "outer_radius = '1e200' is above 1e100");
  check_refused(complete, "wall_points=14", "wall_points = '14' is below 16");
  check_refused(complete, "wall_points=17", "wall_points = '17' is odd");
  check_refused(complete, "wall_points=70000", "wall_points = '70000' is above 65536");
  check_refused(complete, "injection_rate=nan", "injection_rate = 'nan' is not a finite number");
  check_refused(unbounded, "fields_at=0 soon", "fields_at = '0 soon' has 'soon', which is not a finite number");
  check_refused(unbounded, "fields_at=0 2.5",
                "fields_at = '0 2.5' has the time 2.5, which is not between 0 and end_time = 2");
  check_refused(unbounded, "fields_at=-1", "fields_at = '-1' has the time -1");
  check_refused(unbounded, "fields_at=1 0.5", "fields_at = '1 0.5' must be in increasing order");
  check_refused(unbounded, "fields_at=1 1", "fields_at = '1 1' must be in increasing order");
  check_refused(unbounded, "field_points=1", "field_points = '1' must be at least 2");
  check_refused(unbounded, "field_points=20000", "field_points = '20000' is above 10000");
  check_refused(unbounded, "checkpoint_every=-1", "checkpoint_every = '-1' must be at least 0");
  check_refused(unbounded, "refine=nearly",
                "refine = 'nearly' is unknown: it can be none or near; did you mean 'near'?");
  check_refused(unbounded, "summation=fast", "summation = 'fast' is unknown: it can be auto or direct or fmm");
}

TEST_CASE("a case in an annulus that is written as a file makes the same case again, without what changes no result") {
  const Case c = read(complete, {"injection_rate=0.1", "fields_at=0 .1 2", "refine=near", "checkpoint_every=1"});
  CHECK(describe(read(format_case(c))) == describe(c));
  CHECK(format_case(c).find("fields_at = 0 0.1 2\n") != std::string::npos);
  CHECK(format_case(c).find("checkpoint_every") == std::string::npos);
  CHECK(format_case(read(unbounded)).find("wall_points") == std::string::npos);
  CHECK(describe(read(complete, {"inner_angular_velocity=1"})) != describe(read(complete)));
}

TEST_CASE("the suspension in an annulus has the inner wall as its last body and the outer one around it") {
  const Suspension bodies =
      suspension("a,b,x,y,theta,fixed,force_x\n.5,.25,7,0,1,0,3\n.5,.5,-7,0,0,1,0\n",
                 {"wall_points=128", "outer_angular_velocity=2", "inner_angular_velocity=-1", "injection_rate=3"});
  REQUIRE(bodies.size() == 3);
  CHECK_FALSE(bodies[0].fixed);
  CHECK(bodies[0].points == 0);
  CHECK(bodies[0].force == Complex(3.0, 0.0));  // it need not be balanced
  CHECK(bodies[1].fixed);
  CHECK(bodies[1].points == 0);
  CHECK(bodies[2].fixed);
  CHECK(bodies[2].shape == Shape{5.0, 5.0});
  CHECK(bodies[2].pose.centre == Complex(0.0, 0.0));
  CHECK(bodies[2].points == 128);
  REQUIRE(bodies.container);
  CHECK(bodies.container->radius == 10.0);
  CHECK(bodies.container->points == 128);
  // 3 area units per time leave through either wall; the surfaces turn.
  for (const auto& [surface, radius, turn] :
       {std::tuple(bodies[2].surface, 5.0, -1.0), {bodies.container->surface, 10.0, 2.0}}) {
    const Complex u = surface.velocity({0.0, radius});
    CHECK(std::abs(u.imag() * 2.0 * pi * radius - 3.0) < 1e-14);
    CHECK(std::abs(u.real() + turn * radius) < 1e-14);
  }
  // The walls have no row.
  const Suspension again = suspension(format_bodies(bodies));
  REQUIRE(again.size() == 3);
  CHECK(format_bodies(again) == format_bodies(bodies));
  CHECK(again[1].fixed);
  const Workspace here(unbounded, disc);
  const Suspension free = read_suspension(read_case(here.path() / "case.txt"));
  CHECK(free.size() == 1);
  CHECK_FALSE(free.container.has_value());
}

TEST_CASE("walls have no part in the unit of the separation") {
  const Case c = read(complete, {"min_separation=2"});
  CHECK(std::abs(separation_length(c, suspension(disc)) - 2.0 * pi / 32.0) < 1e-15);
}

TEST_CASE("bodies beyond a wall or too close to another are refused with the line, the body and the depth") {
  const std::string inside = "a,b,x,y,theta,fixed\n.5,.5,7,0,0,1\n1,.25,0,9.5,0,0\n.25,.5,-9,0,0,0\n";
  CHECK(refusal([&] { suspension(inside); }) == "accepted");
  check_bodies(".5,.5,7,0,0,0\n.5,.5,0,9.75,0,0\n",
               "3: body 1 (counted from 0) reaches 0.25 beyond the outer wall of radius 10, "
               "the smallest distance to a wall of all; move it inwards.");
  check_bodies("1,.5,0,-9.25,1.5707963267948966,1\n",
               "2: body 0 (counted from 0) reaches 0.25 beyond the outer wall of radius 10");
  check_bodies(".5,.5,20,0,0,0\n", "2: body 0 (counted from 0) reaches 10.5 beyond the outer wall of radius 10");
  check_bodies(".5,.5,9.5,0,0,0\n", "2: body 0 (counted from 0) touches the outer wall of radius 10");
  check_bodies("1,.5,0,5.375,0,0\n",
               "2: body 0 (counted from 0) overlaps the inner wall of radius 5 by 0.125, "
               "the smallest distance to a wall of all; move it outwards.");
  check_bodies(".5,.5,0,5.5,0,0\n", "2: body 0 (counted from 0) touches the inner wall of radius 5");
  check_bodies("1,1,0,0,0,0\n", "2: body 0 (counted from 0) overlaps the inner wall of radius 5 by 6");
  check_bodies("6,6,0,0,0,0\n", "2: body 0 (counted from 0) overlaps the inner wall of radius 5 by 11");
  check_bodies(".5,.5,7,0,0,1\n.5,.5,7.75,0,0,1\n", "3: bodies 0 and 1 (counted from 0) overlap by 0.25");
  check_bodies(".5,.5,7,0,0,0\n.5,.5,7.75,0,0,1\n", "3: bodies 0 and 1 (counted from 0) overlap by 0.25");
  check_bodies(".5,.5,7,0,0,.5\n", "2: fixed = 0.5 of body 0 must be 0 (free) or 1 (held in place)");
  check_bodies("", "1: there are no bodies");
}
