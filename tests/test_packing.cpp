#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "container_gap.hpp"
#include "gap.hpp"
#include "packing.hpp"
#include "refusal.hpp"

using namespace stokes;

namespace {

const Annulus paper{5.0, 10.0};

RandomPlacement ellipses(int count, std::uint64_t seed) {
  RandomPlacement placement{{0.375, 0.125}, count};
  placement.seed = seed;
  return placement;
}

// Smallest distance of any two bodies, the inner wall included, and of a body and the container. Every pair.
double smallest_distance(const Suspension& bodies) {
  double smallest = 1e300;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (&bodies[i] != &bodies.back()) smallest = std::min(smallest, gap(bodies[i], *bodies.container).value);
    for (std::size_t j = 0; j < i; ++j) smallest = std::min(smallest, gap(bodies[i], bodies[j]).value);
  }
  return smallest;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// Mean of a function of the centre's distance from the origin, over many bodies so small that they never meet.
template <class Function>
double mean_over_specks(RadialDensity density, const Function& f) {
  RandomPlacement placement{{1e-9, 1e-9}, 3000, 5.0, 10.0, density};
  double sum = 0.0;
  for (const Body& body : random_bodies(placement)) sum += f(std::abs(body.pose.centre));
  return sum / placement.count;
}

}  // namespace

TEST_CASE("random bodies in an annulus overlap neither each other nor the walls, at the densities of the paper") {
  const std::pair<Shape, int> cases[] = {{{0.375, 0.375}, 80}, {{0.375, 0.125}, 240}, {{0.375, 0.0625}, 320}};
  for (const auto& [shape, count] : cases) {
    RandomPlacement placement{shape, count};
    placement.seed = 7;
    const Suspension bodies = random_annulus(paper, placement);
    REQUIRE(static_cast<int>(bodies.size()) == count + 1);
    CHECK(bodies.back().fixed);
    CHECK(bodies.back().shape == Shape{5.0, 5.0});
    CHECK(bodies.back().points == 256);
    CHECK(bodies.container->radius == 10.0);
    CHECK(smallest_distance(bodies) > 0.0);
    const double expected = count * shape.a * shape.b / 75.0;
    CHECK(std::abs(area_fraction(bodies, paper) - expected) < 1e-12);
  }
  CHECK(std::abs(area_fraction(random_annulus(paper, ellipses(240, 3)), paper) - 0.15) < 1e-12);
}

TEST_CASE("a minimum distance is kept to every body and to both walls") {
  RandomPlacement placement = ellipses(150, 11);
  placement.min_distance = 0.0245;
  CHECK(smallest_distance(random_annulus(paper, placement)) > 0.0245);
  CHECK(smallest_distance(random_annulus(paper, ellipses(150, 11))) < 0.0245);  // which had to be avoided
}

TEST_CASE("the same seed gives the same bodies, another seed others, and these are they") {
  const Suspension bodies = random_annulus(paper, ellipses(20, 1)), again = random_annulus(paper, ellipses(20, 1));
  const Suspension other = random_annulus(paper, ellipses(20, 2));
  for (std::size_t i = 0; i < 20; ++i) {
    CHECK(bodies[i].pose.centre == again[i].pose.centre);
    CHECK(bodies[i].pose.angle == again[i].pose.angle);
    CHECK(bodies[i].pose.centre != other[i].pose.centre);
  }
  const auto check = [&](int i, Complex centre, double angle) {
    CHECK(std::abs(bodies[i].pose.centre - centre) < 1e-13);
    CHECK(std::abs(bodies[i].pose.angle - angle) < 1e-13);
  };
  check(0, {3.7114879405447305, 4.285646201346901}, 2.8350668542164517);
  check(19, {0.7440749088149281, -8.714337230908875}, 6.200850198008736);
}

TEST_CASE("radii are uniform, or uniform by area") {
  const auto r = [](double x) { return x; };
  const auto r2 = [](double x) { return x * x; };
  // Five standard deviations of the mean of 3000.
  const auto close = [](double got, double mean, double variance) {
    return std::abs(got - mean) < 5.0 * std::sqrt(variance / 3000.0);
  };
  CHECK(close(mean_over_specks(RadialDensity::uniform_radius, r), 7.5, 25.0 / 12.0));
  CHECK(close(mean_over_specks(RadialDensity::uniform_radius, r2), 175.0 / 3.0, 19375.0 / 5.0 - 175.0 * 175.0 / 9.0));
  CHECK(close(mean_over_specks(RadialDensity::uniform_area, r), 70.0 / 9.0, 62.5 - 4900.0 / 81.0));
  CHECK(close(mean_over_specks(RadialDensity::uniform_area, r2), 62.5, 5625.0 / 12.0));
}

TEST_CASE("polar angles and orientations are uniform and independent") {
  RandomPlacement placement{{1e-9, 1e-9}, 3000, 5.0, 10.0};
  const std::vector<Body> specks = random_bodies(placement);
  for (int k : {1, 2, 4}) {
    Complex polar = 0.0, turned = 0.0, relative = 0.0;
    for (const Body& body : specks) {
      const double angle = std::arg(body.pose.centre);
      polar += std::polar(1.0, k * angle);
      turned += std::polar(1.0, k * body.pose.angle);
      relative += std::polar(1.0, k * (body.pose.angle - angle));
    }
    for (Complex sum : {polar, turned, relative}) CHECK(std::abs(sum) / 3000.0 < 4.0 / std::sqrt(3000.0));
  }
}

TEST_CASE("discs placed inside a ring of fixed discs stay off it and off the walls") {
  const Annulus annulus{0.5, 10.0};
  Body held{{0.25, 0.25}, {}, {}, {}};
  held.fixed = true;
  const std::vector<Body> posts = ring(held, 41, 5.0);
  REQUIRE(posts.size() == 41);
  CHECK(std::abs(posts[0].pose.centre - 5.0) < 1e-15);
  CHECK(std::abs(posts[10].pose.centre - std::polar(5.0, 2.0 * pi * 10 / 41)) < 1e-14);
  Suspension surroundings = between_walls({posts.begin(), posts.end()}, annulus);
  const std::vector<Body> mobile = random_bodies({{0.25, 0.25}, 50, 1.25, 4.25}, surroundings);
  REQUIRE(mobile.size() == 50);
  Suspension all(mobile.begin(), mobile.end());
  all.insert(all.end(), posts.begin(), posts.end());
  all = between_walls(std::move(all), annulus);
  CHECK(smallest_distance(all) > 0.0);
  CHECK(std::abs(area_fraction(all, annulus) - 50 * 0.0625 / 99.75) < 1e-14);  // fixed bodies do not count
  for (const Body& body : mobile) {
    CHECK(std::abs(body.pose.centre) >= 1.25);
    CHECK(std::abs(body.pose.centre) <= 4.25);
  }
}

TEST_CASE("a packing that cannot be made says how far it came") {
  RandomPlacement placement{{2.0, 2.0}, 50};
  placement.max_tries = 2000;
  const std::string message = refusal<NumericalError>([&] { random_annulus(paper, placement); });
  CAPTURE(message);
  for (const char* part : {"random placement", " of 50 bodies", "2000 tries", "seed = 0", "try"})
    CHECK(contains(message, part));
  CHECK(contains(refusal<InputError>([] { random_bodies({{1.0, 1.0}, 1, 3.0, 2.0}); }), "3 and 2"));
  CHECK(random_bodies({{1.0, 1.0}, 0, 1.0, 2.0}).empty());
}
