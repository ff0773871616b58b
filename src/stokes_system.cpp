#include "stokes_system.hpp"

#include <algorithm>
#include <cmath>

#include "completion.hpp"
#include "container_gap.hpp"
#include "gmres.hpp"
#include "neighbours.hpp"
#include "text.hpp"
#include "threads.hpp"

namespace stokes {

namespace {

// Pairs closer than this part of the smaller circumradius are solved together by the preconditioner.
constexpr double close_pair = 0.35;

Wrench wrench_of(const std::vector<Wrench>& wrenches, int body) {
  return wrenches.empty() ? Wrench{} : wrenches[body];
}

bool is_zero(const Wrench& w) { return w.force == Complex(0.0) && w.torque == 0.0; }

}  // namespace

std::vector<Discretisation> equal_nodes(const Suspension& bodies, int points) {
  std::vector<Discretisation> nodes;
  for (const Body& body : bodies) nodes.push_back({body.points > 0 ? body.points : points, {}});
  return nodes;
}

StokesSystem::StokesSystem(const Suspension& bodies, const std::vector<Discretisation>& nodes, ShapeCache& shapes,
                           const StokesOptions& options)
    : options_(options) {
  place(bodies, nodes, shapes);
  find_near_blocks();
  find_completion_columns();
  if (options.summation == Summation::fmm ||
      (options.summation == Summation::automatic && node_count() >= fmm_crossover))
    fmm_.emplace(nodes_, FmmOptions{std::clamp(0.1 * options.gmres_tolerance, 1e-12, 1e-3)});
  const bool pairs = options.preconditioner == PreconditionerKind::pair;
  preconditioner_.emplace(options.preconditioner, boundaries_,
                          pairs ? close_pairs(bodies) : std::vector<std::pair<int, int>>{},
                          [this](int target, int source) { return interaction(target, source); });
}

bool StokesSystem::has_container() const {
  return !boundaries_.empty() && boundaries_.back().shape->kind == BoundaryKind::container;
}

void StokesSystem::place(const Suspension& bodies, const std::vector<Discretisation>& nodes, ShapeCache& shapes) {
  if (bodies.container) log_length_ = bodies.container->radius;
  const long count = static_cast<long>(bodies.size());
  boundaries_.resize(count);
  const auto make = [&](long i) {
    const Body& body = bodies[i];
    const BoundaryKind kind = body.fixed ? BoundaryKind::fixed : BoundaryKind::free;
    boundaries_[i] = {shapes.get(body.shape, nodes[i], kind, log_length_), body.pose, body.pose.axis(), 0};
  };
  // The cache is filled by one thread; nodes of this configuration alone do not enter it.
  for (long i = 0; i < count; ++i)
    if (nodes[i].clusters.empty()) make(i);
  parallel_for(count, [&](long i) {
    if (!nodes[i].clusters.empty()) make(i);
  });
  for (long i = 0; i < count; ++i) {
    surfaces_.push_back(bodies[i].surface);
    if (bodies[i].fixed) fixed_.push_back(static_cast<int>(i));
  }
  if (bodies.container) {
    const Container& c = *bodies.container;
    boundaries_.push_back({shapes.get({c.radius, c.radius}, {c.points, {}}, BoundaryKind::container, log_length_),
                           {c.centre, c.angle}, std::polar(1.0, c.angle), 0});
    surfaces_.push_back(c.surface);
  }
  int offset = 0;
  for (PlacedShape& b : boundaries_) b.offset = offset, offset += b.size();
  nodes_.resize(offset), weighted_normal_.resize(offset);
  for (const PlacedShape& b : boundaries_)
    for (int k = 0; k < b.size(); ++k) {
      nodes_.set(b.offset + k, b.node(k));
      weighted_normal_.set(b.offset + k, b.axis * b.shape->weighted_normal(k));
    }
}

double StokesSystem::near_reach(int boundary) const {
  return near_distance(*boundaries_[boundary].shape, 0.1 * options_.gmres_tolerance);
}

void StokesSystem::find_near_blocks() {
  std::vector<Complex> centres;
  std::vector<double> radii;
  double reach = 0.0;
  const auto limit = [this](int i, int j) { return std::max(near_reach(i), near_reach(j)); };
  const auto add = [this](int i, int j) {
    near_.push_back({i, j, {}, {}});
    near_.push_back({j, i, {}, {}});
  };
  for (int i = 0; i < body_count(); ++i) {
    const PlacedShape& b = boundaries_[i];
    centres.push_back(b.pose.centre);
    radii.push_back(b.shape->shape.circumradius());
    reach = std::max(reach, near_reach(i));
    const int wall = body_count();
    if (has_container() && boundaries_[wall].shape->shape.circumradius() - radii[i] -
                                   std::abs(centres[i] - boundaries_[wall].pose.centre) < limit(i, wall))
      add(i, wall);
  }
  for (const auto& [i, j] : neighbour_pairs(centres, centres, radii, reach))
    if (std::abs(centres[i] - centres[j]) - radii[i] - radii[j] < limit(i, j)) add(i, j);
  std::sort(near_.begin(), near_.end(), [](const NearBlock& a, const NearBlock& b) {
    return std::pair(a.target, a.source) < std::pair(b.target, b.source);
  });
  parallel_for_large(static_cast<long>(near_.size()), node_count(), [&](long n) {
    NearBlock& near = near_[n];
    const PlacedShape &target = boundaries_[near.target], &source = boundaries_[near.source];
    std::vector<Complex> z(target.size());
    for (int k = 0; k < target.size(); ++k) z[k] = source.local(nodes_[target.offset + k]);
    near.rows = near_rows(*source.shape, z, near_reach(near.source));
    if (near.rows.empty()) return;
    std::vector<Complex> close;
    for (int row : near.rows) close.push_back(z[row]);
    near.matrix = real_matrix(near_correction(*source.shape, close), source.axis * std::conj(target.axis));
  });
  std::erase_if(near_, [](const NearBlock& n) { return n.rows.empty(); });
  first_near_.assign(boundaries_.size() + 1, 0);
  for (const NearBlock& n : near_) ++first_near_[n.target + 1];
  for (std::size_t i = 0; i < boundaries_.size(); ++i) first_near_[i + 1] += first_near_[i];
}

// Column 3 f + j: unit force along the first or second axis, or unit torque, of fixed body f, everything in
// body frames.
void StokesSystem::find_completion_columns() {
  completion_.resize(2 * node_count(), 3 * static_cast<Eigen::Index>(fixed_.size()));
  parallel_for_large(static_cast<long>(fixed_.size()), node_count(), [&](long f) {
    const PlacedShape& source = boundaries_[fixed_[f]];
    for (int j = 0; j < 3; ++j) {
      const Wrench unit{{j == 0 ? 1.0 : 0.0, j == 1 ? 1.0 : 0.0}, j == 2 ? 1.0 : 0.0};
      for (const PlacedShape& b : boundaries_)
        for (int k = 0; k < b.size(); ++k) {
          const Complex u = source.axis * std::conj(b.axis) *
                            completion_velocity(source.shape->shape, {}, unit, source.local(nodes_[b.offset + k]), log_length_);
          completion_(2 * (b.offset + k), 3 * f + j) = u.real();
          completion_(2 * (b.offset + k) + 1, 3 * f + j) = u.imag();
        }
    }
  });
}

// Pairs whose gap is small.
std::vector<std::pair<int, int>> StokesSystem::close_pairs(const Suspension& bodies) const {
  std::vector<Complex> centres;
  std::vector<double> radii;
  double reach = 0.0;
  for (const Body& body : bodies) {
    centres.push_back(body.pose.centre);
    radii.push_back(body.shape.circumradius());
    if (!body.fixed) reach = std::max(reach, close_pair * radii.back());
  }
  std::vector<std::pair<int, int>> pairs;
  for (const auto& [i, j] : neighbour_pairs(centres, centres, radii, reach))
    if (gap(bodies[i], bodies[j]).value < close_pair * std::min(radii[i], radii[j])) pairs.push_back({i, j});
  for (int i = 0; bodies.container && i < body_count(); ++i)
    if (gap(bodies[i], *bodies.container).value < close_pair * radii[i]) pairs.push_back({i, body_count()});
  return pairs;
}

// The operator's block between two boundaries: the double layer, accurate at any distance, and a fixed source's
// completion flows.
Matrix StokesSystem::interaction(int target, int source) const {
  const PlacedShape &t = boundaries_[target], &s = boundaries_[source];
  std::vector<Complex> z;
  for (int k = 0; k < t.size(); ++k) z.push_back(s.local(t.node(k)));
  Matrix block = real_matrix(trapezoid_rows(s.shape->curve, s.shape->side(), z), s.axis * std::conj(t.axis));
  for (int n = first_near_[target]; n < first_near_[target + 1]; ++n)
    if (near_[n].source == source)
      for (std::size_t r = 0; r < near_[n].rows.size(); ++r)
        block.middleRows(2 * near_[n].rows[r], 2) += near_[n].matrix.middleRows(2 * static_cast<Eigen::Index>(r), 2);
  if (s.shape->kind == BoundaryKind::fixed) {
    const auto f = std::lower_bound(fixed_.begin(), fixed_.end(), source) - fixed_.begin();
    block += completion_.block(2 * t.offset, 3 * f, 2 * t.size(), 3) * s.shape->closure;
  }
  return block;
}

ComplexVector StokesSystem::in_laboratory(const Complex* density) const {
  ComplexVector lab(node_count());
  for (const PlacedShape& b : boundaries_)
    for (int k = 0; k < b.size(); ++k) lab[b.offset + k] = b.axis * density[b.offset + k];
  return lab;
}

// The trapezoid sum of all nodes on all others, laboratory frame.
ComplexVector StokesSystem::double_layer(const Complex* density) const {
  const ComplexVector lab = in_laboratory(density);
  if (!fmm_) {
    ComplexVector sum;
    double_layer_velocity(nodes_, nodes_, weighted_normal_, lab, sum);
    return sum;
  }
  FlowFields fields;
  SourceStrengths strengths;
  strengths.weighted_normal = &weighted_normal_, strengths.density = &lab;
  fmm_->evaluate(strengths, FlowOutput::velocity, fields);
  return std::move(fields.velocity);
}

// The operator: the double layer of all nodes on all nodes is one sum, to which every boundary adds its own
// diagonal limit, -1/2, its closure and the close corrections from its neighbours.
void StokesSystem::apply(const Vector& in, Vector& out) const {
  const Complex* eta = reinterpret_cast<const Complex*>(in.data());
  const ComplexVector sum = double_layer(eta);
  Vector wrenches(completion_.cols());
  for (std::size_t f = 0; f < fixed_.size(); ++f) {
    const PlacedShape& b = boundaries_[fixed_[f]];
    const Wrench w = b.shape->wrench(eta + b.offset);
    wrenches.segment<3>(3 * static_cast<Eigen::Index>(f)) << w.force.real(), w.force.imag(), w.torque;
  }
  Complex* result = reinterpret_cast<Complex*>(out.data());
  parallel_for_large(static_cast<long>(boundaries_.size()), node_count(), [&](long i) {
    const PlacedShape& b = boundaries_[i];
    if (wrenches.size() > 0)
      out.segment(2 * b.offset, 2 * b.size()).noalias() = completion_.middleRows(2 * b.offset, 2 * b.size()) * wrenches;
    else
      out.segment(2 * b.offset, 2 * b.size()).setZero();
    for (int k = 0; k < b.size(); ++k) result[b.offset + k] += std::conj(b.axis) * sum[b.offset + k];
    finish_boundary(static_cast<int>(i), in, result);
  });
}

void StokesSystem::finish_boundary(int i, const Vector& in, Complex* result) const {
  const PlacedShape& b = boundaries_[i];
  const Curve& curve = b.shape->curve;
  const Complex* own = reinterpret_cast<const Complex*>(in.data()) + b.offset;
  const bool free = b.shape->kind == BoundaryKind::free;
  const RigidVelocity rigid = free ? b.shape->rigid_part(own) : RigidVelocity{};
  const double flux = b.shape->kind == BoundaryKind::container ? b.shape->flux_part(own) : 0.0;
  for (int k = 0; k < curve.size(); ++k) {
    const Complex t = curve.tangent[k];
    result[b.offset + k] += b.shape->diagonal[k] * dot(t, own[k]) * t -
                            0.5 * (own[k] + rigid.velocity + rigid.omega * perp(curve.position[k])) +
                            flux / curve.weight[k] * b.shape->weighted_normal(k);
  }
  for (int n = first_near_[i]; n < first_near_[i + 1]; ++n) {
    const NearBlock& near = near_[n];
    const PlacedShape& source = boundaries_[near.source];
    const Vector correction = near.matrix * in.segment(2 * source.offset, 2 * source.size());
    for (std::size_t r = 0; r < near.rows.size(); ++r)
      result[b.offset + near.rows[r]] += Complex(correction[2 * r], correction[2 * r + 1]);
  }
}

Complex StokesSystem::driven_velocity(Complex x, const BackgroundFlow& flow, const std::vector<Wrench>& wrenches) const {
  Complex u = flow.velocity(x);
  for (int j = 0; j < body_count(); ++j)
    if (!is_zero(wrench_of(wrenches, j)) && boundaries_[j].shape->kind == BoundaryKind::free)
      u += completion_velocity(boundaries_[j].shape->shape, boundaries_[j].pose, wrenches[j], x, log_length_);
  return u;
}

// What the boundaries' equations have on their right, laboratory frame: surface velocities of walls less background
// and completion flows.
ComplexVector StokesSystem::boundary_data(const BackgroundFlow& flow, const std::vector<Wrench>& wrenches) const {
  ComplexVector u(node_count());
  parallel_for_large(static_cast<long>(boundaries_.size()), node_count(), [&](long i) {
    const PlacedShape& b = boundaries_[i];
    const bool moving = b.shape->kind != BoundaryKind::free && flow.walls != 0.0;
    for (int k = b.offset; k < b.offset + b.size(); ++k) {
      u[k] = -driven_velocity(nodes_[k], flow, wrenches);
      if (moving) u[k] += flow.walls * surfaces_[i].velocity(nodes_[k] - b.pose.centre);
    }
  });
  return u;
}

// Right-hand side in body frames without the rigid part on free bodies, whose exact solution, body by body and in
// the body frame, is the rigid velocity returned.
Vector StokesSystem::straining_data(ComplexVector data, std::vector<RigidVelocity>& rigid) const {
  const double full_norm = data.norm();
  rigid.assign(body_count(), {});
  for (std::size_t j = 0; j < boundaries_.size(); ++j) {
    const PlacedShape& b = boundaries_[j];
    for (int k = 0; k < b.size(); ++k) data[b.offset + k] *= std::conj(b.axis);
    if (b.shape->kind != BoundaryKind::free) continue;
    const RigidVelocity part = b.shape->rigid_part(&data[b.offset]);
    for (int k = 0; k < b.size(); ++k)
      data[b.offset + k] -= part.velocity + part.omega * perp(b.shape->curve.position[k]);
    rigid[j] = {-part.velocity, -part.omega};
  }
  // What is left of a purely rigid right-hand side is round-off, not data.
  if (data.norm() <= 1e-14 * full_norm) data.setZero();
  return as_real(data);
}

// Adds the rigid velocities and the reactions that the density stands for, in the laboratory frame.
void StokesSystem::finish(const Vector& density, StokesSolution& solution) const {
  solution.density.resize(node_count());
  as_real(solution.density) = density;
  solution.reaction = reactions(solution.density);
  for (int j = 0; j < body_count(); ++j) {
    const PlacedShape& b = boundaries_[j];
    if (b.shape->kind != BoundaryKind::free) continue;
    const RigidVelocity part = b.shape->rigid_part(&solution.density[b.offset]);
    solution.velocity[j].velocity = b.axis * (solution.velocity[j].velocity + 0.5 * part.velocity);
    solution.velocity[j].omega += 0.5 * part.omega;
  }
}

StokesSolution StokesSystem::solve_data(ComplexVector data, const ComplexVector& guess) const {
  StokesSolution solution;
  const Vector rhs = straining_data(std::move(data), solution.velocity);
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

StokesSolution StokesSystem::solve(const BackgroundFlow& flow, const std::vector<Wrench>& wrenches,
                                   const ComplexVector& guess) const {
  return solve_data(boundary_data(flow, wrenches), guess);
}

StokesSolution StokesSystem::solve_for_velocity(const ComplexVector& velocity, const ComplexVector& guess) const {
  return solve_data(velocity, guess);
}

// With A the whole operator and A_d its diagonal blocks, A_d eta = rhs - (A - A_d) lagged is
// eta = lagged + A_d^-1 (rhs - A lagged).
StokesSolution StokesSystem::sweep(const BackgroundFlow& flow, const std::vector<Wrench>& wrenches,
                                   const ComplexVector& lagged) const {
  StokesSolution solution;
  Vector residual = straining_data(boundary_data(flow, wrenches), solution.velocity);
  Vector density = Vector::Zero(residual.size()), change(residual.size());
  if (lagged.size() == node_count()) {
    density = as_real(lagged);
    apply(density, change);
    residual -= change;
  }
  Preconditioner(PreconditionerKind::block, boundaries_, {}, {}).apply(residual, change);
  density += change;
  finish(density, solution);
  return solution;
}

StokesSolution StokesSystem::solve_apart(const std::vector<Wrench>& wrenches) const {
  StokesSolution solution;
  std::vector<int> moved;
  for (int j = 0; j < body_count(); ++j)
    if (!is_zero(wrench_of(wrenches, j))) moved.push_back(j);
  const Vector rhs = straining_data(boundary_data({}, wrenches), solution.velocity);
  for (int j = 0; j < body_count(); ++j)
    if (is_zero(wrench_of(wrenches, j))) solution.velocity[j] = {};
  Vector density(rhs.size());
  preconditioner_->apply_to_some(moved, rhs, density);
  finish(density, solution);
  return solution;
}

}  // namespace stokes
