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

// Of the mobility across a gap.
constexpr double largest_mobility_error = 0.1;

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

// What a body has in front of it.
struct Facing {
  int body;
  Complex normal;    // outwards, laboratory frame
  double gap;        // 0 for overlap
  double curvature;  // of the gap: the sum of those of the two boundaries

  double width() const { return std::sqrt(2.0 * gap / std::max(curvature, 1e-6) + gap * gap); }
  // Across the gap, of the lubrication between the two curvatures.
  double mobility() const { return std::pow(gap * curvature, 1.5) / (3.0 * std::sqrt(2.0) * pi); }
};

// The error of the mobility of an ellipse with N nodes at equal steps, as measured at a wall along a flank.
double mobility_error(const Shape& shape, int points) {
  return 0.15 * std::exp(-points * std::atanh(shape.inradius() / shape.circumradius()));
}

// Of a body with nodes of its own, those stay.
bool has_own_nodes(const Body& body) { return body.points > 0; }

// Twice and four times as many where the error is not small beside the mobility.
void add_points(const Body& body, const Facing& facing, int least, double fineness, Discretisation& nodes) {
  while (nodes.points < 4 * least &&
         mobility_error(body.shape, nodes.points) * fineness > largest_mobility_error * facing.mobility())
    nodes.points *= 2;
}

// The pairs of what may be too close for the nodes, either way round; walls face nobody.
std::vector<Facing> facings(const Suspension& bodies, int points, double fineness) {
  std::vector<Complex> centres;
  std::vector<double> radii;
  double reach = 0.0;
  for (const Body& body : bodies) {
    centres.push_back(body.pose.centre);
    radii.push_back(body.shape.circumradius());
    if (has_own_nodes(body)) continue;
    // Beyond, w >= g is more than the widest spacing asks for, and even the mobility along two flanks exceeds the error.
    const double flank = radii.back() * radii.back() / body.shape.inradius();
    const double mobility = mobility_error(body.shape, points) * fineness / largest_mobility_error;
    reach = std::max({reach, 2.0 * pi * radii.back() / points * fineness / (wanted_spacing * least_density),
                      flank * std::pow(3.0 * std::sqrt(2.0) * pi * mobility, 2.0 / 3.0)});
  }
  std::vector<Facing> result;
  for (const auto& [i, j] : neighbour_pairs(centres, centres, radii, reach)) {
    const Body &a = bodies[i], &b = bodies[j];
    const Gap between = gap(a, b);
    const double curvature = 1.0 / a.shape.support(std::conj(a.pose.axis()) * between.normal).curvature_radius +
                             1.0 / b.shape.support(std::conj(b.pose.axis()) * -between.normal).curvature_radius;
    const double g = std::max(between.value, 0.0);
    if (!has_own_nodes(a)) result.push_back({i, between.normal, g, curvature});
    if (!has_own_nodes(b)) result.push_back({j, -between.normal, g, curvature});
  }
  for (std::size_t i = 0; bodies.container && i < bodies.size(); ++i) {
    const Body& body = bodies[i];
    if (has_own_nodes(body)) continue;
    const Gap between = gap(body, *bodies.container);
    if (between.value > reach) continue;
    const Support support = body.shape.support(std::conj(body.pose.axis()) * between.normal);
    result.push_back({static_cast<int>(i), between.normal, std::max(between.value, 0.0),
                      std::max(1.0 / support.curvature_radius - 1.0 / bodies.container->radius, 0.0)});
  }
  return result;
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

std::vector<Discretisation> equal_nodes(const Suspension& bodies, int points) {
  std::vector<Discretisation> nodes;
  for (const Body& body : bodies) nodes.push_back({has_own_nodes(body) ? body.points : points, {}});
  return nodes;
}

std::vector<Discretisation> refined_nodes(const Suspension& bodies, int points, double fineness) {
  std::vector<Discretisation> nodes = equal_nodes(bodies, points);
  const std::vector<Facing> close = facings(bodies, points, fineness);
  for (const Facing& f : close) add_points(bodies[f.body], f, points, fineness, nodes[f.body]);
  for (const Facing& f : close) add_cluster(bodies[f.body], f.normal, f.width(), fineness, nodes[f.body]);
  for (Discretisation& d : nodes) merge(d.clusters);
  return nodes;
}

}  // namespace stokes
