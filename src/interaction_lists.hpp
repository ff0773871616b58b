// Which boxes of a quadtree act on which, and how: the lists of the adaptive fast multipole method
// (Carrier, Greengard and Rokhlin, SIAM J. Sci. Stat. Comput. 9, 1988).
//
// Two boxes of one level are adjacent if they share a point; colleagues are adjacent boxes of one level,
// the box itself included. Every pair of a source and a target is dealt with exactly once:
//   far         source box of the target box's level, not adjacent, but its parent is adjacent to the
//               target's parent: multipole to local
//   fine        source box smaller than the target leaf and not adjacent to it, but its parent is:
//               multipole to points
//   coarse      the reverse, source leaf larger than the target box: points to local
//   near        the rest: points to points
// Fine and coarse pairs with few points are moved to the near list where that costs less.
#pragma once

#include <span>
#include <vector>

#include "quadtree.hpp"

namespace stokes {

// Rows of different length, one after the other.
template <class T>
struct Rows {
  std::vector<int> start;
  std::vector<T> entries;

  std::span<const T> operator[](int row) const {
    return {entries.data() + start[row], static_cast<std::size_t>(start[row + 1] - start[row])};
  }
};

// Offset number of a source box that lies (columns, rows) away from the target box, each from -3 to 3.
inline constexpr int offset_count = 49;
constexpr int offset_number(int columns, int rows) { return 7 * (columns + 3) + rows + 3; }
inline Complex offset_vector(int offset) { return Complex(offset / 7 - 3, offset % 7 - 3); }

struct FarSource {
  int box, offset;
};

struct InteractionLists {
  Rows<FarSource> far;    // for each box
  Rows<int> coarse;       // for each box: source leaves
  Rows<int> fine;         // for each leaf: source boxes
  Rows<PointRange> near;  // for each leaf: sources other than its own, in increasing order
};

// `order`: terms of an expansion, which decides how few points make the near list cheaper. Only pairs with
// sources on one side and targets on the other are listed. Cost O(boxes).
InteractionLists find_interactions(const Quadtree& tree, int order);

}  // namespace stokes
