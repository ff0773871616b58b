#include "circle_evaluation.hpp"

namespace stokes {

namespace {

// The closed forms lose digits like |1 - p|^-2, one of them like 1/|p|; there the series are summed.
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
VelocityRows CircleEvaluation::velocity_rows(const std::vector<Complex>& z) const {
  const Eigen::Index n = direction_.size(), targets = static_cast<Eigen::Index>(z.size());
  const int half = static_cast<int>(n) / 2;
  const bool inside = side_ == Side::interior;
  VelocityRows rows{Matrix(targets, n), ComplexMatrix(targets, n)};
  for (Eigen::Index i = 0; i < targets; ++i) {
    const Complex q = z[i] / radius_, ratio = inside ? q : reciprocal(q);  // p is in the unit disc
    const Complex power = std::pow(ratio, half), power_before = std::pow(ratio, half - 1);
    const double depth = std::norm(q) - 1.0;
    for (Eigen::Index k = 0; k < n; ++k) {
      const double sign = k % 2 == 0 ? 1.0 : -1.0;
      const Complex e = inside ? std::conj(direction_[k]) : direction_[k], p = ratio * e;
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

}  // namespace stokes
