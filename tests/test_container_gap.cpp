// The gap between a body and the circular wall around it.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "container_gap.hpp"
#include "random_suspension.hpp"

using namespace stokes;

namespace {

struct Random : RandomNumbers {
  // Aspect ratio 1 to 8, either semi-axis the longer one.
  Shape shape() {
    const double size = between(0.2, 1.0), ratio = between(1.0, 8.0);
    return engine() % 2 ? Shape{size, size / ratio} : Shape{size / ratio, size};
  }
  // Centre anywhere in the container, and a little outside.
  Pose pose(const Container& container) {
    const double distance = 1.1 * container.radius * std::sqrt(uniform(engine));
    return {container.centre + distance * direction(), between(-7.0, 7.0)};
  }
};

Complex boundary_point(const Shape& shape, const Pose& pose, double alpha) {
  return pose.centre + pose.axis() * Complex(shape.a * std::cos(alpha), shape.b * std::sin(alpha));
}

// The largest of many samples, refined by a golden section between its neighbours.
double sampled_gap(const Shape& shape, const Pose& pose, const Container& container) {
  const auto distance = [&](double alpha) { return std::abs(boundary_point(shape, pose, alpha) - container.centre); };
  constexpr int samples = 400;
  double best = 0.0;
  for (int k = 1; k < samples; ++k)
    if (distance(2.0 * pi * k / samples) > distance(2.0 * pi * best / samples)) best = k;
  double low = 2.0 * pi * (best - 1) / samples, high = 2.0 * pi * (best + 1) / samples;
  const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
  for (int iteration = 0; iteration < 60; ++iteration) {
    const double left = high - ratio * (high - low), right = low + ratio * (high - low);
    (distance(left) > distance(right) ? high : low) = distance(left) > distance(right) ? right : left;
  }
  return container.radius - distance(0.5 * (low + high));
}

}  // namespace

TEST_CASE("the gap of a disc in a container is the wall's distance less the radius") {
  const Container container{{1.0, -2.0}, 5.0};
  const Gap inside = gap(Shape{0.5, 0.5}, {{4.0, 2.0 - 4.0}, 0.7}, container);
  CHECK(inside.value == 1.5);
  CHECK(inside.normal == Complex(1.0, 0.0));
  CHECK(inside.point_a == Complex(4.5, -2.0));
  CHECK(inside.point_b == Complex(6.0, -2.0));
  const Gap across = gap(Shape{0.5, 0.5}, {{1.0, 3.0}, 0.0}, container);
  CHECK(across.value == -0.5);
  CHECK(across.normal == Complex(0.0, 1.0));
  const Gap concentric = gap(Shape{0.5, 0.5}, {{1.0, -2.0}, 0.0}, container);
  CHECK(concentric.value == 4.5);
  CHECK(std::abs(concentric.normal) == 1.0);
}

TEST_CASE("the gap of an ellipse in a container is that of its densely sampled boundary") {
  Random random{std::mt19937_64(1)};
  double worst = 0.0;
  int outside = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    // Containers from much larger than the body to a little smaller: the flattest touch these with both ends.
    const Container container{{random.between(-3.0, 3.0), 1.0}, std::exp(random.between(-0.5, 2.5))};
    const Shape shape = random.shape();
    const Pose pose = random.pose(container);
    const Gap g = gap(shape, pose, container);
    worst = std::max(worst, std::abs(g.value - sampled_gap(shape, pose, container)));
    outside += g.value < 0.0;
    // The points are on the body and the wall.
    const Complex p = (g.point_a - pose.centre) * std::conj(pose.axis());
    CHECK(std::abs(std::hypot(p.real() / shape.a, p.imag() / shape.b) - 1.0) < 1e-13);
    CHECK(std::abs(std::abs(g.point_b - container.centre) / container.radius - 1.0) < 1e-14);
    CHECK(std::abs(g.point_b - g.point_a - g.value * g.normal) < 1e-13);
  }
  CHECK(worst < 1e-13);
  CHECK(outside > 500);
  CHECK(outside < 2500);
}

TEST_CASE("the distance of an ellipse to the wall around it is that of its farthest boundary point") {
  const Container wall{{0.5, -1.0}, 10.0, 64, {}};
  const auto at = [&](Shape shape, Complex from_centre, double angle) {
    return gap(shape, {wall.centre + from_centre, angle}, wall).value;
  };
  CHECK(std::abs(at({2.0, 2.0}, {3.0, 4.0}, 0.0) - 3.0) < 1e-14);
  CHECK(std::abs(at({2.0, 0.5}, {5.0, 0.0}, 0.0) - 3.0) < 1e-14);
  CHECK(std::abs(at({0.5, 2.0}, {0.0, -9.0}, 0.0) + 1.0) < 1e-14);
  CHECK(std::abs(at({2.0, 0.5}, {0.0, 0.0}, 0.7) - 8.0) < 1e-14);
  // d^2 = (x + a c)^2 + b^2 s^2 across the wall: its maximum for a < b is at c = x a / (b^2 - a^2).
  const double a = 0.5, b = 3.0, x = 2.0, c = x * a / (b * b - a * a);
  const double farthest = std::sqrt((x + a * c) * (x + a * c) + b * b * (1.0 - c * c));
  CHECK(std::abs(at({a, b}, {x, 0.0}, 0.0) - (10.0 - farthest)) < 1e-14);
  // Nearly equal maxima at both ends, of which the first sample is not the larger.
  for (double offset : {1e-3, 1e-6, -1e-6, -1e-3}) {
    const double turn = 0.3;
    const Complex d = std::polar(offset, turn + 0.01);
    double largest = 0.0;
    for (int k = 0; k < 400000; ++k) {
      const double alpha = 2.0 * pi * k / 400000;
      const Complex point(2.0 * std::cos(alpha), std::sin(alpha));
      largest = std::max(largest, std::abs(d + std::polar(1.0, turn) * point));
    }
    CHECK(std::abs(at({2.0, 1.0}, d, turn) - (10.0 - largest)) < 1e-9);
  }
}

TEST_CASE("bodies centred in the container, on an axis or at a cusp of the evolute are no exception") {
  const Container container{{0.0, 0.0}, 10.0};
  for (const Shape shape : {Shape{2.0, 1.0}, Shape{1.0, 2.0}, Shape{3.0, 0.01}, Shape{1.0, 1.0 - 1e-9}}) {
    const double longer = shape.circumradius(), shorter = shape.inradius();
    CHECK(std::abs(gap(shape, {0.0, 0.4}, container).value - (10.0 - longer)) < 1e-14);
    // Displaced along the shorter axis by x: the tip of that axis is farthest from x = (a^2 - b^2) / b on.
    const double turned = shape.a < shape.b ? 0.0 : 0.5 * pi, cusp = (longer * longer - shorter * shorter) / shorter;
    for (double x : {1e-30, 1e-12, 0.5 * cusp, cusp * (1.0 - 1e-12), cusp, cusp + 1e-9, 2.0 * cusp})
      for (Complex aside : {Complex(0.0, 0.0), Complex(0.0, 1e-18), Complex(0.0, -1e-9)}) {
        const Container wide{{0.0, 0.0}, 1000.0};
        const Pose pose{x + aside, turned};
        const double size = x + longer + 1000.0;
        const Gap g = gap(shape, pose, wide);
        CHECK(std::abs(g.value - sampled_gap(shape, pose, wide)) < 1e-15 * size);
        CHECK(std::abs(std::abs(g.normal) - 1.0) < 1e-15);
      }
    CHECK(std::abs(gap(shape, {5.0, turned + 0.5 * pi}, container).value - (5.0 - longer)) < 1e-14);
  }
  CHECK(std::isnan(gap(Shape{2.0, 1.0}, {0.0, std::nan("")}, container).value));
}

TEST_CASE("the gradient of the gap to a container is that of finite differences") {
  Random random{std::mt19937_64(2)};
  double worst = 0.0;
  for (int trial = 0; trial < 500; ++trial) {
    Shape shape = random.shape();
    if (trial % 5 == 0) shape.b = shape.a;
    // Wide enough for one point of contact.
    const double longer = shape.circumradius(), flattest = longer * longer / shape.inradius();
    const Container container{{1.0, 2.0}, flattest * random.between(1.5, 5.0)};
    const double distance = container.radius - longer * random.between(0.0, 1.2);
    const Pose pose{container.centre + distance * random.direction(), random.between(0.0, 7.0)};
    const GapGradient g = gradient(gap(shape, pose, container), pose);
    const double step = 1e-6 * longer;
    const auto difference = [&](Complex move, double turn) {
      const Pose ahead{pose.centre + step * move, pose.angle + step * turn};
      const Pose behind{pose.centre - step * move, pose.angle - step * turn};
      return (gap(shape, ahead, container).value - gap(shape, behind, container).value) / (2.0 * step);
    };
    worst = std::max({worst, std::abs(difference(1.0, 0.0) - g.centre_a.real()),
                      std::abs(difference(imaginary_unit, 0.0) - g.centre_a.imag()),
                      std::abs(difference(0.0, 1.0) - g.angle_a)});
    CHECK(g.centre_b == -g.centre_a);
    CHECK(g.angle_b == 0.0);
    // The reaction of the wall balances the torque of the force on the body.
    const Complex arm = pose.centre - container.centre;
    CHECK(std::abs(g.angle_a + cross(arm, g.centre_a)) < 1e-14 * container.radius);
  }
  CHECK(worst < 2e-8);
}

TEST_CASE("a push from the wall along the gap's own normal is the gap's gradient, along others balanced") {
  Random random{std::mt19937_64(3)};
  for (int trial = 0; trial < 200; ++trial) {
    const Shape shape = random.shape();
    const double longer = shape.circumradius(), flattest = longer * longer / shape.inradius();
    const Container container{{1.0, 2.0}, flattest * random.between(1.5, 5.0)};
    const Pose pose{container.centre + (container.radius - longer) * random.direction(), random.between(0.0, 7.0)};
    const Gap g = gap(shape, pose, container);
    const GapGradient expected = gradient(g, pose), same = push_from_wall(shape, pose, container, g.normal);
    CHECK(same.centre_a == expected.centre_a);
    CHECK(std::abs(same.angle_a - expected.angle_a) < 1e-13);
    CHECK(std::abs(same.angle_b) < 1e-12 * container.radius);
    const Complex normal = random.direction();
    const GapGradient other = push_from_wall(shape, pose, container, normal);
    CHECK(other.centre_a == -normal);
    CHECK(other.centre_b == normal);
    CHECK(std::abs(other.angle_a + other.angle_b + cross(pose.centre - container.centre, other.centre_a)) <
          1e-14 * container.radius);
  }
}

TEST_CASE("a body that starts and ends inside leaves the container on the way by no more than its rotation allows") {
  Random random{std::mt19937_64(4)};
  double most = 0.0;  // over the bound by the rotation
  int left = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const Shape shape = random.shape();
    const double longer = shape.circumradius(), shorter = shape.inradius();
    const Container container{{0.5, 0.0}, longer * random.between(1.01, 4.0)};
    const Pose start = random.pose(container);
    // Half of the motions long, half of them short, as in a step along the wall.
    Pose end = random.pose(container);
    if (trial % 2) end = {start.centre + 0.1 * longer * random.direction(), start.angle + random.between(-1.0, 1.0)};
    const double inside = std::min(gap(shape, start, container).value, gap(shape, end, container).value);
    const double turn = end.angle - start.angle;
    const double allowed = (longer * longer - shorter * shorter) / longer * turn * turn / 8.0;
    double smallest = inside;
    for (int k = 1; k < 50; ++k)
      smallest = std::min(smallest, gap(shape, interpolate(start, end, k / 50.0), container).value);
    CHECK(smallest >= inside - allowed - 1e-14 * container.radius);
    if (std::abs(turn) > 1.0) continue;
    left += smallest < inside - 1e-3 * longer;
    most = std::max(most, (inside - smallest) / allowed);
  }
  CHECK(left > 50);
  CHECK(most > 0.8);  // the bound is not loose
}
