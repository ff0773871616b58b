#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "gap.hpp"

using namespace stokes;

namespace {

struct Random {
  std::mt19937_64 engine;
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine() >> 11) * 0x1p-53);
  }
  Complex direction() { return std::polar(1.0, uniform(0.0, 2.0 * pi)); }
  // Either semi-axis may be the longer one.
  Shape shape(double aspect_ratio) {
    const double size = std::exp(uniform(-1.0, 1.0));
    const Shape shape{size, size * std::exp(uniform(-std::log(aspect_ratio), 0.0))};
    return engine() % 2 ? shape : Shape{shape.b, shape.a};
  }
  Complex within(double radius) {
    const double distance = uniform(0.0, radius);
    return distance * direction();
  }
  Pose pose(Complex centre, double radius) { return {centre + within(radius), uniform(-10.0, 10.0)}; }
  // Two bodies with centres up to `spread` times the sum of their circumradii apart.
  std::pair<Body, Body> pair(double aspect_ratio, double spread) {
    const Shape a = shape(aspect_ratio), b = shape(aspect_ratio);
    const Pose at = pose({}, 2.0);
    return {Body{a, at}, Body{b, pose(at.centre, spread * (a.circumradius() + b.circumradius()))}};
  }
};

// |c_B - c_A| plus the circumradii, the unit of round-off.
double size_of(const Body& a, const Body& b) {
  return std::abs(b.pose.centre - a.pose.centre) + a.shape.circumradius() + b.shape.circumradius();
}

double height(const Body& body, Complex n) {
  const Complex m = n * std::conj(body.pose.axis());
  return std::hypot(body.shape.a * m.real(), body.shape.b * m.imag());
}

double separation_along(const Body& a, const Body& b, Complex n) {
  return dot(n, b.pose.centre - a.pose.centre) - height(a, n) - height(b, -n);
}

// First-order distance of a point from the body's boundary.
double distance_from_boundary(const Body& body, Complex point) {
  const Complex p = (point - body.pose.centre) * std::conj(body.pose.axis());
  const Complex scaled{p.real() / body.shape.a, p.imag() / body.shape.b};
  return std::abs(std::abs(scaled) - 1.0) * std::abs(scaled) /
         std::hypot(scaled.real() / body.shape.a, scaled.imag() / body.shape.b);
}

std::vector<Complex> boundary(const Body& body, int points) {
  std::vector<Complex> nodes(points);
  for (int k = 0; k < points; ++k) {
    const double alpha = 2.0 * pi * k / points;
    nodes[k] = body.pose.centre +
               body.pose.axis() * Complex{body.shape.a * std::cos(alpha), body.shape.b * std::sin(alpha)};
  }
  return nodes;
}

// The largest excess over the gap of the separation along `count` directions, half of them crowded around
// the normals of the flat sides, in units of the size.
double largest_excess(const Body& a, const Body& b, double value, int count) {
  double excess = -1.0;
  for (const Body* body : {&a, &b}) {
    for (int k = 0; k < count / 4; ++k) {
      const double alpha = 8.0 * pi * k / count;
      const Complex normal = Complex{body->shape.b * std::cos(alpha), body->shape.a * std::sin(alpha)};
      for (const Complex n : {normal / std::abs(normal), std::polar(1.0, alpha)}) {
        excess = std::max(excess, separation_along(a, b, n * body->pose.axis()) - value);
      }
    }
  }
  return excess / size_of(a, b);
}

}  // namespace

TEST_CASE("an ellipse's support point is on its boundary and the farthest one in its direction") {
  Random random{std::mt19937_64(1)};
  for (int trial = 0; trial < 200; ++trial) {
    const Body body{random.shape(20.0), {}};
    const Complex n = random.direction();
    const Support support = body.shape.support(n);
    CHECK(distance_from_boundary(body, support.point) < 1e-15 * body.shape.circumradius());
    CHECK(std::abs(dot(n, support.point) - support.height) < 1e-15 * body.shape.circumradius());
    for (const Complex p : boundary(body, 100)) CHECK(dot(n, p) < support.height * (1.0 + 1e-15));
    // The support point moves along the tangent by the radius of curvature per radian.
    const Complex forth = body.shape.support(n * std::polar(1.0, 1e-6)).point;
    const Complex back = body.shape.support(n * std::polar(1.0, -1e-6)).point;
    CHECK(std::abs((forth - back) / 2e-6 - support.curvature_radius * perp(n)) <
          1e-7 * support.curvature_radius + 1e-9 * body.shape.circumradius());
  }
}

TEST_CASE("the gap of discs is the distance of the centres less the radii") {
  Random random{std::mt19937_64(2)};
  for (int trial = 0; trial < 200; ++trial) {
    const double ra = random.uniform(0.1, 2.0), rb = random.uniform(0.1, 2.0), r = random.uniform(0.0, 6.0);
    const Complex n = random.direction();
    const Body a{{ra, ra}, random.pose({}, 3.0)}, b{{rb, rb}, {a.pose.centre + r * n, 1.0}};
    const Gap g = gap(a, b);
    CHECK(std::abs(g.value - (r - ra - rb)) < 5e-15);
    CHECK(std::abs(g.normal - n) * r < 2e-15);
    CHECK(std::abs(g.point_a - (a.pose.centre + ra * n)) * r < 1e-14);
    CHECK(std::abs(g.point_b - (b.pose.centre - rb * n)) * r < 1e-14);
  }
}

TEST_CASE("coincident bodies have a unit normal and the sum of their inradii as penetration") {
  const Pose pose{{0.3, -7.0}, 0.4};
  for (const Shape shape_a : {Shape{2.0, 2.0}, Shape{2.0, 0.1}, Shape{1.0, 1.5}}) {
    for (const Shape shape_b : {Shape{1.0, 1.0}, shape_a}) {
      const Gap g = gap({shape_a, pose}, {shape_b, pose});
      CAPTURE(shape_a.b);
      CHECK(std::abs(g.value + shape_a.inradius() + shape_b.inradius()) < 1e-14);
      CHECK(std::abs(std::abs(g.normal) - 1.0) < 1e-15);
      CHECK(std::abs(g.point_b - g.point_a - g.value * g.normal) < 1e-14);
    }
  }
  const Shape disc{1.0, 1.0};
  CHECK(std::abs(gap(disc, {}, disc, {{1e-310, 0.0}, 0.0}).normal - 1.0) < 1e-15);
}

TEST_CASE("a disc inside an ellipse is as deep as the interior distance says, across the evolute") {
  const Shape ellipse{3.0, 1.0};
  const double cusp = 8.0 / 3.0;  // of the evolute, (a^2 - b^2) / a
  for (const double x : {0.0, 0.5, 1.7, 2.6, cusp - 1e-6, cusp, cusp + 1e-6, 2.8, 2.999}) {
    const double interior = x < cusp ? std::sqrt(1.0 - x * x / 8.0) : 3.0 - x;
    const Gap g = gap({ellipse, {}}, {Shape{0.2, 0.2}, {{x, 0.0}, 0.7}});
    CAPTURE(x);
    CHECK(std::abs(g.value + interior + 0.2) < 5e-15);
  }
}

TEST_CASE("contact points are on the boundaries, the gap apart along the normal") {
  Random random{std::mt19937_64(3)};
  for (const double aspect_ratio : {4.0, 20.0, 1000.0}) {
    for (int trial = 0; trial < 1000; ++trial) {
      const auto [a, b] = random.pair(aspect_ratio, 1.5);
      const Gap g = gap(a, b);
      const double scale = size_of(a, b) + std::abs(a.pose.centre);
      CHECK(std::abs(std::abs(g.normal) - 1.0) < 5e-16);
      CHECK(std::abs(g.point_b - g.point_a - g.value * g.normal) < 1e-15 * scale);
      CHECK(distance_from_boundary(a, g.point_a) < 2e-15 * scale);
      CHECK(distance_from_boundary(b, g.point_b) < 2e-15 * scale);
      CHECK(std::abs(separation_along(a, b, g.normal) - g.value) < 1e-15 * scale);
    }
  }
}

TEST_CASE("no direction separates two bodies more than the normal, for any overlap and aspect ratio") {
  Random random{std::mt19937_64(4)};
  for (const double aspect_ratio : {1.001, 4.0, 20.0, 1000.0}) {
    for (const double spread : {1.5, 0.3, 1e-3, 1e-9}) {
      for (int trial = 0; trial < 100; ++trial) {
        auto [a, b] = random.pair(aspect_ratio, spread);
        if (trial % 4 == 0) b.shape = a.shape;
        if (trial % 5 == 0) b.pose.angle = a.pose.angle;
        if (trial % 6 == 0) b.shape.a = b.shape.b;
        INFO("aspect ratio ", aspect_ratio, ", spread ", spread);
        CHECK(largest_excess(a, b, gap(a, b).value, 2000) < 1e-15);
      }
    }
  }
  // Plain Newton iteration for the normal ends in a cycle of two here.
  const Body a{{1.0, 0.053452984}, {{-0.489538168, 0.133103629}, 2.05326252}};
  const Body b{{1.119693279, 6.814768607}, {{-7.765462025, -7.743960152}, 5.715630026}};
  CHECK(largest_excess(a, b, gap(a, b).value, 2000) < 1e-15);
}

TEST_CASE("the gap of separated ellipses is the distance of their densely sampled boundaries") {
  Random random{std::mt19937_64(5)};
  constexpr int points = 1000;
  int separated = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const auto [a, b] = random.pair(10.0, 1.5);
    const double value = gap(a, b).value;
    if (value <= 0.0) continue;
    ++separated;
    double distance = 1e300;
    const std::vector<Complex> nodes_a = boundary(a, points), nodes_b = boundary(b, points);
    for (const Complex p : nodes_a) {
      for (const Complex q : nodes_b) distance = std::min(distance, std::abs(q - p));
    }
    // A closest point is at most half a node's spacing h off along the boundary, radius of curvature R.
    double bound = 0.0, tangential = 0.0;
    for (const Shape& shape : {a.shape, b.shape}) {
      const double h = shape.circumradius() * pi / points;
      bound += 0.5 * h * h * shape.circumradius() / (shape.inradius() * shape.inradius());
      tangential += h;
    }
    CHECK(distance > value - 1e-14);
    CHECK(distance < std::hypot(value + bound, tangential));
  }
  CHECK(separated > 10);
}

TEST_CASE("the gap's gradient is that of finite differences for separated and overlapping ellipses") {
  Random random{std::mt19937_64(6)};
  int separated = 0, overlapping = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const std::pair<Body, Body> bodies = random.pair(5.0, 1.2);
    const Body &a = bodies.first, &b = bodies.second;
    const Gap g = gap(a, b);
    const GapGradient analytic = gradient(g, a.pose, b.pose);
    double worst = 0.0;
    bool kink = false;  // two directions tie in between: no derivative
    const auto compare = [&](const Pose& da, const Pose& db, double derivative) {
      const auto moved = [&](double s) {
        return gap(a.shape, {a.pose.centre + s * da.centre, a.pose.angle + s * da.angle}, b.shape,
                   {b.pose.centre + s * db.centre, b.pose.angle + s * db.angle});
      };
      const Gap forth = moved(1e-5), back = moved(-1e-5);
      kink = kink || std::abs(forth.normal - back.normal) > 1e-2;
      worst = std::max(worst, std::abs((forth.value - back.value) / 2e-5 - derivative));
    };
    compare({1.0, 0.0}, {}, analytic.centre_a.real());
    compare({imaginary_unit, 0.0}, {}, analytic.centre_a.imag());
    compare({0.0, 1.0}, {}, analytic.angle_a);
    compare({}, {1.0, 0.0}, analytic.centre_b.real());
    compare({}, {imaginary_unit, 0.0}, analytic.centre_b.imag());
    compare({}, {0.0, 1.0}, analytic.angle_b);
    if (kink) continue;
    ++(g.value > 0.0 ? separated : overlapping);
    // Rounding 1e-15 / 1e-5, truncation 1e-10 times a third derivative of at most a few hundred.
    CHECK(worst < 5e-8);
  }
  CHECK(std::min(separated, overlapping) > 100);
}

TEST_CASE("contact forces of a pair have no net force and no net torque") {
  Random random{std::mt19937_64(7)};
  for (int trial = 0; trial < 2000; ++trial) {
    const auto [a, b] = random.pair(20.0, 1.2);
    const GapGradient f = gradient(gap(a, b), a.pose, b.pose);
    const double torque = f.angle_a + f.angle_b + cross(a.pose.centre, f.centre_a) +
                          cross(b.pose.centre, f.centre_b);
    CHECK(f.centre_a + f.centre_b == Complex{});
    CHECK(std::abs(torque) < 1e-15 * (size_of(a, b) + std::abs(a.pose.centre)));
  }
}

TEST_CASE("a rigid motion of both bodies leaves their gap and turns its normal") {
  Random random{std::mt19937_64(8)};
  for (int trial = 0; trial < 1000; ++trial) {
    const auto [a, b] = random.pair(20.0, 1.2);
    const Complex shift = random.within(5.0);
    const double angle = random.uniform(-4.0, 4.0);
    const auto moved = [&](const Body& body) {
      return Body{body.shape, {std::polar(1.0, angle) * body.pose.centre + shift, body.pose.angle + angle}};
    };
    const Gap g = gap(a, b), h = gap(moved(a), moved(b));
    CHECK(std::abs(h.value - g.value) < 1e-14 * size_of(a, b));
    // Overlapping bodies may have two equally good directions.
    if (g.value > 0.0) CHECK(std::abs(h.normal - g.normal * std::polar(1.0, angle)) < 1e-12);
  }
}

TEST_CASE("swapping the bodies reverses the normal and leaves the gap") {
  Random random{std::mt19937_64(9)};
  for (int trial = 0; trial < 1000; ++trial) {
    const auto [a, b] = random.pair(20.0, 1.2);
    const Gap g = gap(a, b), h = gap(b, a);
    CHECK(std::abs(h.value - g.value) < 2e-15 * size_of(a, b));
    if (g.value > 0.0) CHECK(std::abs(h.normal + g.normal) < 1e-12);
  }
}

TEST_CASE("bodies far apart have the gap of their support towards each other") {
  for (const double distance : {1e3, 1e9, 1e15}) {
    const Body a{{1.0, 20.0}, {{0.0, 0.0}, 0.5 * pi}}, b{{4.0, 2.0}, {{distance, 0.0}, 0.0}};
    CHECK(std::abs(gap(a, b).value - (distance - 24.0)) < 3e-16 * distance);
  }
}

TEST_CASE("poses that are not numbers give a gap that is not a number, without a search for ever") {
  const Body a{{1.0, 2.0}, {{0.0, 0.0}, std::nan("")}}, b{{1.0, 2.0}, {{std::nan(""), 0.0}, 0.0}};
  CHECK(std::isnan(gap(a, a).value));
  CHECK(std::isnan(gap(b, a).value));
}

TEST_CASE("the first hit of 10 000 motions is where and only where densely sampled gaps say") {
  Random random{std::mt19937_64(10)};
  int hits = 0, passes = 0, misses = 0;
  for (int trial = 0; trial < 10000; ++trial) {
    const double thresholds[] = {0.0, 1e-9, 1e-3, 0.1}, turns[] = {0.0, 0.2, 6.0};
    const double threshold = thresholds[trial % 4], turn = turns[trial % 3];
    const std::pair<Body, Body> bodies = random.pair(trial % 5 == 0 ? 1.0 : 20.0, 1.5);
    const Body &a = bodies.first, &b = bodies.second;
    const double tolerance =
        std::max(1e-3 * threshold, 1e-12 * (a.shape.circumradius() + b.shape.circumradius()));
    const auto moved = [&](const Pose& pose) {
      return Pose{pose.centre + random.within(3.0), pose.angle + random.uniform(-turn, turn)};
    };
    const Pose a_end = moved(a.pose), b_end = moved(b.pose);
    const auto gap_at = [&](double tau) {
      return gap(a.shape, interpolate(a.pose, a_end, tau), b.shape, interpolate(b.pose, b_end, tau)).value;
    };
    if (gap_at(0.0) <= threshold + tolerance) continue;
    const auto hit = first_hit(a.shape, a.pose, a_end, b.shape, b.pose, b_end, threshold);
    double least = 1e300;  // up to the hit or the end
    const double last = hit ? hit->tau : 1.0;
    for (int k = 0; k < 100; ++k) least = std::min(least, gap_at(last * k / 99.0));
    CHECK(least > threshold - 1e-14);
    if (hit) {
      CHECK(hit->gap.value == gap_at(hit->tau));
      CHECK(hit->gap.value <= threshold + tolerance);
    }
    ++(hit ? hits : misses);
    passes += hit && gap_at(1.0) > threshold;
  }
  CHECK(std::min(misses, hits) > 1000);
  CHECK(passes > 500);
}

TEST_CASE("discs hit at the time of their closed form, and pass at a distance above the threshold") {
  const Shape disc{1.0, 1.0};
  for (const double threshold : {0.0, 1e-9, 1e-2}) {
    const double below = 2.0 + 0.99 * threshold - 1e-11, above = 2.0 + 1.002 * threshold + 1e-11;
    for (const double miss : {0.0, 0.3, 1.99, below, above}) {
      const auto hit = first_hit(disc, {}, {{0.0, 0.0}, 3.0}, disc, {{-50.0, miss}, 0.0},
                                 {{50.0, miss}, -9.0}, threshold);
      const double contact = 2.0 + threshold;
      CAPTURE(miss);
      REQUIRE(hit.has_value() == (miss < contact));
      if (!hit) continue;
      const auto tau = [&](double d) { return 0.5 - std::sqrt(d * d - miss * miss) / 100.0; };
      CHECK(hit->tau < tau(contact) + 1e-13);
      CHECK(hit->tau > tau(contact + std::max(1e-3 * threshold, 2e-12)) - 1e-13);
    }
  }
}

TEST_CASE("a pair that starts below the threshold is a hit only if it goes deeper") {
  const Shape a{3.0, 1.0}, b{2.0, 0.5};
  const auto hit = [&](double start, const Pose& end) {  // b above a, moving to `end` from that gap
    return first_hit(a, {}, {}, b, {{0.0, 1.5 + start}, 0.0}, end, 0.1);
  };
  for (const double start : {-0.02, 0.0, 0.09, 0.1, 0.10005}) {
    CAPTURE(start);
    CHECK_FALSE(hit(start, {{0.0, 1.5 + start}, 0.0}));  // at rest
    CHECK_FALSE(hit(start, {{0.5, 4.0}, 0.3}));           // apart
    for (const double depth : {1.0, 5.0}) {               // into and through the other body
      const auto deeper = hit(start, {{0.0, 1.5 - depth}, 0.0});
      REQUIRE(deeper);
      CHECK(deeper->tau == 0.0);
    }
    // The initial rate is zero, but half a turn takes the long axis through the other body.
    const auto turning = hit(start, {{0.0, 1.5 + start}, pi});
    REQUIRE(turning);
    CHECK(turning->tau > 0.0);
    CHECK(turning->gap.value < start - 1e-4);
    CHECK(turning->gap.value > start - 2.001e-4);
  }
  // Rises by 0.002 above its start, and 0.0015 above the threshold, before its longer axis comes round.
  const Shape disc{100.0, 100.0}, slow{1.0, 0.9};
  const auto back = first_hit(disc, {}, {}, slow, {{0.0, 100.9095}, 0.0}, {{0.0, 100.9195}, 0.33}, 0.01);
  REQUIRE(back);
  CHECK(back->gap.value >= 0.01);
  CHECK(back->gap.value <= 1.001 * 0.01);
}

TEST_CASE("the plane of a hit shows the end of a pass-through as violated, with its exact gradient") {
  const Shape a{3.0, 1.0}, b{1.0, 2.0};
  const Pose a_start{{0.0, 0.0}, 0.3}, a_end{{1.0, 0.2}, 0.5};
  const Pose b_start{{0.5, 6.0}, 1.0}, b_end{{0.0, -6.0}, 1.4};
  const auto hit = first_hit(a, a_start, a_end, b, b_start, b_end, 0.01);
  REQUIRE(hit);
  CHECK(gap(a, a_end, b, b_end).value > 0.01);
  const Pose at[] = {interpolate(a_start, a_end, hit->tau), interpolate(b_start, b_end, hit->tau)};
  const SeparatingPlane plane = separating_plane(hit->gap, at[0], at[1]);
  CHECK(std::abs(separation(plane, at[0], at[1]) - hit->gap.value) < 1e-14);
  CHECK(separation(plane, a_end, b_end) < -1.0);
  const GapGradient g = gradient(plane, a_end, b_end);
  const auto difference = [&](const Pose& da, const Pose& db) {
    const auto value = [&](double s) {
      return separation(plane, {a_end.centre + s * da.centre, a_end.angle + s * da.angle},
                        {b_end.centre + s * db.centre, b_end.angle + s * db.angle});
    };
    return (value(1e-5) - value(-1e-5)) / 2e-5;
  };
  const Complex direction = std::polar(1.0, 0.7);
  CHECK(std::abs(difference({direction, 0.0}, {}) - dot(g.centre_a, direction)) < 1e-9);
  CHECK(std::abs(difference({}, {direction, 0.0}) - dot(g.centre_b, direction)) < 1e-9);
  CHECK(std::abs(difference({{}, 1.0}, {}) - g.angle_a) < 1e-9);
  CHECK(std::abs(difference({}, {{}, 1.0}) - g.angle_b) < 1e-9);
}
