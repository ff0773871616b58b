// Shapes of bodies: everything the package knows of a body's form is asked of this class.
#pragma once

#include <vector>

#include "base.hpp"

namespace stokes {

class Curve;

// Support function of a convex shape in a direction n of its own frame: h(n) = max <n, p> over its points p.
struct Support {
  double height;     // h(n)
  Complex point;     // the boundary point p that attains it
  double curvature_radius;  // h + h'', the radius of curvature there
};

// A place of a boundary, in its parameter, around which nodes stand closer, by up to `density` >= 1 times.
struct NodeCluster {
  double alpha;
  double density;

  bool operator==(const NodeCluster&) const = default;
};

// Nodes of a boundary: `points` of them at equal steps of the parameter, and as many again around each cluster.
struct Discretisation {
  int points = 0;
  std::vector<NodeCluster> clusters;

  int size() const { return points * (1 + static_cast<int>(clusters.size())); }
  bool operator==(const Discretisation&) const = default;
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

  // The boundary in the body frame (centre 0, angle 0), zeta = a cos(alpha) + i b sin(alpha), at n nodes of equal
  // steps of a parameter s that maps the circle to itself. With m clusters and Poisson kernels P of mean 1,
  //   (1 + m) s = alpha + Sum_k Int_0^alpha P_k,   P_k = (1-r_k^2)/(1 - 2 r_k cos(alpha - alpha_k) + r_k^2),
  // with (1+r_k)/(1-r_k) = density_k; analytic, so that the trapezoid rule keeps its accuracy.
  Curve curve(const Discretisation& nodes) const;
  Curve curve(int points) const;

  // Node parameters alpha of the same nodes, increasing from 0.
  static std::vector<double> parameters(const Discretisation& nodes);
  // Where in [0, 2 pi) of s a value of alpha in [0, 2 pi) stands: the inverse of that map.
  static double position_of(double alpha, const Discretisation& nodes);
};

}  // namespace stokes
