#include "ncp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lcp.hpp"
#include "text.hpp"

namespace stokes {

namespace {

// A contact in the course of the iteration: its constraint at the current poses and its column M f.
struct Candidate {
  ContactConstraint constraint;
  Response column;
  double multiplier = 0.0;
};

using Pair = std::pair<int, int>;
Pair pair_of(const ContactConstraint& c) { return {c.a, c.b}; }

std::vector<Wrench> wrenches_of(const ContactConstraint& c, std::size_t bodies) {
  std::vector<Wrench> wrenches(bodies);
  wrenches[c.a] = {c.force.centre_a, c.force.angle_a};
  wrenches[c.b] = {c.force.centre_b, c.force.angle_b};
  return wrenches;
}

// Rate of the constraint's value when the bodies move with `velocity`.
double rate(const ContactConstraint& c, const std::vector<RigidVelocity>& velocity) {
  return dot(c.gradient.centre_a, velocity[c.a].velocity) + c.gradient.angle_a * velocity[c.a].omega +
         dot(c.gradient.centre_b, velocity[c.b].velocity) + c.gradient.angle_b * velocity[c.b].omega;
}

std::string name(const ContactConstraint& c) {
  return concat("bodies ", c.a, " and ", c.b, " (constraint ", c.value, ", tolerance ", c.tolerance, ")");
}

class Iteration {
 public:
  Iteration(const Suspension& start, const Response& contact_free, double dt, const ConstraintFunction& constraints,
            const MobilityFunction& mobility)
      : start_(start), free_(contact_free), dt_(dt), constraints_(constraints), mobility_(mobility) {}

  // Moves the bodies with the current multipliers and evaluates all constraints there.
  void update() {
    motion_ = free_;
    for (const Candidate& c : candidates_) {
      if (c.multiplier == 0.0) continue;
      for (std::size_t i = 0; i < start_.size(); ++i) {
        motion_.velocity[i].velocity += c.multiplier * c.column.velocity[i].velocity;
        motion_.velocity[i].omega += c.multiplier * c.column.velocity[i].omega;
      }
      motion_.density += c.multiplier * c.column.density;
    }
    poses_.clear();
    for (std::size_t i = 0; i < start_.size(); ++i)
      poses_.push_back(advance(start_[i].pose, motion_.velocity[i], dt_));

    std::vector<Pair> tracked;
    for (const Candidate& c : candidates_) tracked.push_back(pair_of(c.constraint));
    for (const ContactConstraint& found : constraints_(poses_, tracked)) {
      const auto place = std::lower_bound(candidates_.begin(), candidates_.end(), pair_of(found),
                                          [](const Candidate& c, Pair p) { return pair_of(c.constraint) < p; });
      if (place != candidates_.end() && pair_of(place->constraint) == pair_of(found))
        place->constraint = found;
      else
        candidates_.insert(place, {found, mobility_(wrenches_of(found, start_.size())), 0.0});
    }
  }

  // The candidate farthest from what is required of it, or none when all are within tolerance.
  const Candidate* worst() const {
    const Candidate* result = nullptr;
    double largest = 1.0;
    for (const Candidate& c : candidates_) {
      const double e = violation(c);
      if (!(e <= largest)) largest = e, result = &c;
    }
    return result;
  }
  // In units of the tolerance.
  static double violation(const Candidate& c) {
    const double missed = c.multiplier > 0.0 ? std::abs(c.constraint.value) : -c.constraint.value;
    return missed / c.constraint.tolerance;
  }

  // One LCP for the total multipliers; its failure, if any.
  std::string solve() {
    const Eigen::Index m = static_cast<Eigen::Index>(candidates_.size());
    Matrix B(m, m);
    Vector b(m), old(m);
    for (Eigen::Index l = 0; l < m; ++l) {
      b[l] = candidates_[l].constraint.value;
      old[l] = candidates_[l].multiplier;
      for (Eigen::Index k = 0; k < m; ++k)
        B(l, k) = dt_ * rate(candidates_[l].constraint, candidates_[k].column.velocity);
    }
    for (Eigen::Index l = 0; l < m; ++l)
      if (!(B(l, l) > 0.0))
        return concat("the contact force between ", name(candidates_[l].constraint),
                      " does not part them (mobility ", B(l, l) / dt_,
                      "): the points per body do not resolve so small a gap");
    const LcpResult lcp = solve_lcp(B, b - B * old);
    if (!lcp.solved) return lcp.message;
    for (Eigen::Index l = 0; l < m; ++l) candidates_[l].multiplier = lcp.z[l];
    return {};
  }

  void finish(NcpResult& result) {
    result.wrenches.assign(start_.size(), {});
    for (const Candidate& c : candidates_) {
      if (!(c.multiplier > 0.0)) continue;
      result.contacts.push_back({c.constraint, c.multiplier});
      const std::vector<Wrench> unit = wrenches_of(c.constraint, start_.size());
      for (int body : {c.constraint.a, c.constraint.b}) {
        result.wrenches[body].force += c.multiplier * unit[body].force;
        result.wrenches[body].torque += c.multiplier * unit[body].torque;
      }
    }
    result.motion = std::move(motion_);
    result.poses = std::move(poses_);
  }

 private:
  const Suspension& start_;
  const Response& free_;
  double dt_;
  const ConstraintFunction& constraints_;
  const MobilityFunction& mobility_;
  std::vector<Candidate> candidates_;  // sorted by pair
  Response motion_;
  std::vector<Pose> poses_;
};

}  // namespace

NcpResult resolve_contacts(const Suspension& start, const Response& contact_free, double dt,
                           const ConstraintFunction& constraints, const MobilityFunction& mobility,
                           const NcpOptions& options) {
  NcpResult result;
  Iteration iteration(start, contact_free, dt, constraints, mobility);
  double best = std::numeric_limits<double>::infinity();
  int without_progress = 0;
  iteration.update();
  while (const Candidate* worst = iteration.worst()) {
    const double violation = Iteration::violation(*worst);
    without_progress = violation <= 0.5 * best ? 0 : without_progress + 1;
    best = std::min(best, violation);
    if (result.iterations == options.max_iterations)
      result.failure = concat("contact was not resolved in ", result.iterations, " iterations; worst: ",
                              name(worst->constraint));
    else if (options.demand_progress && without_progress >= 2)
      result.failure = concat("contact resolution stopped converging after ", result.iterations,
                              " iterations; worst: ", name(worst->constraint));
    else
      result.failure = iteration.solve();
    if (!result.failure.empty()) return result;
    ++result.iterations;
    iteration.update();
  }
  result.solved = true;
  iteration.finish(result);
  return result;
}

}  // namespace stokes
