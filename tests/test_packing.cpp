#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "container_gap.hpp"
#include "couette.hpp"
#include "gap.hpp"
#include "injection.hpp"
#include "packing.hpp"
#include "refusal.hpp"

using namespace stokes;

namespace {

const Annulus cylinders{5.0, 10.0};

RandomPlacement ellipses(int count, std::uint32_t seed) {
  RandomPlacement placement{{0.375, 0.125}, count, 5.0, 10.0};
  placement.seed = seed;
  return placement;
}

struct Distances {
  double to_walls = 1e300, between = 1e300;
};

// Smallest gaps of every body to the walls and of every pair.
Distances smallest_distances(const std::vector<Body>& bodies, const Annulus& annulus) {
  Distances smallest;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    smallest.to_walls = std::min({smallest.to_walls, gap(bodies[i], outer_wall(annulus)).value,
                                  gap(bodies[i], inner_wall(annulus)).value});
    for (std::size_t j = 0; j < i; ++j) smallest.between = std::min(smallest.between, gap(bodies[i], bodies[j]).value);
  }
  return smallest;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("uniform numbers are those of the published generator: seed 1000, to the digits that are published") {
  UniformRandom random(1000);
  for (const double published : {0.65358959, 0.11500694, 0.95028286, 0.4821914, 0.87247454, 0.21233268})
    CHECK(std::abs(random() - published) <= 0.5e-8);
}

TEST_CASE("uniform numbers are two outputs of the standard's Mersenne Twister, 27 and 26 bits of them") {
  std::mt19937 generator(5489);
  UniformRandom random(5489);
  for (int k = 0; k < 5000; ++k) {
    const auto high = static_cast<std::uint64_t>(generator() >> 5), low = static_cast<std::uint64_t>(generator() >> 6);
    const std::uint64_t bits = (high << 26) | low;
    REQUIRE(random() == std::ldexp(static_cast<double>(bits), -53));
  }
  std::mt19937 checked;  // the standard fixes the 10000th output from its default seed, 5489
  checked.discard(9999);
  CHECK(checked() == 4123659995u);
}

TEST_CASE("a body is placed by three uniform numbers, to the last bit") {
  UniformRandom random(1000);
  const Body first = place_randomly(ellipses(1, 1000), cylinders).bodies[0];
  // The first try clears both walls.
  const volatile double u1 = random(), u2 = random(), u3 = random();
  const volatile double way = 5.0 * u1, distance = 5.0 + way, polar = 2.0 * pi * u2, angle = 2.0 * pi * u3;
  CHECK(first.pose.centre == std::polar(static_cast<double>(distance), static_cast<double>(polar)));
  CHECK(first.pose.angle == angle);
}

TEST_CASE("the paper's starts take as many tries as the published ones and keep their clearances") {
  const std::pair<const char*, int> published[] = {
      {"phi5_lambda3", 146}, {"phi10_lambda3", 360}, {"phi5_lambda6", 298}, {"phi10_lambda6", 1043}};
  for (const auto& [suspension_name, tries] : published) {
    const char* const name = suspension_name;
    CAPTURE(name);
    const CouetteSuspension& suspension = couette_suspension(name);
    const PlacedBodies placed = couette_placement(suspension, suspension.paper_seed);
    CHECK(placed.tries == tries);
    const Distances distances = smallest_distances(placed.bodies, cylinders);
    CHECK(distances.to_walls > 0.375);
    CHECK(distances.between > suspension.body_clearance);
  }
}

TEST_CASE("the order parameters of the paper's other starts are the published ones") {
  const std::pair<const char*, double> published[] = {
      {"phi5_lambda1", 0.228}, {"phi10_lambda1", 0.008}, {"phi15_lambda1", 0.040}, {"phi15_lambda3", -0.014}};
  for (const auto& [suspension_name, value] : published) {
    const char* const name = suspension_name;
    CAPTURE(name);
    CHECK(std::abs(order_parameter(CouetteCase{couette_suspension(name)}.bodies()) - value) < 0.0011);
  }
}

TEST_CASE("the paper's start of the injection is the published one, disc by disc where centres are published") {
  const Suspension bodies = injection_bodies({});
  const std::pair<std::size_t, Complex> published[] = {{0, {2.524, 2.225}},   {3, {0.957, 2.112}},   {9, {-2.842, 2.114}},
                                                       {14, {0.206, 2.029}},  {22, {2.146, -1.300}}, {30, {-1.652, -0.195}},
                                                       {37, {4.038, 0.496}},  {46, {-2.559, -0.341}}};
  for (const auto& [disc, centre] : published) {
    CHECK(std::abs(bodies[disc].pose.centre.real() - centre.real()) < 0.00051);
    CHECK(std::abs(bodies[disc].pose.centre.imag() - centre.imag()) < 0.00051);
  }
}

TEST_CASE("clearances from walls and from bodies are kept apart from each other") {
  RandomPlacement placement = ellipses(150, 11);
  const Distances none = smallest_distances(place_randomly(placement, cylinders).bodies, cylinders);
  placement.wall_clearance = 0.3, placement.body_clearance = 0.0245;
  const Distances kept = smallest_distances(place_randomly(placement, cylinders).bodies, cylinders);
  CHECK(none.to_walls > 0.0);
  CHECK(none.between > 0.0);
  CHECK(none.between < 0.0245);  // which had to be avoided
  CHECK(kept.between > 0.0245);
  CHECK(kept.between < 0.3);  // the other clearance is of walls alone
  CHECK(none.to_walls < 0.3);
  CHECK(kept.to_walls > 0.3);
}

TEST_CASE("the same seed gives the same bodies, another seed others") {
  const auto bodies = place_randomly(ellipses(20, 1), cylinders).bodies;
  const auto again = place_randomly(ellipses(20, 1), cylinders).bodies;
  const auto other = place_randomly(ellipses(20, 2), cylinders).bodies;
  for (std::size_t i = 0; i < 20; ++i) {
    CHECK(bodies[i].pose.centre == again[i].pose.centre);
    CHECK(bodies[i].pose.angle == again[i].pose.angle);
    CHECK(bodies[i].pose.centre != other[i].pose.centre);
  }
}

TEST_CASE("distances from the axis, polar angles and orientations are uniform and independent") {
  // Bodies so small that they never meet.
  const auto specks = place_randomly({{1e-9, 1e-9}, 3000, 5.0, 10.0}, {1.0, 20.0}).bodies;
  double sum = 0.0, squares = 0.0;
  for (const Body& body : specks) sum += std::abs(body.pose.centre), squares += std::norm(body.pose.centre);
  // Five standard deviations of the mean of 3000.
  CHECK(std::abs(sum / 3000.0 - 7.5) < 5.0 * std::sqrt(25.0 / 12.0 / 3000.0));
  CHECK(std::abs(squares / 3000.0 - 175.0 / 3.0) < 5.0 * std::sqrt((19375.0 / 5.0 - 175.0 * 175.0 / 9.0) / 3000.0));
  for (int k : {1, 2, 4}) {
    Complex polar = 0.0, turned = 0.0, relative = 0.0;
    for (const Body& body : specks) {
      const double angle = std::arg(body.pose.centre);
      polar += std::polar(1.0, k * angle);
      turned += std::polar(1.0, k * body.pose.angle);
      relative += std::polar(1.0, k * (body.pose.angle - angle));
    }
    for (Complex total : {polar, turned, relative}) CHECK(std::abs(total) / 3000.0 < 4.0 / std::sqrt(3000.0));
  }
}

TEST_CASE("a ring of held discs is kept off, and does not count for the area fraction") {
  const Annulus annulus{0.5, 10.0};
  Body held{{0.25, 0.25}, {}, {}, {}};
  held.fixed = true;
  const std::vector<Body> posts = ring(held, 41, 5.0);
  REQUIRE(posts.size() == 41);
  CHECK(std::abs(posts[0].pose.centre - 5.0) < 1e-15);
  CHECK(std::abs(posts[10].pose.centre - std::polar(5.0, 2.0 * pi * 10 / 41)) < 1e-14);
  RandomPlacement placement{{0.25, 0.25}, 50, 1.25, 4.75};
  placement.body_clearance = 0.01;
  const std::vector<Body> mobile = place_randomly(placement, annulus, posts).bodies;
  REQUIRE(mobile.size() == 50);
  for (const Body& body : mobile)
    for (const Body& post : posts) CHECK(gap(body, post).value > 0.01);
  std::vector<Body> all = mobile;
  all.insert(all.end(), posts.begin(), posts.end());
  const Suspension bodies = between_walls({all.begin(), all.end()}, annulus);
  CHECK(std::abs(area_fraction(bodies, annulus) - 50 * 0.0625 / 99.75) < 1e-14);
}

TEST_CASE("a packing that cannot be made says how far it came") {
  RandomPlacement placement{{2.0, 2.0}, 50, 5.0, 10.0};
  placement.max_tries = 2000;
  const std::string message = refusal<NumericalError>([&] { place_randomly(placement, cylinders); });
  CAPTURE(message);
  for (const char* part : {"random placement", " of 50 bodies", "2000 tries", "seed = 0", "try"})
    CHECK(contains(message, part));
  CHECK(contains(refusal<InputError>([] { place_randomly({{1.0, 1.0}, 1, 3.0, 2.0}, cylinders); }), "3 and 2"));
  CHECK(place_randomly({{1.0, 1.0}, 0, 1.0, 2.0}, cylinders).bodies.empty());
}
