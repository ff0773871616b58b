// Contact constraints from space-time interference volumes (sections 2.3 and 3.2 of the paper).
//
// Every body is a polygon: its curve is sampled at equal steps of its parameter, and the vertices are moved outward by
// half the minimum separation along the curve's normals. From the poses at the start to those at the end of a
// step the vertices move linearly, tau in [0, 1]. A vertex P of one body that enters the other through the point
// Q = (1 - sigma) Q_0 + sigma Q_1 of an edge at tau_P, where the outward normal is n, contributes
//   V_P = - ds_P (1 - tau_P) |<n, displacement of P - displacement of Q>| = ds_P <n, (P - Q)(end)>   (< 0),
// where ds_P is half the length of the two edges at P, and Q moves with its edge at fixed sigma. The second
// form holds because P = Q at tau_P. A vertex inside at the start has tau_P = 0 and Q nearest to it, and
// contributes where the second form is negative, that is, unless it leaves through the plane at Q.
// V sums the contributions of a contact region, from vertices of both bodies. Only relative displacements enter. V is
// therefore independent of a common translation, and the two forces of a contact are opposite.
//
// The container is a circle, not a polygon, moved inward by half the minimum separation. A vertex that leaves it
// through Q contributes as above, n pointing inward at Q. One that is outside all the time contributes
// ds_P <n, (P - Q)(end)> with the Q nearest to its end. V < 0 therefore holds exactly if a vertex ends outside.
#pragma once

#include <vector>

#include "contact.hpp"
#include "stiv_geometry.hpp"
#include "suspension.hpp"

namespace stokes {

// The derivative of V with respect to the end of the step. n and sigma are held fixed in both.
enum class StivGradient {
  full,    // dV/dP = ds n, dV/dQ_0 = -(1 - sigma) ds n, dV/dQ_1 = -sigma ds n: tau_P moves with the end
  frozen,  // (1 - tau_P) times that, with the hit time held fixed: the paper's choice. It is too small by this factor,
           // so that a Newton step parts the bodies too far
};

struct StivOptions {
  int vertices;  // of each polygon; at least 8. A fixed body gets the smallest multiple of it with which its
                 // vertices are at least as dense, along the perimeter, as those of the densest mobile body
  StivGradient gradient = StivGradient::full;
};

// Finds the contact regions of one step from the poses at its start, except those of two fixed bodies, with
//   value     = V, an area: negative, and exactly 0 (no constraint) where the polygons do not meet;
//   tolerance = the volume of one vertex at a depth of contact_tolerance times the separation, where the vertices of both
//               bodies are closest; at least 1e-12 r_a r_b, with the circumradii r of the bodies, or the container's
//               radius;
//   gradient  = dV by StivOptions::gradient; (vertex - centre) at the end of the step is the arm of angles;
//   force     = gradient. The forces on the two bodies are opposite to the last bit. Their torques balance up
//               to (P - Q)(end) x force: exactly if V = 0 with the contact at the end of the step.
//
// Accuracy of the gradient. `full` is the derivative of V along n, except where a vertex changes edges, and with a
// relative error of order w where an edge turns by w during the step. Where sliding carries a vertex across a corner, V
// jumps by about ds times 2 pi / vertices times the rest of the way. The corresponding derivative along the tangent, due
// to the change of n along the curve, is in neither choice.
//
// A region is a set of entering vertices that are neighbours on their polygon or whose edges share a vertex
// with each other or with an entering vertex. Regions of a pair are numbered 0, 1, ... by their lowest vertex,
// those of body a (a < b) first. A convex pair rarely has more than one. Numbers shift when a region vanishes.
//
// Limits. The curve bulges beyond its polygon: bodies may come closer than the separation by up to
//   (pi / vertices)^2 / 2 times the sum over the two of r (1 + r separation / (2 r_min^2)),
// where r and r_min are the semi-axes. With 32 vertices that is half a percent of a disc's radius; with a separation of 0
// curves can overlap by it. On its straight path a vertex of a body that turns by w is up to r w^2 / 8 inside the rigid
// path; a graze that shallow is missed or invented. w should be below 0.2 and must be below pi. Bodies must not overlap at
// the start. Their offset polygons may, by less than the separation; a cross with no vertex of either inside the other is
// not seen.
// Cost with 128 vertices: 5 to 10 microseconds for a pair in contact, 80 for one that passes through, less
// for one whose circles only meet; up to 1 ms for 48 crowded bodies.
class StivCollector {
 public:
  // separation >= 0. The suspension must outlive the collector. Raises InputError for fewer than 8 vertices
  // and for a separation that is negative or not a number.
  StivCollector(const Suspension& start, double separation, const StivOptions& options);

  double separation() const { return separation_; }

  // The regions in contact, sorted by pair and region, on the calling thread.
  // trial: one pose per body. Raises what neighbour_pairs() raises.
  std::vector<ContactConstraint> collect(const std::vector<Pose>& trial) const;

 private:
  // A body's vertices relative to its centre: its offset polygon in the laboratory's directions.
  struct Outline {
    std::vector<Complex> body_frame, start;
    std::vector<double> arclength;  // ds
    double shortest = 0.0;          // of them
  };

  std::vector<ContactConstraint> collect_pair(int a, int b, const std::vector<Pose>& trial) const;
  std::vector<ContactConstraint> collect_wall(int a, const Pose& trial) const;

  const Suspension& start_;
  double separation_;
  StivOptions options_;
  std::vector<Outline> outline_;
};

}  // namespace stokes
