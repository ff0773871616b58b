#include "cauchy.hpp"

#include <limits>
#include <numeric>

#include "fourier.hpp"

namespace stokes {

namespace {

// Columns are the images of the unit vectors under `map`.
template <class Map>
ComplexMatrix matrix_of(int columns, const Map& map) {
  ComplexMatrix m;
  for (int k = 0; k < columns; ++k) {
    const ComplexVector column = map(ComplexVector::Unit(columns, k));
    if (k == 0) m.resize(column.size(), columns);
    m.col(k) = column;
  }
  return m;
}

// Boundary values of C[tau] on the fluid side, by the compensated trapezoid rule
//   v_j = (1/2 pi i) ( Sum_{k != j} (tau_k - tau_j)/(zeta_k - zeta_j) dz_k + tau'(alpha_j) 2 pi/N ) + { tau_j inside }.
ComplexMatrix boundary_values(const Curve& curve, const ComplexVector& step, Side side) {
  const int n = curve.size();
  const Complex factor = 1.0 / (2.0 * pi * imaginary_unit);
  ComplexMatrix C = matrix_of(n, fourier_derivative) * (factor * (2.0 * pi / n));
  for (int j = 0; j < n; ++j) {
    Complex row_sum = 0.0;
    for (int k = 0; k < n; ++k) {
      if (k == j) continue;
      const Complex c = factor * step[k] / (curve.position[k] - curve.position[j]);
      C(j, k) += c;
      row_sum += c;
    }
    C(j, j) += (side == Side::interior ? 1.0 : 0.0) - row_sum;
  }
  return C;
}

}  // namespace

Curve refined(const Curve& curve, int upsampling) {
  if (upsampling == 1) return curve;
  const int fine = curve.size() * upsampling;
  const ComplexVector first = fourier_upsample(curve.derivative, fine);
  return Curve(fourier_upsample(curve.position, fine), first, fourier_derivative(first));
}

// With j the nearest node, the weights are written for the differences f_k - f_j, which keeps full accuracy as z
// approaches node j. On the exterior side the rule is applied to zeta f, which tends to a constant at infinity.
void barycentric_weights(const Curve& curve, Side side, Complex z, Eigen::Ref<ComplexVector> weight) {
  const int n = curve.size();
  const bool exterior = side == Side::exterior;
  int nearest = 0;
  double smallest = std::norm(curve.position[0] - z);
  for (int k = 1; k < n; ++k) {
    const double d = std::norm(curve.position[k] - z);
    if (d < smallest) smallest = d, nearest = k;
  }
  if (smallest < std::numeric_limits<double>::min()) {  // on the node: its reciprocal would overflow
    weight.setZero();
    weight[nearest] = 1.0;
    return;
  }
  Complex total = 0.0;
  for (int k = 0; k < n; ++k) {
    const Complex zeta = curve.position[k];
    weight[k] = quotient(exterior ? quotient(curve.derivative[k], zeta) : curve.derivative[k], zeta - z);
    total += weight[k];
  }
  const Complex scale = reciprocal(total);
  Complex others = 0.0;
  for (int k = 0; k < n; ++k) {
    if (k == nearest) continue;
    weight[k] *= scale;
    others += weight[k];
  }
  weight[nearest] = 1.0 - others;
  if (exterior)
    for (int k = 0; k < n; ++k) weight[k] *= quotient(curve.position[k], z);
}

CloseEvaluation::CloseEvaluation(const Curve& curve, Side side, int upsampling)
    : side_(side), fine_(refined(curve, upsampling)) {
  const int n = curve.size(), fine = fine_.size();
  step_ = fine_.derivative * (2.0 * pi / fine);
  C_ = boundary_values(fine_, step_, side);
  refine_ = matrix_of(n, [&](const ComplexVector& eta) { return fourier_upsample(eta, fine); }).real();
  slope_ = matrix_of(n, [&](const ComplexVector& eta) -> ComplexVector {
    return fourier_upsample(fourier_derivative(eta), fine).cwiseQuotient(fine_.derivative);
  });
}

// Row of C[tau](z) on the fine values of tau. From six fine spacings on the trapezoid rule itself is exact to
// round-off, exp(-12 pi); nearer, the boundary values are continued.
ComplexMatrix CloseEvaluation::cauchy_rows(const std::vector<Complex>& z) const {
  const Eigen::Index n = fine_.size(), targets = static_cast<Eigen::Index>(z.size());
  const double limit = 6.0 * fine_.max_spacing();
  ComplexMatrix rows(targets, n), weight(n, targets);
  std::vector<Eigen::Index> close;
  for (Eigen::Index i = 0; i < targets; ++i) {
    double smallest = limit * limit;
    for (Eigen::Index k = 0; k < n; ++k) smallest = std::min(smallest, std::norm(fine_.position[k] - z[i]));
    if (smallest < limit * limit) {
      barycentric_weights(fine_, side_, z[i], weight.col(static_cast<Eigen::Index>(close.size())));
      close.push_back(i);
    } else {
      for (Eigen::Index k = 0; k < n; ++k)
        rows(i, k) = quotient(step_[k], 2.0 * pi * imaginary_unit * (fine_.position[k] - z[i]));
    }
  }
  const ComplexMatrix continued = weight.leftCols(static_cast<Eigen::Index>(close.size())).transpose() * C_;
  for (std::size_t r = 0; r < close.size(); ++r) rows.row(close[r]) = continued.row(static_cast<Eigen::Index>(r));
  return rows;
}

VelocityRows CloseEvaluation::velocity_rows(const std::vector<Complex>& z) const {
  const double s = side_ == Side::interior ? 1.0 : -1.0;
  ComplexMatrix rows = cauchy_rows(z);
  const Matrix direct = -s * (rows.real() * refine_);
  for (Eigen::Index k = 0; k < rows.cols(); ++k)
    for (Eigen::Index i = 0; i < rows.rows(); ++i) rows(i, k) *= std::conj(z[i] - fine_.position[k]);
  return {direct, (0.5 * s) * (rows * slope_).conjugate()};
}

VelocityRows trapezoid_rows(const Curve& curve, Side side, const std::vector<Complex>& z) {
  std::vector<int> nodes(curve.size());
  std::iota(nodes.begin(), nodes.end(), 0);
  return trapezoid_rows(curve, side, z, nodes);
}

VelocityRows trapezoid_rows(const Curve& curve, Side side, const std::vector<Complex>& z, const std::vector<int>& nodes) {
  const double s = side == Side::interior ? 1.0 : -1.0;
  const auto n = static_cast<Eigen::Index>(nodes.size()), targets = static_cast<Eigen::Index>(z.size());
  VelocityRows rows{Matrix(targets, n), ComplexMatrix(targets, n)};
  for (Eigen::Index i = 0; i < targets; ++i)
    for (Eigen::Index c = 0; c < n; ++c) {
      // (1/pi)(r.n)(r.eta) r/|r|^4 w  with  (r.eta) r = (|r|^2 eta + r^2 conj(eta))/2
      const int k = nodes[c];
      const Complex r = z[i] - curve.position[k];
      const Complex normal = -imaginary_unit * s * curve.tangent[k];
      const double rr = std::norm(r), f = curve.weight[k] * dot(r, normal) / (2.0 * pi * rr);
      rows.direct(i, c) = f;
      rows.conjugate(i, c) = f * r * r / rr;
    }
  return rows;
}

}  // namespace stokes
