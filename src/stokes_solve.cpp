// The operator of the completed equations, their right-hand sides and their solution, for all boundaries or some.
#include <algorithm>
#include <cmath>

#include "completion.hpp"
#include "gmres.hpp"
#include "stokes_system.hpp"
#include "text.hpp"
#include "threads.hpp"

namespace stokes {

namespace {

// A body is near the bodies in contact if the distance of their circumscribed circles is below this fraction of its radius.
// This decides the number of iterations, not the result.
constexpr double nearby = 1.0;

bool is_zero(const Wrench& w) { return w.force == Complex(0.0) && w.torque == 0.0; }

// The bodies that wrenches act on.
std::vector<int> acted_on(const std::vector<Wrench>& wrenches) {
  std::vector<int> bodies;
  for (std::size_t i = 0; i < wrenches.size(); ++i)
    if (!is_zero(wrenches[i])) bodies.push_back(static_cast<int>(i));
  return bodies;
}

}  // namespace

ComplexVector StokesSystem::in_laboratory(const BoundarySet& set, const Complex* density) const {
  ComplexVector lab(set.size());
  for (const int i : set.members) {
    const PlacedShape& b = boundaries_[i];
    for (int k = 0; k < b.size(); ++k) lab[set.first[i] + k] = b.axis * density[set.first[i] + k];
  }
  return lab;
}

// The trapezoid sum of all nodes on all others, laboratory frame.
ComplexVector StokesSystem::double_layer(const BoundarySet& set, const Complex* density) const {
  const ComplexVector lab = in_laboratory(set, density);
  if (!fmm_ || &set != &all_) {
    ComplexVector sum;
    double_layer_velocity(set.nodes, set.nodes, set.weighted_normal, lab, sum, softening_);
    return sum;
  }
  FlowFields fields;
  SourceStrengths strengths;
  strengths.weighted_normal = &set.weighted_normal, strengths.density = &lab;
  fmm_->evaluate(strengths, FlowOutput::velocity, fields);
  return std::move(fields.velocity);
}

// The operator: the double layer of all nodes on all nodes is one sum, to which every boundary adds its own
// diagonal limit, -1/2, its closure and the close corrections from its neighbours.
void StokesSystem::apply(const BoundarySet& set, const Vector& in, Vector& out) const {
  const Complex* eta = reinterpret_cast<const Complex*>(in.data());
  const ComplexVector sum = double_layer(set, eta);
  Vector wrenches = Vector::Zero(completion_.cols());
  bool completed = false;
  for (std::size_t f = 0; f < fixed_.size(); ++f) {
    if (!set.has(fixed_[f])) continue;
    const Wrench w = boundaries_[fixed_[f]].shape->wrench(eta + set.first[fixed_[f]]);
    wrenches.segment<3>(3 * static_cast<Eigen::Index>(f)) << w.force.real(), w.force.imag(), w.torque;
    completed = true;
  }
  const std::vector<LongCircleFlow> flows = long_circle_flows(set, eta);
  Complex* result = reinterpret_cast<Complex*>(out.data());
  parallel_for_large(static_cast<long>(set.members.size()), set.size(), [&](long n) {
    const int i = set.members[n], first = set.first[i];
    const PlacedShape& b = boundaries_[i];
    if (completed)
      out.segment(2 * first, 2 * b.size()).noalias() = completion_.middleRows(2 * b.offset, 2 * b.size()) * wrenches;
    else
      out.segment(2 * first, 2 * b.size()).setZero();
    for (int k = 0; k < b.size(); ++k) result[first + k] += std::conj(b.axis) * sum[first + k];
    finish_boundary(set, i, in, flows, result + first);
  });
}

// `result` points to the boundary's first node.
void StokesSystem::finish_boundary(const BoundarySet& set, int i, const Vector& in,
                                   const std::vector<LongCircleFlow>& flows, Complex* result) const {
  const PlacedShape& b = boundaries_[i];
  const Curve& curve = b.shape->curve;
  const Complex* own = reinterpret_cast<const Complex*>(in.data()) + set.first[i];
  const bool free = b.shape->kind == BoundaryKind::free;
  const RigidVelocity rigid = free ? b.shape->rigid_part(own) : RigidVelocity{};
  const double flux = b.shape->kind == BoundaryKind::container ? b.shape->flux_part(own) : 0.0;
  for (int k = 0; k < curve.size(); ++k) {
    const Complex t = curve.tangent[k];
    result[k] += b.shape->diagonal[k] * dot(t, own[k]) * t -
                 0.5 * (own[k] + rigid.velocity + rigid.omega * perp(curve.position[k])) +
                 flux / curve.weight[k] * b.shape->weighted_normal(k);
  }
  for (int n = first_near_[i]; n < first_near_[i + 1]; ++n) {
    const NearBlock& near = near_[n];
    if (!set.has(near.source)) continue;
    if (near.matrix.size() == 0) {
      add_long_circle(near, flows, result);
      continue;
    }
    const Vector correction = near.matrix * in.segment(2 * set.first[near.source], 2 * boundaries_[near.source].size());
    for (std::size_t r = 0; r < near.rows.size(); ++r)
      result[near.rows[r]] += Complex(correction[2 * r], correction[2 * r + 1]);
  }
}

// Flows of all long circles, in the order of long_circles_; zero for circles outside the set.
std::vector<StokesSystem::LongCircleFlow> StokesSystem::long_circle_flows(const BoundarySet& set,
                                                                          const Complex* density) const {
  std::vector<LongCircleFlow> flows;
  for (const LongCircle& circle : long_circles_) {
    const PlacedShape& b = boundaries_[circle.boundary];
    ComplexVector own = ComplexVector::Zero(b.size());
    if (set.has(circle.boundary)) own = ComplexVector::Map(density + set.first[circle.boundary], b.size());
    flows.push_back({CircleFlow(b.shape->shape.a, b.shape->side(), own), b.axis * own});
  }
  return flows;
}

// The series minus the trapezoid rule.
void StokesSystem::add_long_circle(const NearBlock& near, const std::vector<LongCircleFlow>& flows, Complex* result) const {
  std::size_t c = 0;
  while (long_circles_[c].boundary != near.source) ++c;
  const PlacedShape &target = boundaries_[near.target], &source = boundaries_[near.source];
  PointArray points;
  points.resize(static_cast<int>(near.rows.size()));
  std::vector<Complex> z;
  for (std::size_t r = 0; r < near.rows.size(); ++r) {
    const Complex x = all_.nodes[target.offset + near.rows[r]];
    points.set(static_cast<int>(r), x);
    z.push_back(source.local(x));
  }
  ComplexVector plain;
  double_layer_velocity(points, long_circles_[c].nodes, long_circles_[c].weighted_normal, flows[c].density, plain,
                        softening_);
  const std::vector<Complex> exact = flows[c].series.velocity(z);
  for (std::size_t r = 0; r < near.rows.size(); ++r)
    result[near.rows[r]] += std::conj(target.axis) * (source.axis * exact[r] - plain[static_cast<Eigen::Index>(r)]);
}

// Right-hand side of the boundaries' equations, laboratory frame: surface velocities of walls minus background
// and completion flows.
ComplexVector StokesSystem::boundary_data(const BoundarySet& set, const BackgroundFlow& flow,
                                          const std::vector<Wrench>& wrenches) const {
  ComplexVector u(set.size());
  std::vector<int> forced = acted_on(wrenches);
  std::erase_if(forced, [this](int j) { return boundaries_[j].shape->kind != BoundaryKind::free; });
  std::vector<CompletionFlow> completions;
  for (const int j : forced)
    completions.emplace_back(boundaries_[j].shape->shape, boundaries_[j].pose, wrenches[j], log_length_);
  parallel_for_large(static_cast<long>(set.members.size()), set.size(), [&](long n) {
    const int i = set.members[n];
    const PlacedShape& b = boundaries_[i];
    const bool moving = b.shape->kind != BoundaryKind::free && flow.walls != 0.0;
    const int first = set.first[i], last = first + b.size() - 1;
    for (int k = first; k <= last; ++k) {
      u[k] = -flow.velocity(set.nodes[k]);
      if (moving) u[k] += flow.walls * surfaces_[i].velocity(set.nodes[k] - b.pose.centre);
    }
    for (int k = first; k <= last && !completions.empty(); k += lanes) {
      ComplexPack x, sum{};
      for (int l = 0; l < lanes; ++l) {
        const Complex node = set.nodes[std::min(k + l, last)];
        x.re[l] = node.real(), x.im[l] = node.imag();
      }
      for (const CompletionFlow& completion : completions) sum = sum + completion.velocity(x);
      for (int l = 0; l < std::min(lanes, last + 1 - k); ++l) u[k + l] -= Complex(sum.re[l], sum.im[l]);
    }
  });
  return u;
}

// Right-hand side in body frames without the rigid part on free bodies, whose exact solution, body by body and in
// the body frame, is the rigid velocity returned.
Vector StokesSystem::straining_data(const BoundarySet& set, ComplexVector data, std::vector<RigidVelocity>& rigid) const {
  const double full_norm = data.norm();
  rigid.assign(body_count(), {});
  for (const int i : set.members) {
    const PlacedShape& b = boundaries_[i];
    Complex* own = &data[set.first[i]];
    for (int k = 0; k < b.size(); ++k) own[k] *= std::conj(b.axis);
    if (b.shape->kind != BoundaryKind::free) continue;
    const RigidVelocity part = b.shape->rigid_part(own);
    for (int k = 0; k < b.size(); ++k) own[k] -= part.velocity + part.omega * perp(b.shape->curve.position[k]);
    rigid[i] = {-part.velocity, -part.omega};
  }
  // What is left of a purely rigid right-hand side is round-off, not data.
  if (data.norm() <= 1e-14 * full_norm) data.setZero();
  return as_real(data);
}

// Adds the rigid velocities and the reactions of the density, in the laboratory frame. The density of
// boundaries outside the set is zero.
void StokesSystem::finish(const BoundarySet& set, const Vector& density, StokesSolution& solution) const {
  solution.density = ComplexVector::Zero(node_count());
  for (const int i : set.members) {
    const PlacedShape& b = boundaries_[i];
    as_real(solution.density).segment(2 * b.offset, 2 * b.size()) = density.segment(2 * set.first[i], 2 * b.size());
    if (b.shape->kind != BoundaryKind::free) continue;
    const RigidVelocity part = b.shape->rigid_part(&solution.density[b.offset]);
    solution.velocity[i].velocity = b.axis * (solution.velocity[i].velocity + 0.5 * part.velocity);
    solution.velocity[i].omega += 0.5 * part.omega;
  }
  solution.reaction = reactions(solution.density);
}

StokesSolution StokesSystem::solve_data(const BoundarySet& set, ComplexVector data, const ComplexVector& guess,
                                        double tolerance, double scale) const {
  StokesSolution solution;
  const Vector rhs = straining_data(set, std::move(data), solution.velocity);
  const GmresResult result =
      gmres([&](const Vector& in, Vector& out) { apply(set, in, out); },
            [&](const Vector& in, Vector& out) { preconditioner_->apply(set, in, out); }, rhs,
            guess.size() == set.size() ? Vector(as_real(guess)) : Vector(),
            {.tolerance = tolerance, .max_iterations = options_.gmres_max_iterations, .scale = scale});
  if (!result.converged)
    throw NumericalError(
        concat("GMRES stopped at a relative residual of ", result.residual, " after ", result.iterations,
               " iterations; the tolerance is ", tolerance,
               " (bodies closer than the points resolve? try more points_per_body or a larger separation)"));
  solution.iterations = result.iterations;
  solution.residual = result.residual;
  solution.data_norm = rhs.norm();
  finish(set, result.x, solution);
  return solution;
}

StokesSolution StokesSystem::solve(const BackgroundFlow& flow, const std::vector<Wrench>& wrenches,
                                   const ComplexVector& guess, double scale) const {
  StokesSolution solution = solve_data(all_, boundary_data(all_, flow, wrenches), guess, options_.gmres_tolerance, scale);
  add_given_motion(flow, solution);
  return solution;
}

void StokesSystem::add_given_motion(const BackgroundFlow& flow, StokesSolution& solution) const {
  for (const int f : fixed_)
    solution.velocity[f] = {flow.walls * surfaces_[f].translation, flow.walls * surfaces_[f].angular_velocity};
}

StokesSolution StokesSystem::solve_for_velocity(const ComplexVector& velocity, const ComplexVector& guess) const {
  return solve_data(all_, velocity, guess, options_.gmres_tolerance);
}

// With A the whole operator and A_d its diagonal blocks, A_d eta = rhs - (A - A_d) lagged is
// eta = lagged + A_d^-1 (rhs - A lagged).
StokesSolution StokesSystem::sweep(const BackgroundFlow& flow, const std::vector<Wrench>& wrenches,
                                   const ComplexVector& lagged) const {
  StokesSolution solution;
  Vector residual = straining_data(all_, boundary_data(all_, flow, wrenches), solution.velocity);
  Vector density = Vector::Zero(residual.size()), change(residual.size());
  if (lagged.size() == node_count()) {
    density = as_real(lagged);
    apply(all_, density, change);
    residual -= change;
  }
  Preconditioner(PreconditionerKind::block, boundaries_, {}, 0.0, {}).apply(all_, residual, change);
  density += change;
  finish(all_, density, solution);
  add_given_motion(flow, solution);
  return solution;
}

BoundarySet StokesSystem::around(const std::vector<Wrench>& wrenches) const {
  std::vector<int> members;
  const auto reach = [this](int i) { return (1.0 + nearby) * boundaries_[i].shape->shape.circumradius(); };
  const std::vector<int> centres = acted_on(wrenches);
  for (int i = 0; i < static_cast<int>(boundaries_.size()); ++i) {
    const PlacedShape& b = boundaries_[i];
    const double radius = b.shape->shape.circumradius();
    if (std::any_of(centres.begin(), centres.end(), [&](int j) {
          const double apart = std::abs(b.pose.centre - boundaries_[j].pose.centre);
          return b.shape->kind == BoundaryKind::container ? radius - apart < reach(j) : apart - radius < reach(j);
        }))
      members.push_back(i);
  }
  return {boundaries_, std::move(members)};
}

StokesSolution StokesSystem::solve_nearby(const std::vector<Wrench>& wrenches, double tolerance) const {
  const BoundarySet set = around(wrenches);
  return solve_data(set, boundary_data(set, {}, wrenches), {}, tolerance);
}

}  // namespace stokes
