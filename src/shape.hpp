// Shapes of bodies: all that other files need to know of a body's geometry.
#pragma once

#include "base.hpp"
#include "node_map.hpp"

namespace stokes {

class Curve;

// Support function of a convex shape in a direction n of its own frame: h(n) = max <n, p> over its points p.
struct Support {
  double height;     // h(n)
  Complex point;     // the boundary point p that attains it
  double curvature_radius;  // h + h'', the radius of curvature there
};

// An ellipse with semi-axis a along the body's first axis and b across it; a disc has a = b.
struct Shape {
  double a = 1.0;
  double b = 1.0;

  bool operator==(const Shape&) const = default;

  // n: unit vector in the body frame.
  Support support(Complex n) const;

  double circumradius() const { return a > b ? a : b; }
  double inradius() const { return a > b ? b : a; }

  // Arclength of the boundary, to round-off.
  double perimeter() const;

  // The boundary in the body frame (centre 0, angle 0), zeta = a cos(alpha) + i b sin(alpha), at its nodes or, with
  // `upsampling` > 1, at that many times as many equal steps of the parameter s of its nodes (node_map.hpp).
  Curve curve(const Discretisation& nodes, int upsampling = 1) const;
  Curve curve(int points) const;

  // alpha in [0, 2 pi) of the point that reaches farthest along n; point and derivative at a given alpha.
  double parameter(Complex n) const;
  Complex point(double alpha) const;
  Complex derivative(double alpha) const;  // zeta'(alpha)
  // zeta(alpha + t) - zeta(alpha) in the frame whose first axis is the tangent at alpha. Both components, along the
  // tangent and across it, are accurate relative to their own size for any t.
  Complex offset(double alpha, double t) const;
};

}  // namespace stokes
