// Completion flows: the flow of a net force and torque on a body, which a double layer cannot represent.
//
// For an ellipse they are the closed-form flows of the rigid ellipse rather than singularities at its centre.
// On its own boundary such a flow is a rigid motion to round-off with any number of nodes, whereas N nodes
// resolve the trace of a singularity at the centre only like exp(-N atanh(b/a)). For a disc they are
// the Stokeslet with its degenerate quadrupole and the rotlet.
#pragma once

#include "point_flow.hpp"
#include "simd.hpp"
#include "suspension.hpp"

namespace stokes {

// The flow of a body that exerts `wrench` (force, and torque about its centre) on an otherwise quiescent unbounded
// fluid. The logarithm leaves a constant velocity free. It is fixed by log_length, the unit of the distances in the
// logarithm.
class CompletionFlow {
 public:
  CompletionFlow(const Shape& shape, const Pose& pose, const Wrench& wrench, double log_length = 1.0);

  // At points on or outside the body.
  ComplexPack velocity(ComplexPack x) const;
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

// The same with pressure, which vanishes at infinity, and velocity gradient. Accurate to round-off, also on the body.
PointFlow completion_flow(const Shape& shape, const Pose& pose, const Wrench& wrench, Complex x,
                          double log_length = 1.0);

// The rigid motion that this flow is on the body's own boundary: the self-mobility of the body. In two dimensions
// its translational part depends on the unit of length and may be negative.
RigidVelocity completion_trace(const Shape& shape, const Pose& pose, const Wrench& wrench, double log_length = 1.0);

// Stresslet S_11 + i S_12 of the completion flow (laboratory frame, about the centre). It is zero for a
// disc. For a torque L on an ellipse it is -i (L/2)(a^2-b^2)/(a^2+b^2) in the body frame.
Complex completion_stresslet(const Shape& shape, const Pose& pose, const Wrench& wrench);

}  // namespace stokes
