#include "stiv.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cluster.hpp"
#include "curve.hpp"
#include "neighbours.hpp"
#include "text.hpp"

namespace stokes {

namespace {

constexpr double smallest_tolerance = 1e-12;  // of the product of the circumradii, for a volume
constexpr int fewest_vertices = 8;

std::vector<Complex> moved(const std::vector<Complex>& points, Complex factor, Complex shift) {
  std::vector<Complex> result(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) result[k] = shift + factor * points[k];
  return result;
}

std::vector<Complex> offset_polygon(const Shape& shape, int vertices, double offset) {
  const Curve curve = shape.curve(vertices);
  std::vector<Complex> points(vertices);
  for (int k = 0; k < vertices; ++k) points[k] = curve.position[k] - offset * perp(curve.tangent[k]);
  return points;
}

// The tolerance of a volume between bodies (or a body and the container) of these sizes, with vertices at least `spacing`
// apart.
double volume_tolerance(double size_a, double size_b, double separation, double spacing) {
  return std::max(smallest_tolerance * size_a * size_b, contact_tolerance * separation * spacing);
}

// Half the length of the two edges at each vertex.
std::vector<double> vertex_lengths(const std::vector<Complex>& polygon) {
  const std::size_t count = polygon.size();
  std::vector<double> lengths(count, 0.0);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t next = k + 1 == count ? 0 : k + 1;
    const double half = 0.5 * std::abs(polygon[next] - polygon[k]);
    lengths[k] += half, lengths[next] += half;
  }
  return lengths;
}

// A polygon's share of the numbers given to the vertices of all polygons in contact.
struct Range {
  int first, count;
  int next(int k) const { return k + 1 == count ? 0 : k + 1; }
};

// Joins hit vertices that are neighbours on their polygon.
template <class Hit>
void join_neighbours(const std::vector<Hit>& hits, Range moving, DisjointSets& sets) {
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Hit& following = hits[i + 1 == hits.size() ? 0 : i + 1];
    if (following.vertex == moving.next(hits[i].vertex))
      sets.join(moving.first + hits[i].vertex, moving.first + following.vertex);
  }
}

// Joins hit vertices with those of the edges they enter through.
void join_edges(const std::vector<VertexHit>& hits, Range moving, Range target, DisjointSets& sets) {
  for (const VertexHit& hit : hits) {
    sets.join(moving.first + hit.vertex, target.first + hit.edge);
    sets.join(moving.first + hit.vertex, target.first + target.next(hit.edge));
  }
}

// Names regions by their lowest vertices and numbers them in that order.
class RegionNames {
 public:
  explicit RegionNames(DisjointSets sets) : sets_(std::move(sets)) {}

  template <class Hit>
  void add(const std::vector<Hit>& hits, Range moving) {
    for (const Hit& hit : hits) names_.push_back(sets_.find(moving.first + hit.vertex));
    std::sort(names_.begin(), names_.end());
    names_.erase(std::unique(names_.begin(), names_.end()), names_.end());
  }

  int number_of(int vertex) {
    return static_cast<int>(std::lower_bound(names_.begin(), names_.end(), sets_.find(vertex)) - names_.begin());
  }

  // The constraints of the regions, nothing added to them yet.
  std::vector<ContactConstraint> constraints(int a, int b, double tolerance) const {
    std::vector<ContactConstraint> result;
    for (int i = 0; i < static_cast<int>(names_.size()); ++i) result.push_back({a, b, i, 0.0, tolerance, {}, {}});
    return result;
  }

 private:
  DisjointSets sets_;
  std::vector<int> names_;
};

// Value and gradient of one hit, of a vertex of a on b or the reverse, added to a region's.
// arm_p, arm_q: P and Q at the end, each from the centre of its own body.
template <class Hit>
void add(const Hit& hit, bool vertex_of_a, double ds, Complex arm_p, Complex arm_q, StivGradient choice,
         ContactConstraint& region) {
  region.value += ds * hit.interval;
  const Complex pull = (choice == StivGradient::frozen ? ds * (1.0 - hit.tau) : ds) * hit.normal;
  const double turn_p = cross(arm_p, pull), turn_q = -cross(arm_q, pull);
  GapGradient& g = region.gradient;
  g.centre_a += vertex_of_a ? pull : -pull;
  g.centre_b += vertex_of_a ? -pull : pull;
  g.angle_a += vertex_of_a ? turn_p : turn_q;
  g.angle_b += vertex_of_a ? turn_q : turn_p;
}

}  // namespace

StivCollector::StivCollector(const Suspension& start, double separation, const StivOptions& options)
    : start_(start), separation_(separation), options_(options) {
  if (options.vertices < fewest_vertices)
    throw InputError(concat("contact polygons need at least ", fewest_vertices, " vertices; got ",
                            options.vertices));
  if (!(separation >= 0.0))
    throw InputError(concat("the minimum separation must not be negative; got ", separation));
  double shortest = std::numeric_limits<double>::infinity();  // perimeter of a mobile body
  for (const Body& body : start)
    if (!body.fixed) shortest = std::min(shortest, body.shape.perimeter());
  for (const Body& body : start) {
    const double multiple = body.fixed ? std::max(1.0, std::ceil(body.shape.perimeter() / shortest)) : 1.0;
    const int vertices = options.vertices * static_cast<int>(multiple);
    const auto polygon = offset_polygon(body.shape, vertices, 0.5 * separation);
    outline_.push_back({polygon, moved(polygon, body.pose.axis(), 0.0), vertex_lengths(polygon)});
    const auto& lengths = outline_.back().arclength;
    outline_.back().shortest = *std::min_element(lengths.begin(), lengths.end());
  }
}

// Relative to the centre of a, so that neither a distant origin nor a common translation costs digits.
std::vector<ContactConstraint> StivCollector::collect_pair(int a, int b, const std::vector<Pose>& trial) const {
  const Complex shift_start = start_[b].pose.centre - start_[a].pose.centre;
  const Complex shift_end = trial[b].centre - trial[a].centre;
  const MovingPolygon first{outline_[a].start, moved(outline_[a].body_frame, trial[a].axis(), 0.0)};
  const MovingPolygon second{moved(outline_[b].start, 1.0, shift_start),
                             moved(outline_[b].body_frame, trial[b].axis(), shift_end)};
  const std::vector<VertexHit> hits_of_a = vertex_hits(first, second), hits_of_b = vertex_hits(second, first);
  if (hits_of_a.empty() && hits_of_b.empty()) return {};

  const Range of_a{0, static_cast<int>(first.end.size())}, of_b{of_a.count, static_cast<int>(second.end.size())};
  DisjointSets sets(of_a.count + of_b.count);
  join_neighbours(hits_of_a, of_a, sets), join_edges(hits_of_a, of_a, of_b, sets);
  join_neighbours(hits_of_b, of_b, sets), join_edges(hits_of_b, of_b, of_a, sets);
  RegionNames names(std::move(sets));
  names.add(hits_of_a, of_a), names.add(hits_of_b, of_b);

  const double tolerance = volume_tolerance(start_[a].shape.circumradius(), start_[b].shape.circumradius(), separation_,
                                            std::min(outline_[a].shortest, outline_[b].shortest));
  std::vector<ContactConstraint> regions = names.constraints(a, b, tolerance);
  const auto add_all = [&](const std::vector<VertexHit>& hits, bool entering_a) {
    const MovingPolygon &moving = entering_a ? first : second, &target = entering_a ? second : first;
    const Range vertices = entering_a ? of_a : of_b, edges = entering_a ? of_b : of_a;
    const Complex moving_centre = entering_a ? 0.0 : shift_end, target_centre = entering_a ? shift_end : 0.0;
    for (const VertexHit& hit : hits) {
      const Complex q0 = target.end[hit.edge], q1 = target.end[edges.next(hit.edge)];
      const Complex q = (1.0 - hit.sigma) * q0 + hit.sigma * q1;
      add(hit, entering_a, outline_[entering_a ? a : b].arclength[hit.vertex], moving.end[hit.vertex] - moving_centre,
          q - target_centre, options_.gradient, regions[names.number_of(vertices.first + hit.vertex)]);
    }
  };
  add_all(hits_of_a, true);
  add_all(hits_of_b, false);
  for (ContactConstraint& region : regions) region.force = region.gradient;
  return regions;
}

// Relative to the centre of the container.
std::vector<ContactConstraint> StivCollector::collect_wall(int a, const Pose& trial) const {
  const Container& container = *start_.container;
  const Complex from = start_[a].pose.centre - container.centre, to = trial.centre - container.centre;
  const MovingPolygon polygon{moved(outline_[a].start, 1.0, from), moved(outline_[a].body_frame, trial.axis(), to)};
  const std::vector<WallHit> hits = wall_hits(polygon, container.radius - 0.5 * separation_);
  if (hits.empty()) return {};

  const Range vertices{0, static_cast<int>(polygon.end.size())};
  DisjointSets sets(vertices.count);
  join_neighbours(hits, vertices, sets);
  RegionNames names(std::move(sets));
  names.add(hits, vertices);
  const double tolerance =
      volume_tolerance(start_[a].shape.circumradius(), container.radius, separation_, outline_[a].shortest);
  std::vector<ContactConstraint> regions = names.constraints(a, container_index, tolerance);
  for (const WallHit& hit : hits)
    add(hit, true, outline_[a].arclength[hit.vertex], polygon.end[hit.vertex] - to, hit.point, options_.gradient,
        regions[names.number_of(hit.vertex)]);
  for (ContactConstraint& region : regions) region.force = region.gradient;
  return regions;
}

std::vector<ContactConstraint> StivCollector::collect(const std::vector<Pose>& trial) const {
  std::vector<ContactConstraint> contacts;
  for (const auto& [a, b] : contact_candidates(start_, trial, separation_)) {
    const auto regions = b == container_index ? collect_wall(a, trial[a]) : collect_pair(a, b, trial);
    contacts.insert(contacts.end(), regions.begin(), regions.end());
  }
  return contacts;
}

}  // namespace stokes
