#include "contact.hpp"

#include <algorithm>

#include "container_gap.hpp"
#include "neighbours.hpp"

namespace stokes {

namespace {

// Without a given separation: a fraction of the smallest semi-axis, below which the sum over nodes that face each other
// loses more digits than a solution to 1e-8 can spare, and a fraction of the distance from the origin, whose
// round-off the tolerance must exceed.
constexpr double smallest_separation = 1e-7, smallest_of_extent = 1e-10;

}  // namespace

GapCollector::GapCollector(const Suspension& start, const Suspension& at, double separation, double tolerance)
    : start_(start), at_(at), separation_(separation) {
  if (separation_ == 0.0) {
    double smallest = start.front().shape.inradius(), extent = 0.0;
    for (const Body& body : start) {
      smallest = std::min(smallest, body.shape.inradius());
      extent = std::max(extent, std::abs(body.pose.centre));
    }
    if (start.container) extent = std::max(extent, std::abs(start.container->centre) + start.container->radius);
    separation_ = std::max(smallest_separation * smallest, smallest_of_extent * extent);
  }
  tolerance_ = tolerance * separation_;
}

// If the body ends inside, every tangent plane of the wall is behind it, so a hit on the way adds nothing.
ContactConstraint GapCollector::evaluate_wall(int a, const Pose& trial) const {
  const Body& body = at_[a];
  const Container& container = *start_.container;
  const Gap before = gap(body, container), after = gap(body.shape, trial, container);
  const bool alike = dot(before.normal, after.normal) > 0.5;
  return {a, container_index, 0, after.value - separation_, tolerance_, gradient(after, trial),
          alike ? gradient(before, body.pose) : push_from_wall(body.shape, body.pose, container, after.normal)};
}

ContactConstraint GapCollector::evaluate(int a, int b, const std::vector<Pose>& trial) const {
  if (b == container_index) return evaluate_wall(a, trial[a]);
  const Body &body_a = start_[a], &body_b = start_[b];
  const Gap before = gap(body_a, body_b);
  const bool at_start = at_[a].pose == body_a.pose && at_[b].pose == body_b.pose;
  const Gap at = at_start ? before : gap(at_[a], at_[b]);
  const Gap after = gap(body_a.shape, trial[a], body_b.shape, trial[b]);
  ContactConstraint contact{a, b, 0, after.value - separation_, tolerance_, gradient(after, trial[a], trial[b]),
                            gradient(at, at_[a].pose, at_[b].pose)};
  if (after.value < separation_ && dot(before.normal, after.normal) > 0.0) return contact;
  // Apart at the end, or overlapping so far that the normal has turned: did they pass through each other?
  // The threshold is half the separation: a dip below it within a step is a pass; the next step restores any other.
  const auto hit = first_hit(body_a.shape, body_a.pose, trial[a], body_b.shape, body_b.pose, trial[b],
                             0.5 * separation_);
  if (!hit) return contact;
  const SeparatingPlane plane = separating_plane(hit->gap, interpolate(body_a.pose, trial[a], hit->tau),
                                                 interpolate(body_b.pose, trial[b], hit->tau));
  const double value = stokes::separation(plane, trial[a], trial[b]) - separation_;
  // Bodies that roll over each other dip below half the separation and part again. The frozen plane then
  // is not violated, and the gap at the end counts.
  if (value < contact.value) contact.value = value, contact.gradient = gradient(plane, trial[a], trial[b]);
  return contact;
}

std::vector<ContactConstraint> GapCollector::collect(const std::vector<Pose>& trial,
                                                     const std::vector<std::pair<int, int>>& tracked) const {
  const std::vector<std::pair<int, int>> pairs = contact_candidates(start_, trial, separation_);
  std::vector<std::pair<int, int>> all;
  std::set_union(pairs.begin(), pairs.end(), tracked.begin(), tracked.end(), std::back_inserter(all));
  std::vector<ContactConstraint> contacts;
  for (const auto& [a, b] : all) {
    const ContactConstraint contact = evaluate(a, b, trial);
    if (contact.value < -tolerance_ || std::binary_search(tracked.begin(), tracked.end(), std::pair(a, b)))
      contacts.push_back(contact);
  }
  return contacts;
}

}  // namespace stokes
