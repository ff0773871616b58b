#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

#include "random_suspension.hpp"
#include "stiv.hpp"

using namespace stokes;

namespace {

// The bodies at the start, their trial poses, and the minimum separation.
struct Step {
  Suspension start;
  std::vector<Pose> trial;
  double separation;
};

std::vector<ContactConstraint> contacts(const Step& step, int vertices,
                                        StivGradient choice = StivGradient::full) {
  return StivCollector(step.start, step.separation, {vertices, choice}).collect(step.trial);
}

ContactConstraint sum(const std::vector<ContactConstraint>& regions) {
  ContactConstraint total{0, 1, 0, 0.0, 0.0, {}, {}};
  for (const ContactConstraint& region : regions) {
    total.value += region.value;
    total.gradient.centre_a += region.gradient.centre_a, total.gradient.centre_b += region.gradient.centre_b;
    total.gradient.angle_a += region.gradient.angle_a, total.gradient.angle_b += region.gradient.angle_b;
  }
  return total;
}

double volume(const Step& step, int vertices) { return sum(contacts(step, vertices)).value; }

using Polygon = std::vector<Complex>;

// (a cos, b sin) moved along its normal, which points along (b cos, a sin).
Polygon offset_polygon(const Shape& shape, const Pose& pose, int vertices, double separation) {
  Polygon polygon;
  for (int k = 0; k < vertices; ++k) {
    const double c = std::cos(2.0 * pi * k / vertices), s = std::sin(2.0 * pi * k / vertices);
    const Complex normal{shape.b * c, shape.a * s};
    polygon.push_back(pose.centre + pose.axis() * (Complex(shape.a * c, shape.b * s) +
                                                   0.5 * separation * normal / std::abs(normal)));
  }
  return polygon;
}

// Largest separation along an edge's normal: positive exactly when convex polygons are apart, and at most their
// distance.
double apart(const Polygon& a, const Polygon& b) {
  double largest = -1e300;
  for (const auto& [p, q] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    for (std::size_t j = 0; j < p->size(); ++j) {
      const Complex edge = (*p)[(j + 1) % p->size()] - (*p)[j];
      const Complex normal = Complex(0.0, -1.0) * edge / std::abs(edge);
      double smallest = 1e300;
      for (const Complex x : *q) smallest = std::min(smallest, dot(normal, x - (*p)[j]));
      largest = std::max(largest, smallest);
    }
  }
  return largest;
}

enum class Verdict { overlap_at_start, meet, pass_through, miss, borderline };

// Samples tau so densely that the distance cannot have dropped from the margin to zero in between. It changes by at most
// the longest paths of the vertices of both bodies, relative to the first.
Verdict judge(const Step& step, int vertices, double margin) {
  std::vector<Polygon> from, to;
  const Complex drift = step.trial[0].centre - step.start[0].pose.centre;
  double way = 0.0;
  for (int i : {0, 1}) {
    from.push_back(offset_polygon(step.start[i].shape, step.start[i].pose, vertices, step.separation));
    to.push_back(offset_polygon(step.start[i].shape, step.trial[i], vertices, step.separation));
    double longest = 0.0;
    for (int k = 0; k < vertices; ++k) longest = std::max(longest, std::abs(to[i][k] - from[i][k] - drift));
    way += longest;
  }
  if (apart(from[0], from[1]) < margin) return Verdict::overlap_at_start;
  double smallest = 1e300;
  for (double tau = 0.0;;) {
    std::vector<Polygon> now = from;
    for (int i : {0, 1})
      for (int k = 0; k < vertices; ++k) now[i][k] = (1.0 - tau) * from[i][k] + tau * to[i][k];
    const double distance = apart(now[0], now[1]);
    if (distance < 0.0) return apart(to[0], to[1]) < 0.0 ? Verdict::meet : Verdict::pass_through;
    smallest = std::min(smallest, distance);
    if (tau == 1.0) return smallest > margin ? Verdict::miss : Verdict::borderline;
    tau = std::min(1.0, tau + std::max(distance, margin) / way);
  }
}

// Contact by V against judge().
struct Tally {
  int cases = 0, met = 0, missed = 0, borderline = 0, passed = 0, wrong = 0;
  void add(const Step& step, int vertices, double margin) {
    const Verdict verdict = judge(step, vertices, margin);
    if (verdict == Verdict::overlap_at_start) return;
    const bool miss = verdict == Verdict::miss, open = verdict == Verdict::borderline;
    ++cases, met += verdict == Verdict::meet, passed += verdict == Verdict::pass_through;
    missed += miss, borderline += open, wrong += !open && (volume(step, vertices) < 0.0) == miss;
  }
};

struct Random : RandomNumbers {
  // A third of them discs, the others of aspect ratio 1 to 6.
  Shape shape() {
    const double size = between(0.5, 1.5);
    return uniform(engine) < 1.0 / 3.0 ? Shape{size, size} : Shape{size, size / between(1.0, 6.0)};
  }
  // Two bodies whose centres are up to 1.5 sums of circumradii apart, half of the steps shorter than the
  // bodies and half several times as long; rotation up to `turn`.
  Step step(double turn) {
    Body a{shape(), {{between(-1.0, 1.0), between(-1.0, 1.0)}, between(0.0, 7.0)}, {}, {}};
    Body b{shape(), {{}, between(0.0, 7.0)}, {}, {}};
    const double size = a.shape.circumradius() + b.shape.circumradius();
    b.pose.centre = a.pose.centre + size * within(0.2, 1.5);
    const double way = between(0.0, uniform(engine) < 0.5 ? 0.5 : 3.0) * size;
    const Complex target = a.pose.centre + size * within(0.0, 1.0), aim = target - b.pose.centre;
    const Complex move = way * aim / std::abs(aim), common = within(0.0, 2.0);
    return {{a, b},
            {{a.pose.centre + common, a.pose.angle + between(-turn, turn)},
             {b.pose.centre + move + common, b.pose.angle + between(-turn, turn)}},
            between(0.0, 0.2)};
  }
  // Bodies that begin close, push a little into each other and slide; always in contact.
  Step close_step(double turn) {
    for (;;) {
      Step s = step(turn);
      s.separation = 0.05;
      const Gap g = gap(s.start[0], s.start[1]);
      if (g.value < 0.05 || g.value > 0.3) continue;
      const double depth = between(0.0, 0.1), slide = between(-0.1, 0.1);
      s.trial[0].centre = s.start[0].pose.centre;
      s.trial[1].centre = s.start[1].pose.centre - (g.value - 0.05 + depth) * g.normal + slide * perp(g.normal);
      if (volume(s, 64) < 0.0) return s;
    }
  }
};

// Two unit discs, their centres `start` and then `end` apart, the first one at rest; no rotation.
Step discs(Complex start, double angle_a, double angle_b, Complex end, double separation) {
  return {{{{1.0, 1.0}, {{}, angle_a}, {}, {}}, {{1.0, 1.0}, {start, angle_b}, {}, {}}},
          {{{}, angle_a}, {end, angle_b}},
          separation};
}
Step discs(Complex end) { return discs(2.3, 0.1, 0.37, end, 0.02); }

double relative(double got, double expected) { return std::abs(got - expected) / std::abs(expected); }

// Central difference of V as body b's end moves along `way`.
double difference(Step step, Pose way, double h, int vertices) {
  const RigidVelocity velocity{way.centre, way.angle};
  const Pose end = step.trial[1];
  step.trial[1] = advance(end, velocity, h);
  const double ahead = volume(step, vertices);
  step.trial[1] = advance(end, velocity, -h);
  return (ahead - volume(step, vertices)) / (2.0 * h);
}

}  // namespace

TEST_CASE("stiv: V is negative exactly when the offset polygons meet during the step, tunnelling included") {
  Random random{std::mt19937_64(20)};
  Tally tally;
  while (tally.cases < 10000) tally.add(random.step(uniform(random.engine) < 0.5 ? 0.2 : 2.0), 32, 1e-5);
  CHECK(tally.wrong == 0);
  CHECK(tally.borderline <= 3);
  CHECK(std::min({tally.met, tally.passed, tally.missed}) > 1000);
}

TEST_CASE("stiv: vertices that meet vertices and edges that meet edges are no exception") {
  // Polygons that are mirror images of each other or half an edge away from that.
  Random random{std::mt19937_64(21)};
  Tally tally;
  for (int trial = 0; trial < 2000; ++trial) {
    const auto multiple = [&] { return pi / 16.0 * std::floor(random.between(0.0, 32.0)); };
    const double distance = random.between(2.11, 3.1), angle_a = multiple(), angle_b = multiple();
    const Complex axis = std::polar(1.0, multiple());
    const Complex end = (distance - random.between(0.0, 1.0)) * axis;
    tally.add(discs(distance * axis, angle_a, angle_b, end, 0.1), 16, 1e-7);
  }
  CHECK(tally.wrong == 0);
  CHECK(std::min(tally.met, tally.missed) > 500);
}

TEST_CASE("stiv: V and its derivative converge to the closed form of two discs head on") {
  // A point of either circle (radius r) at angle phi from the axis has cos(phi) (2 r cos(phi) - d) of its way
  // left at the end, d apart: V = -2 r Int of it = -2 r (2 r (f + sin f cos f) - 2 d sin f), cos f = d / 2 r.
  const double r = 1.01, d = 1.8, f = std::acos(0.5 * d / r);
  const double exact = -2.0 * r * (2.0 * r * (f + std::sin(f) * std::cos(f)) - 2.0 * d * std::sin(f));
  const double slope = 4.0 * r * std::sin(f);
  double previous = 2e-2;
  for (int vertices : {256, 1024, 4096}) {
    const ContactConstraint total = sum(contacts(discs(d), vertices));
    CHECK(relative(total.value, exact) < previous);
    CHECK(relative(total.gradient.centre_b.real(), slope) < 8.0 / vertices);
    previous = relative(total.value, exact) / 4.0;
  }
}

TEST_CASE("stiv: without rotation `full` is the derivative of V, and `frozen` is several times smaller") {
  // About 30 % of the way is left after a head-on or oblique hit, almost none in a shallow contact.
  using Row = std::tuple<Complex, double, double>;
  for (const auto& [end, low, high] :
       {Row{1.8, 0.25, 0.35}, Row{{1.8, 0.3}, 0.25, 0.35}, Row{2.01, 0.0, 0.05}}) {
    const Step step = discs(end);
    const Complex n = end / std::abs(end);
    const double exact = difference(step, {n, 0.0}, 1e-6, 128);
    CHECK(relative(dot(sum(contacts(step, 128)).gradient.centre_b, n), exact) < 1e-7);
    const double part = dot(sum(contacts(step, 128, StivGradient::frozen)).gradient.centre_b, n) / exact;
    CHECK(part > low);
    CHECK(part < high);
  }
}

TEST_CASE("stiv: with rotation and sliding `full` is the derivative along the normal to a few percent") {
  Random random{std::mt19937_64(23)};
  std::vector<double> full, turning, frozen;
  for (int trial = 0; trial < 300; ++trial) {
    const Step step = random.close_step(0.1);
    const GapGradient gradient = sum(contacts(step, 128)).gradient;
    const double size = std::abs(gradient.centre_b);
    const Complex n = gradient.centre_b / size;
    const double exact = difference(step, {n, 0.0}, 1e-4, 128);
    full.push_back(relative(size, exact));
    frozen.push_back(dot(sum(contacts(step, 128, StivGradient::frozen)).gradient.centre_b, n) / exact);
    turning.push_back(std::abs(gradient.angle_b - difference(step, {0.0, 1.0}, 1e-4, 128)) / size);
  }
  for (auto* values : {&full, &turning, &frozen}) std::sort(values->begin(), values->end());
  CHECK(std::max(full[150], turning[150]) < 0.02);  // half of the cases; arms are 0.1 to 1.5
  CHECK(std::max(full[240], turning[240]) < 0.06);  // 80 % of them
  CHECK(frozen[150] < 0.4);
}

TEST_CASE("stiv: the two forces of a region are opposite, also when one of the bodies is at rest") {
  Random random{std::mt19937_64(24)};
  for (const StivGradient choice : {StivGradient::full, StivGradient::frozen}) {
    double unbalanced = 0.0, torque = 0.0;
    for (int trial = 0; trial < 200; ++trial) {
      Step step = random.close_step(0.2);
      if (const int at_rest = trial % 3; at_rest < 2) {
        const Complex back = step.start[at_rest].pose.centre - step.trial[at_rest].centre;
        for (Pose& pose : step.trial) pose.centre += back;
        step.trial[at_rest].angle = step.start[at_rest].pose.angle;
      }
      const Complex arm = step.trial[1].centre - step.trial[0].centre;
      for (const auto& [a, b, region, value, tolerance, gradient, force] : contacts(step, 64, choice)) {
        const double size = std::abs(force.centre_a);
        CHECK(size > 0.0);
        CHECK(force.centre_a == gradient.centre_a);
        CHECK(force.angle_b == gradient.angle_b);
        unbalanced = std::max(unbalanced, std::abs(force.centre_a + force.centre_b) / size);
        torque = std::max(torque, std::abs(force.angle_a + force.angle_b + cross(arm, force.centre_b)) / size);
      }
    }
    CHECK(unbalanced < 1e-12);
    CHECK(torque < 0.5);  // up to |P - Q| at the end; arms are 0.1 to 1.5
  }
}

TEST_CASE("stiv: mirror-symmetric discs repel exactly along the line of their centres") {
  // Vertex meets vertex, on the way or inside from the start: the normal could be that of either adjacent edge.
  for (int k = 0; k < 32; ++k) {
    const Complex axis = std::polar(1.0, k * pi / 16.0);
    for (const auto& [start, end] : {std::pair(2.3, 2.02 - 1e-9), std::pair(2.3, 1.9), std::pair(2.01, 2.0)}) {
      const auto regions = contacts(discs(start * axis, 0.0, 0.0, end * axis, 0.02), 32);
      REQUIRE(regions.size() == 1);
      const double force = dot(regions[0].force.centre_b, axis);
      CHECK(force > 0.0);
      CHECK(std::abs(cross(regions[0].force.centre_b, axis)) < 1e-12 * force);
      CHECK(std::abs(regions[0].force.angle_a) < 1e-12 * force);
    }
  }
}

TEST_CASE("stiv: vertices inside at the start are held to the nearest edge and may leave through it") {
  // Offset polygons that overlap by 0.01 at the start. They may part; they must not stay or go deeper.
  const auto moved_to = [](double end) { return discs(2.09, 0.0, 0.0, end, 0.1); };
  CHECK(volume(moved_to(2.11), 128) == 0.0);
  const double resting = volume(moved_to(2.09), 128);
  CHECK(resting < -1e-4);
  CHECK(volume(moved_to(2.08), 128) < resting);
  CHECK(volume(moved_to(-2.5), 128) < 10.0 * resting);  // out on the other side
  // Hits at tau = 0: there is no difference between the gradients.
  const Complex full = sum(contacts(moved_to(2.09), 128)).gradient.centre_b;
  CHECK(full == sum(contacts(moved_to(2.09), 128, StivGradient::frozen)).gradient.centre_b);
  CHECK(full.real() > 0.0);
}

TEST_CASE("stiv: the first entry of a vertex counts, and that it touched or left an edge does not hide one") {
  // The vertex that meets the square [-1, 1]^2 as it turns about a pivot.
  const auto hit = [](Complex from, Complex to, double turn, double pivot) {
    MovingPolygon square{{{1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}, {-1.0, -1.0}}, {}};
    for (const Complex p : square.start) square.end.push_back(pivot + std::polar(1.0, turn) * (p - pivot));
    const auto hits = vertex_hits({{from, {3.0, 0.1}, {3.0, 0.2}}, {to, {3.0, 0.1}, {3.0, 0.2}}}, square);
    REQUIRE((hits.size() == 1 && hits[0].vertex == 0));
    return hits[0];
  };
  for (const double x : {1.0, 1.0 - 1e-13, 1.0 + 1e-13, 0.99}) {
    CHECK(std::abs(hit(x, 0.9, 0.0, 0.0).interval - (0.9 - 1.0)) < 1e-9);
    CHECK(hit(x, 1.05, 0.5, 0.0).tau > 0.1);  // the side turns to x = 0.92 at this height
  }
  // Both turn about (-2, 0), against each other: seen from the square the vertex moves on a circle, in
  // through the top at x = 0.94, out at the right, and in again there at the end.
  CHECK(hit(-2.025 + std::polar(3.125, 0.36), -2.025 + std::polar(3.125, 0.035), 0.325, -2.025).tau < 0.2);
}

TEST_CASE("stiv: bodies without contact keep the separation up to the bulge of their curves") {
  Random random{std::mt19937_64(25)};
  double most = 0.0;  // of the allowed loss
  for (int trial = 0; trial < 300; ++trial) {
    Step step = random.close_step(0.0);
    const Body &a = step.start[0], &b = step.start[1];
    // Retreat along the normal until the polygons just part.
    const Complex n = gap(a, b).normal, inside = step.trial[1].centre;
    double low = 0.0, high = 0.3;
    for (int k = 0; k < 30; ++k) {
      step.trial[1].centre = inside + 0.5 * (low + high) * n;
      (volume(step, 32) < 0.0 ? low : high) = 0.5 * (low + high);
    }
    step.trial[1].centre = inside + high * n;
    const auto bulge = [&](double r, double r_min) {
      return 0.5 * std::pow(pi / 32.0, 2) * r * (1.0 + 0.5 * r * step.separation / (r_min * r_min));
    };
    const double loss = step.separation - gap(a.shape, step.trial[0], b.shape, step.trial[1]).value;
    most = std::max(most, loss / (bulge(a.shape.circumradius(), a.shape.inradius()) +
                                  bulge(b.shape.circumradius(), b.shape.inradius())));
  }
  CHECK(most < 1.02);
  CHECK(most > 0.2);
}

TEST_CASE("stiv: a pair that meets in two places has two regions, numbered alike for any number of vertices") {
  // A short ellipse sweeps past a long one that turns the other way: first one tip, then a side.
  const Step step{{{{0.6, 0.26}, {{0.99, 0.65}, 2.29}, {}, {}}, {{1.06, 0.21}, {{-0.74, 1.67}, 5.54}, {}, {}}},
                  {{{-1.85, 1.32}, 3.58}, {{-0.75, 1.68}, 6.67}},
                  0.06};
  REQUIRE(judge(step, 32, 1e-6) != Verdict::overlap_at_start);
  const auto fine = contacts(step, 256);
  for (int vertices : {32, 64, 128}) {
    const auto regions = contacts(step, vertices);
    REQUIRE(regions.size() == 2);
    for (int i : {0, 1}) {
      CHECK(regions[i].region == i);
      CHECK(relative(regions[i].value, fine[i].value) < 0.05);
      CHECK(regions[i].force.centre_a == -regions[i].force.centre_b);
    }
  }
}

TEST_CASE("stiv: V ignores common translations, turns with the axes, scales with area, swaps with the bodies") {
  Random random{std::mt19937_64(26)};
  const Complex turn = std::polar(1.0, 0.7);
  for (int trial = 0; trial < 100; ++trial) {
    const Step step = random.close_step(0.2);
    Step drifting = step, turned = step, scaled = step;
    const Step swapped{{step.start[1], step.start[0]}, {step.trial[1], step.trial[0]}, step.separation};
    scaled.separation *= 8.0;
    for (int i : {0, 1}) {
      drifting.trial[i].centre += Complex(40.0, -70.0);
      for (Pose* pose : {&turned.start[i].pose, &turned.trial[i]})
        *pose = {turn * pose->centre, pose->angle + 0.7};
      for (Pose* pose : {&scaled.start[i].pose, &scaled.trial[i]}) pose->centre *= 8.0;
      scaled.start[i].shape = {8.0 * step.start[i].shape.a, 8.0 * step.start[i].shape.b};
    }
    const ContactConstraint one = sum(contacts(step, 64));
    const auto differs = [&](const Step& other, Complex factor, bool swap) {
      const auto [a, b, region, value, tolerance, gradient, force] = sum(contacts(other, 64));
      const double area = std::norm(factor);
      return std::abs(value / area - one.value) +
             std::abs((swap ? gradient.centre_b : gradient.centre_a) / factor - one.gradient.centre_a) +
             std::abs((swap ? gradient.angle_b : gradient.angle_a) / area - one.gradient.angle_a);
    };
    CHECK(differs(drifting, 1.0, false) < 1e-11);
    CHECK(differs(turned, turn, false) < 1e-11);
    CHECK(differs(scaled, 8.0, false) < 1e-11);
    CHECK(differs(swapped, 1.0, true) < 1e-11);
    CHECK(contacts(scaled, 64)[0].tolerance == 64.0 * contacts(step, 64)[0].tolerance);
  }
}

TEST_CASE("stiv: V is met to one vertex 1e-4 of the separation deep, without a separation to 1e-12") {
  Step step = discs(1.8);
  const double edge = 2.0 * (1.0 + 0.5 * step.separation) * std::sin(pi / 64.0);
  CHECK(relative(contacts(step, 64)[0].tolerance, 1e-4 * step.separation * edge) < 1e-12);
  step.separation = 0.0;
  CHECK(contacts(step, 64)[0].tolerance == 1e-12);
}

TEST_CASE("stiv: too few vertices, a negative separation and a trial of another size are refused") {
  const Step step = discs(1.8);
  CHECK_THROWS_AS(StivCollector(step.start, 0.02, {7}), InputError);
  CHECK_THROWS_AS(StivCollector(step.start, -0.02, {32}), InputError);
  CHECK_THROWS_AS(StivCollector(step.start, std::nan(""), {32}), InputError);
  CHECK_THROWS_AS(StivCollector(step.start, 0.02, {32}).collect({step.trial[0]}), InputError);
}
