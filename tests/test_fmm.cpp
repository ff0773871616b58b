#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "fmm.hpp"
#include "interaction_lists.hpp"
#include "point_sets.hpp"
#include "quadtree.hpp"
#include "threads.hpp"

using namespace stokes;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// Sources of all three kinds at the same points.
struct Sources {
  PointArray points, weighted_normal;
  ComplexVector density, force;
  Vector torque;

  Sources(const NormalPoints& nodes, std::mt19937_64& generator)
      : points(nodes.points), weighted_normal(nodes.weighted_normal) {
    density = random_vectors(points.size(), generator);
    force = random_vectors(points.size(), generator);
    torque = random_vectors(points.size(), generator).real();
  }
  SourceStrengths stresslets() const { return {.weighted_normal = &weighted_normal, .density = &density}; }
  SourceStrengths stokeslets() const { return {.force = &force}; }
  SourceStrengths rotlets() const { return {.torque = &torque}; }
  SourceStrengths all() const { return {&weighted_normal, &density, &force, &torque}; }
};

Sources make_sources(PointSet set, int count, unsigned seed) {
  std::mt19937_64 generator(seed);
  return Sources(make_points(set, count, generator), generator);
}

// Points at distances from 1e-6 to 1, spread evenly in the logarithm, around three centres.
Sources clustered_sources(int count, unsigned seed) {
  std::mt19937_64 generator(seed);
  NormalPoints nodes = make_points(PointSet::uniform, count, generator);
  for (int k = 0; k < count; ++k) {
    const Complex centre = std::polar(1.0, 2.0 * pi * (k % 3) / 3.0);
    const double distance = std::pow(10.0, -6.0 * nodes.points.x[k]);
    nodes.points.set(k, centre + std::polar(distance, 2.0 * pi * nodes.points.y[k]));
  }
  return Sources(nodes, generator);
}

PointArray every(const PointArray& points, int step) {
  PointArray chosen;
  for (int k = 0; k < points.size(); k += step) {
    chosen.x.push_back(points.x[k]), chosen.y.push_back(points.y[k]);
  }
  return chosen;
}

// Largest error over every step-th target divided by the largest value of the quantity; of the pressure by
// the largest gradient where it vanishes.
double relative_error(const FlowFields& fmm, const FlowFields& exact, int step) {
  const auto errors = [step](const auto& a, const auto& b, double least) {
    double error = 0.0, largest = least;
    for (int k = 0; k < b.size(); ++k) {
      const double difference = std::abs(a[k * step] - b[k]);
      error = std::isnan(difference) ? difference : std::max(error, difference);
      largest = std::max(largest, std::abs(b[k]));
    }
    return error == 0.0 ? 0.0 : error / largest;
  };
  double worst = errors(fmm.velocity, exact.velocity, 0.0);
  if (exact.pressure.size() == 0) return worst;
  const double gradient = exact.velocity_x.cwiseAbs().maxCoeff();
  const double no_pressure = exact.pressure.cwiseAbs().maxCoeff() == 0.0 ? gradient : 0.0;
  for (const double error : {errors(fmm.velocity_x, exact.velocity_x, 0.0),
                             errors(fmm.velocity_y, exact.velocity_y, 0.0),
                             errors(fmm.pressure, exact.pressure, no_pressure)}) {
    if (!(error <= worst)) worst = error;
  }
  return worst;
}

FlowFields exact_fields(const Sources& sources, const SourceStrengths& strengths, int step) {
  FlowFields exact;
  direct_fields(every(sources.points, step), sources.points, strengths, FlowOutput::gradient, exact);
  return exact;
}

double fmm_error(const Sources& sources, const SourceStrengths& strengths, double tolerance,
                 const FlowFields& exact, int step) {
  FlowFields fmm;
  FmmPlan(sources.points, {tolerance}).evaluate(strengths, FlowOutput::gradient, fmm);
  return relative_error(fmm, exact, step);
}

double fmm_error(const Sources& sources, const SourceStrengths& strengths, double tolerance) {
  return fmm_error(sources, strengths, tolerance, exact_fields(sources, strengths, 1), 1);
}

// Checks the error at every fifth target, for each kind of sources.
void check_errors(const Sources& sources, const std::vector<double>& tolerances) {
  constexpr int step = 5;
  for (const SourceStrengths& strengths : {sources.stresslets(), sources.stokeslets(), sources.rotlets()}) {
    const FlowFields exact = exact_fields(sources, strengths, step);
    for (const double tolerance : tolerances) {
      CAPTURE(tolerance);
      CHECK(fmm_error(sources, strengths, tolerance, exact, step) <= tolerance);
    }
  }
}

bool same(const FlowFields& a, const FlowFields& b) {
  return a.velocity == b.velocity && a.pressure == b.pressure && a.velocity_x == b.velocity_x &&
         a.velocity_y == b.velocity_y;
}

// Velocity as the kernels are written in direct_fields.hpp.
Complex plain_velocity(Complex target, const Sources& s, const SourceStrengths& strengths) {
  Complex u = 0.0;
  for (int j = 0; j < s.points.size(); ++j) {
    const Complex r = target - s.points[j];
    const double rr = std::norm(r);
    if (rr == 0.0) continue;
    if (strengths.density) u += dot(r, s.weighted_normal[j]) * dot(r, s.density[j]) * r / (rr * rr * pi);
    if (strengths.force) u -= std::log(rr) * s.force[j] / (8.0 * pi);
    if (strengths.force) u += dot(r, s.force[j]) * r / (rr * 4.0 * pi);
    if (strengths.torque) u += s.torque[j] * perp(r) / (rr * 4.0 * pi);
  }
  return u;
}

FlowFields direct_at(Complex target, const Sources& s, const SourceStrengths& strengths) {
  PointArray targets;
  targets.resize(1);
  targets.set(0, target);
  FlowFields fields;
  direct_fields(targets, s.points, strengths, FlowOutput::gradient, fields);
  return fields;
}

}  // namespace

TEST_CASE("direct fields are the sums of the kernels, and their derivatives") {
  const Sources s = make_sources(PointSet::discs, 129, 1);
  const Complex x(0.31, 1.2);
  constexpr double h = 1e-4;
  for (const SourceStrengths& strengths : {s.stresslets(), s.stokeslets(), s.rotlets(), s.all()}) {
    const FlowFields f = direct_at(x, s, strengths);
    const FlowFields east = direct_at(x + h, s, strengths), west = direct_at(x - h, s, strengths);
    const FlowFields north = direct_at(x + h * imaginary_unit, s, strengths);
    const FlowFields south = direct_at(x - h * imaginary_unit, s, strengths);
    const Complex u = plain_velocity(x, s, strengths), on_node = plain_velocity(s.points[5], s, strengths);
    CHECK(std::abs(f.velocity[0] - u) < 1e-13 * std::abs(u));
    const FlowFields node_flow = direct_at(s.points[5], s, strengths);
    CHECK(std::abs(node_flow.velocity[0] - on_node) < 1e-13 * std::abs(on_node));
    // Central differences: off by h^2/6 times a third derivative; the nearest circle is 0.2 away.
    const double gradient = std::abs(f.velocity_x[0]) + std::abs(f.velocity_y[0]);
    const Complex du_dx = (east.velocity[0] - west.velocity[0]) / (2.0 * h);
    const Complex du_dy = (north.velocity[0] - south.velocity[0]) / (2.0 * h);
    CHECK(std::abs(du_dx - f.velocity_x[0]) < 1e-5 * gradient);
    CHECK(std::abs(du_dy - f.velocity_y[0]) < 1e-5 * gradient);
    CHECK(std::abs(f.velocity_x[0].real() + f.velocity_y[0].imag()) < 1e-14 * gradient);
    const Complex laplacian =
        east.velocity_x[0] - west.velocity_x[0] + north.velocity_y[0] - south.velocity_y[0];
    const Complex pressure(east.pressure[0] - west.pressure[0], north.pressure[0] - south.pressure[0]);
    CHECK(std::abs(laplacian - pressure) / (2.0 * h) < 1e-5 * gradient / 0.2);
  }
}

TEST_CASE("direct fields of stresslets are the double-layer sum") {
  const Sources s = make_sources(PointSet::uniform, 333, 2);
  ComplexVector velocity;
  FlowFields fields;
  double_layer_velocity(s.points, s.points, s.weighted_normal, s.density, velocity);
  direct_fields(s.points, s.points, s.stresslets(), FlowOutput::velocity, fields);
  CHECK((fields.velocity - velocity).cwiseAbs().maxCoeff() < 1e-14 * velocity.cwiseAbs().maxCoeff());
}

TEST_CASE("every pair of a source and a target is in exactly one interaction list") {
  const Sources s = clustered_sources(2000, 3), t = clustered_sources(1500, 4);
  const Quadtree tree(s.points, &t.points, 5);
  const InteractionLists lists = find_interactions(tree, 4);
  CHECK(lists.far.entries.size() > 1000);
  CHECK(lists.coarse.entries.size() > 100);
  CHECK(lists.fine.entries.size() > 100);
  int wrong = 0, targets = 0;
  for (int leaf = 0; leaf < tree.box_count(); ++leaf) {
    const Box& box = tree.boxes()[leaf];
    if (!box.is_leaf() || box.targets.size() == 0) continue;
    std::vector<int> seen(s.points.size(), 0);
    const auto see = [&seen](PointRange r) {
      for (int k = r.begin; k < r.end; ++k) ++seen[k];
    };
    see(box.sources);
    for (const PointRange r : lists.near[leaf]) see(r);
    for (const int b : lists.fine[leaf]) see(tree.boxes()[b].sources);
    for (int b = leaf; b >= 0; b = tree.boxes()[b].parent) {
      for (const FarSource source : lists.far[b]) see(tree.boxes()[source.box].sources);
      for (const int source : lists.coarse[b]) see(tree.boxes()[source].sources);
    }
    wrong += static_cast<int>(std::count_if(seen.begin(), seen.end(), [](int n) { return n != 1; }));
    targets += box.targets.size();
  }
  CHECK(wrong == 0);
  CHECK(targets == 1500);
}

TEST_CASE("the error stays below every tolerance, for all point sets, kinds of sources and quantities") {
  for (const PointSet set : {PointSet::uniform, PointSet::discs, PointSet::annulus}) {
    CAPTURE(static_cast<int>(set));
    const Sources s = make_sources(set, 6000, 5);
    check_errors(s, {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12});
    // Errors far below the tolerance would waste time.
    const FlowFields exact = exact_fields(s, s.stresslets(), 6);
    CHECK(fmm_error(s, s.stresslets(), 1e-3, exact, 6) > 1e-6);
    CHECK(fmm_error(s, s.stresslets(), 1e-9, exact, 6) > 1e-13);
  }
}

TEST_CASE("smooth strengths, whose far field adds up, are summed to the tolerance") {
  for (const PointSet set : {PointSet::uniform, PointSet::discs}) {
    Sources s = make_sources(set, 6000, 6);
    for (int k = 0; k < s.points.size(); ++k) {
      if (set == PointSet::uniform) s.weighted_normal.set(k, {0.006, 0.008});
      s.density[k] = {1.0 + std::cos(3.0 * s.points.x[k]), s.points.y[k]};
      s.force[k] = {1.0, s.points.x[k]}, s.torque[k] = 1.0;
    }
    check_errors(s, {1e-3, 1e-6, 1e-9, 1e-12});
  }
}

TEST_CASE("clusters in clusters are summed to the tolerance") {
  check_errors(clustered_sources(5000, 7), {1e-4, 1e-8, 1e-12});
}

TEST_CASE("targets need not be sources") {
  const Sources s = make_sources(PointSet::discs, 5000, 8);
  PointArray targets = every(make_sources(PointSet::uniform, 4000, 9).points, 1);
  for (int k = 0; k < 4000; ++k) {
    if (k % 4 == 0) targets.set(k, s.points[k]);                   // on a source, which is left out
    if (k % 4 == 1) targets.set(k, 3.0 * targets[k] - Complex(1.0, 1.0));  // around the sources
    if (k % 400 == 2) targets.set(k, 1e4 * targets[k]);            // far away
  }
  for (const FlowOutput output : {FlowOutput::velocity, FlowOutput::gradient}) {
    FlowFields fmm, exact;
    FmmPlan(s.points, targets, {1e-10}).evaluate(s.all(), output, fmm);
    direct_fields(targets, s.points, s.all(), output, exact);
    CHECK(fmm.pressure.size() == exact.pressure.size());
    CHECK(relative_error(fmm, exact, 1) <= 1e-10);
  }
}

TEST_CASE("forces at a few of the sources act like Stokeslets there alone") {
  Sources s = make_sources(PointSet::discs, 4000, 10);
  for (int k = 0; k < 4000; ++k) {
    if (k % 61 != 0) s.force[k] = 0.0, s.torque[k] = 0.0;
  }
  CHECK(fmm_error(s, s.all(), 1e-10) <= 1e-10);
  s.force.setZero(), s.torque.setZero();
  CHECK(fmm_error(s, s.all(), 1e-10) <= 1e-10);
}

TEST_CASE("the flow has the same bits for 1, 2 and 4 threads and for every use of a plan") {
  const int threads = thread_count();
  const Sources s = make_sources(PointSet::annulus, 12000, 11);
  set_thread_count(1);
  const FmmPlan plan(s.points, {1e-7});
  FlowFields once, again;
  plan.evaluate(s.all(), FlowOutput::gradient, once);
  plan.evaluate(s.stresslets(), FlowOutput::velocity, again);
  CHECK(again.pressure.size() == 0);
  plan.evaluate(s.all(), FlowOutput::gradient, again);
  CHECK(same(once, again));
  for (const int count : {2, 4}) {
    set_thread_count(count);
    FmmPlan(s.points, {1e-7}).evaluate(s.all(), FlowOutput::gradient, again);
    CHECK(same(once, again));
  }
  set_thread_count(threads);
}

TEST_CASE("no, one, equal and nearly equal points are no obstacle") {
  for (const int count : {0, 1, 2, 500}) {
    Sources s = make_sources(PointSet::uniform, count, 12);
    for (int k = 0; k < count; ++k) s.points.set(k, {0.1, 0.2});
    FlowFields fields;
    FmmPlan(s.points, {1e-9}).evaluate(s.all(), FlowOutput::gradient, fields);
    CHECK(fields.velocity.size() == count);
    CHECK(fields.velocity == ComplexVector::Zero(count));
    CHECK(fields.velocity_x == ComplexVector::Zero(count));
  }
  Sources s = make_sources(PointSet::uniform, 2000, 13);
  for (int k = 0; k < 2000; ++k) {
    if (k % 3 == 0) s.points.set(k, s.points[k % 9]);  // three heaps of 222 points
    if (k % 3 == 1) s.points.set(k, Complex(0.5, 0.5) + 1e-12 * Complex(k % 7, k % 11));  // 77 places
  }
  CHECK(fmm_error(s, s.all(), 1e-9) <= 1e-9);
  const PointArray none;
  FlowFields fields;
  FmmPlan(none, s.points, {1e-9}).evaluate({}, FlowOutput::velocity, fields);
  CHECK(fields.velocity == ComplexVector::Zero(2000));
  FmmPlan(s.points, none, {1e-9}).evaluate(s.all(), FlowOutput::velocity, fields);
  CHECK(fields.velocity.size() == 0);
}

TEST_CASE("outliers and a distance from the origin cost no accuracy") {
  for (const double distance : {1e3, 1e6, 1e10, 1e14}) {
    CAPTURE(distance);
    Sources outlier = make_sources(PointSet::uniform, 2000, 14), moved = outlier;
    outlier.points.set(17, {distance, -0.3 * distance});
    CHECK(fmm_error(outlier, outlier.stresslets(), 1e-9) <= 1e-9);
    CHECK(fmm_error(outlier, outlier.all(), 1e-9) <= 1e-9);
    for (int k = 0; k < 2000; ++k) moved.points.set(k, moved.points[k] + Complex(distance, -0.3 * distance));
    CHECK(fmm_error(moved, moved.stresslets(), 1e-12) <= 1e-12);
  }
  // Heaps on neighbouring doubles, where the centres of small boxes could not be stored.
  Sources heaps = make_sources(PointSet::uniform, 2500, 14);
  for (int k = 0; k < 2500; ++k) heaps.points.set(k, {1e14 + k % 5 * 0x1p-6, 1e14 + k / 5 % 5 * 0x1p-6});
  CHECK(fmm_error(heaps, heaps.stresslets(), 1e-12) <= 1e-12);
}

TEST_CASE("what is not a number, not in range or not one for each source is refused") {
  Sources s = make_sources(PointSet::uniform, 3000, 15);
  FlowFields fields;
  PointArray bad = s.points;
  bad.y[2999] = not_a_number;
  CHECK_THROWS_AS(FmmPlan(bad, {1e-9}), InputError);
  CHECK_THROWS_AS(FmmPlan(s.points, bad, {1e-9}), InputError);
  bad.y[2999] = 1e38;
  CHECK_THROWS_AS(FmmPlan(bad, {1e-9}), InputError);
  bad.y.pop_back();
  CHECK_THROWS_AS(FmmPlan(bad, {1e-9}), InputError);
  for (const double tolerance : {not_a_number, 0.0, 1e-14, 0.2}) {
    CHECK_THROWS_AS(FmmPlan(s.points, {tolerance}), InputError);
  }

  const FmmPlan plan(s.points, {1e-9});
  const auto evaluate = [&](const SourceStrengths& strengths) {
    plan.evaluate(strengths, FlowOutput::velocity, fields);
  };
  const ComplexVector few = s.density.head(2999);
  CHECK_THROWS_AS(evaluate({.weighted_normal = &s.weighted_normal, .density = &few}), InputError);
  CHECK_THROWS_AS(evaluate({.density = &s.density}), InputError);
  CHECK_THROWS_AS(evaluate({.weighted_normal = &s.weighted_normal}), InputError);
  CHECK_THROWS_AS(evaluate({.force = &few}), InputError);
  Sources broken = s;
  broken.density[1234] = {0.0, not_a_number}, broken.force[1234] = {not_a_number, 0.0};
  broken.torque[1234] = std::numeric_limits<double>::infinity();
  CHECK_THROWS_AS(evaluate(broken.stresslets()), NumericalError);
  CHECK_THROWS_AS(evaluate(broken.stokeslets()), NumericalError);
  CHECK_THROWS_AS(evaluate(broken.rotlets()), NumericalError);
  broken.density[1234] = 0.0, broken.weighted_normal.x[0] = not_a_number;
  CHECK_THROWS_AS(evaluate(broken.stresslets()), NumericalError);
  evaluate(s.stresslets());
  CHECK(fields.velocity.allFinite());
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they slow the two down unequally
TEST_CASE("1e5 points, spread or in one place, take no longer than the direct sum of 1.4e4, a plan less") {
  const int threads = thread_count();
  set_thread_count(1);
  const auto seconds = [](const auto& work) {
    double least = std::numeric_limits<double>::infinity();
    for (int run = 0; run < 3; ++run) {
      const std::clock_t start = std::clock();
      work();
      least = std::min(least, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    }
    return least;
  };
  const Sources many = make_sources(PointSet::discs, 100000, 16);
  const Sources few = make_sources(PointSet::discs, 14000, 16);
  const FmmPlan plan(many.points, {1e-9});
  FlowFields fields;
  ComplexVector velocity;
  const double fmm = seconds([&] { plan.evaluate(many.stresslets(), FlowOutput::velocity, fields); });
  const double direct = seconds([&] {
    double_layer_velocity(few.points, few.points, few.weighted_normal, few.density, velocity);
  });
  const double planning = seconds([&] { FmmPlan(many.points, {1e-9}); });
  CHECK(fmm <= direct);
  CHECK(planning <= fmm);
  Sources heap = many;
  for (int k = 0; k < 100000; ++k) heap.points.set(k, {0.3, 0.4});
  const FmmPlan heap_plan(heap.points, {1e-9});
  CHECK(seconds([&] { heap_plan.evaluate(heap.stresslets(), FlowOutput::velocity, fields); }) <= direct);
  set_thread_count(threads);
}
#endif
