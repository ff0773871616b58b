#include "node_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base.hpp"

namespace stokes {

namespace {

double arithmetic_geometric_mean(double x, double y) {
  while (std::abs(x - y) > 1e-15 * x) {
    const double mean = 0.5 * (x + y);
    y = std::sqrt(x * y);
    x = mean;
  }
  return x;
}

// Carlson's R_F by duplication, to round-off: differences shrink by four each time, and the series of the remainder is
// that of order five (DLMF 19.36.1).
double carlson_rf(double x, double y, double z) {
  double mean, dx, dy, dz;
  do {
    const double a = std::sqrt(x), b = std::sqrt(y), c = std::sqrt(z), lambda = a * b + b * c + c * a;
    x = 0.25 * (x + lambda), y = 0.25 * (y + lambda), z = 0.25 * (z + lambda);
    mean = (x + y + z) / 3.0;
    dx = 1.0 - x / mean, dy = 1.0 - y / mean, dz = 1.0 - z / mean;
  } while (std::max({std::abs(dx), std::abs(dy), std::abs(dz)}) > 2e-3);
  const double e2 = dx * dy - dz * dz, e3 = dx * dy * dz;
  return (1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0) / std::sqrt(mean);
}

}  // namespace

int Discretisation::size() const {
  int count = points;
  for (const NodeCluster& c : clusters) count += c.points;
  return count;
}

// I(t) = sign(t) (2 m/w) R_F(c, c + 1, c + 1 + 4/w^2), c = cot^2(t/2), and I(t + 2 pi) = I(t) + 2 pi.
double NodeMap::Kernel::integral(double t) const {
  const double turns = std::round(t / (2.0 * pi)), rest = t - 2.0 * pi * turns;
  if (rest == 0.0) return 2.0 * pi * turns;
  const double cotangent = std::cos(0.5 * rest) / std::sin(0.5 * rest), c = cotangent * cotangent;
  const double part = 2.0 * scale / width * carlson_rf(c, c + 1.0, c + 1.0 + 4.0 / (width * width));
  return 2.0 * pi * turns + std::copysign(part, rest);
}

double NodeMap::Kernel::value(double t) const { return scale / std::hypot(width, 2.0 * std::sin(0.5 * t)); }

double NodeMap::Kernel::slope(double t) const {
  const double distance = std::hypot(width, 2.0 * std::sin(0.5 * t));
  return -scale * std::sin(t) / (distance * distance * distance);
}

NodeMap::NodeMap(const Discretisation& nodes) {
  for (const NodeCluster& c : nodes.clusters) {
    const double share = static_cast<double>(c.points) / nodes.points;
    const double scale = arithmetic_geometric_mean(std::sqrt(c.width * c.width + 4.0), c.width);
    kernels_.push_back({c.alpha, c.width, scale, share, 0.0});
    total_ += share;
  }
  start_ = sum(0.0);
  for (Kernel& k : kernels_) k.position = position(k.alpha);
  for (std::size_t k = 0; k < kernels_.size(); ++k)
    for (std::size_t l = 0; l < kernels_.size(); ++l) between_.push_back(kernels_[l].integral(apart(k, l)));
}

// Without the constant that makes s = 0 at alpha = 0.
double NodeMap::sum(double alpha) const {
  double result = alpha;
  for (const Kernel& k : kernels_) result += k.share * k.integral(alpha - k.alpha);
  return result / total_;
}

double NodeMap::position(double alpha) const { return kernels_.empty() ? alpha : sum(alpha) - start_; }

double NodeMap::apart(std::size_t k, std::size_t l) const { return l == k ? 0.0 : kernels_[k].alpha - kernels_[l].alpha; }

// s minus that of cluster k, at the distance t from it in alpha.
double NodeMap::from_cluster(std::size_t k, double t) const {
  double s = t;
  for (std::size_t l = 0; l < kernels_.size(); ++l)
    s += kernels_[l].share * (kernels_[l].integral(apart(k, l) + t) - between_[k * kernels_.size() + l]);
  return s / total_;
}

double NodeMap::first_derivative(std::size_t k, double t) const {
  double first = 1.0;
  for (std::size_t l = 0; l < kernels_.size(); ++l) first += kernels_[l].share * kernels_[l].value(apart(k, l) + t);
  return first / total_;
}

double NodeMap::second_derivative(std::size_t k, double t) const {
  double second = 0.0;
  for (std::size_t l = 0; l < kernels_.size(); ++l) second += kernels_[l].share * kernels_[l].slope(apart(k, l) + t);
  return second / total_;
}

// The inverse, by Halley's method for sigma in t = w sinh(sigma); around the cluster s is nearly linear in sigma. Another
// cluster on the way makes s steep there, so that steps may oscillate. They are therefore kept between bounds that become
// narrower, and a step that does not halve the error is followed by a bisection.
double NodeMap::distance_from_cluster(std::size_t k, double s, double guess) const {
  const double width = kernels_[k].width, sign = s < 0.0 ? -1.0 : 1.0;
  double low = 0.0, high = std::asinh(2.0 * pi / width), sigma = sign * std::asinh(guess / width);
  if (!(sigma > low && sigma < high)) sigma = std::abs(s) / (2.0 * pi) * high;
  double before = 4.0 * pi;
  for (int iteration = 0; iteration < 100; ++iteration) {
    const double sinh = width * std::sinh(sigma), cosh = std::hypot(width, sinh), t = sign * sinh;
    const double excess = sign * (s - from_cluster(k, t));
    const double first = first_derivative(k, t), bend = sign * second_derivative(k, t) * cosh / first + sinh / cosh;
    const double newton = excess / (first * cosh), step = newton / std::max(0.5, 1.0 + 0.5 * newton * bend);
    const double next = sigma + step;
    if (std::abs(step) <= 1e-7 * (1.0 + sigma)) return sign * width * std::sinh(next);  // the error is its cube
    (excess > 0.0 ? low : high) = sigma;
    sigma = next > low && next < high && std::abs(excess) < 0.5 * before ? next : 0.5 * (low + high);
    before = std::abs(excess);
  }
  return sign * width * std::sinh(sigma);
}

std::vector<MappedNode> NodeMap::at_equal_steps(int count) const {
  std::vector<MappedNode> nodes(count);
  double expected = 0.0;  // alpha of the next node
  for (int j = 0; j < count; ++j) {
    const double s = 2.0 * pi * j / count;
    if (kernels_.empty()) {
      nodes[j] = {s, 1.0, 0.0, -1, 0.0};
      continue;
    }
    std::size_t nearest = 0;
    double way = 4.0 * pi;
    for (std::size_t k = 0; k < kernels_.size(); ++k)
      if (const double from = std::remainder(s - kernels_[k].position, 2.0 * pi); std::abs(from) < std::abs(way))
        way = from, nearest = k;
    const double guess = std::remainder(expected - kernels_[nearest].alpha, 2.0 * pi);
    const double t = distance_from_cluster(nearest, way, guess), alpha = kernels_[nearest].alpha + t;
    const double first = first_derivative(nearest, t), second = second_derivative(nearest, t);
    nodes[j] = {alpha - 2.0 * pi * std::floor(alpha / (2.0 * pi)), 1.0 / first, -second / (first * first * first),
                static_cast<int>(nearest), t};
    const double ahead = 2.0 * pi / count;
    expected = alpha + ahead * (nodes[j].first + 0.5 * ahead * nodes[j].second);
  }
  return nodes;
}

}  // namespace stokes
