// Fast multipole method for the flow of stresslets, Stokeslets and rotlets in the plane.
//
// The flow of direct_fields.hpp, in O(targets + sources): an adaptive quadtree (quadtree.hpp), expansions of
// the two analytic functions of Stokes flow about its boxes (fmm_translations.hpp), the kernels of the direct
// sum between boxes that touch. Sources that coincide with a target are left out.
//
// Accuracy: the largest error over the targets, divided by the largest value there, of velocity, pressure
// and velocity gradient, is below the tolerance (measured: 3 to 50 times below, from 1e-3 to 1e-12, for
// uniform points, points on bodies and bodies in an annulus, random and smooth strengths). No such bound
// holds if the flow cancels at all targets. Rounding limits the accuracy to about 1e-14.
//
// Cost on one core with 512-bit vectors, for stresslets and velocity: 0.10, 0.2, 0.25 and 0.3 microseconds a
// point at tolerances 1e-3, 1e-6, 1e-9 and 1e-12; 2.5 times that for the gradient. A plan costs less than an
// evaluation. Multipole-to-local translations take about two thirds of the time and are bound by the multiply-add
// units. The near field takes the rest. Leaves hold 20 to 60 points, where the sum of both is flat. Points closer than
// 1e-14 of the largest coordinate share a leaf, whose pairs are summed directly.
#pragma once

#include <memory>

#include "direct_fields.hpp"

namespace stokes {

// From this many points on, an evaluation is faster than the direct sum at any tolerance. Ten evaluations make up for
// the plan (measured crossover of the evaluation: 350 points at 1e-3 to 600 at 1e-12).
inline constexpr int fmm_crossover = 1000;

struct FmmOptions {
  double tolerance = 1e-9;  // see above; 1e-13 to 0.1
};

// Everything that depends on the points only: tree, interaction lists, translation tables.
//
// A plan also owns the memory of its evaluations, so that only one evaluation of a plan may run at a time.
class FmmPlan {
 public:
  // Targets are the sources. Raises InputError for a tolerance out of range, and for coordinates that are
  // not finite or beyond 1e37.
  FmmPlan(const PointArray& points, const FmmOptions& options);
  FmmPlan(const PointArray& sources, const PointArray& targets, const FmmOptions& options);
  ~FmmPlan();
  FmmPlan(FmmPlan&&) noexcept;
  FmmPlan& operator=(FmmPlan&&) noexcept;

  // Flow at all targets, in the order of the targets. The sum of Stokeslets and rotlets skips sources without force
  // and torque. Threaded; the result does not depend on the number of threads or on
  // earlier evaluations. Raises InputError for strengths of the wrong number, NumericalError for strengths
  // that are not finite.
  void evaluate(const SourceStrengths& strengths, FlowOutput output, FlowFields& fields) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace stokes
