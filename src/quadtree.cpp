#include "quadtree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "text.hpp"
#include "threads.hpp"

namespace stokes {

namespace {

constexpr double largest_coordinate = 1e37;  // fourth powers of squared distances do not overflow

struct Bounds {
  double low_x = std::numeric_limits<double>::infinity(), low_y = low_x, high_x = -low_x, high_y = -low_x;

  void add(const SortedPoints& points) {
    for (const double x : points.x) low_x = std::min(low_x, x), high_x = std::max(high_x, x);
    for (const double y : points.y) low_y = std::min(low_y, y), high_y = std::max(high_y, y);
  }
};

SortedPoints unsorted(const PointArray& points, const char* what) {
  if (points.x.size() != points.y.size()) {
    throw InputError(concat("quadtree: the ", what, "s have ", points.x.size(), " abscissae and ",
                            points.y.size(), " ordinates; give one of each"));
  }
  for (int k = 0; k < points.size(); ++k) {
    if (std::abs(points.x[k]) <= largest_coordinate && std::abs(points.y[k]) <= largest_coordinate) continue;
    throw InputError(concat("quadtree: ", what, ' ', k, " lies at (", points.x[k], ", ", points.y[k],
                            "); coordinates must be finite and at most 1e37"));
  }
  SortedPoints result{points.x, points.y, std::vector<int>(points.x.size())};
  for (int k = 0; k < points.size(); ++k) result.index[k] = k;
  return result;
}

bool all_in_one_place(const SortedPoints& points, PointRange range, double x, double y) {
  for (int k = range.begin; k < range.end; ++k) {
    if (points.x[k] != x || points.y[k] != y) return false;
  }
  return true;
}

using Counts = std::array<int, 4>;

// Sorts ranges of points by quadrant; calls for ranges that do not overlap may run side by side.
struct QuadrantSorter {
  SortedPoints& points;
  SortedPoints scratch;
  std::vector<unsigned char> quadrant;

  explicit QuadrantSorter(SortedPoints& sorted)
      : points(sorted), scratch(sorted), quadrant(sorted.x.size()) {}

  // Keeps the order within each quadrant: 0 and 1 are the lower ones, 1 and 3 those to the right. Returns
  // how many points there are in each.
  Counts operator()(PointRange range, double x, double y) {
    Counts counts{};
    for (int k = range.begin; k < range.end; ++k) {
      const int q = (points.x[k] > x ? 1 : 0) + (points.y[k] > y ? 2 : 0);
      quadrant[k] = static_cast<unsigned char>(q);
      ++counts[q];
    }
    Counts next{range.begin};
    for (int q = 0; q < 3; ++q) next[q + 1] = next[q] + counts[q];
    for (int k = range.begin; k < range.end; ++k) {
      const int to = next[quadrant[k]]++;
      scratch.x[to] = points.x[k], scratch.y[to] = points.y[k], scratch.index[to] = points.index[k];
    }
    const auto copy_back = [range](const auto& from, auto& to) {
      std::copy(from.begin() + range.begin, from.begin() + range.end, to.begin() + range.begin);
    };
    copy_back(scratch.x, points.x), copy_back(scratch.y, points.y), copy_back(scratch.index, points.index);
    return counts;
  }
};

}  // namespace

Quadtree::Quadtree(const PointArray& sources, const PointArray* targets, int leaf_size)
    : targets_are_sources_(targets == nullptr), sources_(unsorted(sources, "source")) {
  if (leaf_size < 1) {
    throw InputError(concat("quadtree: at most ", leaf_size, " points a leaf; give 1 or more"));
  }
  if (targets) targets_ = unsorted(*targets, "target");
  add_root();
  QuadrantSorter sort_sources(sources_), sort_targets(targets_);
  for (;;) {
    const int before = box_count();
    add_level(leaf_size, sort_sources, sort_targets);
    if (box_count() == before) break;
    first_box_.push_back(box_count());
    sizes_.push_back(0.5 * sizes_.back());
  }
}

// Translations assume that distances of centres are multiples of the box size. For this to hold to the last
// bit, however far from the origin the points are, all centres are integer multiples of `unit`, the
// resolution of the largest coordinate, and the size is unit times a power of two times 8 to 16.
void Quadtree::add_root() {
  Box root{};
  root.parent = -1;
  root.sources = {0, sources_.size()};
  root.targets = {0, this->targets().size()};
  double size = 0.0;
  if (root.sources.size() + root.targets.size() > 0) {
    Bounds bounds;
    bounds.add(sources_), bounds.add(targets_);
    size = std::max(bounds.high_x - bounds.low_x, bounds.high_y - bounds.low_y);
    const double farthest = std::max({std::abs(bounds.low_x), std::abs(bounds.high_x), std::abs(bounds.low_y),
                                      std::abs(bounds.high_y)});
    root.x = 0.5 * (bounds.low_x + bounds.high_x), root.y = 0.5 * (bounds.low_y + bounds.high_y);
    if (size > 0.0) {
      const double least = std::numeric_limits<double>::min();
      const double unit = std::max(std::ldexp(1.0, std::ilogb(farthest) - 51), least);
      const double step = std::ldexp(1.0, std::ilogb(size) - 3);
      root.x = std::round(root.x / unit) * unit, root.y = std::round(root.y / unit) * unit;
      size = std::ceil(size / step) * step;
      // Centres at level l are multiples of the root's size over 2^(l + 1).
      deepest_ = std::clamp(std::ilogb(step / unit) - 2, 0, 48);
    }
  }
  boxes_.push_back(root);
  first_box_ = {0, 1};
  sizes_ = {size > 0.0 ? size : 1.0};
}

bool Quadtree::in_one_place(const Box& box) const {
  const bool has_source = box.sources.size() > 0;
  const SortedPoints& some = has_source ? sources_ : targets();
  const int k = has_source ? box.sources.begin : box.targets.begin;
  return all_in_one_place(sources_, box.sources, some.x[k], some.y[k]) &&
         all_in_one_place(targets(), box.targets, some.x[k], some.y[k]);
}

template <class Sorter>
void Quadtree::add_level(int leaf_size, Sorter& sort_sources, Sorter& sort_targets) {
  const int level = level_count() - 1;
  std::vector<int> split;
  long work = 0;
  for (int b = first_box(level); b < first_box(level + 1); ++b) {
    Box& box = boxes_[b];
    if (std::max(box.sources.size(), box.targets.size()) <= leaf_size) continue;
    box.coincident = in_one_place(box);
    if (box.coincident || level == deepest_) continue;
    split.push_back(b);
    work += box.sources.size() + box.targets.size();
  }
  std::vector<std::array<Counts, 2>> counts(split.size());
  parallel_for_large(static_cast<long>(split.size()), work / 4, [&](long s) {
    const Box& box = boxes_[split[s]];
    counts[s][0] = sort_sources(box.sources, box.x, box.y);
    counts[s][1] = targets_are_sources_ ? counts[s][0] : sort_targets(box.targets, box.x, box.y);
  });
  const double quarter = 0.25 * sizes_[level];
  for (std::size_t s = 0; s < split.size(); ++s) {
    const Box parent = boxes_[split[s]];
    boxes_[split[s]].first_child = box_count();
    int source = parent.sources.begin, target = parent.targets.begin;
    for (int q = 0; q < 4; ++q) {
      const int n = counts[s][0][q], m = counts[s][1][q];
      if (n + m == 0) continue;
      const int right = q % 2, up = q / 2;
      Box child{};
      child.x = parent.x + (right ? quarter : -quarter), child.y = parent.y + (up ? quarter : -quarter);
      child.column = 2 * parent.column + right, child.row = 2 * parent.row + up;
      child.level = level + 1, child.parent = split[s];
      child.sources = {source, source + n}, child.targets = {target, target + m};
      source += n, target += m;
      boxes_.push_back(child);
      ++boxes_[split[s]].child_count;
    }
  }
}

}  // namespace stokes
