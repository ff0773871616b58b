#include "interaction_lists.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

namespace stokes {

namespace {

// Up to nine adjacent boxes of one level.
struct Colleagues {
  std::array<int, 9> box;
  int count = 0;

  void add(int b) { box[count++] = b; }
};

// Boxes (of any two levels, `large` the coarser) that share a point.
bool adjacent(const Box& large, const Box& small) {
  const int shift = small.level - large.level;
  const auto meets = [shift](std::int64_t a, std::int64_t b) {
    return b >= (a << shift) - 1 && b <= ((a + 1) << shift);
  };
  return meets(large.column, small.column) && meets(large.row, small.row);
}

// Pairs (row, entry) in rows; the order of entries within a row stays.
template <class T>
Rows<T> in_rows(const std::vector<std::pair<int, T>>& pairs, int row_count) {
  Rows<T> rows;
  rows.start.assign(row_count + 1, 0);
  for (const auto& [row, entry] : pairs) ++rows.start[row + 1];
  for (int r = 0; r < row_count; ++r) rows.start[r + 1] += rows.start[r];
  rows.entries.resize(pairs.size());
  std::vector<int> next(rows.start.begin(), rows.start.end() - 1);
  for (const auto& [row, entry] : pairs) rows.entries[next[row]++] = entry;
  return rows;
}

class Search {
 public:
  Search(const Quadtree& tree, int order) : tree_(tree), boxes_(tree.boxes()), order_(order) {}

  InteractionLists run() {
    const int count = tree_.box_count();
    colleagues_.resize(count);
    colleagues_[0].add(0);
    touching_.start = {0, 0};
    lists_.far.start = lists_.coarse.start = {0, 0};
    for (int b = 1; b < count; ++b) {
      visit(b);
      touching_.start.push_back(static_cast<int>(touching_.entries.size()));
      lists_.far.start.push_back(static_cast<int>(lists_.far.entries.size()));
      lists_.coarse.start.push_back(static_cast<int>(lists_.coarse.entries.size()));
    }
    for (int b = 0; b < count; ++b) {
      if (boxes_[b].is_leaf()) find_near(b);
    }
    lists_.fine = in_rows(fine_, count);
    lists_.near = in_rows(near_, count);
    merge_ranges();
    return std::move(lists_);
  }

 private:
  // Divides the boxes adjacent to the parent of b into those that are adjacent to b and those that are not.
  void visit(int b) {
    const Box& box = boxes_[b];
    const Colleagues& around = colleagues_[box.parent];
    for (int k = 0; k < around.count; ++k) {
      const int c = around.box[k];
      const Box& other = boxes_[c];
      if (other.is_leaf()) {
        visit_leaf(b, c);
        continue;
      }
      for (int d = other.first_child; d < other.first_child + other.child_count; ++d) {
        const int columns = static_cast<int>(boxes_[d].column - box.column);
        const int rows = static_cast<int>(boxes_[d].row - box.row);
        if (std::abs(columns) <= 1 && std::abs(rows) <= 1) {
          colleagues_[b].add(d);
        } else if (box.targets.size() > 0 && boxes_[d].sources.size() > 0) {
          lists_.far.entries.push_back({d, offset_number(columns, rows)});
        }
      }
    }
    for (int k = touching_.start[box.parent]; k < touching_.start[box.parent + 1]; ++k) {
      visit_leaf(b, touching_.entries[k]);
    }
  }

  // A leaf that is larger than b and adjacent to b's parent.
  void visit_leaf(int b, int leaf) {
    const Box &box = boxes_[b], &large = boxes_[leaf];
    if (adjacent(large, box)) {
      touching_.entries.push_back(leaf);
      return;
    }
    if (large.sources.size() > 0 && box.targets.size() > 0) {
      if (box.is_leaf() && !prefer_points_to_local(large.sources.size(), box.targets.size())) {
        near_.emplace_back(b, large.sources);
      } else {
        lists_.coarse.entries.push_back(leaf);
      }
    }
    if (box.sources.size() > 0 && large.targets.size() > 0) {
      if (box.sources.size() > order_) {
        fine_.emplace_back(leaf, b);
      } else {
        near_.emplace_back(leaf, box.sources);
      }
    }
  }

  // Estimated cycles: pairs of points come eight targets at a time, expansions eight sources at a time and
  // with a summation over the lanes.
  bool prefer_points_to_local(int sources, int targets) const {
    const long pairs = 8L * sources * ((targets + 7) / 8);
    const long expansion = order_ * (9L * ((sources + 7) / 8) + 14);
    return pairs > expansion;
  }

  void find_near(int b) {
    const auto add = [this](int target, int source) {
      if (boxes_[target].targets.size() > 0 && boxes_[source].sources.size() > 0) {
        near_.emplace_back(target, boxes_[source].sources);
      }
    };
    for (int k = 0; k < colleagues_[b].count; ++k) {
      const int c = colleagues_[b].box[k];
      if (c != b && boxes_[c].is_leaf()) add(b, c);
    }
    for (int k = touching_.start[b]; k < touching_.start[b + 1]; ++k) {
      add(b, touching_.entries[k]);
      add(touching_.entries[k], b);
    }
  }

  // Longer loops over sources cost less, so consecutive ranges are joined.
  void merge_ranges() {
    Rows<PointRange>& near = lists_.near;
    std::vector<PointRange> merged;
    merged.reserve(near.entries.size());
    for (std::size_t b = 0; b + 1 < near.start.size(); ++b) {
      const auto first = near.entries.begin() + near.start[b];
      const auto last = near.entries.begin() + near.start[b + 1];
      std::sort(first, last, [](PointRange p, PointRange q) { return p.begin < q.begin; });
      near.start[b] = static_cast<int>(merged.size());
      for (auto range = first; range != last; ++range) {
        if (range != first && merged.back().end == range->begin) {
          merged.back().end = range->end;
        } else {
          merged.push_back(*range);
        }
      }
    }
    near.start.back() = static_cast<int>(merged.size());
    near.entries = std::move(merged);
  }

  const Quadtree& tree_;
  const std::vector<Box>& boxes_;
  const int order_;
  std::vector<Colleagues> colleagues_;
  Rows<int> touching_;  // for each box: larger leaves adjacent to it
  std::vector<std::pair<int, int>> fine_;
  std::vector<std::pair<int, PointRange>> near_;
  InteractionLists lists_;
};

}  // namespace

InteractionLists find_interactions(const Quadtree& tree, int order) { return Search(tree, order).run(); }

}  // namespace stokes
