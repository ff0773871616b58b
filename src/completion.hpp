// Completion flows: what a double layer cannot represent, the flow of a net force and torque on a hole.
//
// For an ellipse they are the closed-form flows of the rigid ellipse itself rather than singularities at
// its centre: their trace on the own boundary is a rigid motion to round-off at any number of nodes,
// where the trace of a centre singularity is resolved only like exp(-N atanh(b/a)). For a disc they are
// the Stokeslet with its degenerate quadrupole and the rotlet.
#pragma once

#include "point_flow.hpp"
#include "suspension.hpp"

namespace stokes {

// The flow of a body that exerts `wrench` (force, and torque about its centre) on an otherwise quiescent unbounded
// fluid; up to the constant velocity that the logarithm leaves free, which log_length, the unit of the distances in it,
// settles.
class CompletionFlow {
 public:
  CompletionFlow(const Shape& shape, const Pose& pose, const Wrench& wrench, double log_length = 1.0);

  // At x on or outside the body.
  Complex velocity(Complex x) const;

 private:
  Complex centre_, axis_;
  double A_, B_;
  Complex focus_;  // of a > b real, otherwise imaginary
  double log_unit_;
  Complex force_, torque_;  // body frame, over 4 pi and times i over 4 pi (A^2 + B^2)
};

inline Complex completion_velocity(const Shape& shape, const Pose& pose, const Wrench& wrench, Complex x,
                                   double log_length = 1.0) {
  return CompletionFlow(shape, pose, wrench, log_length).velocity(x);
}

// The same with pressure, which vanishes at infinity, and velocity gradient. Accurate to round-off up to the body.
PointFlow completion_flow(const Shape& shape, const Pose& pose, const Wrench& wrench, Complex x,
                          double log_length = 1.0);

// The rigid motion to which that flow reduces on the body's own boundary: the self-mobility of the body. In
// two dimensions its translational part depends on the unit of length and may be negative.
RigidVelocity completion_trace(const Shape& shape, const Pose& pose, const Wrench& wrench, double log_length = 1.0);

// Stresslet S_11 + i S_12 (laboratory frame, about the centre) that the completion flow carries: zero
// for a disc; a torque L on an ellipse carries -i (L/2)(a^2-b^2)/(a^2+b^2) in the body frame.
Complex completion_stresslet(const Shape& shape, const Pose& pose, const Wrench& wrench);

}  // namespace stokes
