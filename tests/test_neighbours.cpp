#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <random>
#include <utility>
#include <vector>

#include "container_gap.hpp"
#include "gap.hpp"
#include "neighbours.hpp"

using namespace stokes;

namespace {

struct Random {
  std::mt19937_64 engine;
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine() >> 11) * 0x1p-53);
  }
  Complex point(double extent) { return {uniform(-extent, extent), uniform(-extent, extent)}; }
};

struct Circles {
  std::vector<Complex> start, end;
  std::vector<double> radius;
};

double closest_approach(const Circles& circles, int i, int j) {
  const Complex first = circles.start[j] - circles.start[i], last = circles.end[j] - circles.end[i];
  const Complex way = last - first;
  double distance = std::min(std::abs(first), std::abs(last));
  if (dot(first, way) < 0.0 && dot(last, way) > 0.0) {
    distance = std::min(distance, std::abs(cross(first, way)) / std::abs(way));
  }
  return distance - circles.radius[i] - circles.radius[j];
}

using Pairs = std::vector<std::pair<int, int>>;

Pairs brute_force(const Circles& circles, double distance) {
  Pairs pairs;
  const int count = static_cast<int>(circles.start.size());
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      if (closest_approach(circles, i, j) <= distance) pairs.emplace_back(i, j);
    }
  }
  return pairs;
}

Pairs neighbours(const Circles& circles, double distance) {
  return neighbour_pairs(circles.start, circles.end, circles.radius, distance);
}

// Circles in a square of half-width `extent`, of radii 1 to `spread` times 0.1, moving by up to `way`.
Circles random_circles(Random& random, int count, double extent, double spread, double way) {
  Circles circles;
  for (int i = 0; i < count; ++i) {
    circles.start.push_back(random.point(extent));
    circles.end.push_back(circles.start.back() + random.point(way));
    circles.radius.push_back(0.1 * std::exp(random.uniform(0.0, std::log(spread))));
  }
  return circles;
}

}  // namespace

TEST_CASE("neighbour pairs are those of brute force in thousands of random configurations") {
  Random random{std::mt19937_64(1)};
  std::size_t pairs = 0;
  for (const double extent : {0.5, 5.0, 1000.0}) {
    for (const double spread : {1.0, 3.0, 1000.0}) {
      for (const double way : {0.0, 0.1, 10.0}) {
        for (int trial = 0; trial < 80; ++trial) {
          const int count = static_cast<int>(random.uniform(0.0, 60.0));
          const Circles circles = random_circles(random, count, extent, spread, way);
          const double distance = random.uniform(0.0, 1.0) * (trial % 2);
          const Pairs expected = brute_force(circles, distance);
          CAPTURE(extent);
          CAPTURE(spread);
          CAPTURE(way);
          CHECK(neighbours(circles, distance) == expected);
          pairs += expected.size();
        }
      }
    }
  }
  CHECK(pairs > 100000);
}

TEST_CASE("neighbour pairs are found in clusters a billion apart, and across such distances") {
  Random random{std::mt19937_64(2)};
  for (int trial = 0; trial < 200; ++trial) {
    Circles circles = random_circles(random, 60, 2.0, 3.0, trial % 2 ? 0.5 : 1e9);
    for (int i = 0; i < 60; ++i) {
      const Complex offset = 1e9 * Complex(i % 3, i % 2);
      circles.start[i] += offset;
      circles.end[i] += offset;
    }
    if (trial % 3 == 0) circles.radius[7] = 1e9;
    CHECK(neighbours(circles, 0.1) == brute_force(circles, 0.1));
    CHECK(neighbours(circles, 1.5e9) == brute_force(circles, 1.5e9));
  }
  const std::vector<Complex> remote{{1e140, 0.0}, {-1e140, 1.0}, {-1e140, 0.0}};
  CHECK(neighbours({remote, remote, {1.0, 1.0, 1.0}}, 0.0) == Pairs{{1, 2}});
}

TEST_CASE("circles that just touch are neighbours, wherever the cells' borders are") {
  for (const double spacing : {1.0, 0.25, 4.0}) {
    Circles lattice;
    for (int k = 0; k < 100; ++k) lattice.start.push_back(spacing * Complex(k % 10 - 5, k / 10 - 5));
    lattice.end = lattice.start;
    lattice.radius.assign(100, 0.25 * spacing);
    CHECK(neighbours(lattice, 0.5 * spacing).size() == 180);
    CHECK(neighbours(lattice, 0.499999 * spacing).empty());
    CHECK(neighbours(lattice, 100.0 * spacing).size() == 4950);
  }
}

TEST_CASE("points in one place are all neighbours of each other") {
  const Circles points{std::vector<Complex>(30, {3.0, -1.0}), std::vector<Complex>(30, {3.0, -1.0}),
                       std::vector<double>(30, 0.0)};
  CHECK(neighbours(points, 0.0).size() == 435);
  CHECK(neighbours({}, 1.0).empty());
}

TEST_CASE("bodies that cross each other's path at different times are no neighbours") {
  // Both pass the origin, the second when the first has gone.
  const Circles circles{{{-1.0, 0.0}, {0.0, -9.0}}, {{9.0, 0.0}, {0.0, 1.0}}, {0.2, 0.2}};
  CHECK(neighbours(circles, 0.0).empty());
  CHECK(neighbours({{{-5.0, 0.0}, {0.0, -5.0}}, {{5.0, 0.0}, {0.0, 5.0}}, {0.2, 0.2}}, 0.0).size() == 1);
}

TEST_CASE("100 000 bodies, some of them large, are searched in less than two seconds of processor time") {
  Random random{std::mt19937_64(3)};
  Circles circles = random_circles(random, 100000, 100.0, 2.0, 0.1);
  for (int i = 0; i < 5; ++i) circles.radius[1000 * i] = 20.0;
  const std::clock_t start = std::clock();
  CHECK(neighbours(circles, 0.05).size() > 50000);
  // Measured 0.15; a test of all 5e9 pairs takes 10 or more.
  CHECK(static_cast<double>(std::clock() - start) < 2.0 * CLOCKS_PER_SEC);
}

TEST_CASE("a neighbour search refuses arrays of different length, negative lengths and lost positions") {
  const std::vector<Complex> one{{0.0, 0.0}}, two{{0.0, 0.0}, {1.0, 0.0}};
  const std::vector<Complex> lost{{0.0, 0.0}, {std::nan(""), 0.0}};
  CHECK_THROWS_AS(neighbour_pairs(two, one, {1.0, 1.0}, 0.0), InputError);
  CHECK_THROWS_AS(neighbour_pairs(two, two, {1.0}, 0.0), InputError);
  CHECK_THROWS_AS(neighbour_pairs(two, two, {1.0, -1.0}, 0.0), InputError);
  CHECK_THROWS_AS(neighbour_pairs(two, two, {1.0, 1.0}, -1.0), InputError);
  CHECK_THROWS_AS(neighbour_pairs(two, lost, {1.0, 1.0}, 0.0), NumericalError);
  const Body body{{2.0, 1.0}, {}}, spun{{2.0, 1.0}, {{1.0, 0.0}, std::nan("")}};
  CHECK_THROWS_AS(smallest_gap({body, spun}), NumericalError);
}

TEST_CASE("the smallest gap is that of all pairs, for dilute, dense and overlapping suspensions") {
  Random random{std::mt19937_64(4)};
  int overlapping = 0;
  for (const double extent : {2.0, 10.0, 1e3, 1e9}) {
    for (int trial = 0; trial < 50; ++trial) {
      Suspension suspension;
      const int count = 2 + static_cast<int>(random.uniform(0.0, 30.0));
      for (int i = 0; i < count; ++i) {
        const double a = random.uniform(0.1, 1.0), b = random.uniform(0.1, 1.0);
        suspension.push_back({{a, b}, {random.point(extent), random.uniform(0.0, 6.0)}});
      }
      ClosestPair expected;
      for (int i = 0; i < count; ++i) {
        for (int j = i + 1; j < count; ++j) {
          const double value = gap(suspension[i], suspension[j]).value;
          if (value < expected.gap) expected = {i, j, value};
        }
      }
      const ClosestPair found = smallest_gap(suspension);
      CHECK(found.gap == expected.gap);
      CHECK(found.a == expected.a);
      CHECK(found.b == expected.b);
      overlapping += found.gap < 0.0;
    }
  }
  CHECK(overlapping > 50);
  CHECK(overlapping < 150);
}

TEST_CASE("of equal smallest gaps the pair of lowest indices is reported, and none for a single body") {
  Suspension lattice;
  for (int k = 0; k < 100; ++k) lattice.push_back({{1.0, 1.0}, {4.0 * Complex(k % 10, k / 10), 0.0}});
  std::swap(lattice[1].pose, lattice[55].pose);
  const ClosestPair closest = smallest_gap(lattice);
  CHECK(closest.gap == 2.0);
  CHECK(closest.a == 0);
  CHECK(closest.b == 10);
  const ClosestPair none = smallest_gap({lattice[0]});
  CHECK(none.a == -1);
  CHECK(none.b == -1);
  CHECK(std::isinf(none.gap));
}

TEST_CASE("the smallest gap is that of brute force with fixed bodies, large ones and a container among them") {
  Random random{std::mt19937_64(5)};
  int walls = 0, obstacles = 0, none = 0;
  for (int trial = 0; trial < 600; ++trial) {
    Suspension suspension;
    const int count = static_cast<int>(random.uniform(0.0, 20.0));
    for (int i = 0; i < count; ++i) {
      const double a = random.uniform(0.1, 1.0), b = random.uniform(0.1, 1.0);
      suspension.push_back({{a, b}, {random.point(10.0), random.uniform(0.0, 6.0)}});
      if (random.uniform(0.0, 1.0) < 0.4) suspension.back().fixed = true;
      if (suspension.back().fixed && i == 0) suspension.back().shape = {5.0, 5.0};
    }
    if (trial % 3) suspension.container = Container{random.point(1.0), random.uniform(8.0, 100.0)};
    ClosestPair expected;
    for (int i = 0; i < count; ++i) {
      for (int j = i + 1; j < count; ++j) {
        if (suspension[i].fixed && suspension[j].fixed) continue;
        const double value = gap(suspension[i], suspension[j]).value;
        if (value < expected.gap) expected = {i, j, value};
      }
      if (suspension[i].fixed || !suspension.container) continue;
      const double value = gap(suspension[i], *suspension.container).value;
      if (value < expected.gap) expected = {i, container_index, value};
    }
    const ClosestPair found = smallest_gap(suspension);
    CHECK(found.gap == expected.gap);
    CHECK(found.a == expected.a);
    CHECK(found.b == expected.b);
    none += found.a < 0;
    walls += found.b == container_index;
    obstacles += found.a >= 0 && (suspension[found.a].fixed || (!suspension.container && suspension[found.b].fixed));
  }
  CHECK(walls > 20);
  CHECK(obstacles > 20);
  CHECK(none > 5);
}

TEST_CASE("candidates for contact are pairs whose circles come close, not of two obstacles, and those at the wall") {
  Random random{std::mt19937_64(6)};
  int at_wall = 0;
  for (int trial = 0; trial < 100; ++trial) {
    Suspension start;
    std::vector<Pose> end;
    Circles circles;
    for (int i = 0; i < 15; ++i) {
      start.push_back({{random.uniform(0.1, 1.0), random.uniform(0.1, 1.0)}, {random.point(4.0), 1.0}});
      start.back().fixed = i % 3 == 0;
      end.push_back(start.back().pose);
      if (i % 3) end.back().centre += random.point(1.0);
      circles.start.push_back(start.back().pose.centre), circles.end.push_back(end.back().centre);
      circles.radius.push_back(start.back().shape.circumradius());
    }
    start.container = Container{{0.5, 0.0}, 5.0};
    std::vector<std::pair<int, int>> expected;
    for (const auto& [i, j] : neighbour_pairs(circles.start, circles.end, circles.radius, 0.2))
      if (i % 3 || j % 3) expected.emplace_back(i, j);
    for (int i = 0; i < 15; ++i) {
      if (i % 3 == 0 || std::abs(end[i].centre - 0.5) + circles.radius[i] < 4.8) continue;
      expected.emplace_back(i, container_index);
      ++at_wall;
    }
    std::sort(expected.begin(), expected.end());
    CHECK((contact_candidates(start, end, 0.2) == expected));
  }
  CHECK(at_wall > 50);
}

TEST_CASE("pairs are named after their bodies, or the body and the container") {
  CHECK(pair_name(3, 5) == "bodies 3 and 5");
  CHECK(pair_name(3, container_index) == "body 3 and the container");
}
