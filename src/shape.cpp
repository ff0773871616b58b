#include "shape.hpp"

#include <algorithm>
#include <cmath>

#include "curve.hpp"

namespace stokes {

// h = sqrt(a^2 x^2 + b^2 y^2), p = (a^2 x, b^2 y) / h, h + h'' = a^2 b^2 / h^3.
Support Shape::support(Complex n) const {
  const double ax = a * n.real(), by = b * n.imag();
  const double height = std::sqrt(ax * ax + by * by);
  const double inverse = 1.0 / height, product = a * b * inverse;
  return {height, {a * ax * inverse, b * by * inverse}, product * product * inverse};
}

// Arithmetic-geometric mean: x, y -> (x+y)/2, sqrt(xy) from a, b, and
//   perimeter = (2 pi / mean) (a^2 - Sum_n 2^(n-1) (x_n^2 - y_n^2)),   n = 0, 1, ...
double Shape::perimeter() const {
  double x = circumradius(), y = inradius(), sum = x * x, factor = 0.5;
  while (x - y > 1e-9 * x) {  // the next term is below round-off
    sum -= factor * (x * x - y * y);
    factor *= 2.0;
    const double mean = 0.5 * (x + y);
    y = std::sqrt(x * y);
    x = mean;
  }
  return 4.0 * pi * (sum - factor * (x * x - y * y)) / (x + y);
}

namespace {

// The map s(alpha) and its first two derivatives.
struct ParameterMap {
  double s, first, second;
};

// Without the constant that makes s = 0 at alpha = 0.
ParameterMap parameter_map(double alpha, const std::vector<NodeCluster>& clusters) {
  ParameterMap map{alpha, 1.0, 0.0};
  for (const NodeCluster& c : clusters) {
    const double r = (c.density - 1.0) / (c.density + 1.0), x = alpha - c.alpha, sine = std::sin(x), cosine = std::cos(x);
    const double q = 1.0 - 2.0 * r * cosine + r * r, slope = (1.0 - r * r) / q;
    map.s += x + 2.0 * std::atan2(r * sine, 1.0 - r * cosine);
    map.first += slope;
    map.second -= slope * 2.0 * r * sine / q;
  }
  const double scale = 1.0 / (1.0 + static_cast<double>(clusters.size()));
  return {scale * map.s, scale * map.first, scale * map.second};
}

}  // namespace

double Shape::position_of(double alpha, const Discretisation& nodes) {
  if (nodes.clusters.empty()) return alpha;
  return parameter_map(alpha, nodes.clusters).s - parameter_map(0.0, nodes.clusters).s;
}

// Newton's method from where the node before points to, kept between bounds that it narrows; s increases with alpha.
std::vector<double> Shape::parameters(const Discretisation& nodes) {
  const int n = nodes.size();
  const double spacing = 2.0 * pi / n;
  std::vector<double> alpha(n);
  if (nodes.clusters.empty()) {
    for (int k = 0; k < n; ++k) alpha[k] = spacing * k;
    return alpha;
  }
  ParameterMap map = parameter_map(0.0, nodes.clusters);
  const double start = map.s;
  for (int k = 1; k < n; ++k) {
    const double s = start + spacing * k;
    double low = alpha[k - 1], high = 2.0 * pi, x = std::min(low + spacing / map.first, high);
    for (int iteration = 0; iteration < 100; ++iteration) {
      map = parameter_map(x, nodes.clusters);
      const double step = (s - map.s) / map.first, next = x + step;
      if (std::abs(step) <= 1e-10) {  // what is left is of the order of its square
        x = next;
        break;
      }
      (map.s < s ? low : high) = x;
      x = next > low && next < high ? next : 0.5 * (low + high);
    }
    alpha[k] = x;
  }
  return alpha;
}

Curve Shape::curve(const Discretisation& nodes) const {
  const int n = nodes.size();
  ComplexVector position(n), first(n), second(n);
  const std::vector<double> parameter = parameters(nodes);
  for (int k = 0; k < n; ++k) {
    const double c = std::cos(parameter[k]), s = std::sin(parameter[k]);
    position[k] = {a * c, b * s};
    first[k] = {-a * s, b * c};
    second[k] = -position[k];
    if (nodes.clusters.empty()) continue;
    const ParameterMap map = parameter_map(parameter[k], nodes.clusters);
    first[k] /= map.first;
    second[k] = (second[k] / map.first - first[k] * map.second / map.first) / map.first;
  }
  return Curve(std::move(position), std::move(first), second);
}

Curve Shape::curve(int points) const { return curve(Discretisation{points, {}}); }

}  // namespace stokes
