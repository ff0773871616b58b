// Adaptive quadtree over source and target points.
//
// Boxes are squares. A box with more than `leaf_size` sources or targets is split into its quadrants; quadrants without
// points are left out. Boxes are stored level by level, the children of one box side by side, and the points of every box
// are consecutive in the sorted order.
#pragma once

#include <cstdint>
#include <vector>

#include "base.hpp"
#include "direct_sum.hpp"

namespace stokes {

// Consecutive sorted points [begin, end).
struct PointRange {
  int begin = 0, end = 0;
  int size() const { return end - begin; }
};

struct Box {
  double x, y;               // centre
  std::int64_t column, row;  // place in the grid of its level
  int level, parent;
  int first_child = 0, child_count = 0;
  PointRange sources, targets;
  bool coincident = false;  // more than leaf_size points, all in one place

  bool is_leaf() const { return child_count == 0; }
  // Place in the parent: 0 and 1 below, 1 and 3 to the right.
  int quadrant() const { return static_cast<int>((column & 1) + 2 * (row & 1)); }
};

// Points in the order of the tree: x[k], y[k] is the input point number index[k].
struct SortedPoints {
  std::vector<double> x, y;
  std::vector<int> index;

  int size() const { return static_cast<int>(index.size()); }
};

class Quadtree {
 public:
  // `targets` absent: they are the sources. Cost O(points x depth), threaded; the tree does not depend on
  // the number of threads. Centres and box sizes are exact, which limits the depth: a box smaller than 1e-14
  // of the largest coordinate, or than 2^-48 of the root, is a leaf whatever it contains. Raises InputError
  // for arrays of different length and for coordinates that are not finite or beyond 1e37.
  Quadtree(const PointArray& sources, const PointArray* targets, int leaf_size);

  const std::vector<Box>& boxes() const { return boxes_; }
  int box_count() const { return static_cast<int>(boxes_.size()); }
  int level_count() const { return static_cast<int>(first_box_.size()) - 1; }
  // Boxes of level l: [first_box(l), first_box(l + 1)).
  int first_box(int level) const { return first_box_[level]; }
  double box_size(int level) const { return sizes_[level]; }

  const SortedPoints& sources() const { return sources_; }
  const SortedPoints& targets() const { return targets_are_sources_ ? sources_ : targets_; }
  bool targets_are_sources() const { return targets_are_sources_; }

 private:
  void add_root();
  template <class Sorter>
  void add_level(int leaf_size, Sorter& sort_sources, Sorter& sort_targets);
  bool in_one_place(const Box& box) const;

  bool targets_are_sources_;
  SortedPoints sources_, targets_;
  std::vector<Box> boxes_;
  std::vector<int> first_box_;
  std::vector<double> sizes_;
  int deepest_ = 0;  // level at which boxes are not split any more
};

}  // namespace stokes
