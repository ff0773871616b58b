#include "close_flow.hpp"

#include <algorithm>
#include <cmath>

#include "fourier.hpp"

namespace stokes {

namespace {

using GoursatVector = Eigen::Matrix<Complex, 5, 1>;
using GoursatTable = Eigen::Matrix<Complex, 5, Eigen::Dynamic>;  // one column per node

// Limits of C[tau] on the fluid side, for each of five tau, by the compensated trapezoid rule
//   v_j = (1/2 pi i) ( Sum_{k != j} (tau_k - tau_j)/(zeta_k - zeta_j) dz_k + tau'(alpha_j) 2 pi/N ) + { tau_j inside }.
GoursatTable cauchy_limits(const Curve& curve, Side side, const GoursatTable& tau) {
  const Eigen::Index n = curve.size();
  const Complex factor = 1.0 / (static_cast<double>(n) * imaginary_unit);  // (1/2 pi i) 2 pi/N
  GoursatTable limits(5, n);
  for (int f = 0; f < 5; ++f) limits.row(f) = fourier_derivative(tau.row(f).transpose()).transpose();
  for (Eigen::Index j = 0; j < n; ++j) {
    GoursatVector sum = limits.col(j);
    const ComplexVector difference = curve.from(curve.node(j));
    for (Eigen::Index k = 0; k < n; ++k) {
      if (k == j) continue;
      sum += quotient(curve.derivative[k], difference[k]) * (tau.col(k) - tau.col(j));
    }
    limits.col(j) = factor * sum;
    if (side == Side::interior) limits.col(j) += tau.col(j);
  }
  return limits;
}

PointFlow flow_from(Complex z, const GoursatVector& g) {
  return goursat_flow(z, {g[0], g[1], g[2], g[3], g[4]});
}

}  // namespace

CloseFlow::CloseFlow(const Curve& curve, Side side, int upsampling, const ComplexVector& density)
    : CloseFlow(refined(curve, upsampling), side, density) {}

CloseFlow::CloseFlow(Curve fine, Side side, const ComplexVector& density)
    : fine_(std::move(fine)), winding_(winding(fine_, side)) {
  const int n = fine_.size();
  const ComplexVector first = fourier_derivative(density), along = fourier_upsample(first, n);
  const auto derivative = fine_.derivative.array();
  const Eigen::ArrayXcd eta = fourier_upsample(density, n), slope = along.array() / derivative;
  // eta'' = (eta_alpha,alpha - zeta_alpha,alpha eta') / zeta_alpha^2
  const Eigen::ArrayXcd bend = (fourier_upsample(fourier_derivative(first), n).array() -
                                fine_.second.array() * slope) /
                               (derivative * derivative);
  const Eigen::ArrayXcd conjugate = fine_.position.array().conjugate();
  const Eigen::ArrayXcd conjugate_slope = (along.array().conjugate() + derivative.conjugate() * slope) / derivative;
  const double half = side == Side::interior ? 0.5 : -0.5;
  GoursatTable integrands(5, n);
  integrands.row(0) = -half * eta;
  integrands.row(1) = -half * slope;
  integrands.row(2) = -half * bend;
  integrands.row(3) = half * (eta.conjugate() + conjugate * slope);
  integrands.row(4) = half * (conjugate_slope + conjugate * bend);
  boundary_ = cauchy_limits(fine_, side, integrands);
  upsampling_ = n / static_cast<int>(density.size());
}

PointFlow CloseFlow::at(Complex z) const {
  ComplexVector weight(fine_.size());
  barycentric_weights(fine_, winding_, pole_terms(fine_, {z}), weight);
  return flow_from(z, boundary_ * weight);
}

std::vector<PointFlow> CloseFlow::at_nodes() const {
  std::vector<PointFlow> flows;
  for (int k = 0; k < fine_.size(); k += upsampling_)
    flows.push_back(flow_from(fine_.position[k], boundary_.col(k)));
  return flows;
}

// The integrands' modes decay like exp(-m mu), twice differentiated like m^2 exp(-m mu); those of the density shift
// them by up to N/2. Round-off is at m mu = 33, and m <= (upsampling - 1) N/2 are represented. On a disc they are
// polynomials, of three modes more than the density.
int flow_upsampling(double aspect, int points) {
  const double mu = std::atanh(1.0 / aspect);
  return std::max(2, 1 + static_cast<int>(std::ceil(66.0 / (points * mu))));
}

PointFlow trapezoid_flow(const Curve& curve, Side side, const ComplexVector& density, Complex z) {
  const double s = side == Side::interior ? 1.0 : -1.0;
  PointFlow flow;
  for (int k = 0; k < curve.size(); ++k) {
    const Complex weighted_normal = -imaginary_unit * s * curve.tangent[k] * curve.weight[k];
    flow += stresslet_flow(z - curve.position[k], weighted_normal, density[k]);
  }
  return flow;
}

}  // namespace stokes
