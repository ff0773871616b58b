#include "stokes_system.hpp"

#include <algorithm>
#include <cmath>

#include "completion.hpp"
#include "fourier.hpp"
#include "gap.hpp"
#include "gmres.hpp"
#include "neighbours.hpp"
#include "text.hpp"
#include "threads.hpp"

namespace stokes {

namespace {

// Pairs closer than this part of the smaller circumradius are solved together by the preconditioner.
constexpr double close_pair = 0.2;

Wrench wrench_of(const std::vector<Wrench>& wrenches, int body) {
  return wrenches.empty() ? Wrench{} : wrenches[body];
}

bool is_zero(const Wrench& w) { return w.force == Complex(0.0) && w.torque == 0.0; }

}  // namespace

StokesSystem::StokesSystem(const Suspension& bodies, int points, ShapeCache& shapes, const StokesOptions& options)
    : options_(options) {
  int offset = 0;
  for (const Body& body : bodies) {
    const DiscreteShape& shape = shapes.get(body.shape, points);
    blocks_.push_back({&shape, body.pose, body.pose.axis(), offset});
    offset += shape.size();
  }
  nodes_.resize(offset), weighted_normal_.resize(offset);
  for (const PlacedShape& b : blocks_)
    for (int k = 0; k < b.shape->size(); ++k) {
      const Curve& curve = b.shape->curve;
      nodes_.set(b.offset + k, b.node(k));
      weighted_normal_.set(b.offset + k, b.axis * imaginary_unit * curve.tangent[k] * curve.weight[k]);
    }
  find_near_blocks();
  std::vector<std::pair<int, int>> pairs;
  if (options.preconditioner == PreconditionerKind::pair)
    for (const NearBlock& n : near_) {
      const Body &a = bodies[n.target], &b = bodies[n.source];
      const double limit = close_pair * std::min(a.shape.circumradius(), b.shape.circumradius());
      if (gap(a, b).value < limit) pairs.push_back(std::minmax(n.target, n.source));
    }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  preconditioner_.emplace(options.preconditioner, blocks_, pairs);
}

void StokesSystem::find_near_blocks() {
  std::vector<Complex> centres;
  std::vector<double> radii;
  double reach = 0.0;
  for (const PlacedShape& b : blocks_) {
    centres.push_back(b.pose.centre);
    radii.push_back(b.shape->shape.circumradius());
    reach = std::max(reach, near_distance(*b.shape));
  }
  for (const auto& [i, j] : neighbour_pairs(centres, centres, radii, reach)) {
    near_.push_back({i, j, {}, {}});
    near_.push_back({j, i, {}, {}});
  }
  std::sort(near_.begin(), near_.end(), [](const NearBlock& a, const NearBlock& b) {
    return std::pair(a.target, a.source) < std::pair(b.target, b.source);
  });
  parallel_for_large(static_cast<long>(near_.size()), node_count(), [&](long n) {
    NearBlock& near = near_[n];
    const PlacedShape &target = blocks_[near.target], &source = blocks_[near.source];
    std::vector<Complex> z(target.shape->size());
    for (int k = 0; k < target.shape->size(); ++k)
      z[k] = source.local(nodes_[target.offset + k]);
    near.rows = near_rows(*source.shape, z);
    if (near.rows.empty()) return;
    std::vector<Complex> close;
    for (int row : near.rows) close.push_back(z[row]);
    near.matrix = real_matrix(near_correction(*source.shape, close), source.axis * std::conj(target.axis));
  });
  std::erase_if(near_, [](const NearBlock& n) { return n.rows.empty(); });
  first_near_.assign(blocks_.size() + 1, 0);
  for (const NearBlock& n : near_) ++first_near_[n.target + 1];
  for (std::size_t i = 0; i < blocks_.size(); ++i) first_near_[i + 1] += first_near_[i];
}

ComplexVector StokesSystem::in_laboratory(const Complex* density) const {
  ComplexVector lab(node_count());
  for (const PlacedShape& b : blocks_)
    for (int k = 0; k < b.shape->size(); ++k) lab[b.offset + k] = b.axis * density[b.offset + k];
  return lab;
}

// The deflated operator. The double layer of all nodes on all nodes is one sum; each body then adds its
// diagonal limit, -1/2, the deflation and the close corrections from its neighbours.
void StokesSystem::apply(const Vector& in, Vector& out) const {
  const Complex* eta = reinterpret_cast<const Complex*>(in.data());
  ComplexVector sum;
  double_layer_velocity(nodes_, nodes_, weighted_normal_, in_laboratory(eta), sum);

  Complex* result = reinterpret_cast<Complex*>(out.data());
  const auto finish_body = [&](long i) {
    const PlacedShape& b = blocks_[i];
    const Curve& curve = b.shape->curve;
    const Complex* own = eta + b.offset;
    const RigidVelocity rigid = b.shape->rigid_part(own);
    for (int k = 0; k < curve.size(); ++k) {
      const Complex t = curve.tangent[k];
      result[b.offset + k] = std::conj(b.axis) * sum[b.offset + k] + b.shape->diagonal[k] * dot(t, own[k]) * t -
                             0.5 * (own[k] + rigid.velocity + rigid.omega * perp(curve.position[k]));
    }
    for (int n = first_near_[i]; n < first_near_[i + 1]; ++n) {
      const NearBlock& near = near_[n];
      const PlacedShape& source = blocks_[near.source];
      const Vector correction = near.matrix * in.segment(2 * source.offset, 2 * source.shape->size());
      for (std::size_t r = 0; r < near.rows.size(); ++r)
        result[b.offset + near.rows[r]] += Complex(correction[2 * r], correction[2 * r + 1]);
    }
  };
  parallel_for_large(body_count(), node_count(), finish_body);
}

Complex StokesSystem::driven_velocity(Complex x, const BackgroundFlow& flow, const std::vector<Wrench>& wrenches) const {
  Complex u = flow.velocity(x);
  for (int j = 0; j < body_count(); ++j)
    if (!is_zero(wrench_of(wrenches, j)))
      u += completion_velocity(blocks_[j].shape->shape, blocks_[j].pose, wrenches[j], x);
  return u;
}

// Background and completion flows at the nodes, each in its body's frame.
ComplexVector StokesSystem::boundary_velocity(const BackgroundFlow& flow, const std::vector<Wrench>& wrenches) const {
  ComplexVector u(node_count());
  parallel_for_large(body_count(), node_count(), [&](long i) {
    const PlacedShape& b = blocks_[i];
    for (int k = 0; k < b.shape->size(); ++k)
      u[b.offset + k] = std::conj(b.axis) * driven_velocity(nodes_[b.offset + k], flow, wrenches);
  });
  return u;
}

// The right-hand side without its rigid part, whose exact solution, body by body and in the body frame, is
// the rigid velocity returned.
Vector StokesSystem::straining_data(const BackgroundFlow& flow, const std::vector<Wrench>& wrenches,
                                    std::vector<RigidVelocity>& rigid) const {
  ComplexVector rhs = -boundary_velocity(flow, wrenches);
  const double full_norm = rhs.norm();
  rigid.resize(body_count());
  for (int j = 0; j < body_count(); ++j) {
    const PlacedShape& b = blocks_[j];
    const RigidVelocity part = b.shape->rigid_part(&rhs[b.offset]);
    for (int k = 0; k < b.shape->size(); ++k)
      rhs[b.offset + k] -= part.velocity + part.omega * perp(b.shape->curve.position[k]);
    rigid[j] = {-part.velocity, -part.omega};
  }
  // What is left of a purely rigid right-hand side is round-off, not data.
  if (rhs.norm() <= 1e-14 * full_norm) rhs.setZero();
  return as_real(rhs);
}

// Adds the rigid velocities that the density stands for and turns them into the laboratory frame.
void StokesSystem::finish(const Vector& density, StokesSolution& solution) const {
  solution.density.resize(node_count());
  as_real(solution.density) = density;
  for (int j = 0; j < body_count(); ++j) {
    const PlacedShape& b = blocks_[j];
    const RigidVelocity part = b.shape->rigid_part(&solution.density[b.offset]);
    solution.velocity[j].velocity = b.axis * (solution.velocity[j].velocity + 0.5 * part.velocity);
    solution.velocity[j].omega += 0.5 * part.omega;
  }
}

StokesSolution StokesSystem::solve(const BackgroundFlow& flow, const std::vector<Wrench>& wrenches,
                                   const ComplexVector& guess) const {
  StokesSolution solution;
  const Vector rhs = straining_data(flow, wrenches, solution.velocity);
  const GmresResult result = gmres([this](const Vector& in, Vector& out) { apply(in, out); },
                                   [this](const Vector& in, Vector& out) { preconditioner_->apply(in, out); }, rhs,
                                   guess.size() == node_count() ? Vector(as_real(guess)) : Vector(),
                                   {options_.gmres_tolerance, options_.gmres_max_iterations});
  if (!result.converged)
    throw NumericalError(concat("GMRES stopped at a relative residual of ", result.residual, " after ", result.iterations,
                                " iterations; the tolerance is ", options_.gmres_tolerance,
                                " (bodies closer than the points resolve? try more points_per_body or a larger separation)"));
  solution.iterations = result.iterations;
  solution.residual = result.residual;
  finish(result.x, solution);
  return solution;
}

// With A the whole operator and A_d its diagonal blocks, A_d eta = rhs - (A - A_d) lagged is
// eta = lagged + A_d^-1 (rhs - A lagged).
StokesSolution StokesSystem::sweep(const BackgroundFlow& flow, const std::vector<Wrench>& wrenches,
                                   const ComplexVector& lagged) const {
  StokesSolution solution;
  Vector residual = straining_data(flow, wrenches, solution.velocity);
  Vector density = Vector::Zero(residual.size()), change(residual.size());
  if (lagged.size() == node_count()) {
    density = as_real(lagged);
    apply(density, change);
    residual -= change;
  }
  Preconditioner(PreconditionerKind::block, blocks_, {}).apply(residual, change);
  density += change;
  finish(density, solution);
  return solution;
}

ComplexVector StokesSystem::velocity(const std::vector<Complex>& points, const ComplexVector& density,
                                     const BackgroundFlow& flow, const std::vector<Wrench>& wrenches) const {
  const int count = static_cast<int>(points.size());
  PointArray targets;
  targets.resize(count);
  for (int i = 0; i < count; ++i) targets.set(i, points[i]);
  ComplexVector u;
  double_layer_velocity(targets, nodes_, weighted_normal_, in_laboratory(density.data()), u);
  for (int i = 0; i < count; ++i) u[i] += driven_velocity(points[i], flow, wrenches);
  for (const PlacedShape& b : blocks_) {
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
    const PlacedShape& b = blocks_[j];
    // n = i t on a body, and S_11 + i S_12 = -Int n eta ds as a complex product.
    Complex sum = 0.0;
    for (int k = 0; k < b.shape->size(); ++k)
      sum -= b.shape->curve.weight[k] * imaginary_unit * b.shape->curve.tangent[k] * density[b.offset + k];
    result[j] = b.axis * b.axis * sum + completion_stresslet(b.shape->shape, b.pose, wrench_of(wrenches, j));
  }
  return result;
}

double StokesSystem::density_tail(const ComplexVector& density) const {
  double largest = 0.0;
  const double scale = density.size() > 0 ? density.cwiseAbs().maxCoeff() : 0.0;
  for (const PlacedShape& b : blocks_) {
    const int n = b.shape->size();
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
