#include "solved_response.hpp"

namespace stokes {

namespace {

using Contact = KnownContacts::Contact;

ContactAnswers answers_of(const KnownContacts& known, std::vector<ComplexVector> densities) {
  ContactAnswers result{std::move(densities), {}};
  for (std::size_t l = 0; l < known.contacts.size(); ++l) {
    const auto row = known.multipliers.row(static_cast<Eigen::Index>(l));
    result.multipliers[known.contacts[l]].assign(row.begin(), row.end());
  }
  return result;
}

// For the change s of the multipliers and the change y it made in the rates of the constraints, and then for all
// multipliers and what they do, the smallest symmetric change of the matrix is made after which M' s = y. The forces of a
// contact stay the same from one iteration to the next, so that none is committed.
class LearnedResponse : public SolvedResponse {
 public:
  LearnedResponse(const ContactStep& step, const MobilityFunction& column, const ResponseFunction& response,
                  const KnownContacts& known, const std::vector<ComplexVector>& answers)
      : SolvedResponse(step, column, response, answers_of(known, answers)), begun_with_(answers.size()), known_(known),
        present_(step.contact_free.velocity) {}

  std::vector<Contact> expected() const override { return known_.contacts; }

  Response motion(const Candidates& candidates, const std::vector<Wrench>& wrenches, bool balanced) override {
    Response result = SolvedResponse::motion(candidates, wrenches, balanced);
    before_ = std::move(present_);
    present_ = result.velocity;
    return result;
  }

  void observe(const Candidates& candidates) override {
    const auto m = static_cast<Eigen::Index>(multipliers_before_.size());
    if (m == 0) return;
    Vector change(m), changed(m), present(m), total(m);
    Eigen::Index l = 0;
    for (const Candidate& c : candidates) {
      if (l == m || identity(c.constraint) != known_.contacts[l]) continue;  // found by the latest motion
      const auto rate = [&](const auto& velocity) { return step_.rate(c.constraint, c.constraint.gradient, velocity); };
      change[l] = c.multiplier - multipliers_before_[l];
      present[l] = c.multiplier;
      changed[l] = rate(present_) - rate(before_);
      total[l] = rate(present_) - rate(step_.contact_free.velocity);
      ++l;
    }
    multipliers_before_.clear();
    if (present.maxCoeff() <= 0.0) return;
    learn(known_.rates, change, changed, present);
    learn(known_.rates, present, total, present);
  }

  Vector values_without_forces(Candidates& candidates) override {
    extend(candidates);
    // It has learnt from answers whose errors it shows: columns anew.
    if (!(known_.rates.diagonal().minCoeff() > 0.0)) {
      known_ = {};
      extend(candidates);
    }
    Vector b(static_cast<Eigen::Index>(candidates.size()));
    Eigen::Index k = 0;
    for (const Candidate& c : candidates) b[k++] = c.constraint.value;
    k = 0;
    for (const Candidate& c : candidates) {
      b -= step_.dt * c.multiplier * known_.rates.col(k++);
      multipliers_before_.push_back(c.multiplier);
    }
    return b;
  }

  Matrix rates(const Candidates&) const override { return known_.rates; }
  Matrix rates_along_forces(const Candidates&) const override { return known_.rates; }

  // Of the contacts that press, or did at the end of the step before.
  KnownContacts known(const Candidates& candidates) override {
    std::vector<Eigen::Index> kept;
    KnownContacts result;
    std::vector<std::vector<double>> answered;
    for (const Candidate& c : candidates) {
      const Eigen::Index row = known_.find(identity(c.constraint));
      std::vector<double> earlier = multipliers(c);
      earlier.resize(begun_with_);
      if (row < 0 || (c.multiplier == 0.0 && (begun_with_ == 0 || earlier.back() == 0.0))) continue;
      kept.push_back(row);
      earlier.push_back(c.multiplier);
      answered.push_back(std::move(earlier));
      result.contacts.push_back(identity(c.constraint));
    }
    result.rates = known_.rates(kept, kept);
    result.multipliers.resize(static_cast<Eigen::Index>(kept.size()), static_cast<Eigen::Index>(begun_with_) + 1);
    for (Eigen::Index l = 0; l < result.multipliers.rows(); ++l)
      for (Eigen::Index j = 0; j < result.multipliers.cols(); ++j) result.multipliers(l, j) = answered[l][j];
    return result;
  }

 protected:
  double scale(Eigen::Index contact) const override { return std::sqrt(known_.rates(contact, contact)); }

 private:
  // Rates of all candidates: those known, and by columns where they are not or where a force has changed.
  void extend(Candidates& candidates) {
    const auto m = static_cast<Eigen::Index>(candidates.size());
    KnownContacts all{{}, Matrix(m, m), {}};
    std::vector<Eigen::Index> row;
    for (Candidate& c : candidates) {
      row.push_back(c.force != c.constraint.force ? -1 : known_.find(identity(c.constraint)));
      if (row.back() < 0) find_column(c);
      all.contacts.push_back(identity(c.constraint));
    }
    const auto by_column = [&](Eigen::Index l, Eigen::Index k) {
      const ContactConstraint& c = candidates[l].constraint;
      return step_.rate(c, c.gradient, candidates[k].column.velocity);
    };
    for (Eigen::Index l = 0; l < m; ++l)
      for (Eigen::Index k = 0; k <= l; ++k)
        all.rates(l, k) = all.rates(k, l) = row[l] >= 0 && row[k] >= 0 ? known_.rates(row[l], row[k])
                                            : row[l] >= 0              ? by_column(l, k)
                                            : row[k] >= 0              ? by_column(k, l)
                                                                       : 0.5 * (by_column(l, k) + by_column(k, l));
    known_ = std::move(all);
  }

  std::size_t begun_with_;                 // answers
  KnownContacts known_;                    // the rates of all candidates, once an LCP was begun
  std::vector<double> multipliers_before_; // those of known_.contacts at the latest LCP
  std::vector<RigidVelocity> present_, before_;  // motion, and the one before
};

}  // namespace

ContactResponseFactory learned(MobilityFunction column, ResponseFunction response, KnownContacts known,
                               std::vector<ComplexVector> answers) {
  return [column = std::move(column), response = std::move(response), known = std::move(known),
          answers = std::move(answers)](const ContactStep& step) {
    return std::make_unique<LearnedResponse>(step, column, response, known, answers);
  };
}

}  // namespace stokes
