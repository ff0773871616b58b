// The vectorised double-layer sum against the formula, term by term.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "direct_sum.hpp"
#include "random_suspension.hpp"
#include "threads.hpp"

using namespace stokes;

namespace {

struct Problem {
  PointArray targets, sources, weighted_normal;
  ComplexVector density;
};

PointArray random_points(std::mt19937_64& generator, int count, double size) {
  PointArray points;
  points.resize(count);
  for (int k = 0; k < count; ++k) {
    const double x = size * (uniform(generator) - 0.5);
    points.set(k, {x, size * (uniform(generator) - 0.5)});
  }
  return points;
}

Problem random_problem(int targets, int sources, unsigned seed) {
  std::mt19937_64 generator(seed);
  Problem p{random_points(generator, targets, 2.0), random_points(generator, sources, 2.0),
            random_points(generator, sources, 0.1), ComplexVector(sources)};
  const PointArray density = random_points(generator, sources, 2.0);
  for (int j = 0; j < sources; ++j) p.density[j] = density[j];
  return p;
}

// One target, and the sum of the absolute values of its terms, to which round-off is relative.
struct Sum {
  Complex value;
  double absolute = 0.0;
};
Sum plain_sum(const Problem& p, int i) {
  double x = 0.0, y = 0.0, absolute = 0.0;
  for (int j = 0; j < p.sources.size(); ++j) {
    const double rx = p.targets.x[i] - p.sources.x[j], ry = p.targets.y[i] - p.sources.y[j];
    const double rr = rx * rx + ry * ry;
    if (rr == 0.0) continue;
    const double rn = rx * p.weighted_normal.x[j] + ry * p.weighted_normal.y[j];
    const double re = rx * p.density[j].real() + ry * p.density[j].imag();
    x += rn * re * rx / (rr * rr) / pi, y += rn * re * ry / (rr * rr) / pi;
    absolute += std::abs(p.weighted_normal[j]) * std::abs(p.density[j]) / (std::sqrt(rr) * pi);
  }
  return {{x, y}, absolute};
}

ComplexVector fast_sum(const Problem& p) {
  ComplexVector velocity;
  double_layer_velocity(p.targets, p.sources, p.weighted_normal, p.density, velocity);
  return velocity;
}

// Largest error relative to the sum of the terms' absolute values.
double largest_error(const Problem& p) {
  const ComplexVector velocity = fast_sum(p);
  if (velocity.size() != p.targets.size()) return 1.0;
  double error = 0.0;
  for (int i = 0; i < p.targets.size(); ++i) {
    const Sum plain = plain_sum(p, i);
    const double scale = plain.absolute > 0.0 ? plain.absolute : 1.0;
    const double difference = std::abs(velocity[i] - plain.value) / scale;
    if (!(difference <= error)) error = difference;  // also when it is not a number
  }
  return error;
}

}  // namespace

TEST_CASE("the sum is the formula for every count of targets and sources, multiples of the vectors or not") {
  for (int targets : {1, 2, 3, 7, 8, 15, 16, 17, 31, 33, 100})
    for (int sources : {1, 2, 5, 16, 63, 200}) {
      const double error = largest_error(random_problem(targets, sources, 1000 * targets + sources));
      INFO(targets, " targets, ", sources, " sources: ", error);
      CHECK(error < 1e-14);
    }
}

TEST_CASE("sums long enough to be shared between threads are the formula too") {
  CHECK(largest_error(random_problem(1001, 1003, 5)) < 1e-14);
  CHECK(largest_error(random_problem(70001, 3, 6)) < 1e-14);
  CHECK(largest_error(random_problem(3, 200001, 7)) < 1e-13);  // the plain sum's own round-off
}

TEST_CASE("sources that coincide with a target are left out, wherever they stand") {
  Problem p = random_problem(41, 41, 9);
  p.targets = p.sources;
  CHECK(largest_error(p) < 1e-14);
  for (int j = 0; j < 41; j += 2) p.targets.set(j, p.sources[40 - j]);
  CHECK(largest_error(p) < 1e-14);
  // Nothing but coincident sources.
  Problem single = random_problem(5, 2, 10);
  for (int i = 0; i < 5; ++i) single.targets.set(i, {0.25, 0.5});
  for (int j = 0; j < 2; ++j) single.sources.set(j, {0.25, 0.5});
  CHECK(fast_sum(single) == ComplexVector::Zero(5));
}

TEST_CASE("a coincident source of one target does not disturb the others of its block") {
  Problem p = random_problem(64, 20, 11);
  const ComplexVector before = fast_sum(p);
  p.targets.set(13, p.sources[4]);
  const ComplexVector after = fast_sum(p);
  for (int i = 0; i < 64; ++i)
    if (i != 13) CHECK(std::abs(after[i] - before[i]) <= 1e-14 * plain_sum(p, i).absolute);
  CHECK(std::abs(after[13] - plain_sum(p, 13).value) < 1e-14 * plain_sum(p, 13).absolute);
}

TEST_CASE("very near and very far pairs lose nothing beside each other") {
  Problem p = random_problem(16, 8, 12);
  p.targets.set(3, p.sources[2] + Complex(1e-9, -2e-9));
  p.targets.set(4, {1e8, -3e8});
  p.targets.set(5, p.sources[7] + Complex(0.0, 1e-30));
  CHECK(largest_error(p) < 1e-14);
}

TEST_CASE("the result has the same bits for 1, 2 and 3 threads") {
  const int threads = thread_count();
  for (const auto& [targets, sources] : {std::pair(1500, 1501), std::pair(17, 40000), std::pair(40000, 17)}) {
    const Problem p = random_problem(targets, sources, 13);
    set_thread_count(1);
    const ComplexVector one = fast_sum(p);
    set_thread_count(2);
    CHECK(fast_sum(p) == one);
    set_thread_count(3);
    CHECK(fast_sum(p) == one);
  }
  set_thread_count(threads);
}

TEST_CASE("no targets give no velocities, and no sources give zero") {
  Problem p = random_problem(0, 10, 14);
  ComplexVector velocity = ComplexVector::Ones(3);
  double_layer_velocity(p.targets, p.sources, p.weighted_normal, p.density, velocity);
  CHECK(velocity.size() == 0);
  CHECK(fast_sum(random_problem(5, 0, 15)) == ComplexVector::Zero(5));
}

TEST_CASE("a constant density on a closed curve gives one inside and nothing outside") {
  const int count = 200;
  Problem p;
  p.sources.resize(count), p.weighted_normal.resize(count), p.targets.resize(3);
  p.density = ComplexVector::Constant(count, Complex(2.0, -1.0));
  for (int k = 0; k < count; ++k) {
    const double alpha = 2.0 * pi * k / count;
    p.sources.set(k, {2.0 * std::cos(alpha), std::sin(alpha)});
    // w n, n into a body
    p.weighted_normal.set(k, -Complex(std::cos(alpha), 2.0 * std::sin(alpha)) * (2.0 * pi / count));
  }
  p.targets.set(0, {0.3, 0.1}), p.targets.set(1, {-0.8, 0.2}), p.targets.set(2, {3.0, 1.0});
  const ComplexVector u = fast_sum(p);
  CHECK(std::abs(u[0] - Complex(2.0, -1.0)) < 1e-13);
  CHECK(std::abs(u[1] - Complex(2.0, -1.0)) < 1e-13);
  CHECK(std::abs(u[2]) < 1e-13);
}
