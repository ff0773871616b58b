#include "shape.hpp"

#include <cmath>

#include "curve.hpp"

namespace stokes {

// h = sqrt(a^2 x^2 + b^2 y^2), p = (a^2 x, b^2 y) / h, h + h'' = a^2 b^2 / h^3.
Support Shape::support(Complex n) const {
  const double ax = a * n.real(), by = b * n.imag();
  const double height = std::sqrt(ax * ax + by * by);
  const double inverse = 1.0 / height, product = a * b * inverse;
  return {height, {a * ax * inverse, b * by * inverse}, product * product * inverse};
}

// Arithmetic-geometric mean: x, y -> (x+y)/2, sqrt(xy) from a, b, and
//   perimeter = (2 pi / mean) (a^2 - Sum_n 2^(n-1) (x_n^2 - y_n^2)),   n = 0, 1, ...
double Shape::perimeter() const {
  double x = circumradius(), y = inradius(), sum = x * x, factor = 0.5;
  while (x - y > 1e-9 * x) {  // the next term is below round-off
    sum -= factor * (x * x - y * y);
    factor *= 2.0;
    const double mean = 0.5 * (x + y);
    y = std::sqrt(x * y);
    x = mean;
  }
  return 4.0 * pi * (sum - factor * (x * x - y * y)) / (x + y);
}

Curve Shape::curve(int points) const {
  ComplexVector position(points), first(points), second(points);
  for (int k = 0; k < points; ++k) {
    const double alpha = 2.0 * pi * k / points, c = std::cos(alpha), s = std::sin(alpha);
    position[k] = {a * c, b * s};
    first[k] = {-a * s, b * c};
    second[k] = -position[k];
  }
  return Curve(std::move(position), std::move(first), second);
}

}  // namespace stokes
