// Smooth closed curves sampled at N equal steps of their parameter, counter-clockwise.
#pragma once

#include <vector>

#include "base.hpp"

namespace stokes {

// A point near a curve. If it belongs to a cluster of the curve, its offset from the cluster's point is also stored, in
// the frame whose first axis is the tangent there. Differences from nodes of the cluster then keep their relative accuracy.
struct Target {
  Complex position;
  int cluster = -1;
  Complex offset{};
};

// For each node the nearest cluster (node_map.hpp) and the offset from the cluster's point. Empty without clusters.
struct CurveClusters {
  std::vector<Complex> tangent;  // of each cluster
  std::vector<int> nearest;
  std::vector<Complex> offset;
};

class Curve {
 public:
  // From nodes zeta(alpha_k) and exact derivatives with respect to alpha, each of length N.
  Curve(ComplexVector position, ComplexVector derivative, ComplexVector second_derivative, CurveClusters clusters = {});

  // From the nodes alone, with spectral derivatives. N even, at least 8, counter-clockwise; otherwise
  // InputError.
  static Curve through(const ComplexVector& nodes);

  int size() const { return static_cast<int>(position.size()); }
  double length() const { return weight.sum(); }
  double area() const;         // enclosed, (1/2) Int Im(conj(zeta) zeta') d alpha
  double max_spacing() const { return weight.maxCoeff(); }
  Complex centroid() const;    // of the arclength measure

  Target node(Eigen::Index k) const;
  // zeta_k - z for every node.
  ComplexVector from(const Target& z) const;

  ComplexVector position;      // zeta
  ComplexVector derivative;    // zeta'
  ComplexVector second;        // zeta''
  ComplexVector tangent;       // t = zeta' / |zeta'|
  Vector weight;               // trapezoid weights |zeta'| 2 pi / N of the arclength
  Vector curvature;            // positive where a counter-clockwise curve is convex
  CurveClusters clusters;
};

}  // namespace stokes
