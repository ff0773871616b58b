// Strengths of point sources, sorted in the order of a quadtree for the kernels.
#pragma once

#include <vector>

#include "direct_fields.hpp"
#include "simd.hpp"
#include "pair_kernels.hpp"
#include "quadtree.hpp"

namespace stokes {

class SortedStrengths {
 public:
  // `sources` must outlive the strengths, `strengths` have been checked for their sizes. Raises
  // NumericalError for values that are not finite. Cost O(sources), threaded.
  void sort(const SortedPoints& sources, const SourceStrengths& strengths);

  bool has_stresslets() const { return has_stresslets_; }
  const StressletArrays& stresslets() const { return stresslets_; }

  // Stokeslets and rotlets: only the sources with a force or a torque, in the order of the tree.
  bool has_forces() const { return has_forces_; }
  const PointForceArrays& forces() const { return forces_; }
  // The range of forces() that belongs to a range of all sources.
  PointRange forces_among(PointRange range) const {
    if (!has_forces_) return {};
    return {rank_[range.begin], rank_[range.end]};
  }

 private:
  void sort_stresslets(const SortedPoints& sources, const SourceStrengths& s);
  void sort_forces(const SortedPoints& sources, const SourceStrengths& s);

  bool has_stresslets_ = false, has_forces_ = false;
  AlignedVector nx_, ny_, ex_, ey_;
  AlignedVector x_, y_, fx_, fy_, torque_;
  std::vector<int> rank_;  // number of sources with force or torque before each one, in the order of the tree
  StressletArrays stresslets_{};
  PointForceArrays forces_{};
};

}  // namespace stokes
