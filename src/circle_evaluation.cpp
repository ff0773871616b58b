#include "circle_evaluation.hpp"

#include <algorithm>
#include <numeric>

#include "fourier.hpp"

namespace stokes {

namespace {

// The closed forms lose digits like |1 - p|^-2, one of them like 1/|p|; where that is too much, the series are summed.
constexpr double near_one = 0.01, near_zero = 0.1;

// With h = N/2, given p^h and p^(h-1):
struct Series {
  Complex plain;   // Sum_{m=1}^{h-1} p^m + p^h / 2
  Complex first;   // Sum_{m=1}^{h-1} m p^(m-1)
  Complex second;  // Sum_{m=2}^{h-1} m p^(m-2)
};

Series summed(Complex p, int half, Complex last) {
  Complex plain = 0.0, second = 0.0;
  for (int m = half - 1; m >= 1; --m) {
    plain = plain * p + 1.0;
    if (m >= 2) second = second * p + static_cast<double>(m);
  }
  return {plain * p + 0.5 * last, 1.0 + second * p, second};
}

Series series(Complex p, int half, Complex last, Complex before) {
  const Complex rest = 1.0 - p;
  if (std::norm(rest) < near_one * near_one || std::norm(p) < near_zero * near_zero) return summed(p, half, last);
  const Complex inverse = reciprocal(rest);
  const double h = half;
  const Complex first = (1.0 - h * before + (h - 1.0) * last) * inverse * inverse;
  return {(p - last) * inverse + 0.5 * last, first, quotient(first - 1.0, p)};
}

}  // namespace

CircleEvaluation::CircleEvaluation(double radius, int points, Side side)
    : radius_(radius), side_(side), direction_(points) {
  for (int k = 0; k < points; ++k) direction_[k] = std::polar(1.0, 2.0 * pi * k / points);
}

// u = -(s/2) ( C[eta] + conj(C[conj(eta)]) - conj(C[conj(z - zeta) eta']) ). Powers p^h at the nodes are those of q
// with alternating sign.
VelocityRows CircleEvaluation::velocity_rows(const std::vector<Complex>& z, const std::vector<int>& nodes) const {
  const Eigen::Index targets = static_cast<Eigen::Index>(z.size()), columns = static_cast<Eigen::Index>(nodes.size());
  const int half = static_cast<int>(direction_.size()) / 2;
  const double n = static_cast<double>(direction_.size());
  const bool inside = side_ == Side::interior;
  VelocityRows rows{Matrix(targets, columns), ComplexMatrix(targets, columns)};
  for (Eigen::Index i = 0; i < targets; ++i) {
    const Complex q = z[i] / radius_, ratio = inside ? q : reciprocal(q);  // p is in the unit disc
    const Complex power = std::pow(ratio, half), power_before = std::pow(ratio, half - 1);
    const double depth = std::norm(q) - 1.0;
    for (Eigen::Index k = 0; k < columns; ++k) {
      const Complex direction = direction_[nodes[k]];
      const double sign = nodes[k] % 2 == 0 ? 1.0 : -1.0;
      const Complex e = inside ? std::conj(direction) : direction, p = ratio * e;
      const Series s = series(p, half, sign * power, sign * power_before * std::conj(e));
      if (inside) {
        rows.direct(i, k) = -(1.0 + s.plain.real()) / n;
        rows.conjugate(i, k) = 0.5 / n * std::conj(std::conj(q) * e + depth * e * e * s.second);
      } else {
        rows.direct(i, k) = -s.plain.real() / n;
        rows.conjugate(i, k) = -0.5 / n * std::conj(std::conj(e) * ratio + depth * ratio * ratio * p * s.first);
      }
    }
  }
  return rows;
}

VelocityRows CircleEvaluation::velocity_rows(const std::vector<Complex>& z) const {
  std::vector<int> nodes(direction_.size());
  std::iota(nodes.begin(), nodes.end(), 0);
  return velocity_rows(z, nodes);
}

// With p = q inside and 1/q outside, the series are Sum a_m p^m, Sum b_m p^m (of which the flow has the conjugate)
// and Sum d_m p^m.
CircleFlow::CircleFlow(double radius, Side side, const ComplexVector& density) : radius_(radius), side_(side) {
  ComplexVector c = fourier_coefficients(density);
  const Eigen::Index n = c.size(), half = n / 2;
  c[half] *= 0.5;  // one half for each sign of its frequency
  first_ = c[1];
  const bool inside = side == Side::interior;
  for (Eigen::Index m = 0; m <= half; ++m) {
    const Complex plus = c[m], minus = m == 0 ? c[0] : c[n - m];
    Complex a = plus, b = std::conj(minus), d = m + 2 < half ? (m + 2.0) * c[m + 2] : 0.0;
    if (!inside) {
      a = m == 0 ? 0.0 : minus, b = m == 0 ? 0.0 : std::conj(plus);
      d = m < half ? static_cast<double>(m) * minus : 0.0;
    }
    for (const Complex x : {a, b, d}) series_.push_back(x.real()), series_.push_back(x.imag());
  }
}

std::vector<Complex> CircleFlow::velocity(const std::vector<Complex>& z) const {
  const bool inside = side_ == Side::interior;
  const int count = static_cast<int>(z.size());
  std::vector<Complex> result(z.size());
  for (int first = 0; first < count; first += lanes) {
    Complex q[lanes], p[lanes];
    double x[lanes], y[lanes];
    for (int k = 0; k < lanes; ++k) {
      q[k] = z[std::min(first + k, count - 1)] / radius_;
      p[k] = inside ? q[k] : reciprocal(q[k]);
      x[k] = p[k].real(), y[k] = p[k].imag();
    }
    const Pack px = load(x), py = load(y);
    Pack sum[6] = {};
    for (std::size_t m = series_.size(); m > 0; m -= 6)
      for (int s = 0; s < 6; s += 2) {
        const Pack re = sum[s] * px - sum[s + 1] * py + series_[m - 6 + s];
        sum[s + 1] = sum[s] * py + sum[s + 1] * px + series_[m - 5 + s];
        sum[s] = re;
      }
    for (int k = 0; k < std::min(lanes, count - first); ++k) {
      const Complex even(sum[0][k] + sum[2][k], sum[1][k] - sum[3][k]), third(sum[4][k], sum[5][k]);
      const double depth = std::norm(q[k]) - 1.0;
      result[first + k] = inside ? -0.5 * (even - std::conj(std::conj(q[k]) * first_ + depth * third))
                                 : -0.5 * (even + std::conj(p[k] * first_ + depth * p[k] * p[k] * third));
    }
  }
  return result;
}

}  // namespace stokes
