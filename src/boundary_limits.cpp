#include "boundary_limits.hpp"

#include "fourier.hpp"

namespace stokes {

namespace {

// Half the jump of the gradient and pressure, from the derivative of the density along the curve.
PointFlow jump(Complex tangent, Complex slope) {
  const double q = dot(slope, tangent), half_rotation = -0.5 * cross(tangent, slope);
  const Complex strain = -0.5 * q * tangent * tangent;  // t t - n n = [Re t^2, Im t^2; Im t^2, -Re t^2]
  return {0.0, q, strain + Complex(0.0, half_rotation), -imaginary_unit * strain - half_rotation};
}

}  // namespace

std::vector<PointFlow> boundary_limits(const Curve& curve, Side side, const ComplexVector& density) {
  const int n = curve.size();
  if (n % 2 != 0)
    throw InputError("limits on a curve by alternate points need an even number of nodes; got " + std::to_string(n));
  const double s = side == Side::interior ? 1.0 : -1.0;
  const ComplexVector along = fourier_derivative(density);
  std::vector<PointFlow> limits(n);
  for (int j = 0; j < n; ++j) {
    const Complex tangent = curve.tangent[j];
    PointFlow principal_value;
    Complex layer = -s * curve.curvature[j] / (2.0 * pi) * curve.weight[j] * dot(tangent, density[j]) * tangent;
    for (int k = 0; k < n; ++k) {
      if (k == j) continue;
      const Complex r = curve.position[j] - curve.position[k];
      const Complex weighted_normal = -imaginary_unit * s * curve.tangent[k] * curve.weight[k];
      layer += stresslet_flow(r, weighted_normal, density[k]).velocity;
      if ((k - j) % 2 != 0) principal_value += stresslet_flow(r, 2.0 * weighted_normal, density[k] - density[j]);
    }
    limits[j] = principal_value + jump(tangent, along[j] / std::abs(curve.derivative[j]));
    limits[j].velocity = layer - 0.5 * density[j];
  }
  return limits;
}

}  // namespace stokes
