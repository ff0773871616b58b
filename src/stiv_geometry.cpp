#include "stiv_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace stokes {

namespace {

constexpr double touching = 1e-12;  // of the target's size: above the rounding of an accepted step's end
constexpr double corner = 1e-9;     // of an edge: above the rounding of sigma
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Box {
  double left = infinity, right = -infinity, bottom = infinity, top = -infinity;

  void add(Complex p) {
    left = std::min(left, p.real()), right = std::max(right, p.real());
    bottom = std::min(bottom, p.imag()), top = std::max(top, p.imag());
  }
  void widen(double by) { left -= by, right += by, bottom -= by, top += by; }
  bool meets(const Box& o) const {
    return left <= o.right && o.left <= right && bottom <= o.top && o.bottom <= top;
  }
  double size() const { return std::max(right - left, top - bottom); }
};

Box common(const Box& a, const Box& b) {
  return {std::max(a.left, b.left), std::min(a.right, b.right), std::max(a.bottom, b.bottom),
          std::min(a.top, b.top)};
}

Complex outward_normal(Complex edge) { return -perp(edge) / std::abs(edge); }

// The tau in [0, 1] at which c + b tau + a tau^2 falls through zero. Where a quadratic falls its slope is
// -sqrt(b^2 - 4 a c), which belongs to one root whatever the sign of a.
std::optional<double> falling_root(double c, double b, double a) {
  const double middle = c + 0.5 * b, last = c + b + a;  // with c, the Bernstein coefficients
  if (c > 0.0 && middle > 0.0 && last > 0.0) return {};
  if (c < 0.0 && middle < 0.0 && last < 0.0) return {};
  const double discriminant = b * b - 4.0 * a * c;
  if (!(discriminant > 0.0)) return {};  // at most touches zero, or constant
  const double root = std::sqrt(discriminant);
  const double tau = b > 0.0 ? -(b + root) / (2.0 * a) : 2.0 * c / (root - b);  // infinite if it only rises
  return tau >= 0.0 && tau <= 1.0 ? std::optional(tau) : std::nullopt;
}

class Target {
 public:
  explicit Target(const MovingPolygon& polygon)
      : polygon_(polygon), count_(static_cast<int>(polygon.start.size())), edge_box_(count_) {
    for (int j = 0; j < count_; ++j) {
      for (int k : {j, next(j)}) edge_box_[j].add(polygon.start[k]), edge_box_[j].add(polygon.end[k]);
      start_box_.add(polygon.start[j]);
      box_.add(polygon.start[j]), box_.add(polygon.end[j]);
    }
    tolerance_ = touching * start_box_.size();
    box_.widen(tolerance_), start_box_.widen(tolerance_);
  }

  const Box& box() const { return box_; }

  // Keeps the edges whose path meets the region.
  void restrict_to(const Box& region) {
    for (int j = 0; j < count_; ++j)
      if (edge_box_[j].meets(region)) edges_.push_back(j);
  }

  std::optional<VertexHit> first_hit(int vertex, Complex from, Complex to) const {
    if (auto hit = hit_at_start(vertex, from, to)) return hit;
    return first_entry(vertex, from, to);
  }

 private:
  int next(int j) const { return j + 1 == count_ ? 0 : j + 1; }
  int previous(int j) const { return j == 0 ? count_ - 1 : j - 1; }
  Complex at(int j, double tau) const { return (1.0 - tau) * polygon_.start[j] + tau * polygon_.end[j]; }
  Complex normal(int j, double tau) const { return outward_normal(at(next(j), tau) - at(j, tau)); }

  std::optional<VertexHit> finish(int vertex, Complex to, double tau, int edge, double sigma) const {
    Complex n = normal(edge, tau);
    if (sigma <= corner) sigma = 0.0, n += normal(previous(edge), tau);
    if (sigma >= 1.0 - corner) sigma = 1.0, n += normal(next(edge), tau);
    n /= std::abs(n);
    const Complex end = (1.0 - sigma) * polygon_.end[edge] + sigma * polygon_.end[next(edge)];
    const double interval = dot(n, to - end);
    if (!(interval < 0.0)) return {};
    return VertexHit{vertex, edge, tau, sigma, n, interval};
  }

  // Outward distance of a point from the line of edge j at tau = 0.
  double distance(int j, Complex point) const {
    return dot(normal(j, 0.0), point - polygon_.start[j]);
  }

  std::optional<VertexHit> hit_at_start(int vertex, Complex from, Complex to) const {
    Box point;
    point.add(from);
    if (!point.meets(start_box_)) return {};
    int nearest = 0;
    double largest = -infinity;
    for (int j = 0; j < count_; ++j) {
      const double d = distance(j, from);
      if (d > tolerance_) return {};
      if (d > largest) largest = d, nearest = j;
    }
    const Complex edge = polygon_.start[next(nearest)] - polygon_.start[nearest];
    const double tie = corner * std::abs(edge);
    double sigma = std::clamp(dot(from - polygon_.start[nearest], edge) / std::norm(edge), 0.0, 1.0);
    // Equally far from two edges: their corner stands for both.
    if (distance(previous(nearest), from) >= largest - tie) sigma = 0.0;
    if (distance(next(nearest), from) >= largest - tie) sigma = 1.0;
    return finish(vertex, to, 0.0, nearest, sigma);
  }

  std::optional<VertexHit> first_entry(int vertex, Complex from, Complex to) const {
    Box way;
    way.add(from), way.add(to);
    const Complex displacement = to - from;
    double earliest = infinity, sigma_there = 0.0;
    int edge = -1;
    for (int j : edges_) {
      if (!way.meets(edge_box_[j])) continue;
      const int k = next(j);
      const Complex a0 = from - polygon_.start[j], a1 = displacement - (polygon_.end[j] - polygon_.start[j]);
      const Complex e0 = polygon_.start[k] - polygon_.start[j];
      const Complex e1 = polygon_.end[k] - polygon_.end[j] - e0;
      const auto tau = falling_root(cross(a0, e0), cross(a0, e1) + cross(a1, e0), cross(a1, e1));
      if (!tau || *tau >= earliest) continue;
      const Complex e = e0 + *tau * e1;
      const double sigma = dot(a0 + *tau * a1, e) / std::norm(e);
      if (sigma >= -corner && sigma <= 1.0 + corner) earliest = *tau, edge = j, sigma_there = sigma;
    }
    if (edge < 0) return {};
    return finish(vertex, to, earliest, edge, sigma_there);
  }

  const MovingPolygon& polygon_;
  int count_;
  double tolerance_ = 0.0;
  std::vector<Box> edge_box_;
  Box box_, start_box_;
  std::vector<int> edges_;
};

}  // namespace

std::vector<VertexHit> vertex_hits(const MovingPolygon& moving, const MovingPolygon& target) {
  const std::size_t count = moving.start.size();
  Box box;
  for (std::size_t k = 0; k < count; ++k) box.add(moving.start[k]), box.add(moving.end[k]);
  Target goal(target);
  const Box region = common(box, goal.box());
  std::vector<VertexHit> hits;
  if (!region.meets(region)) return hits;  // turned inside out: the boxes do not meet
  goal.restrict_to(region);
  for (std::size_t k = 0; k < count; ++k) {
    Box way;
    way.add(moving.start[k]), way.add(moving.end[k]);
    if (!way.meets(region)) continue;
    if (const auto hit = goal.first_hit(static_cast<int>(k), moving.start[k], moving.end[k]))
      hits.push_back(*hit);
  }
  return hits;
}

std::vector<WallHit> wall_hits(const MovingPolygon& moving, double radius) {
  std::vector<WallHit> hits;
  for (std::size_t k = 0; k < moving.start.size(); ++k) {
    const Complex from = moving.start[k], to = moving.end[k], way = to - from;
    if (!(std::abs(to) > radius)) continue;
    // Backwards from the end: |to - s way| = radius at s = 1 - tau, the smaller root of a s^2 - 2 b s + c, c > 0.
    const double a = dot(way, way), b = dot(way, to);
    const double c = (std::abs(to) - radius) * (std::abs(to) + radius), discriminant = b * b - a * c;
    const double rest = b > 0.0 && discriminant >= 0.0 ? c / (b + std::sqrt(discriminant)) : infinity;
    const Complex there = rest <= 1.0 ? to - rest * way : to;
    const Complex normal = -there / std::abs(there), point = -radius * normal;
    const double interval = dot(normal, to - point);
    if (interval < 0.0) hits.push_back({static_cast<int>(k), rest <= 1.0 ? 1.0 - rest : 0.0, normal, point, interval});
  }
  return hits;
}

}  // namespace stokes
