#include "pack_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "text.hpp"

namespace stokes {

namespace {

constexpr int tries_for_a_body = 1000;
constexpr double most_bodies = 1e6;

double area(const Shape& shape) { return pi * shape.a * shape.b; }

void check(const PackingRequest& r) {
  const auto refuse = [](const auto&... parts) { throw InputError(concat(parts...)); };
  if (r.shapes.empty()) refuse("there are no shapes; give at least one.");
  if (r.number <= 0 && !(r.area_fraction > 0.0)) refuse("number or area_fraction must be given.");
  if (r.number > most_bodies) refuse("number = ", r.number, " is above ", most_bodies, ".");
  if (r.area_fraction >= 1.0) refuse("area_fraction = ", r.area_fraction, " must be below 1; discs of one size reach .9.");
  if (!(r.polydispersity >= 0.0 && r.polydispersity <= 0.5))
    refuse("polydispersity = ", r.polydispersity, " must be between 0 and .5.");
}

// Number of bodies of each shape: the integer parts of the shares, and one more for the largest remainders.
std::vector<int> counts(const std::vector<ShapeShare>& shapes, int number) {
  double total = 0.0;
  for (const ShapeShare& s : shapes) total += s.share;
  std::vector<int> count;
  std::vector<std::pair<double, std::size_t>> left;
  int placed = 0;
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    const double wanted = number * shapes[k].share / total;
    count.push_back(static_cast<int>(std::floor(wanted)));
    left.emplace_back(count.back() - wanted, k);
    placed += count.back();
  }
  std::stable_sort(left.begin(), left.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t k = 0; placed < number; ++k, ++placed) ++count[left[k % left.size()].second];
  return count;
}

int number_for(const PackingRequest& r) {
  double total = 0.0, sum = 0.0;
  for (const ShapeShare& s : r.shapes) total += s.share, sum += s.share * area(s.shape);
  const double mean = sum / total * (1.0 + r.polydispersity * r.polydispersity);
  const double number = std::max(1.0, std::round(r.area_fraction * r.region.area() / mean));
  if (number > most_bodies)
    throw InputError(concat("area_fraction = ", r.area_fraction, " takes ", number, " bodies, more than ", most_bodies,
                            "; give larger shapes."));
  return static_cast<int>(number);
}

// The bodies placed so far, in squares so large that all near bodies are in a body's own square or in adjacent ones.
class Placed {
 public:
  Placed(const Region& region, const Clearance& clearance, double largest_radius) : clearance_(clearance) {
    const double side = region.kind == RegionKind::box ? std::max(region.width, region.height) : 2.0 * region.outer_radius;
    size_ = std::max(2.0 * largest_radius + clearance.bodies, side / 1000.0);
    half_ = 0.5 * side;
    row_ = static_cast<int>(side / size_) + 3;
    squares_.resize(static_cast<std::size_t>(row_) * row_);
  }

  bool has_room_for(const Body& body) const {
    const auto [column, row] = square(body.pose.centre);
    for (int j = row - 1; j <= row + 1; ++j)
      for (int i = column - 1; i <= column + 1; ++i)
        for (const Body& other : squares_[static_cast<std::size_t>(j) * row_ + i])
          if (is_too_close(body, other)) return false;
    return true;
  }

  void add(const Body& body) {
    const auto [column, row] = square(body.pose.centre);
    squares_[static_cast<std::size_t>(row) * row_ + column].push_back(body);
  }

 private:
  std::pair<int, int> square(Complex x) const {
    return {1 + static_cast<int>((x.real() + half_) / size_), 1 + static_cast<int>((x.imag() + half_) / size_)};
  }

  bool is_too_close(const Body& body, const Body& other) const {
    const double reach = body.shape.circumradius() + other.shape.circumradius() + clearance_.bodies;
    if (std::norm(body.pose.centre - other.pose.centre) > reach * reach) return false;
    return !(gap(body, other).value > clearance_.bodies);
  }

  const Clearance& clearance_;
  double size_, half_;
  int row_;
  std::vector<std::vector<Body>> squares_;
};

double smallest_wall_gap(const Region& region, const Body& body) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Gap& g : region.wall_gaps(body.shape, body.pose)) smallest = std::min(smallest, g.value);
  return smallest;
}

// False once a body has no room; all later bodies are then put anywhere.
bool place(const std::vector<Shape>& shapes, const PackingRequest& r, UniformRandom& random, std::vector<Body>& bodies) {
  Placed placed(r.region, r.clearance, shapes.front().circumradius());
  bool has_room = true;
  for (const Shape& shape : shapes) {
    Body body{shape, {}};
    bool found = false;
    for (int tries = 0; !found && tries < (has_room ? tries_for_a_body : 1); ++tries) {
      const double u1 = random(), u2 = random(), u3 = random();
      body.pose = {r.region.point(u1, u2), 2.0 * pi * u3};
      found = has_room && smallest_wall_gap(r.region, body) > r.clearance.walls && placed.has_room_for(body);
    }
    has_room = found;
    if (found) placed.add(body);
    bodies.push_back(body);
  }
  return has_room;
}

}  // namespace

std::vector<Shape> requested_shapes(const PackingRequest& request, UniformRandom& random) {
  check(request);
  const int number = request.number > 0 ? request.number : number_for(request);
  const std::vector<int> count = counts(request.shapes, number);
  std::vector<Shape> shapes;
  double sum = 0.0;
  for (std::size_t k = 0; k < count.size(); ++k)
    for (int n = 0; n < count[k]; ++n) {
      const Shape& mean = request.shapes[k].shape;
      double size = 1.0;
      // A uniform distribution reaches as far as root 3 of its standard deviation.
      if (request.polydispersity > 0.0) size += request.polydispersity * std::sqrt(3.0) * (2.0 * random() - 1.0);
      shapes.push_back({size * mean.a, size * mean.b});
      sum += area(shapes.back());
    }
  if (request.number > 0 && request.area_fraction > 0.0) {
    const double size = std::sqrt(request.area_fraction * request.region.area() / sum);
    for (Shape& shape : shapes) shape = {size * shape.a, size * shape.b};
  }
  std::stable_sort(shapes.begin(), shapes.end(),
                   [](const Shape& s, const Shape& t) { return s.circumradius() > t.circumradius(); });
  return shapes;
}

Packing pack_bodies(const PackingRequest& request) {
  UniformRandom random(request.seed);
  const std::vector<Shape> shapes = requested_shapes(request, random);
  Packing packing;
  double sum = 0.0;
  for (const Shape& shape : shapes) sum += area(shape);
  packing.area_fraction = sum / request.region.area();
  const std::string what = concat(shapes.size(), " bodies, an area fraction of ", brief(packing.area_fraction));
  if (packing.area_fraction >= 1.0) throw InputError(concat(what, ", do not fit; ask for fewer or smaller ones."));
  packing.relaxed = !place(shapes, request, random, packing.bodies);
  if (packing.relaxed) relax(packing.bodies, request.region, request.clearance, random);
  packing.wall_gap = std::numeric_limits<double>::infinity();
  for (const Body& body : packing.bodies)
    packing.wall_gap = std::min(packing.wall_gap, smallest_wall_gap(request.region, body));
  packing.closest = smallest_gap({packing.bodies.begin(), packing.bodies.end()});
  const Clearance& wanted = request.clearance;
  const double lacking = std::max(wanted.walls - packing.wall_gap, wanted.bodies - packing.closest.gap);
  if (!(lacking < 0.0))
    throw NumericalError(concat(what, ": no places were found for them; after the removal of overlaps a gap is still ",
                                brief(lacking), " too narrow (clearances ", wanted.bodies, " between bodies, ", wanted.walls,
                                " from walls). Try fewer bodies, smaller clearances or another seed."));
  return packing;
}

}  // namespace stokes
