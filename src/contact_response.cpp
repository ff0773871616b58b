#include "contact_response.hpp"

#include "contact_wrenches.hpp"

namespace stokes {

double ContactStep::rate(const ContactConstraint& c, const GapGradient& gradient,
                         const std::vector<RigidVelocity>& velocity) const {
  return rate_of(start, c, gradient, velocity);
}

ContactResponse::ContactResponse(const ContactStep& step, MobilityFunction column)
    : step_(step), fixed_(fixed_bodies(step.start)), column_(std::move(column)) {}

Vector ContactResponse::values_without_forces(Candidates& candidates) {
  Vector b(static_cast<Eigen::Index>(candidates.size()));
  for (std::size_t l = 0; l < candidates.size(); ++l) {
    const ContactConstraint& c = candidates[l].constraint;
    double value = c.value;
    for (const Candidate& k : candidates)
      if (k.multiplier > 0.0) value -= step_.dt * k.multiplier * step_.rate(c, c.gradient, k.column.velocity);
    b[static_cast<Eigen::Index>(l)] = value;
  }
  for (Candidate& c : candidates)
    if (c.column.velocity.empty() || c.force != c.constraint.force) find_column(c);
  return b;
}

namespace {

Matrix rates_by_columns(const ContactStep& step, const Candidates& candidates, auto gradient_of) {
  const auto m = static_cast<Eigen::Index>(candidates.size());
  Matrix rates(m, m);
  for (Eigen::Index l = 0; l < m; ++l)
    for (Eigen::Index k = 0; k < m; ++k)
      rates(l, k) = step.rate(candidates[l].constraint, gradient_of(candidates[l]), candidates[k].column.velocity);
  return rates;
}

}  // namespace

Matrix ContactResponse::rates(const Candidates& candidates) const {
  return rates_by_columns(step_, candidates, [](const Candidate& c) { return c.constraint.gradient; });
}

Matrix ContactResponse::rates_along_forces(const Candidates& candidates) const {
  return rates_by_columns(step_, candidates, [](const Candidate& c) { return c.force; });
}

void ContactResponse::find_column(Candidate& c) const {
  c.force = c.constraint.force;
  ContactWrenches unit{std::vector<Wrench>(step_.start.size()), {}};
  unit.add(c.constraint, c.force, 1.0);
  c.column = column_(unit.on_all_but(fixed_));
}

void add(std::vector<RigidVelocity>& a, double factor, const std::vector<RigidVelocity>& b) {
  for (std::size_t i = 0; i < b.size(); ++i) {
    a[i].velocity += factor * b[i].velocity;
    a[i].omega += factor * b[i].omega;
  }
}

void add(Response& a, double factor, const Response& b) {
  add(a.velocity, factor, b.velocity);
  a.density += factor * b.density;
}

}  // namespace stokes
