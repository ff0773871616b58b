#include "stepper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cluster.hpp"
#include "completion.hpp"
#include "neighbours.hpp"

namespace stokes {

namespace {

// Newton's method on interference volumes takes 3 to 6 iterations where it converges; it cycles where sliding
// carries vertices across corners.
constexpr int stiv_increments_after = 8;

bool same(const std::vector<Wrench>& u, const std::vector<Wrench>& v) {
  return std::equal(u.begin(), u.end(), v.begin(), v.end(),
                    [](const Wrench& a, const Wrench& b) { return a.force == b.force && a.torque == b.torque; });
}

}  // namespace

Stepper::Stepper(Suspension bodies, const StepperOptions& options)
    : bodies_(std::move(bodies)), options_(options), shapes_(options.near_singular) {}

int Stepper::shape_count() const {
  std::vector<Shape> distinct;
  for (const Body& body : bodies_)
    if (std::find(distinct.begin(), distinct.end(), body.shape) == distinct.end()) distinct.push_back(body.shape);
  return static_cast<int>(distinct.size());
}

Stepper::Configuration& Stepper::configuration(double driving) {
  if (now_ && now_->driving == driving) return *now_;
  now_.emplace(bodies_, options_, shapes_, driving);
  std::vector<Wrench> external;
  for (const Body& body : bodies_) external.push_back({body.force, body.torque});
  const BackgroundFlow flow{options_.flow.kind, driving * options_.flow.rate};
  // Densities live in the body frames, so the previous ones are already turned with their bodies.
  StokesSolution solution;
  try {
    solution = options_.coupling == Coupling::local && lagged_.size() > 0
                   ? now_->system.sweep(flow, external, lagged_)
                   : now_->system.solve(flow, external, driving * guess_);
  } catch (...) {
    now_.reset();  // a configuration without its velocities is none
    throw;
  }
  now_->gmres_iterations = solution.iterations;
  now_->contact_free = {std::move(solution.velocity), std::move(solution.density)};
  return *now_;
}

Response Stepper::respond(Configuration& now, const std::vector<Wrench>& wrenches) {
  for (const auto& [known, response] : now.columns)
    if (same(known, wrenches)) return response;
  StokesSolution solution = now.system.solve({}, wrenches);
  now.gmres_iterations += solution.iterations;
  now.columns.push_back({wrenches, {std::move(solution.velocity), std::move(solution.density)}});
  return now.columns.back().second;
}

// No body feels the forces on another; the densities answer a rigid motion with nothing.
Response Stepper::respond_alone(const Configuration& now, const std::vector<Wrench>& wrenches) const {
  Response response{{}, ComplexVector::Zero(now.system.node_count())};
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    response.velocity.push_back(completion_trace(bodies_[i].shape, bodies_[i].pose, wrenches[i]));
  return response;
}

NcpResult Stepper::resolve(Configuration& now, double dt, const NcpOptions& ncp) {
  const MobilityFunction full = [&](const std::vector<Wrench>& w) { return respond(now, w); };
  const MobilityFunction alone = [&](const std::vector<Wrench>& w) { return respond_alone(now, w); };
  ContactMobility mobility{full, {}};
  if (options_.coupling == Coupling::local)
    mobility = {alone, {}};
  else if (options_.lcp_matrix == LcpMatrix::self)
    mobility = {alone, full};
  const auto solve = [&](const ConstraintFunction& constraints, const BalanceFunction& balance) {
    NcpOptions options = ncp;
    if (options_.contact == ContactModel::stiv) options.increments_after = stiv_increments_after;
    return resolve_contacts(bodies_, now.contact_free, dt, constraints, mobility, options, balance);
  };
  switch (options_.contact) {
    case ContactModel::gap: {
      const GapCollector collector(bodies_, options_.separation);
      return solve([&](const auto& trial, const auto& tracked) { return collector.collect(trial, tracked); }, {});
    }
    case ContactModel::stiv: {
      const int vertices = options_.stiv_vertices > 0 ? options_.stiv_vertices : 4 * options_.points_per_body;
      const StivCollector collector(bodies_, options_.separation, {vertices, options_.stiv_gradient});
      return solve([&](const auto& trial, const auto&) { return collector.collect(trial); }, balance_clusters);
    }
    case ContactModel::none: break;
  }
  return solve([](const auto&, const auto&) { return std::vector<ContactConstraint>{}; }, {});
}

StepOutcome Stepper::attempt(double dt, double driving, const NcpOptions& ncp) {
  Configuration& now = configuration(driving);
  NcpResult result = resolve(now, dt, ncp);
  now.ncp_iterations += result.iterations;

  StepOutcome outcome;
  outcome.accepted = result.solved;
  outcome.failure = result.failure;
  outcome.dt = dt;
  outcome.gmres_iterations = now.gmres_iterations;
  outcome.ncp_iterations = now.ncp_iterations;
  if (!result.solved) return outcome;
  outcome.contacts = std::move(result.contacts);
  outcome.contact_wrench = std::move(result.wrenches);
  outcome.density_tail = now.system.density_tail(result.motion.density);
  lagged_ = std::move(result.motion.density);
  outcome.velocity = std::move(result.motion.velocity);
  for (std::size_t i = 0; i < bodies_.size(); ++i) bodies_[i].pose = result.poses[i];
  guess_ = driving * now.contact_free.density;
  now_.reset();
  return outcome;
}

double Stepper::geometric_step_limit(double driving) {
  const std::vector<RigidVelocity>& u = configuration(driving).contact_free.velocity;
  double limit = std::numeric_limits<double>::infinity();
  std::vector<Complex> centres;
  std::vector<double> radii;
  double width = 0.0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (u[i].omega != 0.0) limit = std::min(limit, 0.2 / std::abs(u[i].omega));
    centres.push_back(bodies_[i].pose.centre);
    radii.push_back(bodies_[i].shape.circumradius());
    width = std::max(width, bodies_[i].shape.inradius());
  }
  for (const auto& [i, j] : neighbour_pairs(centres, centres, radii, width)) {
    const double speed = std::abs(u[i].velocity - u[j].velocity);
    const double smaller = std::min(bodies_[i].shape.inradius(), bodies_[j].shape.inradius());
    if (speed > 0.0) limit = std::min(limit, smaller / speed);
  }
  return limit;
}

}  // namespace stokes
