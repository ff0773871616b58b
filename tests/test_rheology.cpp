// Alignment, effective viscosity and bulk stress between cylinders: closed forms, symmetries, contacts.
#include <doctest/doctest.h>

#include <cmath>

#include "container_gap.hpp"
#include "couette_bodies.hpp"
#include "text.hpp"

using namespace stokes;

namespace {

const double annulus_area = pi * (10.0 * 10.0 - 5.0 * 5.0);

// Ellipses 3:1 on a circle around the walls' centre, turned by `angle` from the direction of the radius.
Suspension ellipses_on_circle(int count, double angle) {
  std::vector<Body> bodies;
  for (int k = 0; k < count; ++k) {
    const double phi = 0.3 + 2.0 * pi * k / count;
    bodies.push_back(body_at({0.375, 0.125}, std::polar(7.0 + 0.2 * k, phi), phi + angle));
  }
  return between_cylinders(bodies);
}

// Two discs pressed together, one pressed on each wall, and an ellipse by itself; all contacts at the given separation.
Suspension pressed_bodies(double separation) {
  const Shape ellipse{0.375, 0.125}, disc{0.25, 0.25};
  const Complex up = std::polar(1.0, 2.0), left = std::polar(1.0, 3.5), line = std::polar(1.0, -pi / 4);
  return between_cylinders({body_at(disc, 7.5 - (0.25 + 0.5 * separation) * line, 0.0, 10.0 * line),
                            body_at(disc, 7.5 + (0.25 + 0.5 * separation) * line, 0.0, -10.0 * line),
                            body_at(disc, (9.75 - separation) * up, 0.0, 10.0 * up),
                            body_at(disc, (5.25 + separation) * left, 0.0, -10.0 * left),
                            body_at(ellipse, {0.0, -7.0}, 0.4)});
}

void check_equal(const BodyStress& a, const BodyStress& b, double tolerance) {
  CHECK(std::abs(a.shear - b.shear) < tolerance);
  CHECK(std::abs(a.normal_difference - b.normal_difference) < tolerance);
}

// sym(F (x) d) without its trace, per area, in the frame (r, theta) at a place: independent of complex products.
BodyStress force_dipole(Complex F, Complex d, Complex place) {
  const Complex r = place / std::abs(place), theta = perp(r);
  const double shear = 0.5 * (dot(F, r) * dot(d, theta) + dot(F, theta) * dot(d, r));
  return {shear / annulus_area, (dot(F, theta) * dot(d, theta) - dot(F, r) * dot(d, r)) / annulus_area};
}

}  // namespace

TEST_CASE("Couette flow: torques, velocity and shear rate are those of the solved flow, and the viscosity is 1") {
  Suspension bodies = between_cylinders({});
  bodies.back().surface.angular_velocity = -0.7;
  const CouetteFlow couette = couette_flow(bodies);
  CHECK(couette.inner_radius == 5.0);
  CHECK(couette.outer_radius == 10.0);
  CHECK(couette.A() * 5.0 + couette.B() / 5.0 == doctest::Approx(-0.7 * 5.0).epsilon(1e-14));
  CHECK(couette.velocity(10.0) == doctest::Approx(20.0).epsilon(1e-14));

  ShapeCache shapes;
  const StokesSystem system(bodies, 32, shapes, {1e-13});
  const BackgroundFlow driving{FlowKind::none, 1.0, 1.0};
  const StokesSolution s = system.solve(driving, {});
  CHECK(std::abs(s.reaction[0].torque / couette.inner_torque() - 1.0) < 1e-10);
  std::vector<Complex> points;
  for (const double r : {5.01, 6.0, 7.5, 9.0, 9.99}) points.push_back(std::polar(r, 2.0 * r));
  const std::vector<PointFlow> flow = system.flow(points, s.density, driving, {});
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double r = std::abs(points[k]);
    const Complex along_r = points[k] / r, along_theta = perp(along_r);
    const auto slope = [&](Complex e) { return e.real() * flow[k].velocity_x + e.imag() * flow[k].velocity_y; };
    CHECK(std::abs(dot(flow[k].velocity, along_theta) - couette.velocity(r)) < 1e-9);
    CHECK(std::abs(dot(slope(along_r), along_theta) + dot(slope(along_theta), along_r) - couette.shear_rate(r)) < 1e-8);
  }

  const StepOutcome outcome = one_step(bodies, accurate_steps(32, 0.0));
  CHECK(std::abs(effective_viscosity(bodies, outcome) - 1.0) < 1e-10);
  CHECK(std::abs(effective_viscosity_outer(bodies, outcome) - 1.0) < 1e-10);
  CHECK(std::isnan(order_parameter(bodies)));
  bodies.back().surface.angular_velocity = outer_rotation;
  CHECK(std::isnan(effective_viscosity(bodies, one_step(bodies, accurate_steps(32, 0.0)))));
}

TEST_CASE("the order parameter is 1 along the circles, -1 across, 0 in between, for turned and mirrored suspensions") {
  const auto check = [](const Suspension& bodies, double expected) {
    CHECK(std::abs(order_parameter(bodies) - expected) < 1e-13);
    CHECK(std::abs(order_parameter(turned_about_axis(bodies, 1.234)) - expected) < 1e-13);
    CHECK(std::abs(order_parameter(mirrored(bodies)) - expected) < 1e-13);
  };
  check(ellipses_on_circle(7, pi / 2), 1.0);
  check(ellipses_on_circle(7, -pi / 2), 1.0);
  check(ellipses_on_circle(7, 0.0), -1.0);
  check(ellipses_on_circle(7, 5.0 * pi), -1.0);
  check(ellipses_on_circle(7, pi / 4), 0.0);
  check(ellipses_on_circle(4, 0.2), std::cos(2.0 * (0.2 - pi / 2)));
  // A mean over the free bodies only.
  Suspension mixed = ellipses_on_circle(4, pi / 2);
  mixed[0].pose.angle += pi / 2;
  check(mixed, 0.5);
  mixed[0].fixed = true;
  check(mixed, 1.0);
}

TEST_CASE("a small disc raises the viscosity by its dissipation, and its stresslet is 4 pi a^2 E") {
  const double a = 0.05;
  std::string table = "r   (mu - 1) / dilute - 1   S_rt / (4 pi a^2 E) - 1   (S_tt - S_rr) / (4 pi a^2 E)\n";
  for (const double r : {6.5, 7.5, 8.5}) {
    const Suspension bodies = between_cylinders({body_at({a, a}, std::polar(r, 0.7))});
    StepperOptions options = accurate_steps(32, 0.0);
    options.stokes.gmres_tolerance = 1e-13;
    const StepOutcome outcome = one_step(bodies, options);
    const CouetteFlow couette = couette_flow(bodies);
    const double rate = 2.0 * std::abs(couette.B()) / (r * r), torque = 4.0 * pi * std::abs(couette.B());
    // Power of the outer cylinder: its speed times the torque; of that the disc takes S : E.
    const double dilute = 2.0 * pi * a * a * rate * rate / (outer_rotation * torque);
    const double viscosity = (effective_viscosity(bodies, outcome) - 1.0) / dilute;
    const double strength = 4.0 * pi * a * a * 0.5 * couette.shear_rate(r) / annulus_area;
    const ParticleStress stress = particle_stress(bodies, outcome);
    table += concat(r, "  ", viscosity - 1.0, "  ", stress.stresslets.shear / strength - 1.0, "  ",
                    stress.stresslets.normal_difference / strength, "\n");
    CHECK(strength > 0.0);
    // Of order (a / distance from the wall)^2, a^2 / r^2.
    CHECK(std::abs(viscosity - 1.0) < 0.02);
    CHECK(std::abs(stress.stresslets.shear / strength - 1.0) < 5e-3);
    CHECK(std::abs(stress.stresslets.normal_difference / strength) < 5e-3);
    CHECK(stress.contacts.shear == 0.0);
    CHECK(stress.contacts.normal_difference == 0.0);
  }
  MESSAGE(table);
}

TEST_CASE("the outer cylinder's torque is the one that the stress carries through a circle around the bodies") {
  const Suspension bodies = between_cylinders({body_at({0.375, 0.125}, 7.5, 0.6), body_at({0.375, 0.375}, {0.0, 7.0})});
  ShapeCache shapes;
  const StokesSystem system(bodies, 64, shapes, {1e-12});
  const BackgroundFlow driving{FlowKind::none, 1.0, 1.0};
  const StokesSolution s = system.solve(driving, {});
  const int count = 256;
  const double r = 8.8;
  std::vector<Complex> circle;
  for (int k = 0; k < count; ++k) circle.push_back(std::polar(r, 2.0 * pi * k / count));
  const std::vector<PointFlow> flow = system.flow(circle, s.density, driving, {});
  double torque = 0.0;  // of the fluid outside on that inside
  for (int k = 0; k < count; ++k) {
    const Stress sigma = stress(flow[k]);
    const Complex n = circle[k] / r;
    const Complex traction(sigma.xx * n.real() + sigma.xy * n.imag(), sigma.xy * n.real() + sigma.yy * n.imag());
    torque += cross(circle[k], traction) * 2.0 * pi * r / count;
  }
  CHECK(std::abs(system.container_wrench(s.density, {}).torque / torque - 1.0) < 1e-9);
  CHECK(std::abs(s.reaction.back().torque / -torque - 1.0) < 1e-9);
  CHECK(torque > couette_flow(bodies).inner_torque() * -1.0);
}

TEST_CASE("two discs pressed together bear the force between them, and their contact stress is compressive") {
  const double separation = 0.02, a = 0.25, push = 2.0, apart = 2.0 * a + separation;
  for (const double angle : {0.0, pi / 2, pi / 4, -pi / 4, 1.0}) {  // of the line of centres, from the radius
    const Complex at = std::polar(7.5, 0.9), line = std::polar(1.0, 0.9 + angle);
    const Suspension bodies = between_cylinders({body_at({a, a}, at - 0.5 * apart * line, 0.0, push * line),
                                                 body_at({a, a}, at + 0.5 * apart * line, 0.0, -push * line)});
    const StepOutcome outcome = one_step(bodies, accurate_steps(64, separation), 0.01, 0.0);  // cylinders at rest
    REQUIRE(outcome.accepted);
    REQUIRE(outcome.contacts.size() == 1);
    // The contact balances the forces, except for the motion within its tolerance.
    CHECK(std::abs(outcome.contacts[0].multiplier / push - 1.0) < 1e-2);
    const BodyStress contacts = particle_stress(bodies, outcome).contacts;
    const double size = outcome.contacts[0].multiplier * apart / annulus_area;
    // -size along the line: sigma_tt - sigma_rr = size cos 2 angle, sigma_rt = -size / 2 sin 2 angle.
    check_equal(contacts, {-0.5 * size * std::sin(2.0 * angle), size * std::cos(2.0 * angle)}, 1e-12 * size);
    check_equal(contacts, force_dipole(outcome.contact_wrench[0].force, apart * line, at), 1e-12 * size);
  }
}

TEST_CASE("a body pressed on either wall has the contact stress of its force at the place of contact") {
  const double separation = 0.02;
  for (const bool outer : {true, false})
    for (const Shape shape : {Shape{0.25, 0.25}, Shape{0.375, 0.125}, Shape{0.375, 0.25}}) {
      const Complex radial = std::polar(1.0, 2.2);
      Suspension bodies = between_cylinders({body_at(shape, 7.0 * radial, 2.7, (outer ? 4.0 : -4.0) * radial)});
      const auto contact = [&] { return outer ? gap(bodies[0], *bodies.container) : gap(bodies[0], bodies[1]); };
      for (int k = 0; k < 30; ++k)
        bodies[0].pose.centre += (outer ? 1.0 : -1.0) * (contact().value - separation) * radial;
      REQUIRE(std::abs(contact().value - separation) < 1e-12);
      StepperOptions options = accurate_steps(64, separation);
      options.refine = Refine::near;
      const StepOutcome outcome = one_step(bodies, options, 0.02, 0.0);
      REQUIRE(outcome.accepted);
      REQUIRE(outcome.contacts.size() == 1);
      const Complex force = outcome.contact_wrench[0].force, place = contact().point_b;
      const Complex d = place - bodies[0].pose.centre;
      CHECK(outcome.contacts[0].multiplier > 0.0);
      CHECK(dot(force, radial) * (outer ? -1.0 : 1.0) > 0.0);
      const BodyStress expected = force_dipole(force, d, bodies[0].pose.centre + 0.5 * d);
      const BodyStress found = particle_stress(bodies, outcome).contacts;
      check_equal(found, expected, 1e-11 * std::abs(force));
      // Compressive across the gap: sigma_rr < 0.
      CHECK(found.normal_difference > 0.0);
      if (shape.a == shape.b)
        CHECK(found.normal_difference ==
              doctest::Approx(std::abs(force) * (shape.a + separation) / annulus_area).epsilon(1e-10));
    }
}

TEST_CASE("with contacts, nothing changes when all turns about the axis, and both cylinders feel the same torque") {
  const double separation = 0.02;
  const Suspension bodies = pressed_bodies(separation);
  const StepperOptions options = accurate_steps(64, separation);
  const StepOutcome outcome = one_step(bodies, options);
  REQUIRE(outcome.accepted);
  CHECK(outcome.contacts.size() == 3);
  const double viscosity = effective_viscosity(bodies, outcome);
  CHECK(viscosity > 1.0);
  CHECK(std::abs(effective_viscosity_outer(bodies, outcome) - viscosity) < 1e-8);
  const Suspension turned = turned_about_axis(bodies, 1.1);
  const StepOutcome after = one_step(turned, options);
  REQUIRE(after.accepted);
  CHECK(std::abs(effective_viscosity(turned, after) - viscosity) < 1e-9);
  const ParticleStress a = particle_stress(bodies, outcome), b = particle_stress(turned, after);
  const double scale =
      std::abs(a.contacts.shear) + std::abs(a.contacts.normal_difference) + std::abs(a.stresslets.shear);
  check_equal(a.stresslets, b.stresslets, 1e-7 * scale);
  check_equal(a.contacts, b.contacts, 1e-7 * scale);

  // In the mirror the shear stresses have the other sign.
  const Suspension mirror = mirrored(bodies);
  const StepOutcome seen = one_step(mirror, options);
  REQUIRE(seen.accepted);
  CHECK(std::abs(effective_viscosity(mirror, seen) - viscosity) < 1e-9);
  const ParticleStress m = particle_stress(mirror, seen);
  check_equal({-m.stresslets.shear, m.stresslets.normal_difference}, a.stresslets, 1e-7 * scale);
  check_equal({-m.contacts.shear, m.contacts.normal_difference}, a.contacts, 1e-7 * scale);
}

TEST_CASE("inner and outer viscosity agree with contacts, and flow driven backwards has the same viscosity") {
  const double separation = 0.02;
  std::vector<Body> crowd;
  for (int k = 0; k < 8; ++k)  // along the compression of the flow, and two at the walls
    crowd.push_back(body_at({0.375, 0.125}, Complex(7.5, 0.0) + std::polar(0.27 * (k - 3.5), -pi / 4), pi / 4));
  crowd.push_back(body_at({0.25, 0.25}, {0.0, 9.75 - separation}));
  crowd.push_back(body_at({0.25, 0.25}, {0.0, 5.25 + separation}));
  const Suspension bodies = between_cylinders(crowd);
  StepperOptions options = accurate_steps(64, separation);
  const StepOutcome outcome = one_step(bodies, options, 2e-3), back = one_step(bodies, options, 2e-3, -1.0);
  REQUIRE(outcome.accepted);
  REQUIRE(back.accepted);
  MESSAGE(outcome.contacts.size(), " contacts, viscosity ", effective_viscosity(bodies, outcome), "; ",
          back.contacts.size(), " contacts and ", effective_viscosity(bodies, back), " backwards");
  for (const StepOutcome* o : {&outcome, &back})
    CHECK(std::abs(effective_viscosity(bodies, *o) - effective_viscosity_outer(bodies, *o)) < 1e-8);
  CHECK(outcome.contacts.size() >= 3);
  // Without contacts the velocities, and the torques, only change their sign.
  options.contact = ContactModel::none;
  const double forward = effective_viscosity(bodies, one_step(bodies, options));
  CHECK(std::abs(effective_viscosity(bodies, one_step(bodies, options, 1e-3, -1.0)) - forward) < 1e-9);
  CHECK(std::abs(effective_viscosity(bodies, one_step(bodies, options, 1e-3, 0.5)) - forward) < 1e-9);
  CHECK(effective_viscosity(bodies, outcome) > forward);
}
