#include "refinement.hpp"

#include <algorithm>
#include <cmath>

#include "container_gap.hpp"
#include "neighbours.hpp"

namespace stokes {

namespace {

// The spacing wanted, in units of w; a cluster is worth its nodes from this excess on, and up to this density
// (gaps of a thousandth of a semi-axis).
constexpr double wanted_spacing = 0.6, least_density = 1.5, largest_density = 60.0;

// Adds a cluster where `body` faces a neighbour in direction n (laboratory frame), if its nodes are too sparse.
void add_cluster(const Body& body, Complex n, double width, double fineness, Discretisation& nodes) {
  const Complex axis = body.pose.axis();
  const Complex p = body.shape.support(std::conj(axis) * n).point;
  const double c = p.real() / body.shape.a, s = p.imag() / body.shape.b;
  const double spacing = std::hypot(body.shape.a * s, body.shape.b * c) * 2.0 * pi / nodes.points;
  const double excess = spacing * fineness / (wanted_spacing * width);
  if (excess < least_density) return;
  const double density = std::clamp(excess - 1.0, 1.0, largest_density);
  const double alpha = std::atan2(s, c);
  nodes.clusters.push_back({alpha < 0.0 ? alpha + 2.0 * pi : alpha, density});
}

// Of clusters that overlap the densest is kept.
void merge(std::vector<NodeCluster>& clusters) {
  std::stable_sort(clusters.begin(), clusters.end(),
                   [](const NodeCluster& a, const NodeCluster& b) { return a.density > b.density; });
  std::vector<NodeCluster> kept;
  for (const NodeCluster& c : clusters) {
    const bool covered = std::any_of(kept.begin(), kept.end(), [&c](const NodeCluster& k) {
      return std::abs(std::remainder(c.alpha - k.alpha, 2.0 * pi)) < 2.0 / (1.0 + k.density);
    });
    if (!covered) kept.push_back(c);
  }
  std::sort(kept.begin(), kept.end(), [](const NodeCluster& a, const NodeCluster& b) { return a.alpha < b.alpha; });
  clusters = std::move(kept);
}

}  // namespace

std::vector<Discretisation> refined_nodes(const Suspension& bodies, int points, double fineness) {
  std::vector<Discretisation> nodes;
  std::vector<Complex> centres;
  std::vector<double> radii;
  double reach = 0.0;
  for (const Body& body : bodies) {
    nodes.push_back({body.points > 0 ? body.points : points, {}});
    centres.push_back(body.pose.centre);
    radii.push_back(body.shape.circumradius());
    // Beyond, w >= g is more than the widest spacing asks for.
    if (body.points == 0)
      reach = std::max(reach, 2.0 * pi * radii.back() / points * fineness / (wanted_spacing * least_density));
  }
  for (const auto& [i, j] : neighbour_pairs(centres, centres, radii, reach)) {
    const Body &a = bodies[i], &b = bodies[j];
    const Gap between = gap(a, b);
    const double g = std::max(between.value, 0.0);
    const double radius_a = a.shape.support(std::conj(a.pose.axis()) * between.normal).curvature_radius;
    const double radius_b = b.shape.support(std::conj(b.pose.axis()) * -between.normal).curvature_radius;
    const double width = std::sqrt(2.0 * g * radius_a * radius_b / (radius_a + radius_b) + g * g);
    if (a.points == 0) add_cluster(a, between.normal, width, fineness, nodes[i]);
    if (b.points == 0) add_cluster(b, -between.normal, width, fineness, nodes[j]);
  }
  if (bodies.container) {
    const Container& wall = *bodies.container;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (bodies[i].points > 0) continue;
      const Gap between = gap(bodies[i], wall);
      const double g = std::max(between.value, 0.0);
      if (g > reach) continue;
      const Support support = bodies[i].shape.support(std::conj(bodies[i].pose.axis()) * between.normal);
      const double curvature = std::max(1.0 / support.curvature_radius - 1.0 / wall.radius, 0.0);
      const double width = std::sqrt(2.0 * g / std::max(curvature, 1e-6) + g * g);
      add_cluster(bodies[i], between.normal, width, fineness, nodes[i]);
    }
  }
  for (Discretisation& d : nodes) merge(d.clusters);
  return nodes;
}

}  // namespace stokes
