#include "refinement.hpp"

#include <algorithm>
#include <cmath>

#include "fronts.hpp"

namespace stokes {

namespace {

// Of the mobility across a gap.
constexpr double largest_mobility_error = 0.1;

// Across the gap, of the lubrication between the two curvatures.
double mobility(const Front& f) { return std::pow(std::max(f.gap * f.curvature, 0.0), 1.5) / (3.0 * std::sqrt(2.0) * pi); }

// The error of the mobility of an ellipse with N nodes at equal steps, as measured at a wall along a flank.
double mobility_error(const Shape& shape, int points) {
  return 0.15 * std::exp(-points * std::atanh(shape.inradius() / shape.circumradius()));
}

// Of a body with nodes of its own, those stay.
bool has_own_nodes(const Body& body) { return body.points > 0; }

// Beyond, W >= gap is wide enough for the equal steps.
double cluster_reach(const Shape& shape, int points, double tolerance) {
  return shape.circumradius() * std::log(1.0 / tolerance) / points;
}

void add_cluster(const Shape& shape, const Front& front, double factor, double tolerance, Discretisation& nodes) {
  const double digits = std::log(1.0 / tolerance), w = front.width / std::abs(shape.derivative(front.alpha));
  if (w > digits / nodes.points) return;
  const double count = factor * 2.0 / (pi * pi) * std::log(8.0 / w) * digits;
  nodes.clusters.push_back({front.alpha, w, 2 * static_cast<int>(std::ceil(0.5 * count))});
}

// Of clusters closer than the narrower is wide that one is kept.
void merge(std::vector<NodeCluster>& clusters) {
  std::stable_sort(clusters.begin(), clusters.end(),
                   [](const NodeCluster& a, const NodeCluster& b) { return a.width < b.width; });
  std::vector<NodeCluster> kept;
  for (const NodeCluster& c : clusters) {
    const bool covered = std::any_of(kept.begin(), kept.end(), [&c](const NodeCluster& k) {
      return std::abs(std::remainder(c.alpha - k.alpha, 2.0 * pi)) < k.width;
    });
    if (!covered) kept.push_back(c);
  }
  std::sort(kept.begin(), kept.end(), [](const NodeCluster& a, const NodeCluster& b) { return a.alpha < b.alpha; });
  clusters = std::move(kept);
}

}  // namespace

std::vector<Discretisation> equal_nodes(const Suspension& bodies, int points) {
  std::vector<Discretisation> nodes;
  for (const Body& body : bodies) nodes.push_back({has_own_nodes(body) ? body.points : points, {}});
  return nodes;
}

std::vector<Discretisation> refined_nodes(const Suspension& bodies, int points, double tolerance) {
  std::vector<Discretisation> nodes = equal_nodes(bodies, points);
  std::vector<double> reach;
  for (const Body& body : bodies) {
    // Beyond, even the mobility along two flanks exceeds the error.
    const double flank = std::pow(body.shape.circumradius(), 2) / body.shape.inradius();
    const double least = mobility_error(body.shape, points) / largest_mobility_error;
    reach.push_back(has_own_nodes(body) ? -1.0
                                        : std::max(cluster_reach(body.shape, points, tolerance),
                                                   flank * std::pow(3.0 * std::sqrt(2.0) * pi * least, 2.0 / 3.0)));
  }
  reach.push_back(-1.0);  // the container
  const std::vector<Front> close = fronts(bodies, reach);
  for (const Front& f : close)
    while (nodes[f.boundary].points < 4 * points &&
           mobility_error(bodies[f.boundary].shape, nodes[f.boundary].points) > largest_mobility_error * mobility(f))
      nodes[f.boundary].points *= 2;
  for (const Front& f : close) add_cluster(bodies[f.boundary].shape, f, 1.0, tolerance, nodes[f.boundary]);
  for (Discretisation& d : nodes) merge(d.clusters);
  return nodes;
}

double rate_tolerance(double relative_gap) {
  constexpr double relative = 0.1, round_off = 1e-12;
  return std::max(relative * std::pow(relative_gap, 1.5), round_off);
}

ClusteredNodes clustered_nodes(const Suspension& bodies, const std::vector<Resolution>& resolution, double tolerance) {
  const std::vector<Shape> shapes = boundary_shapes(bodies);
  ClusteredNodes result;
  auto& nodes = result.nodes;
  result.relative_gap.assign(shapes.size(), 2.0);
  std::vector<double> reach;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    nodes.push_back({resolution[i].points, {}});
    reach.push_back(cluster_reach(shapes[i], resolution[i].points, tolerance));
  }
  for (const Front& f : fronts(bodies, reach)) {
    const double of_rate = rate_tolerance(f.gap * f.curvature);
    add_cluster(shapes[f.boundary], f, resolution[f.boundary].factor, std::min(tolerance, of_rate), nodes[f.boundary]);
    double& least = result.relative_gap[f.boundary];
    least = std::min(least, std::max(f.gap * f.curvature, 1e-12));
  }
  for (Discretisation& d : nodes) merge(d.clusters);
  return result;
}

}  // namespace stokes
