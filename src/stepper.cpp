#include "stepper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "neighbours.hpp"

namespace stokes {

namespace {

// A step changes the poses of fixed bodies, which move with their surfaces. Only the container's surface is turned here.
void turn_container(Suspension& bodies, double path) {
  if (bodies.container) bodies.container->angle = bodies.container->surface.angular_velocity * path;
}

void add(Wrench& sum, double weight, const Wrench& other) {
  sum.force += weight * other.force;
  sum.torque += weight * other.torque;
}

// Multipliers add up; the constraint is that of the latest stage.
void add(std::vector<ActiveContact>& sum, double weight, const std::vector<ActiveContact>& contacts) {
  const auto identity = [](const ActiveContact& c) {
    return std::tuple(c.constraint.a, c.constraint.b, c.constraint.region);
  };
  for (const ActiveContact& c : contacts) {
    const auto place =
        std::lower_bound(sum.begin(), sum.end(), c, [&](const auto& u, const auto& v) { return identity(u) < identity(v); });
    if (place == sum.end() || identity(*place) != identity(c))
      sum.insert(place, {c.constraint, weight * c.multiplier});
    else
      *place = {c.constraint, place->multiplier + weight * c.multiplier};
  }
}

// Adds the contribution of a stage to the outcome of a step.
void add_stage(StepOutcome& outcome, const Stage& stage) {
  const ContactSolution& solution = stage.solution;
  const StokesSystem& system = stage.at->system();
  const Suspension& bodies = stage.at->bodies();
  std::vector<Wrench> wrenches = solution.wrenches;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    wrenches[i].force += bodies[i].force, wrenches[i].torque += bodies[i].torque;
  const std::vector<Wrench> reaction = system.reactions(solution.density);
  const std::vector<Complex> stresslets = system.stresslets(solution.density, wrenches);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    add(outcome.contact_wrench[i], stage.weight, solution.wrenches[i]);
    add(outcome.reaction[i], stage.weight, reaction[i]);
    outcome.stresslets[i] += stage.weight * stresslets[i];
  }
  add(outcome.container_contact, stage.weight, solution.container_wrench);
  add(outcome.container, stage.weight, system.container_wrench(solution.density, wrenches));
  add(outcome.contacts, stage.weight, solution.contacts);
  outcome.density_tail = std::max(outcome.density_tail, system.density_tail(solution.density));
  outcome.estimated_error = std::max(outcome.estimated_error, stage.at->estimated_error());
}

// The outcome without any stage. Adding -0 changes no number.
StepOutcome empty_outcome(std::size_t bodies) {
  constexpr Wrench none{{-0.0, -0.0}, -0.0};
  StepOutcome outcome;
  outcome.contact_wrench.assign(bodies, none);
  outcome.reaction.assign(bodies, none);
  outcome.container_contact = outcome.container = none;
  outcome.stresslets.assign(bodies, {-0.0, -0.0});
  return outcome;
}

}  // namespace

// The present configuration and the memory of earlier steps, hidden from the users of a stepper.
class Stepper::State : public StepStart {
 public:
  State(Suspension bodies, const StepperOptions& options)
      : bodies_(std::move(bodies)), fluid_(options), contacts_(options), integrator_(make_integrator(options)) {}

  const Suspension& bodies() const override { return bodies_; }
  const ShapeCache& shapes() const { return fluid_.shapes; }

  std::shared_ptr<Configuration> at_start(double driving) {
    driving_ = driving;
    return configuration();
  }

  std::shared_ptr<Configuration> configuration() override {
    if (!start_ || start_->driving() != driving_) {
      start_.reset();
      start_ = std::make_shared<Configuration>(bodies_, memory_.path, driving_, fluid_, memory_);
    }
    return start_;
  }

  std::shared_ptr<Configuration> configuration(const std::vector<Pose>& poses, double elapsed) override {
    Suspension bodies = at_poses(poses, elapsed);
    if (const ClosestPair closest = smallest_gap(bodies); closest.gap < 0.0)
      throw NumericalError(concat(pair_name(closest.a, closest.b), " overlap by ", brief(-closest.gap), " within the step"));
    return std::make_shared<Configuration>(std::move(bodies), path_after(elapsed), driving_, fluid_, memory_);
  }

  ContactSolution solve(Configuration& at, const std::vector<Pose>& base, double length) override {
    return contacts_.solve(bodies_, at, base, length, ncp_);
  }

  std::vector<RigidVelocity> contact_velocity(Configuration& at, const std::vector<ActiveContact>& contacts) override {
    return contacts_.respond(at, contacts).velocity;
  }

  double path_after(double elapsed) const override { return memory_.path + driving_ * elapsed; }
  bool continues() const override { return continued_driving_ == driving_; }

  double relative_gap(const std::vector<Pose>& poses) const override {
    const Suspension bodies = at_poses(poses, 0.0);
    return smallest_gap(bodies).gap / GapCollector(bodies, fluid_.options.separation).separation();
  }

  StepOutcome attempt(double dt, double driving, const NcpOptions& ncp) {
    driving_ = driving;
    ncp_ = ncp;
    dt_ = dt;
    contacts_.matrix().reject();
    trial_ = integrator_->attempt(*this, dt);
    StepOutcome outcome = empty_outcome(bodies_.size());
    outcome.failure = trial_.failure;
    outcome.accepted = trial_.failure.empty();
    outcome.dt = dt;
    outcome.driving = driving;
    outcome.error = trial_.error;
    outcome.restoring = restoring_ = starts_too_close();
    outcome.gmres_iterations = fluid_.effort.gmres_iterations;
    outcome.ncp_iterations = fluid_.effort.ncp_iterations;
    outcome.stokes_solves = fluid_.effort.stokes_solves;
    if (!outcome.accepted) return outcome;
    const Configuration& first = *trial_.stages.front().at;
    outcome.background_iterations = first.background_iterations();
    for (const Stage& stage : trial_.stages) add_stage(outcome, stage);
    if (trial_.stages[0].at == start_) {
      outcome.at_start = start_;
      outcome.density = trial_.stages[0].solution.density;
    }
    outcome.velocity = trial_.velocity;
    outcome.unresolved = first.unresolved();
    outcome.shortfalls = first.shortfalls();
    for (const Discretisation& d : first.nodes()) {
      outcome.nodes += d.size();
      outcome.clusters += static_cast<int>(d.clusters.size());
      outcome.most_nodes = std::max(outcome.most_nodes, d.size());
    }
    return outcome;
  }

  void accept() {
    integrator_->accept(trial_, dt_);
    std::vector<const Configuration*> configurations;
    for (const Stage& stage : trial_.stages) configurations.push_back(stage.at.get());
    contacts_.matrix().accept(configurations);
    const Configuration& first = *configurations.front();
    memory_.background.append({first.path(), first.nodes(), first.driving() * first.contact_free().density});
    memory_.total = {first.path(), first.nodes(), trial_.stages.front().solution.density};
    memory_.resolution = trial_.stages.back().at->resolution();
    for (std::size_t i = 0; i < bodies_.size(); ++i) bodies_[i].pose = trial_.poses[i];
    memory_.path += driving_ * dt_;
    turn_container(bodies_, memory_.path);
    if (restoring_)
      continued_driving_.reset();
    else
      continued_driving_ = driving_;
    fluid_.effort = {};
    start_.reset();
    trial_ = {};
  }

  void save(StateWriter& writer) const {
    std::vector<double> poses;
    for (const Body& body : bodies_)
      poses.insert(poses.end(), {body.pose.centre.real(), body.pose.centre.imag(), body.pose.angle});
    writer.line("poses", poses);
    memory_.save(writer);
    writer.line("continued_driving", continued_driving_.value_or(0.0));
    contacts_.matrix().save(writer);
    integrator_->save(writer);
  }

  void restore(StateReader& reader) {
    const std::vector<double> poses = reader.numbers("poses");
    if (poses.size() != 3 * bodies_.size()) throw std::runtime_error("it has another number of bodies");
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      bodies_[i].pose = {{poses[3 * i], poses[3 * i + 1]}, poses[3 * i + 2]};
    memory_ = FluidMemory::restored(reader);
    reader.begin("continued_driving");
    continued_driving_.reset();
    if (const double driving = reader.number(); driving != 0.0) continued_driving_ = driving;
    contacts_.matrix().restore(reader);
    integrator_->restore(reader);
    turn_container(bodies_, memory_.path);
    start_.reset();
  }

 private:
  // The bodies at other poses, with the container turned as after this time.
  Suspension at_poses(const std::vector<Pose>& poses, double elapsed) const {
    Suspension bodies = bodies_;
    for (std::size_t i = 0; i < bodies.size(); ++i) bodies[i].pose = poses[i];
    turn_container(bodies, path_after(elapsed));
    return bodies;
  }

  // Not used by forward Euler.
  bool starts_too_close() const {
    const StepperOptions& options = fluid_.options;
    if (options.integrator == IntegratorKind::euler || options.contact != ContactModel::gap) return false;
    const GapCollector collector(bodies_, bodies_, options.separation, options.contact_tolerance);
    const auto violated = collector.collect(poses_of(bodies_), {});
    return std::any_of(violated.begin(), violated.end(),
                       [&](const ContactConstraint& c) { return c.value < -2.0 * collector.tolerance(); });
  }

  Suspension bodies_;
  Fluid fluid_;
  ContactProblem contacts_;
  std::unique_ptr<Integrator> integrator_;
  FluidMemory memory_;
  std::optional<double> continued_driving_;  // of the step before, if the next one may continue it

  // State of the step under way.
  double driving_ = 1.0, dt_ = 0.0;
  bool restoring_ = false;
  NcpOptions ncp_;
  std::shared_ptr<Configuration> start_;
  Trial trial_;
};

Stepper::Stepper(Suspension bodies, const StepperOptions& options)
    : state_(std::make_unique<State>(std::move(bodies), options)) {}
Stepper::~Stepper() = default;

const Suspension& Stepper::bodies() const { return state_->bodies(); }
int Stepper::factorisations() const { return state_->shapes().factorisations(); }

int Stepper::shape_count() const {
  std::vector<Shape> distinct;
  for (const Body& body : bodies())
    if (std::find(distinct.begin(), distinct.end(), body.shape) == distinct.end()) distinct.push_back(body.shape);
  return static_cast<int>(distinct.size());
}

StepOutcome Stepper::attempt(double dt, double driving, const NcpOptions& ncp) { return state_->attempt(dt, driving, ncp); }
void Stepper::accept() { state_->accept(); }

StepOutcome Stepper::step(double dt, double driving, const NcpOptions& ncp) {
  StepOutcome outcome = attempt(dt, driving, ncp);
  if (outcome.accepted) accept();
  return outcome;
}

void Stepper::save(StateWriter& writer) const { state_->save(writer); }
void Stepper::restore(StateReader& reader) { state_->restore(reader); }

double Stepper::geometric_step_limit(double driving) {
  const std::shared_ptr<Configuration> at = state_->at_start(driving);
  const std::vector<RigidVelocity>& u = at->contact_free().velocity;
  const Suspension& all = bodies();
  double limit = std::numeric_limits<double>::infinity(), width = 0.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (u[i].omega != 0.0 && all[i].points == 0) limit = std::min(limit, 0.2 / std::abs(u[i].omega));
    if (!all[i].fixed) width = std::max(width, all[i].shape.inradius());
  }
  for (const auto& [i, j] : contact_candidates(all, poses_of(all), width)) {
    Complex approach = u[i].velocity;
    double smaller = all[i].shape.inradius();
    if (j != container_index) {
      approach -= u[j].velocity;
      smaller = std::min(smaller, all[j].shape.inradius());
    }
    if (approach != 0.0) limit = std::min(limit, smaller / std::abs(approach));
  }
  return limit;
}

}  // namespace stokes
