// Space-time interference volumes with fixed bodies and with the container.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "gap.hpp"
#include "random_suspension.hpp"
#include "stiv.hpp"

using namespace stokes;

namespace {

struct Random : RandomNumbers {
  Shape shape() {
    const double size = between(0.5, 1.0);
    return uniform(engine) < 0.3 ? Shape{size, size} : Shape{size, size / between(1.0, 6.0)};
  }
};

// One body, its trial pose, and the container around it.
struct Step {
  Body body;
  Pose trial;
  Container container;
  double separation;

  std::vector<ContactConstraint> contacts(int vertices, StivGradient choice = StivGradient::full) const {
    Suspension start{body};
    start.container = container;
    return StivCollector(start, separation, {vertices, choice}).collect({trial});
  }
  double volume(int vertices) const {
    double sum = 0.0;
    for (const ContactConstraint& c : contacts(vertices)) sum += c.value;
    return sum;
  }
  // Vertices of the offset polygon from the container's centre.
  std::vector<Complex> polygon(const Pose& pose, int vertices) const {
    std::vector<Complex> result;
    const auto [a, b] = body.shape;
    for (int k = 0; k < vertices; ++k) {
      const double c = std::cos(2.0 * pi * k / vertices), s = std::sin(2.0 * pi * k / vertices);
      const Complex normal{b * c, a * s};
      result.push_back(pose.centre - container.centre +
                       pose.axis() * (Complex(a * c, b * s) + 0.5 * separation * normal / std::abs(normal)));
    }
    return result;
  }
  double largest_distance(const Pose& pose, int vertices) const {
    double largest = 0.0;
    for (const Complex x : polygon(pose, vertices)) largest = std::max(largest, std::abs(x));
    return largest;
  }
};

Step random_step(Random& random, double turn) {
  const Container container{{random.between(-2.0, 2.0), 0.0}, random.between(1.5, 4.0)};
  const auto somewhere = [&] {
    return container.centre + container.radius * random.within(0.0, 1.1);
  };
  Step step{{random.shape(), {somewhere(), random.between(0.0, 7.0)}}, {}, container, random.between(0.0, 0.3)};
  step.trial = {somewhere(), step.body.pose.angle + random.between(-turn, turn)};
  if (uniform(random.engine) < 0.5)
    step.trial.centre = step.body.pose.centre + 0.3 * random.direction();
  return step;
}

}  // namespace

TEST_CASE("stiv obstacles: V is negative exactly when the offset polygon ends across the container's circle") {
  Random random{std::mt19937_64(1)};
  int across = 0, inside = 0, began_outside = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const Step step = random_step(random, 0.5);
    const double limit = step.container.radius - 0.5 * step.separation;
    const double distance = step.largest_distance(step.trial, 64) - limit;
    if (std::abs(distance) < 1e-12) continue;
    CHECK((step.volume(64) < 0.0) == (distance > 0.0));
    (distance > 0.0 ? across : inside) += 1;
    began_outside += distance > 0.0 && step.largest_distance(step.body.pose, 64) > limit;
  }
  CHECK(across > 500);
  CHECK(inside > 500);
  CHECK(began_outside > 200);
}

TEST_CASE("stiv obstacles: V of a body that does not move is the integral of its distances across the circle") {
  Random random{std::mt19937_64(2)};
  double largest = 0.0;
  for (int trial = 0; trial < 100; ++trial) {
    Step step = random_step(random, 0.0);
    step.trial = step.body.pose;
    const std::vector<Complex> x = step.polygon(step.trial, 48);
    double expected = 0.0;
    for (int k = 0; k < 48; ++k) {
      const double ds = 0.5 * (std::abs(x[(k + 1) % 48] - x[k]) + std::abs(x[k] - x[(k + 47) % 48]));
      expected += ds * std::min(0.0, step.container.radius - 0.5 * step.separation - std::abs(x[k]));
    }
    CHECK(std::abs(step.volume(48) - expected) < 1e-13);
    largest = std::max(largest, -expected);
  }
  CHECK(largest > 0.1);
}

TEST_CASE("stiv obstacles: at the container `full` is the derivative of V along the way, `frozen` a fraction") {
  Random random{std::mt19937_64(3)};
  int compared = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    Step step = random_step(random, 0.0);
    const Complex way = step.trial.centre - step.body.pose.centre;
    const double limit = step.container.radius - 0.5 * step.separation;
    if (step.largest_distance(step.body.pose, 64) > limit || step.volume(64) == 0.0) continue;
    Complex slope = 0.0, frozen = 0.0;
    for (const ContactConstraint& c : step.contacts(64)) slope += c.gradient.centre_a;
    for (const ContactConstraint& c : step.contacts(64, StivGradient::frozen)) frozen += c.gradient.centre_a;
    const double h = 1e-7;
    Step ahead = step, behind = step;
    ahead.trial.centre += h * way, behind.trial.centre -= h * way;
    // A vertex that meets the circle within the difference has a kink there, of a volume of order h^2.
    CHECK(std::abs((ahead.volume(64) - behind.volume(64)) / (2.0 * h) - dot(slope, way)) < 1e-5);
    CHECK(dot(slope, way) < 0.0);
    CHECK(dot(frozen, way) < 0.0);
    CHECK(dot(frozen, way) > dot(slope, way));
    ++compared;
  }
  CHECK(compared > 50);
}

TEST_CASE("stiv obstacles: the turning moment at the container is the derivative of V for a body outside at rest") {
  Random random{std::mt19937_64(4)};
  int compared = 0;
  for (int trial = 0; trial < 300; ++trial) {
    Step step = random_step(random, 0.0);
    step.trial = step.body.pose;
    double moment = 0.0;
    for (const ContactConstraint& c : step.contacts(64)) moment += c.gradient.angle_a;
    const auto volume_at = [&](double turn) {
      Step turned = step;
      turned.trial.angle += turn, turned.body.pose = turned.trial;
      return turned.volume(64);
    };
    if (volume_at(0.0) == 0.0) continue;
    const double h = 1e-6;
    CHECK(std::abs((volume_at(h) - volume_at(-h)) / (2.0 * h) - moment) < 1e-5);
    ++compared;
  }
  CHECK(compared > 100);
}

TEST_CASE("stiv obstacles: forces on the body and on the container are opposite, and on lines through its centre") {
  Random random{std::mt19937_64(5)};
  int found = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Step step = random_step(random, 0.2);
    for (const ContactConstraint& c : step.contacts(64)) {
      ++found;
      CHECK(c.a == 0);
      CHECK(c.b == container_index);
      CHECK(c.value < 0.0);
      CHECK(c.force.centre_b == -c.force.centre_a);
      CHECK(std::abs(c.force.angle_b) < 1e-13);
    }
  }
  CHECK(found > 50);
}

TEST_CASE("stiv obstacles: a long body that meets the container with both ends has two regions there") {
  Step step{{{1.0, 0.1}, {{0.0, 0.3}, 0.0}}, {{0.0, 0.5}, 0.0}, {{0.0, 0.0}, 1.1}, 0.0};
  const auto regions = step.contacts(64);
  REQUIRE(regions.size() == 2);
  CHECK(regions[0].region == 0);
  CHECK(regions[1].region == 1);
  CHECK(regions[0].gradient.centre_a.real() < 0.0);  // the end at +1, where vertex 0 is
  CHECK(regions[1].gradient.centre_a.real() > 0.0);
  CHECK(std::abs(regions[0].value - regions[1].value) < 1e-14);
}

TEST_CASE("stiv obstacles: a fixed body differs from one at rest only in that two of them have no contact") {
  Random random{std::mt19937_64(6)};
  int found = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Shape shape{0.8, 0.4};
    Suspension start{{shape, {0.0, random.between(0.0, 7.0)}},
                     {shape, {1.7 * random.direction(), random.between(0.0, 7.0)}}};
    const std::vector<Pose> end{start[0].pose, {0.3 * start[1].pose.centre, start[1].pose.angle + 0.1}};
    const auto at_rest = StivCollector(start, 0.1, {32}).collect(end);
    start[0].fixed = true;
    const auto fixed = StivCollector(start, 0.1, {32}).collect(end);
    REQUIRE(fixed.size() == at_rest.size());
    for (std::size_t k = 0; k < fixed.size(); ++k) {
      CHECK(fixed[k].value == at_rest[k].value);
      CHECK(fixed[k].force.centre_a == at_rest[k].force.centre_a);
      CHECK(fixed[k].force.centre_a == -fixed[k].force.centre_b);
      CHECK(fixed[k].force.angle_b == at_rest[k].force.angle_b);
      ++found;
    }
    start[1].fixed = true;
    CHECK(StivCollector(start, 0.1, {32}).collect(end).empty());
  }
  CHECK(found > 100);
}

TEST_CASE("stiv obstacles: an inner wall has vertices enough for small bodies to keep their distance from it") {
  constexpr double wall = 5.0, radius = 0.25, separation = 0.02;
  constexpr int vertices = 32;
  Random random{std::mt19937_64(7)};
  for (int trial = 0; trial < 20; ++trial) {
    const Complex direction = random.direction();
    Suspension start{{{wall, wall}, {0.0, random.between(0.0, 7.0)}},
                     {{radius, radius}, {6.0 * direction, random.between(0.0, 7.0)}}};
    start[0].fixed = true;
    const StivCollector collector(start, separation, {vertices});
    double touching = 5.0, apart = 6.0;
    while (apart - touching > 1e-9) {
      const double middle = 0.5 * (touching + apart);
      const auto found = collector.collect({start[0].pose, {middle * direction, start[1].pose.angle}});
      (found.empty() ? apart : touching) = middle;
    }
    const double expected = wall + radius + separation;
    // The bulges r (pi / n)^2 / 2 of offset circles with 32 vertices and with 20 times as many.
    const auto bulge = [](double r, double n) { return (r + 0.5 * separation) * (pi / n) * (pi / n) / 2.0; };
    CHECK(apart <= expected + 1e-9);
    CHECK(apart >= expected - bulge(radius, vertices) - bulge(wall, 20.0 * vertices) - 1e-9);
  }
}
