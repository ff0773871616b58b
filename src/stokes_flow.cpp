// Quantities of a solution other than the velocities of the bodies.
#include <algorithm>
#include <cmath>

#include "completion.hpp"
#include "fourier.hpp"
#include "stokes_system.hpp"
#include "threads.hpp"

namespace stokes {

// The trapezoid sum of all nodes.
std::vector<PointFlow> StokesSystem::summed_flow(const PointArray& points, const ComplexVector& lab_density) const {
  FlowFields fields;
  SourceStrengths strengths;
  strengths.weighted_normal = &all_.weighted_normal, strengths.density = &lab_density;
  if (fmm_ && points.size() >= fmm_crossover)
    FmmPlan(all_.nodes, points, {1e-11}).evaluate(strengths, FlowOutput::gradient, fields);
  else
    direct_fields(points, all_.nodes, strengths, FlowOutput::gradient, fields);
  std::vector<PointFlow> result(points.size());
  for (int i = 0; i < points.size(); ++i)
    result[i] = {fields.velocity[i], fields.pressure[i], fields.velocity_x[i], fields.velocity_y[i]};
  return result;
}

std::vector<int> StokesSystem::near_points(const PlacedShape& b, const std::vector<Complex>& points) const {
  const double limit = near_distance_of_gradient(*b.shape), radius = b.shape->shape.circumradius();
  const bool inside = b.shape->kind == BoundaryKind::container;
  std::vector<int> near;
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    const double r = std::abs(points[i] - b.pose.centre);
    if (inside ? r < radius - limit : r > radius + limit) continue;
    for (int k = b.offset; k < b.offset + b.size(); ++k)
      if (std::norm(points[i] - all_.nodes[k]) < limit * limit) {
        near.push_back(i);
        break;
      }
  }
  return near;
}

// Near a boundary the trapezoid sum of its nodes is left out, not subtracted: close to a node it is all round-off.
std::vector<PointFlow> StokesSystem::double_layer_flow(const std::vector<Complex>& points,
                                                       const ComplexVector& density) const {
  const ComplexVector lab = in_laboratory(all_, density.data());
  const long boundary_count = static_cast<long>(boundaries_.size());
  std::vector<std::vector<int>> near(boundary_count);
  std::vector<std::vector<PointFlow>> close(boundary_count);
  parallel_for(boundary_count, [&](long j) {
    const PlacedShape& b = boundaries_[j];
    near[j] = near_points(b, points);
    std::vector<Complex> z;
    for (int i : near[j]) z.push_back(b.local(points[i]));
    if (!z.empty()) close[j] = b.shape->close_flow(density.segment(b.offset, b.size()), z);
  });
  std::vector<std::vector<int>> beside(points.size());  // boundaries that a point is near
  for (int j = 0; j < boundary_count; ++j)
    for (int i : near[j]) beside[i].push_back(j);

  PointArray far;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (beside[i].empty()) far.x.push_back(points[i].real()), far.y.push_back(points[i].imag());
  const std::vector<PointFlow> summed = summed_flow(far, lab);
  std::vector<PointFlow> result(points.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (beside[i].empty()) result[i] = summed[next++];
  parallel_for(static_cast<long>(points.size()), [&](long i) {
    if (beside[i].empty()) return;
    for (int j = 0; j < boundary_count; ++j) {
      if (std::binary_search(beside[i].begin(), beside[i].end(), j)) continue;
      for (int k = boundaries_[j].offset; k < boundaries_[j].offset + boundaries_[j].size(); ++k)
        result[i] += stresslet_flow(points[i] - all_.nodes[k], all_.weighted_normal[k], lab[k]);
    }
  });
  for (int j = 0; j < boundary_count; ++j)
    for (std::size_t r = 0; r < near[j].size(); ++r) result[near[j][r]] += turned(close[j][r], boundaries_[j].axis);
  return result;
}

std::vector<PointFlow> StokesSystem::flow(const std::vector<Complex>& points, const ComplexVector& density,
                                          const BackgroundFlow& background, const std::vector<Wrench>& wrenches) const {
  std::vector<PointFlow> result = double_layer_flow(points, density);
  const std::vector<Wrench> reaction = reactions(density);
  parallel_for(static_cast<long>(points.size()), [&](long i) {
    result[i] += background.flow(points[i]);
    for (int j = 0; j < body_count(); ++j) {
      const bool fixed = boundaries_[j].shape->kind == BoundaryKind::fixed;
      const Wrench& w = fixed ? reaction[j] : wrenches.empty() ? Wrench{} : wrenches[j];
      if (w.force != Complex(0.0) || w.torque != 0.0)
        result[i] += completion_flow(boundaries_[j].shape->shape, boundaries_[j].pose, w, points[i], log_length_);
    }
  });
  return result;
}

Wrench StokesSystem::container_wrench(const ComplexVector& density, const std::vector<Wrench>& wrenches) const {
  Wrench total;
  if (!has_container()) return total;
  const std::vector<Wrench> reaction = reactions(density);
  for (int j = 0; j < body_count(); ++j) {
    const bool fixed = boundaries_[j].shape->kind == BoundaryKind::fixed;
    const Wrench w = fixed ? reaction[j] : wrenches.empty() ? Wrench{} : wrenches[j];
    total.force -= w.force;
    total.torque -= w.torque + cross(boundaries_[j].pose.centre - boundaries_.back().pose.centre, w.force);
  }
  return total;
}

std::vector<Wrench> StokesSystem::reactions(const ComplexVector& density) const {
  std::vector<Wrench> result(body_count());
  for (const int f : fixed_) {
    const Wrench w = boundaries_[f].shape->wrench(&density[boundaries_[f].offset]);
    result[f] = {boundaries_[f].axis * w.force, w.torque};
  }
  return result;
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

std::vector<double> StokesSystem::density_tails(const ComplexVector& density) const {
  const double scale = density.size() > 0 ? density.cwiseAbs().maxCoeff() : 0.0;
  std::vector<double> tails;
  for (const PlacedShape& b : boundaries_) {
    const int n = b.size();
    const ComplexVector c = fourier_coefficients(density.segment(b.offset, n));
    double largest = 0.0, last = 0.0;
    for (int k = 1; k < n; ++k) {
      largest = std::max(largest, std::abs(c[k]));
      if (std::min(k, n - k) > 0.4 * n) last = std::max(last, std::abs(c[k]));
    }
    tails.push_back(largest > 1e-10 * scale ? last / largest : 0.0);
  }
  return tails;
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
