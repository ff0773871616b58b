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

// A contact in the course of the iteration: its constraint at the current poses, and the force that its
// multiplier now exerts with the column M' f of that force.
struct Candidate {
  ContactConstraint constraint;
  GapGradient force{};
  Response column{};       // empty where its rates are known already
  double multiplier = 0.0;
  double committed = 0.0;  // multipliers of forces that are no longer unknowns
  double change = 0.0;     // of the multiplier, from the motion before to the present one
  std::vector<double> answered{};  // multipliers, both kinds, of the known answers of the whole suspension

  const GapGradient& gradient() const { return constraint.gradient; }
  const GapGradient& start_gradient() const { return force; }
};

constexpr double largest_amplification = 1e6;  // a wedge that is as slim is a jam

using Identity = KnownContacts::Contact;
Identity identity(const ContactConstraint& c) { return {c.a, c.b, c.region}; }

std::string name(const ContactConstraint& c) {
  return concat(pair_name(c.a, c.b), " (constraint ", brief(c.value), ", tolerance ", brief(c.tolerance), ")");
}

class Iteration {
 public:
  Iteration(const Suspension& start, const Response& contact_free, double dt, const ConstraintFunction& constraints,
            const ContactMobility& mobility, const BalanceFunction& balance)
      : start_(start), free_(contact_free), dt_(dt), constraints_(constraints), mobility_(mobility), balance_(balance),
        base_(contact_free), base_wrenches_{std::vector<Wrench>(start.size()), {}} {
    for (std::size_t i = 0; i < start.size(); ++i)
      if (start[i].fixed) fixed_.push_back(static_cast<int>(i));
    known_ = mobility.known;
    answers_ = mobility.answers;
  }

  // Moves the bodies with the current multipliers and evaluates all constraints there.
  void update() {
    move();
    std::vector<std::pair<int, int>> tracked;
    for (Candidate& c : candidates_) {
      tracked.push_back({c.constraint.a, c.constraint.b});
      c.constraint.value = 0.0;  // a contact that is no longer found has opened
    }
    // Known contacts take part from the start.
    if (candidates_.empty())
      for (const Identity& c : known_.contacts) tracked.push_back({c.a, c.b});
    tracked.erase(std::unique(tracked.begin(), tracked.end()), tracked.end());
    for (const ContactConstraint& found : constraints_(poses_, tracked)) {
      const auto place = place_of(identity(found));
      if (place != candidates_.end() && identity(place->constraint) == identity(found))
        place->constraint = found;
      else
        candidates_.insert(place, {.constraint = found, .force = found.force, .answered = known_multipliers(identity(found))});
    }
    learn_from_motion();
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
    base_ = motion_, base_wrenches_ = wrenches_;
    for (Candidate& c : candidates_) c.committed += c.multiplier, c.multiplier = 0.0;
  }

  // What is wrong with the present motion.
  std::string work_failure() const { return negative_work(wrenches_.bodies, motion_.velocity, free_.velocity); }

  // What is wrong with the mobilities: a fluid's are positive, and symmetric between forces (to a tenth, what
  // columns of few nodes or of an approximation may miss).
  std::string unphysical(bool check_symmetry) const {
    const auto m = static_cast<Eigen::Index>(candidates_.size());
    const Matrix M = mobility_.learns ? known_.rates : rates_by_columns(&Candidate::start_gradient);
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

  // One LCP for the multipliers; its failure, if any.
  std::string solve(const NcpOptions& options, bool& unresolved) {
    const Eigen::Index m = static_cast<Eigen::Index>(candidates_.size());
    Vector b(m);  // values less what the present forces did to them
    for (Eigen::Index l = 0; l < m; ++l) b[l] = candidates_[l].constraint.value;
    if (mobility_.learns) {
      extend_known();
      // It has learnt from answers whose errors it shows: columns anew.
      if (!(known_.rates.diagonal().minCoeff() > 0.0)) {
        known_ = {};
        extend_known();
      }
      for (Eigen::Index k = 0; k < m; ++k) b -= dt_ * candidates_[k].multiplier * known_.rates.col(k);
    } else {
      for (Eigen::Index l = 0; l < m; ++l)
        for (const Candidate& k : candidates_)
          if (k.multiplier > 0.0) b[l] -= dt_ * k.multiplier * rate(candidates_[l].constraint, k.column.velocity);
      for (Candidate& c : candidates_)
        if (c.column.velocity.empty() || c.force != c.constraint.force) find_column(c);
    }
    if (const std::string problem = unphysical(options.check_mobility && !mobility_.response); !problem.empty()) {
      unresolved = true;
      return problem;
    }
    const Matrix B = dt_ * (mobility_.learns ? known_.rates : rates_by_columns(&Candidate::gradient));
    for (Eigen::Index l = 0; l < m; ++l)
      if (!(B(l, l) > 0.0))
        return concat("the contact force between ", name(candidates_[l].constraint),
                      " does not part them at the end of the step (mobility ", B(l, l) / dt_,
                      "): the step takes them past each other; try a smaller time_step");
    const LcpResult lcp = solve_lcp(B, b);
    if (const double size = amplification(B, b, lcp.z); size > largest_amplification)
      return concat("jammed: the contact forces would have to be ", size, " times those that part a pair by itself, ",
                    "against at most ", largest_amplification, ". Worst: ", name(worst()->constraint));
    if (!lcp.solved) {
      unresolved = static_cast<bool>(mobility_.response);  // of columns that are not the fluid's own, a jam or not
      return concat(lcp.message, " Worst: ", name(worst()->constraint));
    }
    for (Eigen::Index l = 0; l < m; ++l) {
      candidates_[l].change = lcp.z[l] - candidates_[l].multiplier;
      candidates_[l].multiplier = lcp.z[l];
    }
    return {};
  }

  void finish(NcpResult& result) {
    result.wrenches = std::move(wrenches_.bodies);
    result.container_wrench = wrenches_.container;
    for (const Candidate& c : candidates_)
      if (c.multiplier + c.committed > 0.0) result.contacts.push_back({c.constraint, c.multiplier + c.committed});
    result.known = known_contacts();
    result.motion = std::move(motion_);
    result.poses = std::move(poses_);
  }

 private:
  double rate(const ContactConstraint& c, const std::vector<RigidVelocity>& velocity) const {
    return rate_of(start_, c, c.gradient, velocity);
  }

  void add_motion(const Response& response, double factor) {
    for (std::size_t i = 0; i < start_.size(); ++i) {
      motion_.velocity[i].velocity += factor * response.velocity[i].velocity;
      motion_.velocity[i].omega += factor * response.velocity[i].omega;
    }
    motion_.density += factor * response.density;
  }

  // Balances the wrenches; true if that changes them by more than round-off.
  bool balance_changes() {
    if (!balance_) return false;
    std::vector<std::pair<int, int>> pairs;
    for (const Candidate& c : candidates_)
      if (c.multiplier + c.committed > 0.0) pairs.push_back({c.constraint.a, c.constraint.b});
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

  std::vector<Candidate>::iterator place_of(const Identity& wanted) {
    return std::lower_bound(candidates_.begin(), candidates_.end(), wanted,
                            [](const Candidate& c, const Identity& i) { return identity(c.constraint) < i; });
  }

  std::vector<double> known_multipliers(const Identity& contact) const {
    const Eigen::Index row = mobility_.known.find(contact);
    std::vector<double> multipliers(answers_.size());
    for (std::size_t j = 0; row >= 0 && j < mobility_.answers.size(); ++j)
      multipliers[j] = mobility_.known.multipliers(row, static_cast<Eigen::Index>(j));
    return multipliers;
  }

  void find_column(Candidate& c) {
    c.force = c.constraint.force;
    ContactWrenches unit{std::vector<Wrench>(start_.size()), {}};
    unit.add(c.constraint, c.force, 1.0);
    c.column = mobility_.column(unit.on_all_but(fixed_));
  }

  // Rates of all values, or of others with gradients to choose, by all columns.
  Matrix rates_by_columns(const GapGradient& (Candidate::*gradient)() const) const {
    const auto m = static_cast<Eigen::Index>(candidates_.size());
    Matrix rates(m, m);
    for (Eigen::Index l = 0; l < m; ++l)
      for (Eigen::Index k = 0; k < m; ++k)
        rates(l, k) = rate_of(start_, candidates_[l].constraint, (candidates_[l].*gradient)(), candidates_[k].column.velocity);
    return rates;
  }

  // Rates of all candidates: those known, and by columns where they are not or where a force has changed.
  void extend_known() {
    const auto m = static_cast<Eigen::Index>(candidates_.size());
    KnownContacts all{{}, Matrix(m, m), {}};
    std::vector<Eigen::Index> known;
    for (Candidate& c : candidates_) {
      const bool changed = c.force != c.constraint.force;
      known.push_back(changed ? -1 : known_.find(identity(c.constraint)));
      if (known.back() < 0) find_column(c);
      all.contacts.push_back(identity(c.constraint));
    }
    const auto by_column = [this](Eigen::Index l, Eigen::Index k) {
      return rate(candidates_[l].constraint, candidates_[k].column.velocity);
    };
    for (Eigen::Index l = 0; l < m; ++l)
      for (Eigen::Index k = 0; k <= l; ++k)
        all.rates(l, k) = all.rates(k, l) = known[l] >= 0 && known[k] >= 0 ? known_.rates(known[l], known[k])
                                            : known[l] >= 0                ? by_column(l, k)
                                            : known[k] >= 0                ? by_column(k, l)
                                                                           : 0.5 * (by_column(l, k) + by_column(k, l));
    known_ = std::move(all);
  }

  // Rate of a value by the contact forces.
  double contact_rate(const ContactConstraint& c) const { return rate(c, motion_.velocity) - rate(c, free_.velocity); }

  void learn_from_motion() {
    if (!mobility_.learns || before_.empty()) return;
    const auto m = static_cast<Eigen::Index>(known_.contacts.size());
    Vector change(m), changed(m), present(m), total(m);
    for (Eigen::Index l = 0; l < m; ++l) {
      const Candidate& c = *place_of(known_.contacts[l]);  // whose force moved something, so it is there
      change[l] = c.change;
      present[l] = c.multiplier;
      changed[l] = rate(c.constraint, motion_.velocity) - rate(c.constraint, before_);
      total[l] = contact_rate(c.constraint);
    }
    learn(known_.rates, change, changed, present);
    learn(known_.rates, present, total, present);
    before_.clear();
  }

  // Of the contacts that press, or did at the end of the step before.
  KnownContacts known_contacts() const {
    const std::size_t earlier = mobility_.answers.size();
    std::vector<const Candidate*> kept;
    KnownContacts result;
    for (const Candidate& c : candidates_) {
      const bool known = mobility_.learns ? known_.find(identity(c.constraint)) >= 0 : !c.column.velocity.empty();
      if (!known || (c.multiplier == 0.0 && (earlier == 0 || c.answered[earlier - 1] == 0.0))) continue;
      kept.push_back(&c);
      result.contacts.push_back(identity(c.constraint));
    }
    const auto m = static_cast<Eigen::Index>(kept.size());
    result.rates.resize(m, m);
    result.multipliers.resize(m, static_cast<Eigen::Index>(earlier) + 1);
    const auto by_column = [this](const Candidate& l, const Candidate& k) { return rate(l.constraint, k.column.velocity); };
    for (Eigen::Index l = 0; l < m; ++l) {
      for (Eigen::Index k = 0; k < m; ++k)
        result.rates(l, k) = mobility_.learns ? known_.rates(known_.find(result.contacts[l]), known_.find(result.contacts[k]))
                                              : 0.5 * (by_column(*kept[l], *kept[k]) + by_column(*kept[k], *kept[l]));
      for (std::size_t j = 0; j < earlier; ++j) result.multipliers(l, static_cast<Eigen::Index>(j)) = kept[l]->answered[j];
      result.multipliers(l, static_cast<Eigen::Index>(earlier)) = kept[l]->multiplier;
    }
    return result;
  }

  // The combination of known answers that is nearest to the present forces, changed by the columns to what they are.
  ComplexVector expected_density() const {
    const auto m = static_cast<Eigen::Index>(candidates_.size()), n = static_cast<Eigen::Index>(answers_.size());
    Matrix answered(m, n);
    Vector wanted(m), scale = Vector::Ones(m);
    for (Eigen::Index l = 0; l < m; ++l) {
      const Candidate& c = candidates_[l];
      wanted[l] = c.multiplier + c.committed;
      if (mobility_.learns) scale[l] = std::sqrt(known_.rates(l, l));
      for (Eigen::Index j = 0; j < n; ++j) answered(l, j) = c.answered[j];
    }
    const Vector part = nearest_combination(answered, wanted, scale), rest = wanted - answered * part;
    ComplexVector density = ComplexVector::Zero(free_.density.size());
    for (Eigen::Index j = 0; j < n; ++j) density += part[j] * answers_[j];
    for (Eigen::Index l = 0; l < m; ++l)
      if (candidates_[l].column.density.size() > 0) density += rest[l] * candidates_[l].column.density;
    return density;
  }

  void move() {
    wrenches_ = base_wrenches_;
    bool forced = false;
    for (const Candidate& c : candidates_) {
      forced = forced || c.multiplier + c.committed > 0.0;
      if (c.multiplier > 0.0) wrenches_.add(c.constraint, c.force, c.multiplier);
    }
    if (forced && mobility_.response) {
      balance_changes();
      const Response answer = mobility_.response(wrenches_.on_all_but(fixed_), expected_density());
      answers_.push_back(answer.density);
      for (Candidate& c : candidates_) c.answered.push_back(c.multiplier + c.committed);
      before_ = std::move(motion_.velocity);
      motion_ = free_;
      add_motion(answer, 1.0);
    } else if (forced && balance_changes()) {
      motion_ = free_;
      add_motion(mobility_.column(wrenches_.on_all_but(fixed_)), 1.0);
    } else {
      motion_ = base_;
      for (const Candidate& c : candidates_)
        if (c.multiplier > 0.0) add_motion(c.column, c.multiplier);
    }
    poses_.clear();
    for (std::size_t i = 0; i < start_.size(); ++i) {
      const RigidVelocity& u = motion_.velocity[i];
      const bool rests = start_[i].fixed && u.velocity == 0.0 && u.omega == 0.0;
      poses_.push_back(rests ? start_[i].pose : advance(start_[i].pose, u, dt_));
    }
  }

  const Suspension& start_;
  const Response& free_;
  double dt_;
  const ConstraintFunction& constraints_;
  const ContactMobility& mobility_;
  const BalanceFunction& balance_;
  std::vector<int> fixed_;             // bodies
  std::vector<Candidate> candidates_;  // sorted by pair and region
  Response base_;                      // motion with the committed forces
  ContactWrenches base_wrenches_;      // and these
  KnownContacts known_;                // their rates: of all candidates once an LCP was solved
  std::vector<ComplexVector> answers_; // densities of the whole suspension for contact forces
  std::vector<RigidVelocity> before_;  // the motion that `change` of the multipliers made the present one of
  Response motion_;
  ContactWrenches wrenches_;
  std::vector<Pose> poses_;
};

}  // namespace

NcpResult resolve_contacts(const Suspension& start, const Response& contact_free, double dt,
                           const ConstraintFunction& constraints, const ContactMobility& mobility,
                           const NcpOptions& options, const BalanceFunction& balance) {
  NcpResult result;
  Iteration iteration(start, contact_free, dt, constraints, mobility, balance);
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
