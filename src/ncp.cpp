#include "ncp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact_work.hpp"
#include "contact_wrenches.hpp"
#include "interruption.hpp"
#include "lcp.hpp"
#include "text.hpp"

namespace stokes {

namespace {

constexpr double largest_amplification = 1e6;  // a wedge that is as slim is a jam

using Identity = KnownContacts::Contact;

std::string name(const ContactConstraint& c) {
  return concat(pair_name(c.a, c.b), " (constraint ", brief(c.value), ", tolerance ", brief(c.tolerance), ")");
}

class Iteration {
 public:
  Iteration(const ContactStep& step, const ConstraintFunction& constraints, const ContactResponseFactory& response,
            const BalanceFunction& balance)
      : step_(step), constraints_(constraints), balance_(balance), fixed_(fixed_bodies(step.start)),
        response_(response(step)), base_wrenches_{std::vector<Wrench>(step.start.size()), {}} {}

  // Moves the bodies with the current multipliers and evaluates all constraints there.
  void update() {
    move();
    std::vector<std::pair<int, int>> tracked;
    for (Candidate& c : candidates_) {
      tracked.push_back({c.constraint.a, c.constraint.b});
      c.constraint.value = 0.0;  // a contact that is no longer found has opened
    }
    if (candidates_.empty())
      for (const Identity& c : response_->expected()) tracked.push_back({c.a, c.b});
    tracked.erase(std::unique(tracked.begin(), tracked.end()), tracked.end());
    for (const ContactConstraint& found : constraints_(poses_, tracked)) {
      const auto place = std::lower_bound(candidates_.begin(), candidates_.end(), identity(found),
                                          [](const Candidate& c, const Identity& i) { return identity(c.constraint) < i; });
      if (place != candidates_.end() && identity(place->constraint) == identity(found))
        place->constraint = found;
      else
        candidates_.insert(place, {.constraint = found, .force = found.force});
    }
    response_->observe(candidates_);
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

  // From here on the present forces stay, and the unknowns are what is added to them.
  void commit() {
    response_->commit(motion_);
    base_wrenches_ = wrenches_;
    for (Candidate& c : candidates_) c.committed += c.multiplier, c.multiplier = 0.0;
  }

  // What is wrong with the present motion.
  std::string work_failure() const {
    return negative_work(wrenches_.bodies, motion_.velocity, step_.contact_free.velocity);
  }

  // One LCP for the multipliers; its failure, if any.
  std::string solve(const NcpOptions& options, bool& unresolved) {
    const Eigen::Index m = static_cast<Eigen::Index>(candidates_.size());
    const Vector b = response_->values_without_forces(candidates_);
    if (const std::string problem = unphysical(options.check_mobility && response_->exact()); !problem.empty()) {
      unresolved = true;
      return problem;
    }
    const Matrix B = step_.dt * response_->rates(candidates_);
    for (Eigen::Index l = 0; l < m; ++l)
      if (!(B(l, l) > 0.0))
        return concat("the contact force between ", name(candidates_[l].constraint),
                      " does not part them at the end of the step (mobility ", B(l, l) / step_.dt,
                      "): the step takes them past each other; try a smaller time_step");
    const LcpResult lcp = solve_lcp(B, b);
    if (const double size = amplification(B, b, lcp.z); size > largest_amplification)
      return concat("jammed: the contact forces would have to be ", size, " times those that part a pair by itself, ",
                    "against at most ", largest_amplification, ". Worst: ", name(worst()->constraint));
    if (!lcp.solved) {
      unresolved = !response_->exact();  // of columns that are not the fluid's own, a jam or not
      return concat(lcp.message, " Worst: ", name(worst()->constraint));
    }
    for (Eigen::Index l = 0; l < m; ++l) candidates_[l].multiplier = lcp.z[l];
    return {};
  }

  void finish(NcpResult& result) {
    result.wrenches = std::move(wrenches_.bodies);
    result.container_wrench = wrenches_.container;
    for (const Candidate& c : candidates_)
      if (c.total() > 0.0) result.contacts.push_back({c.constraint, c.total()});
    result.known = response_->known(candidates_);
    result.motion = std::move(motion_);
    result.poses = std::move(poses_);
  }

 private:
  // What is wrong with the mobilities: a fluid's are positive, and symmetric between forces (to a tenth, what
  // columns of few nodes or of an approximation may miss).
  std::string unphysical(bool check_symmetry) const {
    const auto m = static_cast<Eigen::Index>(candidates_.size());
    const Matrix M = response_->rates_along_forces(candidates_);
    for (Eigen::Index l = 0; l < m; ++l)
      if (!(M(l, l) > 0.0))
        return concat("the contact force between ", name(candidates_[l].constraint), " does not part them (mobility ",
                      brief(M(l, l)), "): the nodes do not resolve so small a gap; ", finer_nodes);
    if (std::string work = work_failure(); !work.empty()) return work;
    for (Eigen::Index l = 0; check_symmetry && l < m; ++l)
      for (Eigen::Index k = 0; k < l; ++k)
        if (std::abs(M(l, k) - M(k, l)) > 0.1 * std::sqrt(M(l, l) * M(k, k)))
          return concat("the contacts of ", name(candidates_[l].constraint), " and of ", name(candidates_[k].constraint),
                        " act on each other by mobilities of ", brief(M(l, k)), " and ", brief(M(k, l)),
                        ", which should be equal: the nodes do not resolve so small a gap; ", finer_nodes);
    return {};
  }

  // Balances the wrenches; true if that changes them by more than round-off.
  bool balance_changes() {
    if (!balance_) return false;
    std::vector<std::pair<int, int>> pairs;
    for (const Candidate& c : candidates_)
      if (c.total() > 0.0) pairs.push_back({c.constraint.a, c.constraint.b});
    if (pairs.empty()) return false;
    std::vector<Wrench> balanced = wrenches_.bodies;
    balance_(pairs, balanced, fixed_);
    double scale = 0.0, change = 0.0;
    for (std::size_t i = 0; i < balanced.size(); ++i) {
      scale = std::max(scale, std::abs(wrenches_.bodies[i].force));
      change = std::max(change, std::abs(balanced[i].force - wrenches_.bodies[i].force));
    }
    if (change <= 1e-12 * scale) return false;
    wrenches_.bodies = std::move(balanced);
    return true;
  }

  void move() {
    wrenches_ = base_wrenches_;
    for (const Candidate& c : candidates_)
      if (c.multiplier > 0.0) wrenches_.add(c.constraint, c.force, c.multiplier);
    const bool balanced = balance_changes();
    motion_ = response_->motion(candidates_, wrenches_.on_all_but(fixed_), balanced);
    const Suspension& start = step_.start;
    poses_.clear();
    for (std::size_t i = 0; i < start.size(); ++i) {
      const RigidVelocity& u = motion_.velocity[i];
      const bool rests = start[i].fixed && u.velocity == 0.0 && u.omega == 0.0;
      poses_.push_back(rests ? start[i].pose : advance(start[i].pose, u, step_.dt));
    }
  }

  const ContactStep step_;
  const ConstraintFunction& constraints_;
  const BalanceFunction& balance_;
  const std::vector<int> fixed_;  // bodies
  std::unique_ptr<ContactResponse> response_;
  Candidates candidates_;
  ContactWrenches base_wrenches_;  // of the committed forces
  Response motion_;
  ContactWrenches wrenches_;
  std::vector<Pose> poses_;
};

}  // namespace

NcpResult resolve_contacts(const Suspension& start, const Response& contact_free, double dt,
                           const ConstraintFunction& constraints, const ContactResponseFactory& response,
                           const NcpOptions& options, const BalanceFunction& balance) {
  NcpResult result;
  Iteration iteration({start, contact_free, dt}, constraints, response, balance);
  double best = std::numeric_limits<double>::infinity();
  int without_progress = 0;
  iteration.update();
  while (const Candidate* worst = iteration.worst()) {
    const double violation = Iteration::violation(*worst);
    without_progress = violation <= 0.5 * best ? 0 : without_progress + 1;
    best = std::min(best, violation);
    end_if_interrupted();
    const auto where = [&] { return concat(result.iterations, " iterations; worst: ", name(worst->constraint)); };
    if (result.iterations == options.max_iterations)
      result.failure = concat("contact was not resolved in ", where());
    else if (options.demand_progress && without_progress >= 2)
      result.failure = concat("contact resolution stopped converging after ", where());
    else {
      if (result.iterations >= options.increments_after) iteration.commit();
      result.failure = iteration.solve(options, result.unresolved);
    }
    if (!result.failure.empty()) return result;
    ++result.iterations;
    iteration.update();
  }
  result.failure = iteration.work_failure();
  if (!result.failure.empty()) {
    result.unresolved = true;
    return result;
  }
  result.solved = true;
  iteration.finish(result);
  return result;
}

}  // namespace stokes
