// Shapes of bodies: everything the package knows of a body's form is asked of this class.
#pragma once

#include "base.hpp"

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

  // The boundary in the body frame (centre 0, angle 0) sampled at `points` nodes of equal parameter,
  // zeta_k = a cos(alpha_k) + i b sin(alpha_k).
  Curve curve(int points) const;
};

}  // namespace stokes
