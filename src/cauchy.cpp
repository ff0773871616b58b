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

// M W of a real and a complex matrix, by one product of real ones.
ComplexMatrix product(const Matrix& M, const ComplexMatrix& W) {
  Matrix parts(W.rows(), 2 * W.cols());
  parts << W.real(), W.imag();
  const Matrix p = M * parts;
  ComplexMatrix result(M.rows(), W.cols());
  result.real() = p.leftCols(W.cols());
  result.imag() = p.rightCols(W.cols());
  return result;
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
    : side_(side), fine_(refined(curve, upsampling)), slope_(fine_.derivative.cwiseInverse()),
      poles_(ComplexVector::Zero(fine_.size())) {
  const int n = curve.size(), fine = fine_.size();
  for (int k = 0; k < fine; ++k)
    for (int j = 0; j < fine; ++j)
      if (j != k) poles_[k] += quotient(fine_.derivative[j], fine_.position[k] - fine_.position[j]);
  const ComplexVector unit = ComplexVector::Unit(n, 0);
  differentiate_ = matrix_of_map(fourier_derivative(ComplexVector::Unit(fine, 0)), fine).transpose();
  refine_ = matrix_of_map(fourier_upsample(unit, fine), n).transpose();
  refine_derivative_ = matrix_of_map(fourier_upsample(fourier_derivative(unit), fine), n).transpose();
}

// Columns of C[tau](z), one a target, on the fine values of tau. From six fine spacings on the trapezoid rule itself is
// exact to round-off, exp(-12 pi). Nearer, boundary values v_j are continued with barycentric weights w_j, the v_j by
// the compensated trapezoid rule on the fluid side,
//   v_j = (1/2 pi i) ( Sum_{k != j} (tau_k - tau_j)/(zeta_k - zeta_j) dz_k + tau'(alpha_j) 2 pi/N ) + { tau_j inside }.
// The weights being a common factor times p_j = zeta'_j/(zeta_j - z), partial fractions leave of the double sum
//   Sum_j w_j v_j = (1/i N) Sum_k tau_k w_k ( Sum_{j != k} p_j + 2 Sum_{j != k} zeta'_j/(zeta_k - zeta_j) )
//                   + (1/i N) Sum_j w_j tau'(alpha_j) + { Sum_j w_j tau_j inside }.
ComplexMatrix CloseEvaluation::cauchy_columns(const std::vector<Complex>& z) const {
  const Eigen::Index n = fine_.size(), targets = static_cast<Eigen::Index>(z.size());
  const double limit = 6.0 * fine_.max_spacing();
  const Complex factor = 1.0 / (static_cast<double>(n) * imaginary_unit);
  ComplexMatrix columns(n, targets), weight(n, targets);
  ComplexVector p(n);
  std::vector<Eigen::Index> close;
  for (Eigen::Index i = 0; i < targets; ++i) {
    Eigen::Index nearest = 0;
    const double smallest = (fine_.position.array() - z[i]).abs2().minCoeff(&nearest);
    for (Eigen::Index k = 0; k < n; ++k) p[k] = quotient(fine_.derivative[k], fine_.position[k] - z[i]);
    if (smallest >= limit * limit) {
      columns.col(i) = factor * p;
      continue;
    }
    auto w = weight.col(static_cast<Eigen::Index>(close.size()));
    barycentric_weights(fine_, side_, z[i], w);
    close.push_back(i);
    p[nearest] = 0.0;  // it may be infinite; w_k times it is w of the nearest times p_k
    const Complex others = p.sum();
    for (Eigen::Index k = 0; k < n; ++k)
      columns(k, i) = factor * (w[k] * (others - p[k] + 2.0 * poles_[k]) + w[nearest] * p[k]);
    if (side_ == Side::interior) columns.col(i) += w;
  }
  const ComplexMatrix derivative = product(differentiate_, weight.leftCols(static_cast<Eigen::Index>(close.size())));
  for (std::size_t r = 0; r < close.size(); ++r)
    columns.col(close[r]) += factor * derivative.col(static_cast<Eigen::Index>(r));
  return columns;
}

VelocityRows CloseEvaluation::velocity_rows(const std::vector<Complex>& z) const {
  const double s = side_ == Side::interior ? 1.0 : -1.0;
  ComplexMatrix columns = cauchy_columns(z);
  const Matrix direct = -s * (refine_ * columns.real());
  for (Eigen::Index i = 0; i < columns.cols(); ++i)
    for (Eigen::Index k = 0; k < columns.rows(); ++k)
      columns(k, i) *= std::conj(z[i] - fine_.position[k]) * slope_[k];
  return {direct.transpose(), (0.5 * s) * product(refine_derivative_, columns).adjoint()};
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
  for (Eigen::Index c = 0; c < n; ++c) {
    // (1/pi)(r.n)(r.eta) r/|r|^4 w  with  (r.eta) r = (|r|^2 eta + r^2 conj(eta))/2
    const int k = nodes[c];
    const Complex normal = -imaginary_unit * (s * curve.weight[k] / (2.0 * pi)) * curve.tangent[k];
    for (Eigen::Index i = 0; i < targets; ++i) {
      const Complex r = z[i] - curve.position[k];
      const double over = 1.0 / std::norm(r), f = dot(r, normal) * over;
      rows.direct(i, c) = f;
      rows.conjugate(i, c) = f * over * (r * r);
    }
  }
  return rows;
}

}  // namespace stokes
