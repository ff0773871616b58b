#include "cauchy.hpp"

#include <limits>
#include <numeric>

#include "fourier.hpp"

namespace stokes {

namespace {

// Of a linear map that commutes with turning the nodes, from the image of the first unit vector: the image of each
// next one is turned by as many more nodes. All maps here take real values to real ones.
Matrix matrix_of_map(const ComplexVector& first, int columns) {
  const Eigen::Index rows = first.size(), step = rows / columns;
  Matrix m(rows, columns);
  for (Eigen::Index k = 0; k < columns; ++k) {
    m.col(k).tail(rows - k * step) = first.real().head(rows - k * step);
    m.col(k).head(k * step) = first.real().tail(k * step);
  }
  return m;
}

// [Re M^T; Im M^T].
Matrix stacked_transpose(const ComplexMatrix& M) {
  Matrix stacked(2 * M.cols(), M.rows());
  stacked << M.real().transpose(), M.imag().transpose();
  return stacked;
}

// M^T W by one product of real matrices, with which Eigen is faster than with complex ones.
ComplexMatrix product(const Matrix& stacked, const ComplexMatrix& W) {
  const Eigen::Index rows = stacked.rows() / 2, columns = W.cols();
  Matrix parts(W.rows(), 2 * columns);
  parts << W.real(), W.imag();
  const Matrix p = stacked * parts;
  ComplexMatrix result(rows, columns);
  result.real() = p.topLeftCorner(rows, columns) - p.bottomRightCorner(rows, columns);
  result.imag() = p.topRightCorner(rows, columns) + p.bottomLeftCorner(rows, columns);
  return result;
}

// Boundary values of C[tau] on the fluid side, by the compensated trapezoid rule
//   v_j = (1/2 pi i) ( Sum_{k != j} (tau_k - tau_j)/(zeta_k - zeta_j) dz_k + tau'(alpha_j) 2 pi/N ) + { tau_j inside }.
ComplexMatrix boundary_values(const Curve& curve, const ComplexVector& step, Side side) {
  const int n = curve.size();
  const Complex factor = 1.0 / (2.0 * pi * imaginary_unit);
  const ComplexVector weighted = factor * step;
  ComplexMatrix C = (factor * (2.0 * pi / n)) * matrix_of_map(fourier_derivative(ComplexVector::Unit(n, 0)), n);
  for (int j = 0; j < n; ++j) {
    Complex row_sum = 0.0;
    for (int k = 0; k < n; ++k) {
      if (k == j) continue;
      const Complex c = quotient(weighted[k], curve.position[k] - curve.position[j]);
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
  limits_ = stacked_transpose(boundary_values(fine_, step_, side));
  const ComplexVector unit = ComplexVector::Unit(n, 0);
  refine_ = matrix_of_map(fourier_upsample(unit, fine), n).transpose();
  const Matrix derivative = matrix_of_map(fourier_upsample(fourier_derivative(unit), fine), n);
  slope_ = stacked_transpose(fine_.derivative.cwiseInverse().asDiagonal() * derivative);
}

// Columns of C[tau](z), one a target, on the fine values of tau. From six fine spacings on the trapezoid rule itself is
// exact to round-off, exp(-12 pi); nearer, the boundary values are continued.
ComplexMatrix CloseEvaluation::cauchy_columns(const std::vector<Complex>& z) const {
  const Eigen::Index n = fine_.size(), targets = static_cast<Eigen::Index>(z.size());
  const double limit = 6.0 * fine_.max_spacing();
  ComplexMatrix columns(n, targets), weight(n, targets);
  std::vector<Eigen::Index> close;
  for (Eigen::Index i = 0; i < targets; ++i) {
    double smallest = limit * limit;
    for (Eigen::Index k = 0; k < n; ++k) smallest = std::min(smallest, std::norm(fine_.position[k] - z[i]));
    if (smallest < limit * limit) {
      barycentric_weights(fine_, side_, z[i], weight.col(static_cast<Eigen::Index>(close.size())));
      close.push_back(i);
    } else {
      for (Eigen::Index k = 0; k < n; ++k)
        columns(k, i) = quotient(step_[k], 2.0 * pi * imaginary_unit * (fine_.position[k] - z[i]));
    }
  }
  const ComplexMatrix continued = product(limits_, weight.leftCols(static_cast<Eigen::Index>(close.size())));
  for (std::size_t r = 0; r < close.size(); ++r) columns.col(close[r]) = continued.col(static_cast<Eigen::Index>(r));
  return columns;
}

VelocityRows CloseEvaluation::velocity_rows(const std::vector<Complex>& z) const {
  const double s = side_ == Side::interior ? 1.0 : -1.0;
  ComplexMatrix columns = cauchy_columns(z);
  const Matrix direct = -s * (refine_ * columns.real());
  for (Eigen::Index i = 0; i < columns.cols(); ++i)
    for (Eigen::Index k = 0; k < columns.rows(); ++k) columns(k, i) *= std::conj(z[i] - fine_.position[k]);
  return {direct.transpose(), (0.5 * s) * product(slope_, columns).adjoint()};
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
