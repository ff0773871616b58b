// What a solution says beside the velocities of the bodies.
#include <algorithm>
#include <cmath>

#include "completion.hpp"
#include "fourier.hpp"
#include "stokes_system.hpp"

namespace stokes {

ComplexVector StokesSystem::velocity(const std::vector<Complex>& points, const ComplexVector& density,
                                     const BackgroundFlow& flow, const std::vector<Wrench>& wrenches) const {
  const int count = static_cast<int>(points.size());
  PointArray targets;
  targets.resize(count);
  for (int i = 0; i < count; ++i) targets.set(i, points[i]);
  ComplexVector u;
  double_layer_velocity(targets, nodes_, weighted_normal_, in_laboratory(density.data()), u);
  for (int i = 0; i < count; ++i) u[i] += driven_velocity(points[i], flow, wrenches);
  for (const int f : fixed_) {
    const PlacedShape& b = boundaries_[f];
    const Wrench w = b.shape->wrench(&density[b.offset]);
    for (int i = 0; i < count; ++i)
      u[i] += b.axis * completion_velocity(b.shape->shape, {}, w, b.local(points[i]), log_length_);
  }
  for (const PlacedShape& b : boundaries_) {
    std::vector<Complex> z(count), close;
    for (int i = 0; i < count; ++i) z[i] = b.local(points[i]);
    const std::vector<int> rows = near_rows(*b.shape, z);
    if (rows.empty()) continue;
    for (int row : rows) close.push_back(z[row]);
    const Vector correction = real_matrix(near_correction(*b.shape, close), b.axis) *
                              as_real(density).segment(2 * b.offset, 2 * b.shape->size());
    for (std::size_t r = 0; r < rows.size(); ++r) u[rows[r]] += Complex(correction[2 * r], correction[2 * r + 1]);
  }
  return u;
}

std::vector<Complex> StokesSystem::stresslets(const ComplexVector& density, const std::vector<Wrench>& wrenches) const {
  std::vector<Complex> result(body_count());
  for (int j = 0; j < body_count(); ++j) {
    const PlacedShape& b = boundaries_[j];
    // S_11 + i S_12 = -Int n eta ds as a complex product.
    Complex sum = 0.0;
    for (int k = 0; k < b.size(); ++k) sum -= b.shape->weighted_normal(k) * density[b.offset + k];
    const Wrench own = b.shape->kind == BoundaryKind::fixed ? b.shape->wrench(&density[b.offset])
                       : wrenches.empty()                   ? Wrench{}
                                                            : wrenches[j];
    const Pose frame{{}, b.shape->kind == BoundaryKind::fixed ? 0.0 : b.pose.angle};
    const Complex turn = b.shape->kind == BoundaryKind::fixed ? b.axis * b.axis : Complex(1.0);
    result[j] = b.axis * b.axis * sum + turn * completion_stresslet(b.shape->shape, frame, own);
  }
  return result;
}

double StokesSystem::density_tail(const ComplexVector& density) const {
  double largest = 0.0;
  const double scale = density.size() > 0 ? density.cwiseAbs().maxCoeff() : 0.0;
  for (const PlacedShape& b : boundaries_) {
    const int n = b.size();
    ComplexVector own = density.segment(b.offset, n);
    const RigidVelocity rigid = b.shape->rigid_part(own.data());
    for (int k = 0; k < n; ++k) own[k] -= rigid.velocity + rigid.omega * perp(b.shape->curve.position[k]);
    const ComplexVector c = fourier_coefficients(own);
    double total = 0.0, tail = 0.0;
    for (int k = 0; k < n; ++k) {
      const int mode = std::min(k, n - k);
      total += std::norm(c[k]);
      if (3 * mode > n) tail += std::norm(c[k]);
    }
    // A density at the level of round-off has no meaningful spectrum.
    if (total > 1e-26 * scale * scale) largest = std::max(largest, tail / total);
  }
  return largest;
}

}  // namespace stokes
