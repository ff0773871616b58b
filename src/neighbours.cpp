#include "neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>

#include "container_gap.hpp"
#include "gap.hpp"

namespace stokes {

namespace {

constexpr double largest = 1e150;  // squares of lengths do not overflow

struct Cell {
  std::int64_t x, y;
  bool operator==(const Cell&) const = default;
};

// Boxes of one size class: those with extents up to `size`, a power of two. They are stored under the cell of that
// size in which their centre lies. Buckets are chains through `next`, in reversed order of insertion.
struct Level {
  double size;
  std::vector<int> members;
  std::vector<int> bucket;  // first entry of each chain, an index into members, or -1
  std::vector<int> next;
  std::vector<Cell> cells;

  // A power of two: the quotient is exact, so its order is that of the coordinates.
  std::int64_t index(double coordinate) const {
    return static_cast<std::int64_t>(std::floor(coordinate / size));
  }

  std::size_t slot(Cell cell) const {
    std::uint64_t hash = static_cast<std::uint64_t>(cell.x) * 0x9e3779b97f4a7c15u;
    hash = (hash ^ (hash >> 32)) + static_cast<std::uint64_t>(cell.y) * 0xc2b2ae3d27d4eb4fu;
    hash ^= hash >> 29;
    return (hash * 0x165667b19e3779f9u >> 32) & (bucket.size() - 1);
  }

  void build(const std::vector<Complex>& centre) {
    std::size_t buckets = 1;
    while (buckets < 2 * members.size()) buckets *= 2;
    bucket.assign(buckets, -1);
    next.resize(members.size());
    cells.resize(members.size());
    for (std::size_t k = 0; k < members.size(); ++k) {
      const Complex c = centre[members[k]];
      cells[k] = {index(c.real()), index(c.imag())};
      const std::size_t s = slot(cells[k]);
      next[k] = bucket[s];
      bucket[s] = static_cast<int>(k);
    }
  }

  // Calls visit(j) for every member whose box may meet the box centre +- half.
  template <class Visit>
  void for_each_near(Complex centre, Complex half, const Visit& visit) const {
    const Complex reach = half + Complex{0.5 * size, 0.5 * size};
    const Complex lowest = centre - reach, highest = centre + reach;
    const Cell low{index(lowest.real()), index(lowest.imag())};
    const Cell high{index(highest.real()), index(highest.imag())};
    for (std::int64_t x = low.x; x <= high.x; ++x) {
      for (std::int64_t y = low.y; y <= high.y; ++y) {
        for (int k = bucket[slot({x, y})]; k >= 0; k = next[k]) {
          if (cells[k] == Cell{x, y}) visit(members[k]);
        }
      }
    }
  }
};

void check_input(const std::vector<Complex>& start, const std::vector<Complex>& end,
                 const std::vector<double>& radius, double distance) {
  if (end.size() != start.size() || radius.size() != start.size()) {
    throw InputError("neighbour search: " + std::to_string(start.size()) + " initial positions, " +
                     std::to_string(end.size()) + " final positions and " + std::to_string(radius.size()) +
                     " radii; give one of each per body");
  }
  const auto check_length = [](double length, const std::string& name) {
    if (length >= 0.0 && length <= largest) return;
    throw InputError("neighbour search: the " + name + " is " + std::to_string(length) +
                     "; it must lie between 0 and 1e150");
  };
  check_length(distance, "distance");
  for (std::size_t i = 0; i < start.size(); ++i) {
    check_length(radius[i], "radius of body " + std::to_string(i));
    if (!(std::abs(start[i]) <= largest && std::abs(end[i]) <= largest)) {
      throw NumericalError("neighbour search: the position of body " + std::to_string(i) +
                           " is not finite, or beyond 1e150; a smaller time step may keep it finite");
    }
  }
}

// Boxes around the swept circles, each widened by half of the distance: circles that come within the
// distance have boxes that meet.
struct Boxes {
  std::vector<Complex> centre, half;
  double least_cell;  // cells of at least this size have indices that doubles hold exactly

  Boxes(const std::vector<Complex>& start, const std::vector<Complex>& end, const std::vector<double>& radius,
        double distance)
      : centre(start.size()), half(start.size()), least_cell(1e-300) {
    double farthest = 0.0;
    for (std::size_t i = 0; i < start.size(); ++i) {
      for (const Complex c : {start[i], end[i]}) {
        farthest = std::max({farthest, std::abs(c.real()), std::abs(c.imag())});
      }
    }
    least_cell = std::max(least_cell, std::ldexp(farthest, -45));
    for (std::size_t i = 0; i < start.size(); ++i) {
      centre[i] = 0.5 * (start[i] + end[i]);
      const Complex way = 0.5 * (end[i] - start[i]);
      // Rounding of the centres and of the final test must not part boxes that just meet.
      const double reach = (1.0 + 1e-12) * (radius[i] + 0.5 * distance) + 1e-15 * farthest;
      half[i] = {std::abs(way.real()) + reach, std::abs(way.imag()) + reach};
    }
  }

  // Exponent of the smallest power of two above the box's larger extent.
  int level(std::size_t i) const {
    const double extent = std::max({2.0 * half[i].real(), 2.0 * half[i].imag(), least_cell});
    return std::ilogb(extent) + 1;
  }
};

}  // namespace

std::vector<std::pair<int, int>> neighbour_pairs(const std::vector<Complex>& start,
                                                 const std::vector<Complex>& end,
                                                 const std::vector<double>& radius, double distance) {
  check_input(start, end, radius, distance);
  const int count = static_cast<int>(start.size());
  const Boxes boxes(start, end, radius, distance);
  std::map<int, Level> levels;
  for (int i = 0; i < count; ++i) levels[boxes.level(i)].members.push_back(i);
  for (auto& [exponent, level] : levels) {
    level.size = std::ldexp(1.0, exponent);
    level.build(boxes.centre);
  }

  // The smallest squared distance of two centres that both move.
  const auto closest_squared = [&](int i, int j) {
    const Complex d = start[j] - start[i], way = (end[j] - end[i]) - d;
    const double length_squared = dot(way, way);
    const double tau = length_squared > 0.0 ? std::clamp(-dot(d, way) / length_squared, 0.0, 1.0) : 0.0;
    const Complex closest = d + tau * way;
    return dot(closest, closest);
  };
  std::vector<std::pair<int, int>> pairs;
  // Each body looks among those of its own size class and of all larger ones: every cell range is then at
  // most three cells wide, and every pair is seen from one side only.
  for (auto own = levels.begin(); own != levels.end(); ++own) {
    for (auto other = own; other != levels.end(); ++other) {
      for (const int i : own->second.members) {
        other->second.for_each_near(boxes.centre[i], boxes.half[i], [&](int j) {
          if (other == own && j <= i) return;
          const double limit = radius[i] + radius[j] + distance;
          if (closest_squared(i, j) <= limit * limit) pairs.emplace_back(std::min(i, j), std::max(i, j));
        });
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

namespace {

// Pairs of bodies, and of a body and the container, without those of bodies that are all `left_out`.
template <class LeftOut>
std::vector<std::pair<int, int>> candidates(const Suspension& start, const std::vector<Pose>& trial, double distance,
                                            const LeftOut& left_out) {
  std::vector<Complex> from, to;
  std::vector<double> radius;
  for (const Body& body : start) {
    from.push_back(body.pose.centre);
    radius.push_back(body.shape.circumradius());
  }
  for (const Pose& pose : trial) to.push_back(pose.centre);
  std::vector<std::pair<int, int>> pairs = neighbour_pairs(from, to, radius, distance);
  std::erase_if(pairs, [&](const auto& pair) { return left_out(start[pair.first]) && left_out(start[pair.second]); });
  if (!start.container) return pairs;
  const Container& container = *start.container;
  for (int i = 0; i < static_cast<int>(start.size()); ++i)
    if (!left_out(start[i]) && container.radius - std::abs(to[i] - container.centre) - radius[i] <= distance)
      pairs.emplace_back(i, container_index);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

bool is_fixed(const Body& body) { return body.fixed; }
bool is_at_rest(const Body& body) { return body.fixed && !body.is_driven(); }

// The gap of the circumscribed circles of a pair.
double between_circles(const Suspension& suspension, int a, int b) {
  const Complex centre = suspension[a].pose.centre;
  const double radius = suspension[a].shape.circumradius();
  if (b == container_index)
    return suspension.container->radius - std::abs(centre - suspension.container->centre) - radius;
  return std::abs(suspension[b].pose.centre - centre) - radius - suspension[b].shape.circumradius();
}

}  // namespace

std::vector<std::pair<int, int>> contact_candidates(const Suspension& start, const std::vector<Pose>& trial,
                                                    double distance) {
  return candidates(start, trial, distance, is_fixed);
}

ClosestPair smallest_gap(const Suspension& suspension) {
  ClosestPair closest;
  std::vector<Pose> poses;
  double scale = 0.0;
  for (const Body& body : suspension) {
    poses.push_back(body.pose);
    if (!is_at_rest(body)) scale = std::max(scale, body.shape.circumradius());
  }
  // Without a mobile body, or with nothing else, there is no pair at any distance.
  if (scale == 0.0 || (suspension.size() < 2 && !suspension.container)) return closest;

  // No gap is below that of the circumscribed circles. The pairs whose circles are within `distance` therefore
  // include the smallest gap as soon as one of their gaps is at most `distance`.
  double distance = 0.0;
  for (;;) {
    for (const auto& [i, j] : candidates(suspension, poses, distance, is_at_rest)) {
      const Body& body = suspension[i];
      if (between_circles(suspension, i, j) > closest.gap) continue;
      const double value = j == container_index ? gap(body, *suspension.container).value
                                                : gap(body, suspension[j]).value;
      if (std::isnan(value)) {
        throw NumericalError("smallest gap: the gap between " + pair_name(i, j) +
                             " is not a number; check their angles and semi-axes");
      }
      if (std::tie(value, i, j) < std::tie(closest.gap, closest.a, closest.b)) closest = {i, j, value};
    }
    if (closest.gap <= distance) return closest;
    distance = closest.a >= 0 ? closest.gap : std::max(4.0 * distance, 0.25 * scale);
  }
}

}  // namespace stokes
