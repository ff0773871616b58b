#include "interpolation.hpp"

#include <algorithm>
#include <cmath>

#include "boundary_limits.hpp"
#include "close_flow.hpp"
#include "fourier.hpp"

namespace stokes {

namespace {

// In units of h. It exceeds 1 so that every point on the normal lies beyond the near zone.
constexpr double normal_spacing = 1.1;

Curve upsampled(const Curve& curve) {
  const int n = curve.size();
  if (n < 8 || n % 2 != 0)
    throw InputError("close evaluation by interpolation needs an even number of nodes, at least 8; got " +
                     std::to_string(n));
  const int factor = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(n))));
  return Curve::through(fourier_upsample(curve.position, n * factor));
}

using Seven = std::array<double, 7>;
constexpr Seven zero_to_six{0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0};

// Weights at t of the values at `places` in their interpolating polynomial.
Seven lagrange_weights(const Seven& places, double t) {
  Seven weight;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    weight[i] = 1.0;
    for (std::size_t j = 0; j < weight.size(); ++j)
      if (j != i) weight[i] *= (t - places[j]) / (places[i] - places[j]);
  }
  return weight;
}

// Places of the seven values along the normal at x0, in units of the spacing. The target stands at t, the foot of the
// perpendicular from the origin at `origin`.
Seven places_on_normal(NearRule rule, double t, double origin) {
  if (rule == NearRule::from_boundary) return zero_to_six;
  return {0.0, t + 1.0, t + 2.0, t + 3.0, t + 4.0, t + 5.0, origin};
}

// Rows of -1/2 I + D at the nodes: the trapezoid rule with the diagonal limit -s kappa/(2 pi) t (t . eta).
VelocityRows boundary_limit(const Curve& curve, Side side) {
  const double s = side == Side::interior ? 1.0 : -1.0;
  VelocityRows rows = trapezoid_rows(curve, side, std::vector<Complex>(curve.position.begin(), curve.position.end()));
  for (int k = 0; k < curve.size(); ++k) {  // t (t . eta) = (eta + t^2 conj(eta)) / 2
    const double diagonal = -s * curve.curvature[k] * curve.weight[k] / (4.0 * pi);
    rows.direct(k, k) = diagonal - 0.5;
    rows.conjugate(k, k) = diagonal * curve.tangent[k] * curve.tangent[k];
  }
  return rows;
}

}  // namespace

InterpolationEvaluation::InterpolationEvaluation(const Curve& curve, Side side, NearRule rule)
    : side_(side),
      rule_(rule),
      curve_(curve),
      fine_(upsampled(curve)),
      h_(curve.length() / curve.size()),
      coefficients_(fourier_coefficients(curve.position)),
      limit_(boundary_limit(curve, side)) {}

// Newton's method on |zeta(alpha) - z|^2 / 2 from the nearest fine node. The closest point lies within about a fine step
// of that node, which limits the length of the steps. The second derivative may be small or negative if z lies beyond
// a centre of curvature. The Gauss-Newton one, |zeta'|^2, replaces it there.
InterpolationEvaluation::BoundaryPoint InterpolationEvaluation::closest_point(Complex z, int fine_node) const {
  const int n = curve_.size();
  const double longest_step = 2.0 * pi / fine_.size();
  double alpha = longest_step * fine_node;
  for (int iteration = 0;; ++iteration) {
    const Complex turn = std::polar(1.0, alpha);
    Complex zeta = coefficients_[0], first = 0.0, second = 0.0, power = 1.0;
    for (int k = 1; k < n / 2; ++k) {
      power *= turn;
      const Complex plus = coefficients_[k] * power, minus = coefficients_[n - k] * std::conj(power);
      const double mode = k;
      zeta += plus + minus;
      first += imaginary_unit * mode * (plus - minus);
      second -= mode * mode * (plus + minus);
    }
    const double nyquist = 0.5 * n;
    const Complex last = coefficients_[n / 2];
    zeta += last * std::cos(nyquist * alpha);
    first -= nyquist * last * std::sin(nyquist * alpha);
    second -= nyquist * nyquist * last * std::cos(nyquist * alpha);

    const double metric = std::norm(first), curved = metric + dot(second, zeta - z);
    const double step = -dot(first, zeta - z) / (curved > 0.1 * metric ? curved : metric);
    if (std::abs(step) < 1e-14 || iteration == 50) return {alpha, zeta, first};
    alpha += std::clamp(step, -longest_step, longest_step);
  }
}

InterpolationEvaluation::Stencil InterpolationEvaluation::stencil(Complex z) const {
  int nearest = 0;
  (fine_.position.array() - z).abs2().minCoeff(&nearest);
  const Stencil far{0, {}, {z}, Vector::Ones(1)};
  if (std::abs(fine_.position[nearest] - z) > h_ + fine_.max_spacing()) return far;
  const BoundaryPoint foot = closest_point(z, nearest);
  if (std::abs(z - foot.position) >= h_) return far;

  // The normal into the fluid is (z - x0)/|z - x0| without the division that fails on the curve.
  const double s = side_ == Side::interior ? 1.0 : -1.0;
  const Complex into_fluid = s * perp(foot.derivative) / std::abs(foot.derivative);
  const double spacing = normal_spacing * h_, t = dot(z - foot.position, into_fluid) / spacing;
  const Seven places = places_on_normal(rule_, t, -dot(foot.position, into_fluid) / spacing);
  const Seven across = lagrange_weights(places, t);
  const double node = foot.alpha * curve_.size() / (2.0 * pi);
  const int first_node = static_cast<int>(std::lround(node)) - order / 2;
  const Seven along = lagrange_weights(zero_to_six, node - first_node);

  const int points = rule_ == NearRule::from_boundary ? order - 1 : order - 2;  // the value beside the origin is 0
  Stencil near{first_node, along, std::vector<Complex>(points), Vector(points)};
  for (double& weight : near.node_weight) weight *= across[0];
  for (int k = 1; k <= points; ++k) {
    near.points[k - 1] = foot.position + places[k] * spacing * into_fluid;
    near.point_weight[k - 1] = across[k];
  }
  return near;
}

// The row over the N nodes that gives for a density what `fine_row` gives for its upsampled values. This is the
// transpose of fourier_upsample.
ComplexVector InterpolationEvaluation::restricted(const ComplexVector& fine_row) const {
  const Eigen::Index n = curve_.size(), fine = fine_row.size();
  const ComplexVector c = fourier_coefficients(fine_row);
  ComplexVector coarse(n);
  coarse.head(n / 2) = c.head(n / 2);
  coarse.tail(n / 2 - 1) = c.tail(n / 2 - 1);
  coarse[n / 2] = 0.5 * (c[n / 2] + c[fine - n / 2]);
  return fourier_values(coarse) * (static_cast<double>(fine) / static_cast<double>(n));
}

VelocityRows InterpolationEvaluation::velocity_rows(const std::vector<Complex>& z) const {
  const int n = curve_.size(), targets = static_cast<int>(z.size());
  VelocityRows rows{Matrix(targets, n), ComplexMatrix(targets, n)};
  for (int i = 0; i < targets; ++i) {
    const Stencil stencil_i = stencil(z[i]);
    const VelocityRows fine = trapezoid_rows(fine_, side_, stencil_i.points);
    rows.direct.row(i) = restricted(fine.direct.transpose() * stencil_i.point_weight).real().transpose();
    rows.conjugate.row(i) = restricted(fine.conjugate.transpose() * stencil_i.point_weight).transpose();
    for (int k = 0; k < order; ++k) {
      const int node = (stencil_i.first_node + k + n) % n;
      rows.direct.row(i) += stencil_i.node_weight[k] * limit_.direct.row(node);
      rows.conjugate.row(i) += stencil_i.node_weight[k] * limit_.conjugate.row(node);
    }
  }
  return rows;
}

InterpolationFlow::InterpolationFlow(const InterpolationEvaluation& close, const ComplexVector& density)
    : close_(&close),
      fine_density_(fourier_upsample(density, close.fine_.size())),
      limits_(boundary_limits(close.curve_, close.side_, density)) {}

PointFlow InterpolationFlow::at(Complex z) const {
  const auto stencil = close_->stencil(z);
  const int n = close_->curve_.size();
  PointFlow flow;
  for (int k = 0; k < InterpolationEvaluation::order; ++k)
    flow += stencil.node_weight[k] * limits_[(stencil.first_node + k + n) % n];
  for (std::size_t k = 0; k < stencil.points.size(); ++k) {
    const double weight = stencil.point_weight[static_cast<Eigen::Index>(k)];
    flow += weight * trapezoid_flow(close_->fine_, close_->side_, fine_density_, stencil.points[k]);
  }
  return flow;
}

}  // namespace stokes
