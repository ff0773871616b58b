#include "rheology.hpp"

#include <cmath>

namespace stokes {

namespace {

double ratio(double u, double v) { return v != 0.0 ? u / v : std::nan(""); }

// A traceless symmetric tensor T, T_11 + i T_12, at a place with the given direction from the walls' centre.
void add(Complex tensor, Complex radial, BodyStress& stress) {
  const Complex turned = tensor * std::conj(radial) * std::conj(radial);
  stress.shear += turned.imag();
  stress.normal_difference -= 2.0 * turned.real();
}

Complex direction(Complex from_centre) {
  const double r = std::abs(from_centre);
  return r > 0.0 ? from_centre / r : Complex(1.0);
}

// From body a's centre to the place of contact on a concentric wall: the force acts along -n through it, with the
// torque angle_a.
Complex to_wall(const GapGradient& force, Complex from_centre, double wall_radius) {
  const Complex n = -force.centre_a;
  const double sign = dot(n, from_centre) > 0.0 ? 1.0 : -1.0;  // of the outer wall
  return (sign * wall_radius - dot(n, from_centre)) * n + force.angle_a * perp(n);
}

}  // namespace

double CouetteFlow::A() const {
  const double r1 = inner_radius * inner_radius, r2 = outer_radius * outer_radius;
  return (outer_angular_velocity * r2 - inner_angular_velocity * r1) / (r2 - r1);
}

double CouetteFlow::B() const {
  const double r1 = inner_radius * inner_radius, r2 = outer_radius * outer_radius;
  return (inner_angular_velocity - outer_angular_velocity) * r1 * r2 / (r2 - r1);
}

CouetteFlow couette_flow(const Suspension& bodies) {
  const Body& inner = bodies.back();
  const Container& outer = *bodies.container;
  return {inner.shape.a, outer.radius, inner.surface.angular_velocity, outer.surface.angular_velocity};
}

double order_parameter(const Suspension& bodies) {
  const Complex centre = bodies.container ? bodies.container->centre : 0.0;
  double sum = 0.0;
  int count = 0;
  for (const Body& body : bodies) {
    if (body.fixed) continue;
    const Complex along = body.pose.axis() * std::conj(direction(body.pose.centre - centre));
    sum -= (along * along).real();  // cos 2 (x - pi/2) = -cos 2 x
    ++count;
  }
  return ratio(sum, count);
}

double effective_viscosity(const Suspension& bodies, const StepOutcome& outcome) {
  return ratio(outcome.reaction.back().torque, outcome.driving * couette_flow(bodies).inner_torque());
}

double effective_viscosity_outer(const Suspension& bodies, const StepOutcome& outcome) {
  return ratio(-outcome.container.torque, outcome.driving * couette_flow(bodies).inner_torque());
}

StressSum stress_sum(const Suspension& bodies, const StepOutcome& outcome) {
  StressSum sum;
  for (const Complex stresslet : outcome.stresslets) sum.stresslets += stresslet;
  for (const ActiveContact& contact : outcome.contacts) {
    const ContactConstraint& c = contact.constraint;
    const Complex apart = bodies[c.b].pose.centre - bodies[c.a].pose.centre;
    sum.contacts += 0.5 * contact.multiplier * c.force.centre_a * apart;  // without trace, as above
  }
  return sum;
}

double Sample::viscosity(const StressSum& sum, double driving) const {
  const Complex strain = driving * strain_rate;
  return ratio(dot(stress(sum, driving), strain), 2.0 * std::norm(strain));
}

ParticleStress particle_stress(const Suspension& bodies, const StepOutcome& outcome) {
  ParticleStress result;
  const Complex centre = bodies.container->centre;
  const double area = pi * (bodies.container->radius * bodies.container->radius -
                            bodies.back().shape.a * bodies.back().shape.a);
  const int inner_wall = static_cast<int>(bodies.size()) - 1;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (!bodies[i].fixed)
      add(outcome.stresslets[i] / area, direction(bodies[i].pose.centre - centre), result.stresslets);
  for (const ActiveContact& contact : outcome.contacts) {
    const ContactConstraint& c = contact.constraint;
    const Complex from_centre = bodies[c.a].pose.centre - centre;
    Complex apart;
    if (c.b == container_index)
      apart = to_wall(c.force, from_centre, bodies.container->radius);
    else if (c.b == inner_wall)
      apart = to_wall(c.force, from_centre, bodies[inner_wall].shape.a);
    else
      apart = bodies[c.b].pose.centre - bodies[c.a].pose.centre;
    // sym(F (x) d) less its trace has the components Re(F d) / 2 and Im(F d) / 2.
    add(0.5 * contact.multiplier * c.force.centre_a * apart / area, direction(from_centre + 0.5 * apart), result.contacts);
  }
  return result;
}

}  // namespace stokes
