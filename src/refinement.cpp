#include "refinement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stokes {

namespace {

// Relative to the mobility across a gap.
constexpr double largest_mobility_error = 0.1;

// The error of the mobility of an ellipse with N nodes at equal steps, as measured at a wall along a flank.
double mobility_error(const Shape& shape, int points) {
  return 0.15 * std::exp(-points * std::atanh(shape.inradius() / shape.circumradius()));
}

// True for a body with its own number of nodes, which is not changed.
bool has_own_nodes(const Body& body) { return body.points > 0; }

// W in the boundary's parameter.
double width(const Shape& shape, const Front& front) { return front.width / std::abs(shape.derivative(front.alpha)); }

// What a node of a cluster of this width adds to the digits.
double digits_of_node(double w) { return 0.5 * pi * pi / std::log(8.0 / w); }

void add_cluster(const Shape& shape, const Front& front, double factor, double tolerance, Discretisation& nodes) {
  const double digits = factor * std::log(1.0 / tolerance), w = width(shape, front);
  if (nodes.points * w > digits) return;
  const double count = digits / digits_of_node(w);
  nodes.clusters.push_back({front.alpha, w, 2 * static_cast<int>(std::ceil(0.5 * count))});
}

// If two clusters are closer than the width of the narrower one, only the narrower one is kept.
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

// N_0 is the requested number or, where its clusters would have more nodes than that, 2, 4, ... times this number.
Discretisation fewest_nodes(const Shape& shape, const std::vector<Front>& close, const Resolution& resolution,
                            double tolerance, double least_of_clusters) {
  Discretisation fewest;
  for (int points = resolution.points; fewest.points == 0 || points <= fewest.size(); points *= 2) {
    Discretisation nodes{points, {}};
    for (const Front& f : close)
      add_cluster(shape, f, resolution.factor,
                  std::max(least_of_clusters, std::min(tolerance, rate_tolerance(f.gap * f.curvature))), nodes);
    merge(nodes.clusters);
    if (fewest.points == 0 || nodes.size() <= fewest.size()) fewest = std::move(nodes);
    if (fewest.clusters.empty()) break;
  }
  return fewest;
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
                                        : std::max(resolved_distance(body.shape, points, tolerance),
                                                   flank * std::pow(3.0 * std::sqrt(2.0) * pi * least, 2.0 / 3.0)));
  }
  reach.push_back(-1.0);  // the container
  const std::vector<Front> close = fronts(bodies, reach);
  for (const Front& f : close)
    while (nodes[f.boundary].points < 4 * points && mobility_error(bodies[f.boundary].shape, nodes[f.boundary].points) >
                                                        largest_mobility_error * gap_mobility(f.gap * f.curvature))
      nodes[f.boundary].points *= 2;
  for (const Front& f : close) add_cluster(bodies[f.boundary].shape, f, 1.0, tolerance, nodes[f.boundary]);
  for (Discretisation& d : nodes) merge(d.clusters);
  return nodes;
}

double resolved_digits(const Shape& shape, const Discretisation& nodes, const Front& front) {
  const double w = width(shape, front);
  double most = nodes.points * w;
  for (const NodeCluster& c : nodes.clusters)
    if (std::abs(std::remainder(front.alpha - c.alpha, 2.0 * pi)) < c.width)
      most = std::max(most, c.points * digits_of_node(std::min(w, c.width)));
  return most;
}

double gap_mobility(double relative_gap) { return std::pow(std::max(relative_gap, 0.0), 1.5) / (3.0 * std::sqrt(2.0) * pi); }

double resolved_distance(const Shape& shape, int points, double tolerance) {
  return shape.circumradius() * std::log(1.0 / tolerance) / points;
}

std::vector<double> relative_sizes(const Suspension& bodies) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Body& body : bodies)
    if (!body.fixed) smallest = std::min(smallest, body.shape.circumradius());
  std::vector<double> sizes;
  for (const Shape& shape : boundary_shapes(bodies)) sizes.push_back(std::max(1.0, shape.circumradius() / smallest));
  return sizes;
}

double own_tolerance(double accuracy, double relative_size) {
  constexpr double round_off = 1e-11;
  return std::min(accuracy, std::max(accuracy / relative_size, round_off));
}

double rate_tolerance(double relative_gap) {
  constexpr double relative = 0.1, round_off = 1e-12;
  return std::max(relative * std::pow(relative_gap, 1.5), round_off);
}

ClusteredNodes clustered_nodes(const Suspension& bodies, const std::vector<Resolution>& resolution, double tolerance,
                               double least_of_clusters) {
  const std::vector<Shape> shapes = boundary_shapes(bodies);
  const std::vector<double> sizes = relative_sizes(bodies);
  std::vector<double> reach;
  for (std::size_t i = 0; i < shapes.size(); ++i)
    reach.push_back(resolution[i].factor *
                    resolved_distance(shapes[i], resolution[i].points, own_tolerance(tolerance, sizes[i])));
  std::vector<std::vector<Front>> close(shapes.size());
  for (const Front& f : fronts(bodies, reach)) close[f.boundary].push_back(f);
  ClusteredNodes result;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    result.nodes.push_back(fewest_nodes(shapes[i], close[i], resolution[i], own_tolerance(tolerance, sizes[i]),
                                        least_of_clusters));
    double least = 2.0;
    for (const Front& f : close[i]) least = std::min(least, std::max(f.gap * f.curvature, 1e-12));
    result.relative_gap.push_back(least);
  }
  return result;
}

}  // namespace stokes
