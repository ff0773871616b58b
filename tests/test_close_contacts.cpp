// Velocities of bodies down to gaps of 1e-8 with nodes that grow like the logarithm of the gap.
#include <doctest/doctest.h>

#include <cmath>

#include "refinement.hpp"
#include "resolution.hpp"
#include "stokes_system.hpp"

using namespace stokes;

namespace {

constexpr double tolerance = 1e-13;  // of GMRES

// N_0 nodes and clusters as for `accuracy`, the nodes of a cluster times `factor`.
std::vector<Discretisation> nodes_of(const Suspension& bodies, int points, double accuracy, double factor,
                                     int upsampling = 2) {
  std::vector<Resolution> resolution(bodies.size() + (bodies.container ? 1 : 0), Resolution{points, factor});
  std::vector<Discretisation> nodes = clustered_nodes(bodies, resolution, accuracy).nodes;
  for (Discretisation& d : nodes) d.upsampling = upsampling;
  return nodes;
}

int most_nodes(const std::vector<Discretisation>& nodes) {
  int most = 0;
  for (const Discretisation& d : nodes) most = std::max(most, d.size());
  return most;
}

StokesSolution solution(const Suspension& bodies, const std::vector<Discretisation>& nodes, FlowKind flow) {
  ShapeCache shapes;
  return StokesSystem(bodies, nodes, shapes, {tolerance}).solve({flow}, {});
}

Suspension discs_apart(double gap, Complex middle) {
  const Complex half{0.0, 1.0 + 0.5 * gap};
  return {{{1.0, 1.0}, {middle - half, 0.0}}, {{1.0, 1.0}, {middle + half, 0.0}}};
}

Suspension tip_on_flank(double gap) {
  return {{{1.0, 1.0 / 3.0}, {}}, {{1.0, 1.0 / 3.0}, {{0.0, 4.0 / 3.0 + gap}, pi / 2}}};
}

}  // namespace

// Solutions in bipolar coordinates for two free discs in u = (x, -y) along their line of centres: speed of each.
TEST_CASE(
    "two discs in extension and shear: absolute errors below 1e-11 at gaps of 1e-2 to 1e-8, anywhere, with 128 nodes") {
  struct Row {
    double gap, approach;  // of each disc, towards the other
  };
  for (const Row& row : {Row{1e-2, 0.5 * 3.936090751532e-3}, Row{1e-4, 1.999675055459e-6}, Row{1e-6, 1.999996750006e-9},
                         Row{1e-8, 1.9999999675e-12}})
    for (const Complex middle : {Complex{0.0, 0.0}, Complex{10.0, 3.0}}) {
      const Suspension discs = discs_apart(row.gap, middle);
      const std::vector<Discretisation> nodes = nodes_of(discs, 44, 1e-13, 1.0);
      CHECK(most_nodes(nodes) <= 128);
      const StokesSolution s = solution(discs, nodes, FlowKind::extension);
      CHECK(std::abs(s.velocity[0].velocity - std::conj(middle) - Complex{0.0, row.approach}) < 1e-11);
      CHECK(std::abs(s.velocity[1].velocity - std::conj(middle) + Complex{0.0, row.approach}) < 1e-11);
      CHECK(std::abs(s.velocity[0].omega) < 1e-10);
      CHECK(s.iterations <= 10);
    }
}

TEST_CASE("two discs, exact digits of N_0 = 26 and 38 nodes of a cluster: 1e-9 at 1e-6") {
  const Suspension discs = discs_apart(1e-6, 0.0);
  std::vector<Discretisation> nodes = nodes_of(discs, 26, 1e-8, 1.0);
  for (Discretisation& d : nodes) d.clusters[0].points = 38;
  const StokesSolution s = solution(discs, nodes, FlowKind::shear),
                       fine = solution(discs, nodes_of(discs, 50, 1e-13, 1.0), FlowKind::shear);
  CHECK(std::abs(s.velocity[1].velocity - fine.velocity[1].velocity) < 1e-9);
  CHECK(std::abs(s.velocity[1].omega - fine.velocity[1].omega) < 1e-9);
}

// Values of an independent dense solver, to all digits given; 2048 equal nodes also give that of the second gap.
TEST_CASE("3:1 tip on flank in extension: rates of the gap to 1e-11 at gaps of 1e-2 to 1e-6 with 176 nodes") {
  struct Row {
    double gap, rate, error;
  };
  for (const Row& row : {Row{1e-2, -1.829832458480e-2, 1e-11}, Row{1e-3, -7.22889264244e-4, 1e-11},
                         Row{1e-4, -2.3547389760e-5, 1e-11}, Row{1e-6, -2.36311e-8, 1e-11}}) {
    const Suspension pair = tip_on_flank(row.gap);
    const std::vector<Discretisation> nodes = nodes_of(pair, 96, 1e-13, 1.2, 3);
    CHECK(most_nodes(nodes) <= 200);
    const StokesSolution s = solution(pair, nodes, FlowKind::extension);
    CHECK(std::abs((s.velocity[1].velocity - s.velocity[0].velocity).imag() - row.rate) < row.error);
    CHECK(std::abs((s.velocity[1].velocity - s.velocity[0].velocity).real()) < row.error);
  }
}

TEST_CASE("a disc pushed to the wall of a container has the mobility of many equal nodes, with clusters on both") {
  struct Row {
    double gap, mobility;
  };
  for (const Row& row : {Row{1e-3, 5.72e-6}, Row{3e-3, 2.96e-5}, Row{1e-2, 1.78e-4}}) {
    Suspension bodies{{{0.5, 0.5}, {{4.5 - row.gap, 0.0}, 0.0}}};
    bodies.container = Container{{}, 5.0, 64};
    const std::vector<Discretisation> nodes = nodes_of(bodies, 56, 1e-10, 1.2);
    REQUIRE(nodes.size() == 2);
    CHECK(nodes[1].clusters.size() == 1);
    CHECK(most_nodes(nodes) <= 128);
    ShapeCache shapes;
    const StokesSystem system(bodies, nodes, shapes, {1e-10});
    const double mobility = system.solve({}, {{{1.0, 0.0}, 0.0}}).velocity[0].velocity.real();
    CHECK(std::abs(mobility / row.mobility - 1.0) < 0.01);
    const std::vector<Discretisation> finer = nodes_of(bodies, 80, 1e-13, 1.4);
    ShapeCache more_shapes;
    const double fine =
        StokesSystem(bodies, finer, more_shapes, {1e-12}).solve({}, {{{1.0, 0.0}, 0.0}}).velocity[0].velocity.real();
    CHECK(std::abs(mobility - fine) < 1e-10);
  }
}

TEST_CASE("chains and triangles of discs at 1e-6: converged to 1e-8, in at most 40 iterations") {
  const double distance = 2.0 + 1e-6;
  const auto disc = [](Complex centre) { return Body{{1.0, 1.0}, {centre, 0.0}}; };
  for (const Suspension& discs : {Suspension{disc(-distance), disc(0.0), disc(std::polar(distance, 1.0))},
                                  Suspension{disc(0.0), disc(distance), disc(std::polar(distance, pi / 3.0))}}) {
    const StokesSolution s = solution(discs, nodes_of(discs, 60, 1e-13, 1.3), FlowKind::extension),
                         fine = solution(discs, nodes_of(discs, 80, 1e-13, 1.8), FlowKind::extension);
    CHECK(s.iterations <= 40);
    CHECK(fine.iterations <= 40);
    for (int i = 0; i < 3; ++i) {
      CHECK(std::abs(s.velocity[i].velocity - fine.velocity[i].velocity) < 1e-8);
      CHECK(std::abs(s.velocity[i].omega - fine.velocity[i].omega) < 1e-8);
    }
  }
}

TEST_CASE("the multipole sum and the direct sum give the same velocities at a gap of 1e-5") {
  const Suspension discs = discs_apart(1e-5, {3.0, 1.0});
  const std::vector<Discretisation> nodes = nodes_of(discs, 40, 1e-10, 1.0);
  const auto velocity = [&](Summation summation) {
    ShapeCache shapes;
    return StokesSystem(discs, nodes, shapes, {.gmres_tolerance = 1e-10, .summation = summation})
        .solve({FlowKind::shear}, {})
        .velocity;
  };
  const auto direct = velocity(Summation::direct), fast = velocity(Summation::fmm);
  for (int i = 0; i < 2; ++i) {
    CHECK(std::abs(direct[i].velocity - fast[i].velocity) < 1e-8);
    CHECK(std::abs(direct[i].omega - fast[i].omega) < 1e-8);
  }
}

TEST_CASE("a small disc in front of one up to 1e4 times as large keeps 1e-8 with nodes that grow like log of the ratio") {
  std::vector<int> most;  // twice the digits, and twice the logarithm of the width
  for (const double ratio : {10.0, 1e2, 1e3, 1e4}) {
    CAPTURE(ratio);
    const Suspension discs{{{ratio, ratio}, {}}, {{1.0, 1.0}, {{0.0, ratio + 1.1}, 0.0}}};
    ShapeCache shapes;
    ShapeResolution alone;
    std::vector<Resolution> resolution;
    const ResolvedSystem resolved =
        solve_to_accuracy({discs, {FlowKind::extension}, {}, {}}, 1e-8, {}, shapes, alone, resolution);
    most.push_back(resolved.most_nodes());
    const StokesSolution fine = solution(discs, nodes_of(discs, 96, 1e-13, 1.5), FlowKind::extension);
    CHECK(std::abs(resolved.solution.velocity[1].velocity - fine.velocity[1].velocity) < 1e-8);
  }
  CHECK(most[3] <= 4 * most[0]);
}
