#include "stepper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cluster.hpp"
#include "completion.hpp"
#include "neighbours.hpp"

namespace stokes {

namespace {

// Newton's method on interference volumes takes 3 to 6 iterations where it converges; it cycles where sliding
// carries vertices across corners.
constexpr int stiv_increments_after = 8;

// Densities that the next one is extrapolated from: quadratic, which on Taylor-Green flow saves twice as many
// iterations as starting from the previous one.
constexpr std::size_t extrapolation_points = 3;
// Of LcpMatrix::near: the mobility across a small gap is 1e-3 and less of what each of the two flows in it is alone.
constexpr double column_tolerance = 1e-6;
// An iteration costs one solve, columns of the full mobility one for each contact: of about a hundred in dense suspensions.
constexpr int nearby_iterations = 24;

// A density on other nodes.
ComplexVector moved(const StepperMemory::Density& density, const std::vector<Discretisation>& nodes) {
  return move_densities(density.value, density.nodes, nodes);
}

// The first and the last body that a wrench acts on: those of a contact.
std::pair<int, int> ends_of(const std::vector<Wrench>& wrenches) {
  std::pair<int, int> ends{-1, -1};
  for (std::size_t i = 0; i < wrenches.size(); ++i) {
    if (wrenches[i].force == Complex(0.0) && wrenches[i].torque == 0.0) continue;
    if (ends.first < 0) ends.first = static_cast<int>(i);
    ends.second = static_cast<int>(i);
  }
  return ends;
}

bool same(const std::vector<Wrench>& u, const std::vector<Wrench>& v) {
  return std::equal(u.begin(), u.end(), v.begin(), v.end(),
                    [](const Wrench& a, const Wrench& b) { return a.force == b.force && a.torque == b.torque; });
}

}  // namespace

std::vector<Discretisation> given_nodes(const Suspension& bodies, const StepperOptions& options) {
  std::vector<Discretisation> nodes = options.refine == Refine::near
                                          ? refined_nodes(bodies, options.points_per_body, near_tolerance)
                                          : equal_nodes(bodies, options.points_per_body);
  if (bodies.container) nodes.push_back({bodies.container->points, {}});
  return nodes;
}

Stepper::Stepper(Suspension bodies, const StepperOptions& options)
    : bodies_(std::move(bodies)), options_(options), shapes_(options.near_singular) {}

int Stepper::shape_count() const {
  std::vector<Shape> distinct;
  for (const Body& body : bodies_)
    if (std::find(distinct.begin(), distinct.end(), body.shape) == distinct.end()) distinct.push_back(body.shape);
  return static_cast<int>(distinct.size());
}

BackgroundFlow Stepper::driven(double driving) const {
  return {options_.flow.kind, driving * options_.flow.rate, driving};
}

// Polynomial through the densities of a history, in the path through configurations: with it the flow may turn back,
// and the first step back starts from what was there. Densities live in the body frames, so they are already turned
// with their bodies.
ComplexVector Stepper::extrapolated(const std::vector<StepperMemory::Density>& history,
                                    const std::vector<Discretisation>& nodes) const {
  std::vector<const StepperMemory::Density*> known;
  for (auto d = history.rbegin(); d != history.rend(); ++d) {
    const auto close = [&d](const auto* k) { return std::abs(k->path - d->path) <= 1e-9 * std::abs(d->path); };
    if (std::none_of(known.begin(), known.end(), close)) known.push_back(&*d);
  }
  int count = 0;
  for (const Discretisation& d : nodes) count += d.size();
  ComplexVector guess = ComplexVector::Zero(count);
  for (const auto* d : known) {
    double weight = 1.0;
    for (const auto* other : known)
      if (other != d) weight *= (memory_.path - other->path) / (d->path - other->path);
    guess += weight * moved(*d, nodes);
  }
  return guess;
}

Stepper::Configuration& Stepper::configuration(double driving) {
  if (now_ && now_->driving == driving) return *now_;
  now_.emplace();
  now_->driving = driving;
  std::vector<Wrench> external;
  for (const Body& body : bodies_) external.push_back({body.force, body.torque});
  StokesSolution solution;
  try {
    solution = solve_contact_free(*now_, external);
  } catch (...) {
    now_.reset();  // a configuration without its velocities is none
    throw;
  }
  now_->gmres_iterations = now_->background_iterations = solution.iterations;
  now_->data_norm = solution.data_norm;
  now_->contact_free = {std::move(solution.velocity), std::move(solution.density)};
  return *now_;
}

// Makes the system, too.
StokesSolution Stepper::solve_contact_free(Configuration& now, const std::vector<Wrench>& external) {
  const auto guess = [&](const std::vector<Discretisation>& nodes) {
    return ComplexVector(now.driving * extrapolated(memory_.background, nodes));
  };
  if (options_.accuracy > 0.0) {
    now.resolution = memory_.resolution;
    ResolvedSystem resolved = solve_to_accuracy({bodies_, driven(now.driving), external, guess}, options_.accuracy,
                                                options_.stokes, shapes_, alone_, now.resolution);
    now.nodes = std::move(resolved.nodes);
    now.system = std::move(resolved.system);
    now.estimated_error = resolved.error;
    now.unresolved = static_cast<int>(resolved.unresolved.size());
    now.stokes_solves = resolved.solves;
    return std::move(resolved.solution);
  }
  now.nodes = given_nodes(bodies_, options_);
  now.shortfalls = shortfalls(bodies_, now.nodes, alone_);
  now.unresolved = static_cast<int>(now.shortfalls.size());
  now.system = std::make_unique<StokesSystem>(bodies_, now.nodes, shapes_, options_.stokes);
  now.stokes_solves = 1;
  if (options_.coupling == Coupling::local && memory_.total.value.size() > 0)
    return now.system->sweep(driven(now.driving), external, moved(memory_.total, now.nodes));
  return now.system->solve(driven(now.driving), external, guess(now.nodes));
}

void Stepper::restore(const std::vector<Pose>& poses, StepperMemory memory) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) bodies_[i].pose = poses[i];
  memory_ = std::move(memory);
  turn_walls(0.0);
  now_.reset();
}

Response Stepper::respond(Configuration& now, const std::vector<Wrench>& wrenches, const ComplexVector& guess,
                          double scale) {
  for (const auto& [known, response] : now.answers)
    if (same(known, wrenches)) return response;
  StokesSolution solution = now.system->solve({}, wrenches, guess, scale);
  now.gmres_iterations += solution.iterations;
  ++now.stokes_solves;
  now.answers.push_back({wrenches, {std::move(solution.velocity), std::move(solution.density)}});
  return now.answers.back().second;
}

// A contact's force changes little from one iterate to the next, more from step to step.
Response Stepper::respond_to_contact(Configuration& now, const std::vector<Wrench>& wrenches) {
  const auto ends = ends_of(wrenches);
  const auto same_ends = [&ends](const auto& answer) { return ends_of(answer.first) == ends; };
  if (const auto latest = std::find_if(now.answers.rbegin(), now.answers.rend(), same_ends); latest != now.answers.rend())
    return respond(now, wrenches, latest->second.density);
  const auto past = memory_.contacts.find(ends);
  return respond(now, wrenches, past == memory_.contacts.end() ? ComplexVector() : extrapolated(past->second, now.nodes));
}

Response Stepper::respond_nearby(const Configuration& now, const std::vector<Wrench>& wrenches) const {
  StokesSolution solution = now.system->solve_nearby(wrenches, column_tolerance);
  return {std::move(solution.velocity), std::move(solution.density)};
}

// No body feels the forces on another; the densities answer a rigid motion with nothing.
Response Stepper::respond_alone(const Configuration& now, const std::vector<Wrench>& wrenches) const {
  Response response{{}, ComplexVector::Zero(now.system->node_count())};
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    response.velocity.push_back(completion_trace(bodies_[i].shape, bodies_[i].pose, wrenches[i]));
  return response;
}

ContactMobility Stepper::contact_mobility(Configuration& now, LcpMatrix matrix, Learnt learnt) {
  const ResponseFunction full = [this, &now](const auto& w, const auto& guess) {
    return respond(now, w, guess, now.data_norm);
  };
  const MobilityFunction column = [this, &now](const auto& w) { return respond_to_contact(now, w); };
  const MobilityFunction nearby = [this, &now](const auto& w) { return respond_nearby(now, w); };
  const MobilityFunction alone = [this, &now](const auto& w) { return respond_alone(now, w); };
  if (options_.coupling == Coupling::local) return {alone, {}, {}};
  if (matrix == LcpMatrix::full) return {column, {}, {}};
  if (matrix == LcpMatrix::self) return {alone, full, {}};
  if (options_.contact == ContactModel::stiv) return {nearby, full};  // whose forces are others at every iterate
  if (learnt == Learnt::not_used) return {nearby, full, true};
  ContactMobility mobility{nearby, full, true, memory_.known};
  for (const StepperMemory::Density& answer : memory_.answers) mobility.answers.push_back(moved(answer, now.nodes));
  return mobility;
}

NcpResult Stepper::resolve(Configuration& now, double dt, const NcpOptions& ncp, LcpMatrix matrix, Learnt learnt) {
  const ContactMobility mobility = contact_mobility(now, matrix, learnt);
  const auto solve = [&](const ConstraintFunction& constraints, const BalanceFunction& balance) {
    NcpOptions options = ncp;
    if (options_.contact == ContactModel::stiv) options.increments_after = stiv_increments_after;
    options.check_mobility = options_.contact == ContactModel::gap && options_.coupling == Coupling::global;
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

// A failure may be due to what was learnt in other configurations or to columns of nearby bodies: columns anew come
// first, whole ones last.
NcpResult Stepper::resolve_nearby(double dt, double driving, const NcpOptions& ncp) {
  NcpOptions at_first = ncp;
  at_first.max_iterations = std::min(ncp.max_iterations, nearby_iterations);
  Configuration& now = configuration(driving);
  NcpResult result = resolve(now, dt, at_first, LcpMatrix::near);
  if (!result.solved && !memory_.known.contacts.empty()) {
    now.ncp_iterations += result.iterations;
    result = resolve(now, dt, at_first, LcpMatrix::near, Learnt::not_used);
  }
  if (result.solved) return result;
  now.ncp_iterations += result.iterations;
  return resolve(now, dt, ncp, LcpMatrix::full);
}

StepOutcome Stepper::attempt(double dt, double driving, const NcpOptions& ncp) {
  NcpResult result = options_.lcp_matrix == LcpMatrix::near
                         ? resolve_nearby(dt, driving, ncp)
                         : resolve(configuration(driving), dt, ncp, options_.lcp_matrix);
  Configuration& now = *now_;
  now.ncp_iterations += result.iterations;

  StepOutcome outcome;
  outcome.accepted = result.solved;
  outcome.failure = result.failure;
  outcome.dt = dt;
  outcome.driving = driving;
  outcome.gmres_iterations = now.gmres_iterations;
  outcome.background_iterations = now.background_iterations;
  outcome.ncp_iterations = now.ncp_iterations;
  outcome.stokes_solves = now.stokes_solves;
  if (result.solved) accept(now, dt, result, outcome);
  return outcome;
}

void Stepper::remember(Configuration& now, ComplexVector total, KnownContacts known) {
  const auto append = [&](std::vector<StepperMemory::Density>& history, ComplexVector density) {
    history.push_back({memory_.path, now.nodes, std::move(density)});
    if (history.size() > extrapolation_points) history.erase(history.begin());
  };
  append(memory_.background, now.driving * now.contact_free.density);
  std::map<std::pair<int, int>, std::vector<StepperMemory::Density>> contacts;
  if (options_.lcp_matrix == LcpMatrix::full)
    for (auto& [wrenches, response] : now.answers) {
      auto& history = contacts[ends_of(wrenches)];
      if (const auto past = memory_.contacts.find(ends_of(wrenches)); past != memory_.contacts.end() && history.empty())
        history = std::move(past->second);
      append(history, std::move(response.density));
    }
  memory_.contacts = std::move(contacts);
  if (options_.lcp_matrix == LcpMatrix::near && options_.contact == ContactModel::gap && !known.contacts.empty()) {
    if (known.multipliers.cols() == 1) memory_.answers.clear();
    append(memory_.answers, total - now.contact_free.density);
    memory_.known = std::move(known);
    memory_.known.multipliers = memory_.known.multipliers.rightCols(static_cast<Eigen::Index>(memory_.answers.size())).eval();
  } else {
    memory_.known = {};
    memory_.answers.clear();
  }
  memory_.total = {memory_.path, now.nodes, std::move(total)};
  memory_.resolution = now.resolution;
}

// `way`: driving times the length of the step just made.
void Stepper::turn_walls(double way) {
  memory_.path += way;
  for (Body& body : bodies_)
    if (body.fixed) body.pose.angle += body.surface.angular_velocity * way;
  if (bodies_.container) bodies_.container->angle = bodies_.container->surface.angular_velocity * memory_.path;
}

void Stepper::accept(Configuration& now, double dt, NcpResult& result, StepOutcome& outcome) {
  outcome.contacts = std::move(result.contacts);
  outcome.contact_wrench = std::move(result.wrenches);
  outcome.container_contact = result.container_wrench;
  outcome.reaction = now.system->reactions(result.motion.density);
  std::vector<Wrench> wrenches = outcome.contact_wrench;
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    wrenches[i].force += bodies_[i].force, wrenches[i].torque += bodies_[i].torque;
  outcome.container = now.system->container_wrench(result.motion.density, wrenches);
  outcome.stresslets = now.system->stresslets(result.motion.density, wrenches);
  outcome.density_tail = now.system->density_tail(result.motion.density);
  outcome.estimated_error = now.estimated_error;
  outcome.unresolved = now.unresolved;
  outcome.shortfalls = now.shortfalls;
  for (const Discretisation& d : now.nodes) {
    outcome.nodes += d.size();
    outcome.clusters += static_cast<int>(d.clusters.size());
    outcome.most_nodes = std::max(outcome.most_nodes, d.size());
  }
  outcome.velocity = std::move(result.motion.velocity);
  for (std::size_t i = 0; i < bodies_.size(); ++i) bodies_[i].pose = result.poses[i];
  outcome.density = result.motion.density;
  remember(now, std::move(result.motion.density), std::move(result.known));
  outcome.system = std::move(now.system);
  turn_walls(now.driving * dt);
  now_.reset();
}

double Stepper::geometric_step_limit(double driving) {
  const std::vector<RigidVelocity>& u = configuration(driving).contact_free.velocity;
  double limit = std::numeric_limits<double>::infinity(), width = 0.0;
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (u[i].omega != 0.0) limit = std::min(limit, 0.2 / std::abs(u[i].omega));
    poses.push_back(bodies_[i].pose);
    if (!bodies_[i].fixed) width = std::max(width, bodies_[i].shape.inradius());
  }
  for (const auto& [i, j] : contact_candidates(bodies_, poses, width)) {
    Complex approach = u[i].velocity;
    double smaller = bodies_[i].shape.inradius();
    if (j != container_index) {
      approach -= u[j].velocity;
      smaller = std::min(smaller, bodies_[j].shape.inradius());
    }
    if (approach != 0.0) limit = std::min(limit, smaller / std::abs(approach));
  }
  return limit;
}

}  // namespace stokes
