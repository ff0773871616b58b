#include "contact_matrix.hpp"

#include <algorithm>
#include <map>

namespace stokes {

namespace {

// An iteration costs one solve, columns of the full mobility one for each contact: of about a hundred in dense suspensions.
constexpr int nearby_iterations = 48;
constexpr int first_iterations = 16;  // with what earlier steps taught: most take fewer, and a fresh start rarely takes more

using Ends = std::pair<int, int>;

// The first and the last body that a wrench acts on: those of a contact.
Ends ends_of(const std::vector<Wrench>& wrenches) {
  Ends ends{-1, -1};
  for (std::size_t i = 0; i < wrenches.size(); ++i) {
    if (wrenches[i].force == Complex(0.0) && wrenches[i].torque == 0.0) continue;
    if (ends.first < 0) ends.first = static_cast<int>(i);
    ends.second = static_cast<int>(i);
  }
  return ends;
}

// Responses to contact forces between the bodies that were in contact in the latest step.
using ContactHistories = std::map<Ends, DensityHistory>;

// A contact's force changes little from one iterate to the next, more from step to step.
Response respond_to_contact(Configuration& at, const std::vector<Wrench>& wrenches, const ContactHistories& histories) {
  const Ends ends = ends_of(wrenches);
  const auto& answers = at.answers();
  const auto latest = std::find_if(answers.rbegin(), answers.rend(),
                                   [&ends](const auto& answer) { return ends_of(answer.first) == ends; });
  if (latest != answers.rend()) return at.respond(wrenches, ComplexVector(latest->second.density));
  const auto past = histories.find(ends);
  return at.respond(wrenches, past == histories.end() ? ComplexVector() : past->second.extrapolated(at.path(), at.nodes()));
}

ContactResponseFactory full_columns(Configuration& at, const ContactHistories& histories) {
  return superposed([&](const auto& wrenches) { return respond_to_contact(at, wrenches, histories); });
}

// The response that moves the iterates of an approximate matrix, a part of the motion as a whole.
ResponseFunction full_response(Configuration& at) {
  return [&at](const auto& wrenches, const auto& guess) { return at.respond(wrenches, guess, at.data_norm()); };
}

// All forces at once.
Response respond_to_all(Configuration& at, const std::vector<std::vector<Wrench>>& units,
                        const std::vector<double>& multipliers, const ComplexVector& guess) {
  std::vector<Wrench> sum(at.bodies().size());
  for (std::size_t k = 0; k < units.size(); ++k)
    for (std::size_t i = 0; i < sum.size(); ++i) {
      sum[i].force += multipliers[k] * units[k][i].force;
      sum[i].torque += multipliers[k] * units[k][i].torque;
    }
  return at.respond(sum, guess, at.data_norm());
}

// A column for each contact, by a Stokes solve that starts from what the same two bodies did before.
class FullMatrix : public ContactMatrix {
 public:
  NcpResult resolve(Configuration& at, const ContactSolver& solve, const NcpOptions& options) override {
    return solve(full_columns(at, histories_), options);
  }

  // By the columns that resolve() asks for, too.
  Response respond(Configuration& at, const std::vector<std::vector<Wrench>>& units,
                   const std::vector<double>& multipliers) override {
    Response sum{std::vector<RigidVelocity>(at.bodies().size()), ComplexVector::Zero(at.system().node_count())};
    for (std::size_t k = 0; k < units.size(); ++k)
      add(sum, multipliers[k], respond_to_contact(at, units[k], histories_));
    return sum;
  }

  void accept(const std::vector<const Configuration*>& at) override {
    ContactHistories present;
    for (const Configuration* configuration : at)
      for (const auto& [wrenches, response] : configuration->answers()) {
        DensityHistory& history = present[ends_of(wrenches)];
        if (const auto past = histories_.find(ends_of(wrenches)); past != histories_.end() && history.empty())
          history = std::move(past->second);
        history.append({configuration->path(), configuration->nodes(), response.density});
      }
    histories_ = std::move(present);
  }
  void reject() override {}

  void save(StateWriter& writer) const override {
    writer.line("contacts", histories_.size());
    for (const auto& [ends, history] : histories_) {
      writer.line("contact", ends.first, ends.second);
      history.save(writer);
    }
  }
  void restore(StateReader& reader) override {
    reader.begin("contacts");
    histories_.clear();
    for (auto count = reader.integer<std::size_t>(); count > 0; --count) {
      reader.begin("contact");
      const int a = reader.integer<int>(), b = reader.integer<int>();
      histories_[{a, b}] = DensityHistory::restored(reader);
    }
  }

 private:
  ContactHistories histories_;
};

// Columns of the bodies around each contact, and what the fluid's answers to earlier iterates taught (known_contacts.hpp).
class NearMatrix : public ContactMatrix {
 public:
  explicit NearMatrix(ContactModel contact) : learns_(contact == ContactModel::gap) {}

  // What was learnt in other configurations may mislead: a second attempt begins without it. A learned matrix is symmetric,
  // which that of a pair that turns far in the step is not: where an LCP has no solution, the third attempt learns nothing.
  // Columns of nearby bodies may be too rough for a long chain: the last attempt takes whole ones.
  NcpResult resolve(Configuration& at, const ContactSolver& solve, const NcpOptions& options) override {
    const bool knows = !latest_.known.contacts.empty();
    NcpOptions limited = options;
    NcpResult result;
    const auto attempt = [&](const ContactResponseFactory& response, int iterations) {
      at.effort().ncp_iterations += result.iterations;
      limited.max_iterations = std::min(options.max_iterations, iterations);
      result = solve(response, limited);
    };
    attempt(nearby(at, latest_), knows ? first_iterations : nearby_iterations);
    if (!result.solved && knows) attempt(nearby(at, latest_ = {}), nearby_iterations);
    if (!result.solved && learns_ && result.iterations < limited.max_iterations)
      attempt(solved(column(at), full_response(at)), nearby_iterations);
    if (!result.solved) attempt(full_columns(at, ContactHistories{}), options.max_iterations);
    if (result.solved) learn(at, result);
    return result;
  }

  Response respond(Configuration& at, const std::vector<std::vector<Wrench>>& units,
                   const std::vector<double>& multipliers) override {
    const std::vector<Density>& answers = accepted_.answers;
    return respond_to_all(at, units, multipliers, answers.empty() ? ComplexVector() : answers.back().on(at.nodes()));
  }

  void accept(const std::vector<const Configuration*>&) override { accepted_ = latest_; }
  void reject() override { latest_ = accepted_; }

  void save(StateWriter& writer) const override { accepted_.save(writer); }
  void restore(StateReader& reader) override { accepted_ = latest_ = Memory::restored(reader); }

 private:
  struct Memory {
    KnownContacts known;
    std::vector<Density> answers;  // those of known.multipliers, of contact forces alone

    void save(StateWriter& writer) const;
    static Memory restored(StateReader& reader);
  };

  static MobilityFunction column(Configuration& at) {
    return [&at](const auto& wrenches) { return at.respond_nearby(wrenches); };
  }

  ContactResponseFactory nearby(Configuration& at, const Memory& memory) const {
    if (!learns_) return solved(column(at), full_response(at));  // forces of interference volumes change with every iterate
    std::vector<ComplexVector> answers;
    for (const Density& answer : memory.answers) answers.push_back(answer.on(at.nodes()));
    return learned(column(at), full_response(at), memory.known, std::move(answers));
  }

  void learn(const Configuration& at, NcpResult& result) {
    if (!learns_ || result.known.contacts.empty()) {
      latest_ = {};
      return;
    }
    if (result.known.multipliers.cols() == 1) latest_.answers.clear();
    latest_.answers.push_back({at.path(), at.nodes(), result.motion.density - at.contact_free().density});
    if (latest_.answers.size() > most_answers) latest_.answers.erase(latest_.answers.begin());
    latest_.known = std::move(result.known);
    latest_.known.multipliers =
        latest_.known.multipliers.rightCols(static_cast<Eigen::Index>(latest_.answers.size())).eval();
  }

  static constexpr std::size_t most_answers = 3;

  bool learns_;
  Memory accepted_, latest_;  // of the latest accepted step, of the latest problem solved
};

void NearMatrix::Memory::save(StateWriter& writer) const {
  writer.line("known", known.contacts.size(), answers.size());
  for (const KnownContacts::Contact& c : known.contacts) writer.line("contact", c.a, c.b, c.region);
  writer.line("rates", std::vector<double>(known.rates.reshaped().begin(), known.rates.reshaped().end()));
  writer.line("multipliers", std::vector<double>(known.multipliers.reshaped().begin(), known.multipliers.reshaped().end()));
  for (const Density& density : answers) density.save(writer);
}

NearMatrix::Memory NearMatrix::Memory::restored(StateReader& reader) {
  Memory memory;
  reader.begin("known");
  memory.known.contacts.resize(reader.integer<std::size_t>());
  memory.answers.resize(reader.integer<std::size_t>());
  for (KnownContacts::Contact& c : memory.known.contacts) {
    reader.begin("contact");
    c.a = reader.integer<int>(), c.b = reader.integer<int>(), c.region = reader.integer<int>();
  }
  const auto rows = static_cast<Eigen::Index>(memory.known.contacts.size());
  memory.known.rates = reader.matrix("rates", rows, rows);
  memory.known.multipliers = reader.matrix("multipliers", rows, static_cast<Eigen::Index>(memory.answers.size()));
  for (Density& density : memory.answers) density = Density::restored(reader);
  return memory;
}

// Columns of bodies that are alone. It keeps nothing.
class SelfMatrix : public ContactMatrix {
 public:
  explicit SelfMatrix(Coupling coupling) : coupling_(coupling) {}

  // Locally coupled, the bodies also move as if they were alone.
  NcpResult resolve(Configuration& at, const ContactSolver& solve, const NcpOptions& options) override {
    const MobilityFunction alone = [&at](const auto& wrenches) { return at.respond_alone(wrenches); };
    return solve(coupling_ == Coupling::local ? superposed(alone) : solved(alone, full_response(at)), options);
  }
  Response respond(Configuration& at, const std::vector<std::vector<Wrench>>& units,
                   const std::vector<double>& multipliers) override {
    return respond_to_all(at, units, multipliers, {});
  }
  void accept(const std::vector<const Configuration*>&) override {}
  void reject() override {}
  void save(StateWriter&) const override {}
  void restore(StateReader&) override {}

 private:
  Coupling coupling_;
};

}  // namespace

std::unique_ptr<ContactMatrix> make_contact_matrix(const StepperOptions& options) {
  if (options.coupling == Coupling::local || options.lcp_matrix == LcpMatrix::self)
    return std::make_unique<SelfMatrix>(options.coupling);
  if (options.lcp_matrix == LcpMatrix::near) return std::make_unique<NearMatrix>(options.contact);
  return std::make_unique<FullMatrix>();
}

}  // namespace stokes
