#include "contact_response.hpp"

namespace stokes {

namespace {

// The fluid is linear: once M f is known for the force of a contact, an iteration costs no Stokes solve.
class SuperposedResponse : public ContactResponse {
 public:
  SuperposedResponse(const ContactStep& step, const MobilityFunction& column)
      : ContactResponse(step, column), base_(step.contact_free) {}

  bool exact() const override { return true; }

  Response motion(const Candidates& candidates, const std::vector<Wrench>& wrenches, bool balanced) override {
    Response result = balanced ? step_.contact_free : base_;
    if (balanced) {
      add(result, 1.0, column_(wrenches));
      return result;
    }
    for (const Candidate& c : candidates)
      if (c.multiplier > 0.0) add(result, c.multiplier, c.column);
    return result;
  }

  void commit(const Response& motion) override { base_ = motion; }

 private:
  Response base_;  // with the committed forces
};

}  // namespace

ContactResponseFactory superposed(MobilityFunction column) {
  return
      [column = std::move(column)](const ContactStep& step) { return std::make_unique<SuperposedResponse>(step, column); };
}

}  // namespace stokes
