// Motions that are solved for, one Stokes solve for each (contact_response.hpp). Solves start from a combination of earlier
// answers of the fluid to contact forces.
#pragma once

#include <map>

#include "contact_response.hpp"

namespace stokes {

// Answers of the fluid to contact forces: their densities, and each contact's multipliers in them, the newest last.
struct ContactAnswers {
  std::vector<ComplexVector> densities{};
  std::map<KnownContacts::Contact, std::vector<double>> multipliers{};
};

class SolvedResponse : public ContactResponse {
 public:
  // `answers`: known when the iterations begin.
  SolvedResponse(const ContactStep& step, MobilityFunction column, ResponseFunction response, ContactAnswers answers = {});

  bool exact() const override { return false; }
  Response motion(const Candidates& candidates, const std::vector<Wrench>& wrenches, bool balanced) override;

 protected:
  // A contact's unit of force in the combinations.
  virtual double scale(Eigen::Index) const { return 1.0; }

  // In all answers.
  std::vector<double>& multipliers(const Candidate& c);

 private:
  ComplexVector expected_density(const Candidates& candidates);

  ResponseFunction response_;
  ContactAnswers answers_;
};

}  // namespace stokes
