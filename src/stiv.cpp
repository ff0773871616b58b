#include "stiv.hpp"

#include <algorithm>
#include <cmath>

#include "cluster.hpp"
#include "curve.hpp"
#include "neighbours.hpp"
#include "text.hpp"

namespace stokes {

namespace {

constexpr double relative_tolerance = 1e-12;  // of the product of the circumradii, for a volume
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

// Joins the vertices of a contact region: body a's are 0 to count - 1, body b's the `count` after them.
// moving, target: where the vertices of the entering body and of the other one begin.
void join_regions(const std::vector<VertexHit>& hits, int count, int moving, int target, DisjointSets& sets) {
  const auto next = [count](int k) { return k + 1 == count ? 0 : k + 1; };
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const int vertex = moving + hits[i].vertex;
    sets.join(vertex, target + hits[i].edge);
    sets.join(vertex, target + next(hits[i].edge));
    const VertexHit& following = hits[i + 1 == hits.size() ? 0 : i + 1];
    if (following.vertex == next(hits[i].vertex)) sets.join(vertex, moving + following.vertex);
  }
}

// Value and gradient of one hit, of a vertex of a on b or the reverse, added to a region's.
// arm_p, arm_q: P and Q at the end, each from the centre of its own body.
void add(const VertexHit& hit, bool vertex_of_a, double ds, Complex arm_p, Complex arm_q, StivGradient choice,
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
  for (const Body& body : start) {
    const auto polygon = offset_polygon(body.shape, options.vertices, 0.5 * separation);
    outline_.push_back({polygon, moved(polygon, body.pose.axis(), 0.0), vertex_lengths(polygon)});
  }
}

// Seen from the centre of a, so that neither a far origin nor a common translation costs digits.
std::vector<ContactConstraint> StivCollector::collect_pair(int a, int b, const std::vector<Pose>& trial) const {
  const Complex shift_start = start_[b].pose.centre - start_[a].pose.centre;
  const Complex shift_end = trial[b].centre - trial[a].centre;
  const MovingPolygon first{outline_[a].start, moved(outline_[a].body_frame, trial[a].axis(), 0.0)};
  const MovingPolygon second{moved(outline_[b].start, 1.0, shift_start),
                             moved(outline_[b].body_frame, trial[b].axis(), shift_end)};
  const std::vector<VertexHit> hits_of_a = vertex_hits(first, second), hits_of_b = vertex_hits(second, first);
  if (hits_of_a.empty() && hits_of_b.empty()) return {};

  const int count = options_.vertices;
  DisjointSets sets(2 * count);
  join_regions(hits_of_a, count, 0, count, sets);
  join_regions(hits_of_b, count, count, 0, sets);
  std::vector<int> names;  // of the regions: their lowest vertices
  for (const VertexHit& hit : hits_of_a) names.push_back(sets.find(hit.vertex));
  for (const VertexHit& hit : hits_of_b) names.push_back(sets.find(count + hit.vertex));
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());

  const double tolerance = relative_tolerance * start_[a].shape.circumradius() * start_[b].shape.circumradius();
  std::vector<ContactConstraint> regions;
  for (int i = 0; i < static_cast<int>(names.size()); ++i) regions.push_back({a, b, i, 0.0, tolerance, {}, {}});
  const auto add_all = [&](const std::vector<VertexHit>& hits, bool of_a) {
    const MovingPolygon &moving = of_a ? first : second, &target = of_a ? second : first;
    const Complex moving_centre = of_a ? 0.0 : shift_end, target_centre = of_a ? shift_end : 0.0;
    for (const VertexHit& hit : hits) {
      const int name = sets.find(hit.vertex + (of_a ? 0 : count));
      const Complex q0 = target.end[hit.edge], q1 = target.end[hit.edge + 1 == count ? 0 : hit.edge + 1];
      const Complex q = (1.0 - hit.sigma) * q0 + hit.sigma * q1;
      add(hit, of_a, outline_[of_a ? a : b].arclength[hit.vertex], moving.end[hit.vertex] - moving_centre,
          q - target_centre, options_.gradient,
          regions[std::lower_bound(names.begin(), names.end(), name) - names.begin()]);
    }
  };
  add_all(hits_of_a, true);
  add_all(hits_of_b, false);
  for (ContactConstraint& region : regions) region.force = region.gradient;
  return regions;
}

std::vector<ContactConstraint> StivCollector::collect(const std::vector<Pose>& trial) const {
  std::vector<Complex> from, to;
  std::vector<double> radius;
  for (const Body& body : start_) {
    from.push_back(body.pose.centre);
    radius.push_back(body.shape.circumradius());
  }
  for (const Pose& pose : trial) to.push_back(pose.centre);
  const auto pairs = neighbour_pairs(from, to, radius, separation_);
  std::vector<ContactConstraint> contacts;
  for (const auto& [a, b] : pairs) {
    const std::vector<ContactConstraint> regions = collect_pair(a, b, trial);
    contacts.insert(contacts.end(), regions.begin(), regions.end());
  }
  return contacts;
}

}  // namespace stokes
