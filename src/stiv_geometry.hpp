// When and where the vertices of one moving convex polygon enter another.
#pragma once

#include <vector>

#include "base.hpp"

namespace stokes {

// A convex polygon, counter-clockwise, whose vertices move linearly during a step:
//   x_k(tau) = (1 - tau) start_k + tau end_k,   tau in [0, 1].
// Edge j runs from vertex j to vertex j + 1, the last one back to vertex 0.
// The polygon must stay convex. A rigid polygon does if its rotation in the step is below pi: on the
// straight paths of its vertices it is rotated and shrunk, by cos(rotation / 2) at most.
struct MovingPolygon {
  std::vector<Complex> start, end;
};

// Vertex `vertex` of one polygon meets the point (1 - sigma) Q_edge + sigma Q_(edge+1) of the other at tau.
struct VertexHit {
  int vertex, edge;
  double tau, sigma;
  Complex normal;   // unit outward normal of the other polygon there, at tau
  double interval;  // <normal, P - Q> at the END of the step, negative; Q moves with its edge at fixed sigma
};

// The first entry of each vertex P of `moving` into `target`, in increasing order of the vertices; at most
// one for each. P enters through an edge where
//   g(tau) = cross(P - Q_0, Q_1 - Q_0)(tau),   a quadratic,
// falls through zero with sigma in [0, 1]. It does so at one of its two roots only, which is computed without
// cancellation; constant and linear g are no exceptions. As P = Q at tau,
//   interval = (1 - tau) <normal, displacement of P - displacement of Q>.
//
// A vertex that is inside at tau = 0, or outside by no more than 1e-12 of the target's size, is measured
// against the nearest point of the boundary: a hit at tau = 0 if its interval is negative. If it is not,
// the vertex leaves, and its first entry after that counts.
//
// At a corner (to 1e-9 of the edge, where rounding would choose between its edges) the normal bisects those
// of the two edges, so that symmetric configurations stay symmetric.
//
// Every entry is found, also one followed by an exit. When two polygons that are apart at tau = 0 first touch,
// a vertex of one is on the other; testing both ways therefore misses no contact.
// Cost: boxes around the paths of vertices and edges reduce the candidates; at worst the product of the
// numbers of vertices, 3 ns each.
std::vector<VertexHit> vertex_hits(const MovingPolygon& moving, const MovingPolygon& target);

// Where a vertex leaves the circle |x| = radius, which is at rest and fluid inside.
struct WallHit {
  int vertex;
  double tau;
  Complex normal;   // unit, from the wall into the fluid
  Complex point;    // Q = -radius normal, on the circle
  double interval;  // <normal, P - Q> at the end of the step, negative
};

// The vertices of `moving` that end outside the circle, in increasing order. A vertex P leaves it where
// |P(tau)|^2 - radius^2, a quadratic, rises through zero. One that is outside at tau = 0 and stays there has
// tau = 0 and the point nearest to its end.
std::vector<WallHit> wall_hits(const MovingPolygon& moving, double radius);

}  // namespace stokes
