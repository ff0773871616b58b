#include "curve.hpp"

#include "fourier.hpp"

namespace stokes {

Curve::Curve(ComplexVector position_, ComplexVector derivative_, ComplexVector second_derivative,
             CurveClusters clusters_)
    : position(std::move(position_)), derivative(std::move(derivative_)), second(std::move(second_derivative)),
      clusters(std::move(clusters_)) {
  const Vector speed = derivative.cwiseAbs();
  tangent = derivative.cwiseQuotient(speed);
  weight = speed * (2.0 * pi / size());
  curvature.resize(size());
  for (int k = 0; k < size(); ++k)
    curvature[k] = cross(derivative[k], second[k]) / (speed[k] * speed[k] * speed[k]);
}

Curve Curve::through(const ComplexVector& nodes) {
  if (nodes.size() < 8 || nodes.size() % 2 != 0)
    throw InputError("a curve needs an even number of nodes, at least 8; got " + std::to_string(nodes.size()));
  const ComplexVector first = fourier_derivative(nodes);
  Curve curve(nodes, first, fourier_derivative(first));
  if (!(curve.area() > 0.0))
    throw InputError("the nodes of a curve must run counter-clockwise: the enclosed area is " +
                     std::to_string(curve.area()) + "; reverse their order");
  return curve;
}

Target Curve::node(Eigen::Index k) const {
  if (clusters.nearest.empty()) return {position[k]};
  return {position[k], clusters.nearest[k], clusters.offset[k]};
}

ComplexVector Curve::from(const Target& z) const {
  ComplexVector difference = position.array() - z.position;
  if (z.cluster < 0) return difference;
  const Complex axis = clusters.tangent[z.cluster];
  for (Eigen::Index k = 0; k < size(); ++k)
    if (clusters.nearest[k] == z.cluster) difference[k] = axis * (clusters.offset[k] - z.offset);
  return difference;
}

double Curve::area() const {
  double sum = 0.0;
  for (int k = 0; k < size(); ++k) sum += cross(position[k], derivative[k]);
  return sum * pi / size();
}

Complex Curve::centroid() const {
  return (position.array() * weight.array()).sum() / length();
}

}  // namespace stokes
