// Nodes concentrated at places of a curve, and the offsets from those places.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "curve.hpp"
#include "discrete_shape.hpp"
#include "node_map.hpp"
#include "shape.hpp"

using namespace stokes;

namespace {

const Discretisation two_clusters{38, {{0.7, 1e-4, 40}, {4.0, 0.03, 18}}};

}  // namespace

TEST_CASE("the map of nodes runs around once, its derivatives are those of its values and it inverts itself") {
  for (const Discretisation& nodes :
       {Discretisation{40, {{1.6, 0.3, 10}}}, Discretisation{38, {{0.0, 1e-4, 58}}}, two_clusters,
        Discretisation{32, {{0.2, 1e-6, 40}, {0.2004, 1e-3, 20}, {6.2, 0.01, 30}}}}) {
    const NodeMap map(nodes);
    CHECK(map.position(0.0) == 0.0);
    CHECK(std::abs(map.position(2.0 * pi - 1e-9) - 2.0 * pi) < 1e-4);
    const std::vector<MappedNode> mapped = map.at_equal_steps(nodes.size());
    const std::vector<MappedNode> fine = map.at_equal_steps(400 * nodes.size());  // for differences
    double worst = 0.0, slope = 0.0, bend = 0.0;
    for (int k = 0; k < nodes.size(); ++k) {
      const MappedNode& node = mapped[k];
      // The round-off is that of s, or of alpha where s changes fast.
      worst = std::max(worst, std::abs(std::remainder(map.position(node.alpha) - 2.0 * pi * k / nodes.size(), 2.0 * pi)) *
                                  std::min(1.0, node.first));
      const NodeCluster& c = nodes.clusters[node.cluster];
      CHECK(std::abs(std::remainder(c.alpha + node.distance - node.alpha, 2.0 * pi)) < 1e-14);
      if (k % 16 != 0) continue;
      const auto near = [&](int step) { return fine[(400 * k + step + 400 * nodes.size()) % (400 * nodes.size())]; };
      if (near(1).cluster != node.cluster || near(-1).cluster != node.cluster) continue;
      const double h = 2.0 * pi / (400 * nodes.size());
      const double way = std::remainder(near(1).distance - near(-1).distance, 2.0 * pi);
      slope = std::max(slope, std::abs(way / (2.0 * h) / node.first - 1.0));
      bend = std::max(bend, std::abs((near(1).first - near(-1).first) / (2.0 * h) - node.second) / node.first);
    }
    CHECK(worst < 4e-15);
    CHECK(slope < 1e-4);
    CHECK(bend < 1e-3);
  }
}

// Newton's steps from the nearest cluster may jump over another one.
TEST_CASE("the map inverts itself for any clusters, also where one stands on the way from another") {
  std::mt19937_64 generator(1);
  const auto uniform = [&] { return static_cast<double>(generator() >> 11) * 0x1p-53; };
  for (int trial = 0; trial < 100; ++trial) {
    Discretisation nodes{32 + 2 * static_cast<int>(60 * uniform()), {}};
    if (trial == 0) nodes = {162, {{4.192490, 1.891e-3, 128}, {4.549370, 8.654e-2, 70}}};
    for (int k = 0; k < trial % 6; ++k)
      nodes.clusters.push_back(
          {2.0 * pi * uniform(), std::pow(10.0, -5.0 * uniform()), 10 + 2 * static_cast<int>(60 * uniform())});
    const NodeMap map(nodes);
    const int count = 3 * nodes.size();
    const std::vector<MappedNode> mapped = map.at_equal_steps(count);
    double worst = 0.0;
    for (int k = 0; k < count; ++k)
      worst = std::max(worst, std::abs(std::remainder(map.position(mapped[k].alpha) - 2.0 * pi * k / count, 2.0 * pi)) *
                                  std::min(1.0, mapped[k].first));
    CAPTURE(trial);
    CHECK(worst < 1e-14);
  }
}

TEST_CASE("nodes of a cluster are as far apart as a constant times their distance from it, down to its width") {
  const Discretisation nodes{38, {{1.0, 1e-5, 58}}};
  const std::vector<MappedNode> mapped = NodeMap(nodes).at_equal_steps(nodes.size());
  const double step = 2.0 * std::log(8.0 / 1e-5) / 58;
  int close = 0;
  for (const MappedNode& node : mapped) {
    if (std::abs(node.distance) > 0.01) continue;
    ++close;
    const double spacing = node.first * 2.0 * pi / nodes.size();
    CHECK(std::abs(spacing / (step * std::hypot(1e-5, node.distance)) - 1.0) < 0.05);
  }
  CHECK(close >= 30);
}

TEST_CASE("offsets from a point keep their digits along the tangent and across it") {
  const Shape ellipse{1.0, 1.0 / 3.0};
  for (const double alpha : {0.0, 0.4, 1.6, 5.0})
    for (const double t : {1.0, 0.31, 0.29, 0.01, -1e-3, 1e-6, -1e-9}) {
      const Complex o = ellipse.offset(alpha, t), slope = ellipse.derivative(alpha), along = slope / std::abs(slope);
      const Complex direct = std::conj(along) * (ellipse.point(alpha + t) - ellipse.point(alpha));
      CHECK(std::abs(o - direct) < 1e-15);
      // The first terms of the series in t; the third derivative of an ellipse is minus its first.
      const Complex second = std::conj(along) * -ellipse.point(alpha), third = std::conj(along) * -slope;
      if (std::abs(t) > 1e-3) continue;
      const Complex series =
          std::abs(slope) * t + t * t / 2.0 * second + t * t * t / 6.0 * third - std::pow(t, 4) / 24.0 * second;
      CHECK(std::abs(o.real() / series.real() - 1.0) < 1e-13);
      CHECK(std::abs(o.imag() / series.imag() - 1.0) < 1e-11);
    }
}

TEST_CASE("a curve through clustered nodes has the ellipse's perimeter, area and derivatives") {
  const Shape ellipse{0.475, 0.1};
  for (const Discretisation& nodes :
       {Discretisation{128, {{1.6, 0.05, 64}}}, Discretisation{128, {{1.6, 1e-4, 64}, {0.3, 0.01, 48}}}}) {
    const Curve curve = ellipse.curve(nodes);
    REQUIRE(curve.size() == nodes.size());
    CHECK(std::abs(curve.length() / ellipse.perimeter() - 1.0) < 1e-12);
    CHECK(std::abs(curve.area() / (pi * ellipse.a * ellipse.b) - 1.0) < 1e-12);
    const Curve through = Curve::through(curve.position);
    CHECK((curve.derivative - through.derivative).cwiseAbs().maxCoeff() < 1e-7);
    for (int k = 0; k < curve.size(); ++k) {
      CHECK(std::abs(std::hypot(curve.position[k].real() / ellipse.a, curve.position[k].imag() / ellipse.b) - 1.0) < 1e-14);
      const Support support = ellipse.support(-imaginary_unit * curve.tangent[k]);
      CHECK(std::abs(curve.curvature[k] * support.curvature_radius - 1.0) < 1e-9);
    }
  }
}

TEST_CASE("a density moved between nodes with any clusters keeps its values") {
  const Discretisation plain{64, {}}, other{48, {{0.7, 0.01, 40}, {0.9, 0.02, 30}, {5.0, 1e-3, 50}}};
  const auto density = [](const Discretisation& nodes) {
    ComplexVector values(nodes.size());
    const std::vector<MappedNode> mapped = NodeMap(nodes).at_equal_steps(nodes.size());
    for (int k = 0; k < nodes.size(); ++k) values[k] = std::polar(1.0, mapped[k].alpha) + std::cos(3.0 * mapped[k].alpha);
    return values;
  };
  const Discretisation clustered{64, {{0.7, 0.05, 30}, {4.0, 0.02, 34}}};
  for (const Discretisation& from : {plain, clustered, other})
    for (const Discretisation& to : {plain, clustered, other, two_clusters})
      CHECK((move_density(density(from), from, to) - density(to)).cwiseAbs().maxCoeff() < (from == plain ? 1e-13 : 1e-7));
}
