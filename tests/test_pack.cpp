// Random suspensions of the program pack: gaps, fractions, reproducible bytes.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "case.hpp"
#include "pack_bodies.hpp"
#include "program.hpp"
#include "refusal.hpp"

using namespace stokes;

namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::filesystem::path pack_program() { return simulate_program().parent_path() / "pack"; }

PackingRequest request(const Region& region, std::vector<ShapeShare> shapes) {
  PackingRequest r;
  r.region = region, r.shapes = std::move(shapes);
  r.clearance = {0.02, 0.03};
  return r;
}

const Region box{RegionKind::box, 20.0, 12.0}, disc{RegionKind::disc, 0.0, 0.0, 0.0, 9.0},
    annulus{RegionKind::annulus, 0.0, 0.0, 4.0, 9.0};

// Points on the outline of a body.
std::vector<Complex> outline(const Body& body, int count = 200) {
  std::vector<Complex> points;
  for (int k = 0; k < count; ++k) {
    const double alpha = 2.0 * pi * k / count;
    const Complex z(body.shape.a * std::cos(alpha), body.shape.b * std::sin(alpha));
    points.push_back(body.pose.centre + body.pose.axis() * z);
  }
  return points;
}

double distance_to_edge(const Region& r, Complex x) {
  if (r.kind == RegionKind::box)
    return std::min(0.5 * r.width - std::abs(x.real()), 0.5 * r.height - std::abs(x.imag()));
  const double outer = r.outer_radius - std::abs(x);
  return r.kind == RegionKind::disc ? outer : std::min(outer, std::abs(x) - r.inner_radius);
}

// Every pair and every point of the outlines.
void check_clearances(const Packing& packing, const PackingRequest& r) {
  double between = 1e300, to_edge = 1e300;
  for (std::size_t i = 0; i < packing.bodies.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) between = std::min(between, gap(packing.bodies[i], packing.bodies[j]).value);
    for (const Complex x : outline(packing.bodies[i])) to_edge = std::min(to_edge, distance_to_edge(r.region, x));
  }
  CHECK(between > r.clearance.bodies);
  CHECK(to_edge > r.clearance.walls);
  CHECK(packing.closest.gap == doctest::Approx(between).epsilon(1e-9));
  CHECK(packing.wall_gap <= to_edge * (1.0 + 1e-9));
  CHECK(packing.wall_gap > 0.9 * to_edge - 1e-3);  // the outline has corners
}

}  // namespace

TEST_CASE("points of a region are uniform over it, and walls are where they should be") {
  UniformRandom random(7);
  for (const Region& region : {box, disc, annulus}) {
    const int count = 40000;
    double right = 0, near = 0;
    const double middle = std::sqrt(0.5 * (region.inner_radius * region.inner_radius + 81.0));  // half of the area is within
    for (int k = 0; k < count; ++k) {
      const double u1 = random(), u2 = random();
      const Complex x = region.point(u1, u2);
      REQUIRE(distance_to_edge(region, x) > -1e-12);
      right += x.real() > 0.0;
      near += region.kind == RegionKind::box ? x.imag() > 3.0 : std::abs(x) < middle;
    }
    CHECK(std::abs(right / count - 0.5) < 0.01);  // four standard deviations
    CHECK(std::abs(near / count - (region.kind == RegionKind::box ? 0.25 : 0.5)) < 0.01);
    const Body body{{0.8, 0.3}, {region.point(0.5, 0.9), 0.7}};
    double smallest = 1e300;
    for (const Complex x : outline(body, 20000)) smallest = std::min(smallest, distance_to_edge(region, x));
    double given = 1e300;
    for (const Gap& g : region.wall_gaps(body.shape, body.pose)) {
      given = std::min(given, g.value);
      CHECK(std::abs(g.point_b - g.point_a - g.value * g.normal) < 1e-12);
    }
    CHECK(std::abs(given - smallest) < 1e-6);
  }
}

TEST_CASE("bodies keep their clearances in every region, sparse ones without a change and dense ones after relaxation") {
  const std::vector<ShapeShare> discs = {{{0.5, 0.5}, 1.0}}, mixed = {{{0.5, 0.5}, 2.0}, {{0.8, 0.3}, 1.0}};
  for (const Region& region : {box, disc, annulus})
    for (const double fraction : {0.15, 0.6}) {
      PackingRequest r = request(region, fraction < 0.5 ? discs : mixed);
      r.area_fraction = fraction;
      r.polydispersity = 0.1;
      const Packing packing = pack_bodies(r);
      CHECK(packing.relaxed == (fraction > 0.5));
      CHECK(std::abs(packing.area_fraction - fraction) < 0.02);
      check_clearances(packing, r);
    }
}

TEST_CASE("discs of one size fill three quarters of a box, and ellipses two thirds") {
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    PackingRequest r = request({RegionKind::box, 20.0, 20.0}, {{{0.5, 0.5}, 1.0}});
    r.clearance = {0.01, 0.01};
    r.area_fraction = 0.75;
    r.seed = seed;
    const Packing packing = pack_bodies(r);
    CHECK(packing.area_fraction > 0.749);
    check_clearances(packing, r);
  }
  PackingRequest r = request({RegionKind::box, 20.0, 20.0}, {{{0.9, 0.3}, 1.0}});
  r.area_fraction = 0.66;
  check_clearances(pack_bodies(r), r);
}

TEST_CASE("shares, number, fraction and polydispersity are those asked for") {
  PackingRequest r = request(box, {{{0.4, 0.2}, 1.0}, {{0.3, 0.3}, 2.0}});
  r.number = 31;
  Packing packing = pack_bodies(r);
  REQUIRE(packing.bodies.size() == 31);
  CHECK(std::count_if(packing.bodies.begin(), packing.bodies.end(), [](const Body& b) { return b.shape.a == 0.4; }) == 10);
  r.area_fraction = 0.2;
  packing = pack_bodies(r);
  CHECK(packing.bodies.size() == 31);
  CHECK(std::abs(packing.area_fraction - 0.2) < 1e-12);
  CHECK(packing.bodies[0].shape.a / packing.bodies[0].shape.b == doctest::Approx(2.0).epsilon(1e-12));

  r = request(box, {{{0.1, 0.1}, 1.0}});
  r.number = 4000, r.polydispersity = 0.2;
  UniformRandom random(3);
  double sum = 0.0, squares = 0.0;
  for (const Shape& shape : requested_shapes(r, random)) sum += shape.a, squares += shape.a * shape.a;
  const double mean = sum / 4000, deviation = std::sqrt(squares / 4000 - mean * mean);
  CHECK(std::abs(mean - 0.1) < 0.0015);  // five standard deviations
  CHECK(std::abs(deviation / mean - 0.2) < 0.01);
}

TEST_CASE("what cannot be packed is refused") {
  PackingRequest r = request(box, {{{0.5, 0.5}, 1.0}});
  CHECK(contains(refusal([&] { pack_bodies(r); }), "number or area_fraction"));
  r.number = 1000;
  CHECK(contains(refusal([&] { pack_bodies(r); }), "do not fit"));
  r.number = 0, r.area_fraction = 1.2;
  CHECK(contains(refusal([&] { pack_bodies(r); }), "must be below 1"));
  r = request({RegionKind::box, 4.0, 4.0}, {{{0.5, 0.5}, 1.0}});
  r.number = 18;  // an area fraction of .88
  CHECK(contains(refusal<NumericalError>([&] { pack_bodies(r); }), "too narrow"));
}

TEST_CASE("pack writes the same bytes for the same seed, which simulate reads, and other ones for another") {
  const TemporaryFolder folder;
  const auto run = [&](std::vector<std::string> arguments) {
    for (const char* argument : {"domain=annulus", "inner_radius=1", "outer_radius=3", "number=30", "area_fraction=0.15"})
      arguments.push_back(argument);
    return run_program(pack_program(), arguments, folder.path());
  };
  const ProgramRun first = run({"output=a.csv"});
  CAPTURE(first.errors);
  REQUIRE(first.status == 0);
  CHECK(contains(first.output, "30 bodies, area fraction 0.15"));
  for (const char* key : {"bodies = a.csv", "geometry = annulus", "inner_radius = 1", "outer_radius = 3"})
    CHECK(contains(first.output, key));
  REQUIRE(run({"output=b.csv"}).status == 0);
  REQUIRE(run({"output=c.csv", "seed=2"}).status == 0);
  CHECK(content_of(folder.path() / "a.csv") == content_of(folder.path() / "b.csv"));
  CHECK(content_of(folder.path() / "a.csv") != content_of(folder.path() / "c.csv"));
  Case c;
  c.file = folder.path() / "case.txt", c.bodies = "a.csv", c.geometry = Geometry::annulus;
  c.inner_radius = 1.0, c.outer_radius = 3.0;
  CHECK(read_suspension(c).size() == 31);
  const std::string before = content_of(folder.path() / "a.csv");
  const ProgramRun again = run({"output=a.csv", "seed=5"});
  CHECK(again.status == 2);
  CHECK(contains(again.errors, "is there already"));
  CHECK(content_of(folder.path() / "a.csv") == before);
  CHECK(run({"output=a.csv", "seed=5", "overwrite=yes"}).status == 0);
  CHECK(content_of(folder.path() / "a.csv") != before);
}

TEST_CASE("pack explains its keys and refuses what it does not know, and writes nothing then") {
  const TemporaryFolder folder;
  const auto errors = [&](const std::vector<std::string>& arguments, int status = 2) {
    const ProgramRun run = run_program(pack_program(), arguments, folder.path());
    CAPTURE(run.errors);
    CHECK(run.status == status);
    CHECK(std::count(run.errors.begin(), run.errors.end(), '\n') == 1);
    CHECK(everything_in(folder.path()).empty());
    return run.errors;
  };
  CHECK(contains(errors({"number=3"}), "domain is missing"));
  CHECK(contains(errors({"domain=box", "number=3"}), "needs width"));
  CHECK(contains(errors({"domain=disc", "outer_radius=3", "width=2", "number=3"}), "width does nothing with domain = disc"));
  CHECK(contains(errors({"domain=box", "width=9", "nunber=3"}), "did you mean 'number'?"));
  CHECK(contains(errors({"domain=box", "width=9", "number=3.5"}), "number = '3.5' is not a whole number"));
  CHECK(contains(errors({"domain=box", "width=9", "number=3", "shapes=1"}), "not two semi-axes"));
  CHECK(contains(errors({"domain=box", "width=9", "number=3", "number=4"}), "given twice"));
  CHECK(contains(errors({"domain=box", "width=4", "number=18", "shapes=.5 .5"}, 3), "too narrow"));
  const ProgramRun help = run_program(pack_program(), {"--help"}, folder.path());
  CHECK(help.status == 0);
  for (const char* key : {"domain", "number", "area_fraction", "shapes", "polydispersity", "body_clearance", "seed"})
    CHECK(contains(help.output, concat("\n  ", key, " ")));
}
