#include "discrete_shape.hpp"

#include <eigen3/Eigen/LU>

namespace stokes {

namespace {

double aspect_ratio(const Shape& shape) { return shape.circumradius() / shape.inradius(); }

// Factor by which the close evaluation oversamples; the bandwidth on an ellipse grows with its aspect.
int upsampling_for(const Shape& shape) { return aspect_ratio(shape) <= 3.0 ? 2 : 3; }

std::variant<CloseEvaluation, InterpolationEvaluation> close_evaluation(const Shape& shape, const Curve& curve,
                                                                       NearSingular near_singular) {
  if (near_singular == NearSingular::interpolation) return InterpolationEvaluation(curve, Side::exterior);
  return CloseEvaluation(curve, Side::exterior, upsampling_for(shape));
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

DiscreteShape::DiscreteShape(const Shape& shape_, int points, NearSingular near_singular)
    : shape(shape_), curve(shape_.curve(points)), close_(close_evaluation(shape, curve, near_singular)) {
  const int n = points;
  const Matrix B = rigid_motions(curve);
  Matrix weighted = B;
  for (int k = 0; k < n; ++k) weighted.middleRows(2 * k, 2) *= curve.weight[k];
  moments = (weighted.transpose() * B).inverse() * weighted.transpose();
  diagonal = curve.curvature.cwiseProduct(curve.weight) / (2.0 * pi);

  VelocityRows self{Matrix(n, n), ComplexMatrix(n, n)};
  const std::vector<Complex> nodes(curve.position.begin(), curve.position.end());
  self = trapezoid_rows(curve, Side::exterior, nodes);
  for (int k = 0; k < n; ++k) {  // t (t . eta) = (eta + t^2 conj(eta)) / 2
    self.direct(k, k) = 0.5 * diagonal[k] - 0.5;
    self.conjugate(k, k) = 0.5 * diagonal[k] * curve.tangent[k] * curve.tangent[k];
  }
  inverse = (real_matrix(self, 1.0) - 0.5 * B * moments).partialPivLu().inverse();
}

VelocityRows DiscreteShape::close_rows(const std::vector<Complex>& z) const {
  return std::visit([&z](const auto& close) { return close.velocity_rows(z); }, close_);
}

std::vector<PointFlow> DiscreteShape::close_flow(const ComplexVector& density, const std::vector<Complex>& z) const {
  std::vector<PointFlow> result;
  const auto evaluate = [&](const auto& flow) {
    for (Complex point : z) result.push_back(flow.at(point));
  };
  if (const auto* interpolation = std::get_if<InterpolationEvaluation>(&close_))
    evaluate(interpolation->flow(density));
  else
    evaluate(CloseFlow(curve, Side::exterior, flow_upsampling(aspect_ratio(shape), size()), density));
  return result;
}

std::vector<PointFlow> DiscreteShape::trapezoid_flow(const ComplexVector& density,
                                                     const std::vector<Complex>& z) const {
  std::vector<PointFlow> result;
  for (Complex point : z) result.push_back(stokes::trapezoid_flow(curve, Side::exterior, density, point));
  return result;
}

RigidVelocity DiscreteShape::rigid_part(const Complex* density) const {
  const Eigen::Map<const Vector> eta(reinterpret_cast<const double*>(density), 2 * size());
  const Eigen::Vector3d m = moments * eta;
  return {{m[0], m[1]}, m[2]};
}

double near_distance(const DiscreteShape& shape) { return 7.0 * shape.curve.max_spacing(); }
double near_distance_of_gradient(const DiscreteShape& shape) { return 8.0 * shape.curve.max_spacing(); }

std::vector<int> near_rows(const DiscreteShape& shape, const std::vector<Complex>& z) {
  const double limit = near_distance(shape);
  std::vector<int> rows;
  for (int i = 0; i < static_cast<int>(z.size()); ++i)
    for (int k = 0; k < shape.size(); ++k)
      if (std::norm(z[i] - shape.curve.position[k]) < limit * limit) {
        rows.push_back(i);
        break;
      }
  return rows;
}

VelocityRows near_correction(const DiscreteShape& shape, const std::vector<Complex>& z) {
  VelocityRows rows = shape.close_rows(z);
  const VelocityRows plain = trapezoid_rows(shape.curve, Side::exterior, z);
  rows.direct -= plain.direct;
  rows.conjugate -= plain.conjugate;
  return rows;
}

Matrix interaction(const PlacedShape& target, const PlacedShape& source) {
  std::vector<Complex> z, close;
  for (int k = 0; k < target.size(); ++k) z.push_back(source.local(target.node(k)));
  VelocityRows rows = trapezoid_rows(source.shape->curve, Side::exterior, z);
  const std::vector<int> near = near_rows(*source.shape, z);
  for (int row : near) close.push_back(z[row]);
  if (!near.empty()) {
    const VelocityRows accurate = source.shape->close_rows(close);
    for (std::size_t r = 0; r < near.size(); ++r) {
      rows.direct.row(near[r]) = accurate.direct.row(r);
      rows.conjugate.row(near[r]) = accurate.conjugate.row(r);
    }
  }
  return real_matrix(rows, source.axis * std::conj(target.axis));
}

const DiscreteShape& ShapeCache::get(const Shape& shape, int points) {
  auto& entry = shapes_[{shape.a, shape.b, points}];
  if (!entry) entry = std::make_unique<DiscreteShape>(shape, points, near_singular_);
  return *entry;
}

}  // namespace stokes
