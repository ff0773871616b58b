// Nodes clustered near contacts, and what dense suspensions cost.
#include <doctest/doctest.h>

#include <cmath>

#include "container_gap.hpp"
#include "couette_bodies.hpp"
#include "curve.hpp"
#include "gap.hpp"
#include "refinement.hpp"
#include "stokes_system.hpp"

using namespace stokes;

namespace {

// An ellipse 4.75:1 along x and another, upright, `distance` above its flank at x.
Suspension tip_on_flank(double x, double distance) {
  Suspension pair{{{0.475, 0.1}, {}}, {{0.475, 0.1}, {{x, 0.0}, pi / 2}}};
  double low = 0.3, high = 1.0;
  for (int k = 0; k < 60; ++k) {
    pair[1].pose.centre = {x, 0.5 * (low + high)};
    (gap(pair[0], pair[1]).value < distance ? low : high) = 0.5 * (low + high);
  }
  return pair;
}

// Rate of the gap for a unit force that parts the pair.
double normal_mobility(const Suspension& pair, const std::vector<Discretisation>& nodes) {
  const GapGradient g = gradient(gap(pair[0], pair[1]), pair[0].pose, pair[1].pose);
  ShapeCache shapes;
  const StokesSystem system(pair, nodes, shapes, {1e-10});
  const std::vector<RigidVelocity> u = system.solve({}, {{g.centre_a, g.angle_a}, {g.centre_b, g.angle_b}}).velocity;
  return dot(g.centre_a, u[0].velocity) + g.angle_a * u[0].omega + dot(g.centre_b, u[1].velocity) + g.angle_b * u[1].omega;
}

// An ellipse flat along the outer of two cylinders; and the rate of the gap for a unit force away from the wall.
Suspension flat_along_wall(const Shape& shape, double distance) {
  return between_cylinders({body_at(shape, 10.0 - distance - shape.b, pi / 2)}, 1024);
}
double wall_mobility(const Suspension& bodies, const std::vector<Discretisation>& nodes) {
  const GapGradient g = gradient(gap(bodies[0], *bodies.container), bodies[0].pose);
  ShapeCache shapes;
  const StokesSystem system(bodies, nodes, shapes, {1e-10});
  const RigidVelocity u = system.solve({}, {{g.centre_a, g.angle_a}, {}}).velocity[0];
  return dot(g.centre_a, u.velocity) + g.angle_a * u.omega;
}

// One disc and the six around it.
Suspension hexagon(double distance) {
  Suspension discs{{{1.0, 1.0}, {}}};
  for (int k = 0; k < 6; ++k) discs.push_back({{1.0, 1.0}, {std::polar(2.0 + distance, k * pi / 3.0), 0.0}});
  return discs;
}

}  // namespace

TEST_CASE("tip on flank, 32 nodes and clusters give the normal mobility of 512 nodes to 1 %, and 128 do not") {
  double missed = 0.0;
  for (const double x : {0.0, 0.15})
    for (const double distance : {0.012, 0.006, 0.003}) {
      const Suspension pair = tip_on_flank(x, distance);
      const double reference = normal_mobility(pair, equal_nodes(pair, 512));
      const std::vector<Discretisation> nodes = refined_nodes(pair, 32, near_tolerance);
      CHECK(nodes[0].size() + nodes[1].size() <= 128);
      CHECK(std::abs(normal_mobility(pair, nodes) / reference - 1.0) < 0.01);
      missed = std::max(missed, std::abs(normal_mobility(pair, equal_nodes(pair, 128)) / reference - 1.0));
    }
  CHECK(missed > 0.4);
}

TEST_CASE("6:1 flat along a wall: with 32 nodes a force towards the wall moves it away, and refined nodes mend that") {
  const Suspension slender = flat_along_wall({0.375, 0.0625}, 0.0247);
  const double reference = wall_mobility(slender, equal_nodes(slender, 256));
  CHECK(std::abs(wall_mobility(slender, equal_nodes(slender, 512)) / reference - 1.0) < 1e-6);
  const std::vector<Discretisation> nodes = refined_nodes(slender, 32, near_tolerance);
  const double equal = wall_mobility(slender, equal_nodes(slender, 32)), refined = wall_mobility(slender, nodes);
  MESSAGE("mobility ", reference, "; 32 nodes ", equal, ", 64 nodes ", wall_mobility(slender, equal_nodes(slender, 64)),
          ", refined to ", nodes[0].size(), " ", refined);
  CHECK(reference > 0.0);
  CHECK(equal < 0.0);
  CHECK(std::abs(refined / reference - 1.0) < 0.01);
  CHECK(nodes[0].points > 32);
  CHECK(nodes[0].size() <= 128);
  CHECK(nodes[1] == Discretisation{1024, {}});
}

TEST_CASE("3:1 flat along the same wall keeps its 32 nodes, and they give its mobility to 1 %") {
  const Suspension bodies = flat_along_wall({0.375, 0.125}, 0.0247);
  const std::vector<Discretisation> nodes = refined_nodes(bodies, 32, near_tolerance);
  const double reference = wall_mobility(bodies, equal_nodes(bodies, 256)), found = wall_mobility(bodies, nodes);
  MESSAGE("mobility ", reference, ", with ", nodes[0].size(), " nodes ", found);
  CHECK(nodes == equal_nodes(bodies, 32));
  CHECK(std::abs(found / reference - 1.0) < 0.01);
}

TEST_CASE("bodies far from others, and walls, keep their nodes") {
  Suspension bodies = tip_on_flank(0.0, 0.5);
  CHECK(refined_nodes(bodies, 32, near_tolerance) == equal_nodes(bodies, 32));
  bodies = tip_on_flank(0.0, 0.005);
  bodies[0].points = 48;
  const std::vector<Discretisation> nodes = refined_nodes(bodies, 32, near_tolerance);
  CHECK(nodes[0] == Discretisation{48, {}});
  CHECK(nodes[1].clusters.size() == 1);
}

TEST_CASE("seven discs in a hexagon take at most 10, 15 and 25 iterations from zero, hardly depending on the nodes") {
  struct Row {
    double distance;
    int points, limit;
  };
  for (const Row& row : {Row{0.3, 64, 10}, Row{0.1, 64, 15}, Row{0.01, 128, 25}}) {
    const Suspension discs = hexagon(row.distance);
    ShapeCache shapes;
    StokesOptions options;
    const int pair = StokesSystem(discs, row.points, shapes, options).solve({FlowKind::shear}, {}).iterations;
    const int finer = StokesSystem(discs, 2 * row.points, shapes, options).solve({FlowKind::shear}, {}).iterations;
    options.preconditioner = PreconditionerKind::block;
    const int block = StokesSystem(discs, row.points, shapes, options).solve({FlowKind::shear}, {}).iterations;
    MESSAGE("gap " << row.distance << ": " << pair << " iterations in pairs, " << finer << " with twice the nodes, "
                   << block << " by blocks");
    CHECK(pair <= row.limit);
    CHECK(std::abs(finer - pair) <= 2);
    CHECK(block > pair);
  }
}

TEST_CASE("bodies so small that they hardly push the others are solved with them") {
  // Between two nodes of the large disc.
  const Body large{{1.0, 1.0}, {}}, small{{1e-6, 1e-6}, {std::polar(1.0 + 1.3e-6, pi / 64.0), 0.0}};
  for (const Suspension& discs : {Suspension{large, small}, Suspension{small, large}}) {
    const int l = discs[0].shape.a == 1.0 ? 0 : 1;
    ShapeCache shapes;
    StokesOptions options;
    const auto pair = StokesSystem(discs, 64, shapes, options).solve({FlowKind::shear}, {});
    options.preconditioner = PreconditionerKind::block;
    const auto block = StokesSystem(discs, 64, shapes, options).solve({FlowKind::shear}, {});
    CHECK(pair.iterations <= block.iterations);
    CHECK(std::abs(pair.velocity[l].omega - block.velocity[l].omega) < 1e-8);
  }
}

TEST_CASE("the fast multipole method and the direct sum give the same velocities to the tolerance") {
  const Suspension discs = hexagon(0.1);
  ShapeCache shapes;
  for (const double tolerance : {1e-6, 1e-10}) {
    StokesOptions options{tolerance};
    options.summation = Summation::direct;
    const auto direct = StokesSystem(discs, 64, shapes, options).solve({FlowKind::extension}, {}).velocity;
    options.summation = Summation::fmm;
    const auto fast = StokesSystem(discs, 64, shapes, options).solve({FlowKind::extension}, {}).velocity;
    for (std::size_t i = 0; i < discs.size(); ++i) {
      CHECK(std::abs(direct[i].velocity - fast[i].velocity) < 10.0 * tolerance);
      CHECK(std::abs(direct[i].omega - fast[i].omega) < 10.0 * tolerance);
    }
  }
}
