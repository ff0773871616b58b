#include "shape.hpp"

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

// e^{it} - 1 - it, each part to its own relative accuracy.
Complex exponential_remainder(double t) {
  const double half = std::sin(0.5 * t);
  double imaginary = std::sin(t) - t;
  if (std::abs(t) < 0.3) {
    imaginary = 0.0;
    double term = -t;
    for (int k = 2; k < 14; k += 2) imaginary += term *= -t * t / (k * (k + 1.0));
    imaginary = -imaginary;
  }
  return {-2.0 * half * half, imaginary};
}

}  // namespace

double Shape::parameter(Complex n) const {
  const Complex p = support(n).point;
  const double alpha = std::atan2(p.imag() / b, p.real() / a);
  return alpha < 0.0 ? alpha + 2.0 * pi : alpha;
}

Complex Shape::point(double alpha) const { return {a * std::cos(alpha), b * std::sin(alpha)}; }

Complex Shape::derivative(double alpha) const { return {-a * std::sin(alpha), b * std::cos(alpha)}; }

// zeta = Sum_k c_k e^{i k alpha} with c_1 = (a + b)/2, c_-1 = (a - b)/2. The part zeta' t is along the tangent, and
// Sum_k c_k e^{i k alpha} (e^{ikt} - 1 - ikt) is left.
Complex Shape::offset(double alpha, double t) const {
  const Complex slope = derivative(alpha), turn = std::polar(1.0, alpha), rest = exponential_remainder(t);
  const double speed = std::abs(slope);
  const Complex bend = 0.5 * (a + b) * turn * rest + 0.5 * (a - b) * std::conj(turn * rest);
  return std::conj(slope / speed) * bend + speed * t;
}

Curve Shape::curve(const Discretisation& nodes, int upsampling) const {
  const std::vector<MappedNode> mapped = NodeMap(nodes).at_equal_steps(nodes.size() * upsampling);
  const auto n = static_cast<Eigen::Index>(mapped.size());
  ComplexVector position(n), first(n), second(n);
  CurveClusters clusters;
  for (const NodeCluster& c : nodes.clusters) {
    const Complex slope = derivative(c.alpha);
    clusters.tangent.push_back(slope / std::abs(slope));
  }
  for (Eigen::Index k = 0; k < n; ++k) {
    const MappedNode& node = mapped[k];
    position[k] = point(node.alpha);
    first[k] = derivative(node.alpha) * node.first;
    second[k] = derivative(node.alpha) * node.second - position[k] * (node.first * node.first);
    if (node.cluster < 0) continue;
    clusters.nearest.push_back(node.cluster);
    clusters.offset.push_back(offset(nodes.clusters[node.cluster].alpha, node.distance));
  }
  return Curve(std::move(position), std::move(first), std::move(second), std::move(clusters));
}

Curve Shape::curve(int points) const { return curve(Discretisation{points, {}}); }

}  // namespace stokes
