#include "discrete_shape.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <eigen3/Eigen/LU>

#include "completion.hpp"
#include "fourier.hpp"

namespace stokes {

namespace {

double aspect_ratio(const Shape& shape) { return shape.circumradius() / shape.inradius(); }

// Factor by which the close evaluation oversamples; the bandwidth on an ellipse grows with its aspect.
int upsampling_for(const Shape& shape, const Discretisation& nodes) {
  if (nodes.upsampling > 0) return nodes.upsampling;
  return aspect_ratio(shape) <= 3.0 ? 2 : 3;
}

std::variant<CloseEvaluation, CircleEvaluation, InterpolationEvaluation> close_evaluation(
    const Shape& shape, const Discretisation& nodes, const Curve& curve, Side side, NearSingular near_singular) {
  if (near_singular == NearSingular::interpolation) return InterpolationEvaluation(curve, side);
  if (shape.a == shape.b && nodes.clusters.empty()) return CircleEvaluation(shape.a, nodes.points, side);
  return CloseEvaluation(curve, shape.curve(nodes, upsampling_for(shape, nodes)), side);
}

// B: rigid motions at the nodes, 2N x 3.
Matrix rigid_motions(const Curve& curve) {
  const int n = curve.size();
  Matrix B = Matrix::Zero(2 * n, 3);
  for (int k = 0; k < n; ++k) {
    B(2 * k, 0) = B(2 * k + 1, 1) = 1.0;
    const Complex rotation = perp(curve.position[k]);
    B(2 * k, 2) = rotation.real(), B(2 * k + 1, 2) = rotation.imag();
  }
  return B;
}

}  // namespace

Eigen::Map<const Vector> as_real(const ComplexVector& v) {
  return {reinterpret_cast<const double*>(v.data()), 2 * v.size()};
}
Eigen::Map<Vector> as_real(ComplexVector& v) { return {reinterpret_cast<double*>(v.data()), 2 * v.size()}; }

Matrix real_matrix(const VelocityRows& rows, Complex turn) {
  Matrix m(2 * rows.direct.rows(), 2 * rows.direct.cols());
  for (Eigen::Index k = 0; k < rows.direct.cols(); ++k)
    for (Eigen::Index i = 0; i < rows.direct.rows(); ++i) {
      const Complex a = turn * rows.direct(i, k), b = turn * rows.conjugate(i, k);
      m(2 * i, 2 * k) = (a + b).real(), m(2 * i, 2 * k + 1) = (b - a).imag();
      m(2 * i + 1, 2 * k) = (a + b).imag(), m(2 * i + 1, 2 * k + 1) = (a - b).real();
    }
  return m;
}

DiscreteShape::DiscreteShape(const Shape& shape_, const Discretisation& nodes_, BoundaryKind kind_, double log_length_,
                             NearSingular near_singular)
    : shape(shape_), nodes(nodes_), kind(kind_), log_length(log_length_), curve(shape_.curve(nodes_)),
      close_(close_evaluation(shape, nodes, curve, side(), near_singular)) {
  const int n = size();
  const Matrix B = rigid_motions(curve);
  Matrix weighted = B;
  for (int k = 0; k < n; ++k) weighted.middleRows(2 * k, 2) *= curve.weight[k];
  moments = (weighted.transpose() * B).inverse() * weighted.transpose();
  closure = -2.0 * pi / curve.length() * weighted.transpose();
  const double s = side() == Side::interior ? 1.0 : -1.0;
  diagonal = -s * curve.curvature.cwiseProduct(curve.weight) / (2.0 * pi);

  const Matrix block = own_block();
  if (!is_circle()) {
    inverse_ = block.partialPivLu().inverse();
    return;
  }
  motions_.resize(2 * n, 4);
  for (int k = 0; k < n; ++k) {
    const Complex out = curve.position[k] / shape.a;
    motions_.row(2 * k) << 1.0, 0.0, out.real(), -out.imag();
    motions_.row(2 * k + 1) << 0.0, 1.0, out.imag(), out.real();
  }
  // W^T W = N: with block = -1/2 + W C W^T / N the inverse is W ((C - 1/2)^-1 + 2) W^T / N - 2.
  const Eigen::Matrix4d C = motions_.transpose() * (block * motions_) / n + 0.5 * Eigen::Matrix4d::Identity();
  core_ = ((C - 0.5 * Eigen::Matrix4d::Identity()).inverse() + 2.0 * Eigen::Matrix4d::Identity()) / n;
}

// The boundary's own part of the operator (BoundaryKind).
Matrix DiscreteShape::own_block() const {
  const int n = size();
  const Matrix B = rigid_motions(curve);
  std::vector<Target> own;
  for (int k = 0; k < n; ++k) own.push_back(curve.node(k));
  VelocityRows self = trapezoid_rows(curve, side(), own);
  for (int k = 0; k < n; ++k) {  // t (t . eta) = (eta + t^2 conj(eta)) / 2
    self.direct(k, k) = 0.5 * diagonal[k] - 0.5;
    self.conjugate(k, k) = 0.5 * diagonal[k] * curve.tangent[k] * curve.tangent[k];
  }
  Matrix block = real_matrix(self, 1.0);
  if (kind == BoundaryKind::free) {
    block -= 0.5 * B * moments;
  } else if (kind == BoundaryKind::fixed) {
    // The completion flows are rigid motions on their own boundary.
    Eigen::Matrix3d trace;
    for (int j = 0; j < 3; ++j) {
      const Wrench unit{{j == 0 ? 1.0 : 0.0, j == 1 ? 1.0 : 0.0}, j == 2 ? 1.0 : 0.0};
      const RigidVelocity u = completion_trace(shape, {}, unit, log_length);
      trace.col(j) << u.velocity.real(), u.velocity.imag(), u.omega;
    }
    block += B * trace * closure;
  } else {
    Vector normal(2 * n), flux(2 * n);
    for (int k = 0; k < n; ++k) {
      const Complex w = weighted_normal(k), unit = w / curve.weight[k];
      flux[2 * k] = w.real(), flux[2 * k + 1] = w.imag();
      normal[2 * k] = unit.real(), normal[2 * k + 1] = unit.imag();
    }
    block -= 0.5 / curve.length() * normal * flux.transpose();
  }
  return block;
}

VelocityRows DiscreteShape::close_rows(const std::vector<Target>& z) const {
  if (const auto* cauchy = std::get_if<CloseEvaluation>(&close_)) return cauchy->velocity_rows(z);
  std::vector<Complex> positions;
  for (const Target& target : z) positions.push_back(target.position);
  return std::visit([&positions](const auto& close) { return close.velocity_rows(positions); }, close_);
}

std::vector<PointFlow> DiscreteShape::close_flow(const ComplexVector& density, const std::vector<Complex>& z) const {
  std::vector<PointFlow> result;
  const auto evaluate = [&](const auto& flow) {
    for (Complex point : z) result.push_back(flow.at(point));
  };
  if (const auto* interpolation = std::get_if<InterpolationEvaluation>(&close_))
    evaluate(interpolation->flow(density));
  else
    evaluate(CloseFlow(shape.curve(nodes, flow_upsampling(aspect_ratio(shape), size())), side(), density));
  return result;
}

RigidVelocity DiscreteShape::rigid_part(const Complex* density) const {
  const Eigen::Map<const Vector> eta(reinterpret_cast<const double*>(density), 2 * size());
  const Eigen::Vector3d m = moments * eta;
  return {{m[0], m[1]}, m[2]};
}

Wrench DiscreteShape::wrench(const Complex* density) const {
  const Eigen::Map<const Vector> eta(reinterpret_cast<const double*>(density), 2 * size());
  const Eigen::Vector3d w = closure * eta;
  return {{w[0], w[1]}, w[2]};
}

double DiscreteShape::flux_part(const Complex* density) const {
  double flux = 0.0;
  for (int k = 0; k < size(); ++k) flux += dot(weighted_normal(k), density[k]);
  return -0.5 / curve.length() * flux;
}

std::vector<int> all_nodes(const PlacedShape& boundary) {
  std::vector<int> nodes(boundary.size());
  std::iota(nodes.begin(), nodes.end(), 0);
  return nodes;
}

BoundarySet::BoundarySet(const std::vector<PlacedShape>& boundaries, std::vector<int> members_)
    : members(std::move(members_)), first(boundaries.size(), -1) {
  int count = 0;
  for (const int i : members) first[i] = count, count += boundaries[i].size();
  nodes.resize(count), weighted_normal.resize(count);
  for (const int i : members) {
    const PlacedShape& b = boundaries[i];
    for (int k = 0; k < b.size(); ++k) {
      nodes.set(first[i] + k, b.node(k));
      weighted_normal.set(first[i] + k, b.axis * b.shape->weighted_normal(k));
    }
  }
}

double near_distance(const DiscreteShape& shape, double accuracy) {
  return 0.7 * std::clamp(-std::log10(accuracy), 4.0, 12.0) * shape.curve.max_spacing();
}
double near_distance_of_gradient(const DiscreteShape& shape) { return 8.0 * shape.curve.max_spacing(); }

std::vector<int> near_rows(const DiscreteShape& shape, const std::vector<Complex>& z, double limit) {
  std::vector<int> rows;
  for (int i = 0; i < static_cast<int>(z.size()); ++i)
    if ((shape.curve.position.array() - z[i]).abs2().minCoeff() < limit * limit) rows.push_back(i);
  return rows;
}

bool DiscreteShape::has_series() const {
  constexpr int long_rows = 256;
  return size() >= long_rows && std::holds_alternative<CircleEvaluation>(close_);
}

VelocityRows DiscreteShape::close_rows(const std::vector<Complex>& z, const std::vector<int>& some) const {
  return std::get<CircleEvaluation>(close_).velocity_rows(z, some);
}

// The series of the old nodes, summed at the new ones by Horner's rule in e^{i s}.
ComplexVector move_density(const ComplexVector& density, const Discretisation& from, const Discretisation& to) {
  if (from == to) return density;
  const Eigen::Index n = density.size(), half = n / 2;
  const ComplexVector c = fourier_coefficients(density);
  const NodeMap old(from);
  const std::vector<MappedNode> wanted = NodeMap(to).at_equal_steps(to.size());
  ComplexVector moved(static_cast<Eigen::Index>(wanted.size()));
  for (std::size_t j = 0; j < wanted.size(); ++j) {
    const double s = old.position(wanted[j].alpha);
    const Complex e = std::polar(1.0, s), back = std::conj(e);
    Complex up = 0.5 * c[half], down = 0.5 * c[half];
    for (Eigen::Index k = half - 1; k >= 1; --k) up = up * e + c[k], down = down * back + c[n - k];
    moved[static_cast<Eigen::Index>(j)] = c[0] + up * e + down * back;
  }
  return moved;
}

ComplexVector move_densities(const ComplexVector& density, const std::vector<Discretisation>& from,
                             const std::vector<Discretisation>& to) {
  Eigen::Index size = 0, old = 0, now = 0;
  for (const Discretisation& d : to) size += d.size();
  ComplexVector result(size);
  for (std::size_t i = 0; i < to.size(); ++i) {
    result.segment(now, to[i].size()) = move_density(density.segment(old, from[i].size()), from[i], to[i]);
    old += from[i].size(), now += to[i].size();
  }
  return result;
}

std::shared_ptr<const DiscreteShape> ShapeCache::get(const Shape& shape, const Discretisation& nodes,
                                                     BoundaryKind kind, double log_length) {
  const auto make = [&] { return std::make_shared<const DiscreteShape>(shape, nodes, kind, log_length, near_singular_); };
  if (!nodes.clusters.empty()) return make();
  auto& entry = shapes_[{shape.a, shape.b, nodes.points, nodes.upsampling, kind, log_length}];
  if (!entry) entry = make();
  return entry;
}

}  // namespace stokes
