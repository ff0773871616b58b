// Smooth closed curves sampled at N equal steps of their parameter, counter-clockwise.
#pragma once

#include "base.hpp"

namespace stokes {

class Curve {
 public:
  // From nodes zeta(alpha_k) and exact derivatives with respect to alpha, each of length N.
  Curve(ComplexVector position, ComplexVector derivative, const ComplexVector& second_derivative);

  // From the nodes alone, with spectral derivatives. N even, at least 8, counter-clockwise; otherwise
  // InputError.
  static Curve through(const ComplexVector& nodes);

  int size() const { return static_cast<int>(position.size()); }
  double length() const { return weight.sum(); }
  double area() const;         // enclosed, (1/2) Int Im(conj(zeta) zeta') d alpha
  double max_spacing() const { return weight.maxCoeff(); }
  Complex centroid() const;    // of the arclength measure

  ComplexVector position;      // zeta
  ComplexVector derivative;    // zeta'
  ComplexVector tangent;       // t = zeta' / |zeta'|
  Vector weight;               // trapezoid weights |zeta'| 2 pi / N of the arclength
  Vector curvature;            // positive where a counter-clockwise curve is convex
};

}  // namespace stokes
