#include "adams_bashforth.hpp"

namespace stokes {

namespace {

RigidVelocity combined(double a, const RigidVelocity& u, double b, const RigidVelocity& v) {
  return {a * u.velocity + b * v.velocity, a * u.omega + b * v.omega};
}

}  // namespace

Trial AdamsBashforth::attempt(StepStart& start, double dt) {
  Trial trial;
  Stage stage{1.0, start.configuration(), {}};
  const std::vector<RigidVelocity>& free = stage.at->contact_free().velocity;
  std::vector<RigidVelocity> ahead(free.size());
  std::vector<Pose> base = poses_of(start.bodies());
  if (before_.dt > 0.0 && start.continues()) {
    const double half_ratio = 0.5 * dt / before_.dt;
    const std::vector<RigidVelocity> by_contact = start.contact_velocity(*stage.at, before_.contacts);
    for (std::size_t i = 0; i < ahead.size(); ++i) {
      const RigidVelocity now = combined(1.0, free[i], 1.0, by_contact[i]);
      const RigidVelocity then = combined(1.0, before_.free[i], 1.0, before_.by_contact[i]);
      ahead[i] = combined(half_ratio, now, -half_ratio, then);
    }
    base = advanced(base, dt, ahead);
  }
  stage.solution = start.solve(*stage.at, base, dt);
  trial.failure = stage.solution.failure;
  if (!stage.solution.solved) return trial;
  trial.poses = stage.solution.poses;
  for (std::size_t i = 0; i < ahead.size(); ++i)
    trial.velocity.push_back(combined(1.0, ahead[i], 1.0, stage.solution.velocity[i]));
  trial.stages.push_back(std::move(stage));
  return trial;
}

void AdamsBashforth::accept(const Trial& trial, double dt) {
  const Stage& stage = trial.stages.front();
  before_ = {dt, stage.at->contact_free().velocity, {}, stage.solution.contacts};
  for (std::size_t i = 0; i < before_.free.size(); ++i)
    before_.by_contact.push_back(combined(1.0, stage.solution.velocity[i], -1.0, before_.free[i]));
}

void AdamsBashforth::save(StateWriter& writer) const {
  writer.line("before", before_.dt, before_.contacts.size());
  writer.line("free", numbers_of(before_.free));
  writer.line("by_contact", numbers_of(before_.by_contact));
  for (const ActiveContact& c : before_.contacts)
    writer.line("contact", c.constraint.a, c.constraint.b, c.constraint.region, c.multiplier);
}

void AdamsBashforth::restore(StateReader& reader) {
  before_ = {};
  reader.begin("before");
  before_.dt = reader.number();
  before_.contacts.resize(reader.integer<std::size_t>());
  before_.free = velocities_of(reader.numbers("free"));
  before_.by_contact = velocities_of(reader.numbers("by_contact"));
  for (ActiveContact& c : before_.contacts) {
    reader.begin("contact");
    c.constraint.a = reader.integer<int>(), c.constraint.b = reader.integer<int>();
    c.constraint.region = reader.integer<int>();
    c.multiplier = reader.number();
  }
}

}  // namespace stokes
