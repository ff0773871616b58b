#include "cauchy.hpp"

#include <cmath>
#include <numeric>

#include "fourier.hpp"

namespace stokes {

namespace {

// The matrix of a linear map that commutes with rotations of the nodes, from the image of the first unit vector. The images
// of the others are rotations of it. All maps here take real values to real values.
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

PoleTerms pole_terms(const Curve& curve, const Target& z) {
  PoleTerms terms;
  terms.difference = curve.from(z);
  terms.distance = std::sqrt(terms.difference.array().abs2().minCoeff(&terms.nearest));
  terms.p.resize(curve.size());
  for (Eigen::Index k = 0; k < curve.size(); ++k) terms.p[k] = quotient(curve.derivative[k], terms.difference[k]);
  terms.p[terms.nearest] = 0.0;
  terms.others = terms.p.sum();
  return terms;
}

std::vector<Target> targets(const std::vector<Complex>& z) {
  std::vector<Target> result;
  for (const Complex point : z) result.push_back({point});
  return result;
}

Complex winding(const Curve& curve, Side side) {
  Complex sum = 0.0;
  for (Eigen::Index k = 0; side == Side::exterior && k < curve.size(); ++k)
    sum += quotient(curve.derivative[k], curve.position[k]);
  return sum;
}

// p_k / Sum_k p_k, and p_k / (Sum_k p_k - winding) on the exterior side, where the rule is applied to zeta f, which tends
// to a constant at infinity. Both are divided by p of the nearest node, which may be infinite.
void barycentric_weights(const Curve& curve, Complex winding, const PoleTerms& terms,
                         Eigen::Ref<ComplexVector> weight) {
  const Eigen::Index j = terms.nearest;
  const Complex over_nearest = quotient(terms.difference[j], curve.derivative[j]);
  const Complex of_nearest = reciprocal(1.0 + (terms.others - winding) * over_nearest);
  weight = (over_nearest * of_nearest) * terms.p;
  weight[j] = of_nearest;
}

CloseEvaluation::CloseEvaluation(const Curve& curve, Side side, int upsampling)
    : CloseEvaluation(curve, refined(curve, upsampling), side) {}

CloseEvaluation::CloseEvaluation(const Curve& curve, Curve fine_curve, Side side)
    : side_(side), fine_(std::move(fine_curve)), winding_(winding(fine_, side)), slope_(fine_.derivative.cwiseInverse()),
      bend_(-fine_.second.cwiseProduct(slope_.cwiseProduct(slope_))), poles_(ComplexVector::Zero(fine_.size())) {
  const int n = curve.size(), fine = fine_.size();
  for (int k = 0; k < fine; ++k) {
    const ComplexVector difference = fine_.from(fine_.node(k));
    for (int j = 0; j < fine; ++j)
      if (j != k) poles_[k] -= quotient(fine_.derivative[j], difference[j]);
  }
  const ComplexVector unit = fourier_upsample(ComplexVector::Unit(n, 0), fine), first = fourier_derivative(unit);
  refine_ = matrix_of_map(unit, n).transpose();
  refine_derivative_ = matrix_of_map(first, n).transpose();
  refine_second_ = matrix_of_map(fourier_derivative(first), n).transpose();
}

// From six fine spacings on the trapezoid rule itself is exact to round-off, exp(-12 pi). At nearer targets, boundary
// values v_j are continued with barycentric weights w_j. The compensated trapezoid rule gives the v_j on the fluid side,
//   v_j = (1/2 pi i) ( Sum_{k != j} (tau_k - tau_j)/(zeta_k - zeta_j) dz_k + tau_alpha,j 2 pi/N ) + { tau_j inside }.
// The weights are a common factor times p_j = zeta'_j/(zeta_j - z), so that partial fractions reduce the double sum to
//   Sum_j w_j v_j = (1/i N) Sum_k tau_k w_k ( Sum_{j != k} p_j + 2 Sum_{j != k} zeta'_j/(zeta_k - zeta_j) )
//                   + (1/i N) Sum_j w_j tau_alpha,j + { Sum_j w_j tau_j inside }.
CloseEvaluation::CauchyColumns CloseEvaluation::cauchy_columns(const std::vector<Target>& z) const {
  const Eigen::Index n = fine_.size(), targets = static_cast<Eigen::Index>(z.size());
  const double limit = 6.0 * fine_.max_spacing();
  const Complex factor = 1.0 / (static_cast<double>(n) * imaginary_unit);
  CauchyColumns columns{ComplexMatrix(n, targets), ComplexMatrix(n, targets), ComplexMatrix(n, targets), {}};
  ComplexVector w(n);
  for (Eigen::Index i = 0; i < targets; ++i) {
    const PoleTerms terms = pole_terms(fine_, z[i]);
    columns.difference.col(i) = terms.difference;
    auto of_value = columns.of_value.col(i);
    if (terms.distance >= limit) {
      of_value = factor * terms.p;
      of_value[terms.nearest] = factor * quotient(fine_.derivative[terms.nearest], terms.difference[terms.nearest]);
      continue;
    }
    barycentric_weights(fine_, winding_, terms, w);
    // p of the nearest may be infinite; w_k times it is w of the nearest times p_k.
    of_value = factor * (w.array() * (terms.others - terms.p.array() + 2.0 * poles_.array()) +
                         w[terms.nearest] * terms.p.array()).matrix();
    if (side_ == Side::interior) of_value += w;
    columns.of_derivative.col(static_cast<Eigen::Index>(columns.close.size())) = factor * w;
    columns.close.push_back(i);
  }
  columns.of_derivative.conservativeResize(Eigen::NoChange, static_cast<Eigen::Index>(columns.close.size()));
  return columns;
}

// tau = eta, and tau = conj(z - zeta) eta_alpha/zeta_alpha with the product rule for its derivative.
VelocityRows CloseEvaluation::velocity_rows(const std::vector<Target>& z) const {
  const double s = side_ == Side::interior ? 1.0 : -1.0;
  auto [of_value, of_derivative, difference, close] = cauchy_columns(z);
  Matrix direct = refine_ * of_value.real();
  const Matrix direct_close = refine_derivative_ * of_derivative.real();
  for (Eigen::Index i = 0; i < of_value.cols(); ++i)
    of_value.col(i).array() *= -difference.col(i).array().conjugate() * slope_.array();
  for (std::size_t r = 0; r < close.size(); ++r) {
    const Eigen::Index i = close[r];
    direct.col(i) += direct_close.col(static_cast<Eigen::Index>(r));
    auto column = of_derivative.col(static_cast<Eigen::Index>(r)).array();
    const auto arm = -difference.col(i).array().conjugate();
    of_value.col(i).array() += column * (arm * bend_.array() - fine_.derivative.array().conjugate() * slope_.array());
    column *= arm * slope_.array();
  }
  ComplexMatrix conjugate = product(refine_derivative_, of_value);
  const ComplexMatrix conjugate_close = product(refine_second_, of_derivative);
  for (std::size_t r = 0; r < close.size(); ++r)
    conjugate.col(close[r]) += conjugate_close.col(static_cast<Eigen::Index>(r));
  return {-s * direct.transpose(), (0.5 * s) * conjugate.adjoint()};
}

VelocityRows CloseEvaluation::velocity_rows(const std::vector<Complex>& z) const { return velocity_rows(targets(z)); }

VelocityRows trapezoid_rows(const Curve& curve, Side side, const std::vector<Target>& z) {
  const double s = side == Side::interior ? 1.0 : -1.0;
  const auto n = static_cast<Eigen::Index>(curve.size()), count = static_cast<Eigen::Index>(z.size());
  VelocityRows rows{Matrix(count, n), ComplexMatrix(count, n)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const ComplexVector difference = curve.from(z[i]);
    for (Eigen::Index k = 0; k < n; ++k) {
      const Complex normal = -imaginary_unit * (s * curve.weight[k] / (2.0 * pi)) * curve.tangent[k];
      const Complex r = -difference[k];
      const double over = 1.0 / std::norm(r), f = dot(r, normal) * over;
      rows.direct(i, k) = f;
      rows.conjugate(i, k) = f * over * (r * r);
    }
  }
  return rows;
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
