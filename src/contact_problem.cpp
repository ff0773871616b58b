#include "contact_problem.hpp"

#include <algorithm>

#include "cluster.hpp"
#include "contact_wrenches.hpp"

namespace stokes {

namespace {

// Newton's method on interference volumes takes 3 to 6 iterations where it converges; it cycles where sliding
// carries vertices across corners.
constexpr int stiv_increments_after = 8;

// The displacement of the base poses from the start of the step, over the length, as a velocity: with it
// start + length (shift + w) = base + length w. Empty if the base is the start.
std::vector<RigidVelocity> shift_of(const Suspension& start, const std::vector<Pose>& base, double length) {
  std::vector<RigidVelocity> shift(start.size());
  bool ahead = false;
  for (std::size_t i = 0; i < start.size(); ++i) {
    if (base[i] == start[i].pose) continue;
    ahead = true;
    shift[i] = {(base[i].centre - start[i].pose.centre) / length, (base[i].angle - start[i].pose.angle) / length};
  }
  return ahead ? shift : std::vector<RigidVelocity>{};
}

}  // namespace

ContactProblem::ContactProblem(const StepperOptions& options)
    : options_(options), matrix_(make_contact_matrix(options)) {}

ContactSolution ContactProblem::solve(const Suspension& start, Configuration& at, const std::vector<Pose>& base,
                                      double length, const NcpOptions& ncp) {
  const std::vector<RigidVelocity> shift = shift_of(start, base, length);
  Response free = at.contact_free();
  add(free.velocity, 1.0, shift);

  NcpOptions options = ncp;
  if (options_.contact == ContactModel::stiv) options.increments_after = stiv_increments_after;
  options.check_mobility = options_.contact == ContactModel::gap && options_.coupling == Coupling::global;
  const auto resolve = [&](const ConstraintFunction& constraints, const BalanceFunction& balance) {
    return matrix_->resolve(
        at,
        [&](const ContactResponseFactory& response, const NcpOptions& how) {
          return resolve_contacts(start, free, length, constraints, response, how, balance);
        },
        options);
  };
  NcpResult result;
  if (options_.contact == ContactModel::gap) {
    const GapCollector collector(start, at.bodies(), options_.separation, options_.contact_tolerance);
    result = resolve([&](const auto& trial, const auto& tracked) { return collector.collect(trial, tracked); }, {});
  } else if (options_.contact == ContactModel::stiv) {
    const int vertices = options_.stiv_vertices > 0 ? options_.stiv_vertices : 4 * options_.points_per_body;
    const StivCollector collector(start, options_.separation, {vertices, options_.stiv_gradient});
    result = resolve([&](const auto& trial, const auto&) { return collector.collect(trial); }, balance_clusters);
  } else {
    result = resolve([](const auto&, const auto&) { return std::vector<ContactConstraint>{}; }, {});
  }
  at.effort().ncp_iterations += result.iterations;

  if (result.solved) add(result.motion.velocity, -1.0, shift);
  return {result.solved, std::move(result.failure), std::move(result.poses), std::move(result.motion.velocity),
          std::move(result.motion.density), std::move(result.contacts), std::move(result.wrenches), result.container_wrench};
}

Response ContactProblem::respond(Configuration& at, const std::vector<ActiveContact>& contacts) {
  const Suspension& bodies = at.bodies();
  std::vector<std::pair<int, int>> pairs;
  for (const ActiveContact& c : contacts) pairs.push_back({c.constraint.a, c.constraint.b});
  const std::vector<int> fixed = fixed_bodies(bodies);
  std::vector<Pose> poses;
  for (const auto& body : bodies) poses.push_back(body.pose);
  std::vector<std::vector<Wrench>> units;
  std::vector<double> multipliers;
  const GapCollector collector(bodies, options_.separation);
  for (const ContactConstraint& c : collector.collect(poses, pairs)) {
    const auto known = std::find(pairs.begin(), pairs.end(), std::pair(c.a, c.b));
    if (known == pairs.end()) continue;
    ContactWrenches unit{std::vector<Wrench>(bodies.size()), {}};
    unit.add(c, c.force, 1.0);
    units.push_back(unit.on_all_but(fixed));
    multipliers.push_back(contacts[known - pairs.begin()].multiplier);
  }
  return matrix_->respond(at, units, multipliers);
}

}  // namespace stokes
