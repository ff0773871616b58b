// Contacts with fixed bodies and with the container, and the complementarity problem of a step with them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "cluster.hpp"
#include "container_gap.hpp"
#include "neighbours.hpp"
#include "ncp.hpp"
#include "random_suspension.hpp"
#include "stiv.hpp"

using namespace stokes;

namespace {

using Pairs = std::vector<std::pair<int, int>>;

Body mobile(double a, double b, Complex centre, double angle = 0.0) { return {{a, b}, {centre, angle}}; }
Body fixed(double a, double b, Complex centre, double angle = 0.0) {
  Body result = mobile(a, b, centre, angle);
  result.fixed = true;
  return result;
}
Suspension in_container(Suspension bodies, Container container) {
  bodies.container = container;
  return bodies;
}

std::vector<Pose> poses_of(const Suspension& bodies) {
  std::vector<Pose> poses;
  for (const Body& b : bodies) poses.push_back(b.pose);
  return poses;
}
Suspension at(Suspension bodies, const std::vector<Pose>& poses) {
  for (std::size_t i = 0; i < bodies.size(); ++i) bodies[i].pose = poses[i];
  return bodies;
}

Pairs pairs_of(const std::vector<ContactConstraint>& contacts) {
  Pairs pairs;
  for (const ContactConstraint& c : contacts) pairs.push_back({c.a, c.b});
  return pairs;
}

// Every mobile body by itself, as in a very viscous bed: velocity = force, omega = torque / 2. Counts the problems
// in which a fixed body is given a force.
struct Bed {
  const Suspension& bodies;
  int problems = 0, forces_on_fixed = 0;

  Response operator()(const std::vector<Wrench>& wrenches) {
    ++problems;
    Response response;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const Wrench& w = wrenches[i];
      forces_on_fixed += bodies[i].fixed && (w.force != Complex{} || w.torque != 0.0);
      response.velocity.push_back(bodies[i].fixed ? RigidVelocity{}
                                                  : RigidVelocity{w.force, 0.5 * w.torque});
    }
    response.density.setZero(1);
    return response;
  }
};

struct Problem {
  Suspension start;
  std::vector<RigidVelocity> velocity;
  double dt, separation;
  NcpOptions options{};
  ContactModel contact = ContactModel::gap;
};

NcpResult resolve(const Problem& p) {
  Bed bed{p.start};
  const Response free{p.velocity, ComplexVector::Zero(1)};
  const auto solve = [&](const ConstraintFunction& constraints, const BalanceFunction& balance) {
    return resolve_contacts(p.start, free, p.dt, constraints, superposed([&](const auto& w) { return bed(w); }), p.options,
                            balance);
  };
  NcpResult result;
  if (p.contact == ContactModel::stiv) {
    const StivCollector collector(p.start, p.separation, {128});
    result = solve([&](const auto& trial, const Pairs&) { return collector.collect(trial); }, balance_clusters);
  } else {
    const GapCollector collector(p.start, p.separation);
    result = solve([&](const auto& trial, const Pairs& tracked) { return collector.collect(trial, tracked); }, {});
  }
  CHECK(bed.forces_on_fixed == 0);
  return result;
}

Suspension random_drop(std::mt19937_64& generator, double separation) {
  Suspension bodies = {fixed(1.0, 1.0, 0.0), fixed(0.6, 0.2, {0.0, 2.2}, 0.5)};
  bodies.container = Container{0.0, 4.0};
  while (bodies.size() < 14) {
    const double a = 0.3 + 0.3 * uniform(generator), b = 0.2 + 0.2 * uniform(generator);
    const Complex centre{8.0 * uniform(generator) - 4.0, 8.0 * uniform(generator) - 4.0};
    const Body next = mobile(a, b, centre, 7.0 * uniform(generator));
    bool apart = gap(next, *bodies.container).value > separation;
    for (const Body& other : bodies) apart = apart && gap(other, next).value > separation;
    if (apart) bodies.push_back(next);
  }
  return bodies;
}

}  // namespace

TEST_CASE("obstacles: contacts with fixed bodies and the container are found, those between obstacles are not") {
  // 0 and 1 overlap, 1 is across the wall.
  const Suspension start = in_container({fixed(1, 1, 0.0), fixed(1, 1, 1.5), mobile(0.5, 0.5, {0.0, 2.0}),
                                         mobile(0.5, 0.5, {-1.0, -1.0})}, {0.0, 3.0});
  const GapCollector collector(start, 0.1);
  std::vector<Pose> trial = poses_of(start);
  CHECK(pairs_of(collector.collect(trial, {})) == Pairs{{0, 3}});
  CHECK(pairs_of(collector.collect(trial, {{2, container_index}})) == Pairs{{0, 3}, {2, container_index}});
  trial[2].centre = {0.0, 2.45};
  trial[3].centre = {-2.0, -2.0};
  const auto contacts = collector.collect(trial, {{0, 3}});
  REQUIRE(pairs_of(contacts) == Pairs{{0, 3}, {2, container_index}, {3, container_index}});
  CHECK(std::abs(contacts[1].value + 0.05) < 1e-15);
  CHECK(contacts[1].gradient.centre_a == Complex(0.0, -1.0));
  CHECK(contacts[1].force.centre_b == Complex(0.0, 1.0));
  CHECK(contacts[1].force.angle_b == 0.0);
  trial[2].centre = {0.0, 2.4 + 0.9e-5};  // within the tolerance
  CHECK(pairs_of(collector.collect(trial, {})) == Pairs{{3, container_index}});
}

TEST_CASE("obstacles: a constraint of the container has the exact gradient and a balanced force that parts") {
  std::mt19937_64 generator(2);
  const auto between = [&](double low, double high) { return low + (high - low) * uniform(generator); };
  int violated = 0, turned = 0;
  for (int trial_number = 0; trial_number < 300; ++trial_number) {
    const double a = between(0.3, 0.6), b = between(0.2, 0.6);
    const Container container{{1.0, 2.0}, 4.0};
    const auto somewhere = [&] {
      const double distance = between(3.0, 4.2);
      return Pose{container.centre + std::polar(distance, between(0.0, 7.0)), between(0.0, 7.0)};
    };
    const Suspension start = in_container({mobile(a, b, somewhere().centre, 1.0)}, container);
    // Half of the steps stay nearby, the others cross the container.
    std::vector<Pose> trial{somewhere()};
    if (trial_number % 2) trial[0].centre = start[0].pose.centre + std::polar(0.3, between(0.0, 7.0));
    const GapCollector collector(start, 0.05);
    const auto value_at = [&](Complex move, double turn) {
      return collector.collect({{trial[0].centre + move, trial[0].angle + turn}}, {{0, container_index}}).at(0).value;
    };
    const ContactConstraint c = collector.collect(trial, {{0, container_index}}).at(0);
    const double step = 1e-6;
    CHECK(std::abs((value_at(step, 0) - value_at(-step, 0)) / (2 * step) - c.gradient.centre_a.real()) < 1e-8);
    CHECK(std::abs((value_at(step * imaginary_unit, 0) - value_at(-step * imaginary_unit, 0)) / (2 * step) -
                   c.gradient.centre_a.imag()) < 1e-8);
    CHECK(std::abs((value_at(0, step) - value_at(0, -step)) / (2 * step) - c.gradient.angle_a) < 1e-8);
    CHECK(c.force.centre_b == -c.force.centre_a);
    CHECK(dot(c.force.centre_a, c.gradient.centre_a) > 0.5);
    CHECK(std::abs(cross(start[0].pose.centre - container.centre, c.force.centre_a) + c.force.angle_a +
                   c.force.angle_b) < 1e-14);
    violated += c.value < 0.0;
    const GapGradient before = gradient(gap(start[0], container), start[0].pose);
    turned += before.centre_a != c.force.centre_a;
  }
  CHECK(violated > 50);
  CHECK(turned > 50);
}

TEST_CASE("obstacles: a disc that is driven against an obstacle stops at the separation, and it bears the force") {
  for (const bool first : {true, false}) {
    Suspension start = {mobile(1, 1, 3.0), fixed(1, 1, 0.0)};
    std::vector<RigidVelocity> velocity = {{-2.0, 0.3}, {}};
    if (first) std::swap(start[0], start[1]), std::swap(velocity[0], velocity[1]);
    const int free = first ? 1 : 0, held = 1 - free;
    const NcpResult result = resolve({start, velocity, 1.0, 0.5});
    REQUIRE(result.solved);
    CHECK(result.iterations == 1);
    CHECK(std::abs(result.poses[free].centre - 2.5) < 1e-14);
    CHECK(result.poses[free].angle == 0.3);
    CHECK(result.poses[held].centre == 0.0);
    CHECK(std::abs(result.contacts.at(0).multiplier - 1.5) < 1e-14);
    CHECK(std::abs(result.wrenches[free].force - 1.5) < 1e-14);
    CHECK(result.wrenches[held].force == -result.wrenches[free].force);
    CHECK(result.motion.velocity[held].velocity == 0.0);
    CHECK(result.container_wrench.force == 0.0);
  }
}

TEST_CASE("obstacles: a disc that is driven against the wall stops there, wherever it comes from") {
  // Radii 3 and 0.5, separation 0.1: centres up to 2.4 from that of the container.
  for (const Complex centre : {Complex(2.3, 0.0), Complex(0.0, 0.0), Complex(1e-3, 0.3), Complex(-2.0, 0.0)}) {
    const Container container{{1.0, 1.0}, 3.0};
    const Suspension start = in_container({mobile(0.5, 0.5, container.centre + centre)}, container);
    const NcpResult result = resolve({start, {{10.0, 0.0}}, 1.0, 0.1});
    CAPTURE(result.failure);
    REQUIRE(result.solved);
    const Complex end = result.poses[0].centre - container.centre;
    CHECK(std::abs(std::abs(end) - 2.4) < 1e-5);
    CHECK(end.real() > 2.2);
    REQUIRE(result.contacts.size() == 1);
    CHECK(result.contacts[0].constraint.b == container_index);
    CHECK(result.container_wrench.force == -result.wrenches[0].force);
    CHECK(std::abs(result.container_wrench.torque + cross(centre, result.wrenches[0].force) +
                   result.wrenches[0].torque) < 1e-13);
    CHECK(std::abs(end - (centre + 10.0 + result.wrenches[0].force)) < 1e-13);
  }
}

TEST_CASE("obstacles: a disc between an inner wall and the container keeps from either and slides along it") {
  // Centres 5.45 to 5.55 from the common centre, 5.5 at the start.
  const Suspension start = in_container({fixed(5, 5, 0.0), mobile(0.4, 0.4, {0.0, 5.5})}, {0.0, 6.0});
  for (const double radial : {0.3, -0.3}) {
    const NcpResult result = resolve({start, {{}, {{0.1, radial}, 0.0}}, 1.0, 0.05});
    REQUIRE(result.solved);
    CHECK(std::abs(std::abs(result.poses[1].centre) - (radial > 0.0 ? 5.55 : 5.45)) < 1e-5);
    CHECK(std::abs(result.poses[1].centre.real() - 0.1) < 1e-14);
    CHECK((result.wrenches[0].force == 0.0) == (radial > 0.0));
    CHECK((result.container_wrench.force == 0.0) == (radial < 0.0));
    CHECK(result.wrenches[0].force + result.container_wrench.force == -result.wrenches[1].force);
  }
  CHECK(resolve({start, {{}, {{0.1, 0.0}, 0.0}}, 1.0, 0.05}).iterations == 0);
}

TEST_CASE("obstacles: several contacts at once with an obstacle, an inner wall and the container") {
  // A row of three discs from the inner wall to the container, with 0.2 of play, and a fourth pushed at an obstacle.
  const Suspension start = in_container({fixed(5, 5, 0.0), mobile(0.5, 0.5, 5.6), mobile(0.5, 0.5, 6.7),
                                         mobile(0.5, 0.5, 7.8), fixed(0.5, 0.3, {0.0, 7.0}),
                                         mobile(0.4, 0.4, {0.0, 7.9})}, {0.0, 8.4});
  std::vector<RigidVelocity> velocity(6);
  velocity[1].velocity = 1.0, velocity[5].velocity = {0.0, -0.5};
  const NcpResult out = resolve({start, velocity, 1.0, 0.05});
  REQUIRE(out.solved);
  CHECK(std::abs(out.poses[3].centre - 7.85) < 1e-5);
  CHECK(std::abs(out.poses[2].centre - 6.80) < 1e-5);
  CHECK(std::abs(out.poses[1].centre - 5.75) < 1e-5);
  CHECK(std::abs(out.poses[5].centre - Complex(0.0, 7.75)) < 1e-5);
  CHECK(std::abs(out.container_wrench.force - 0.7) < 1e-4);  // 0.85 - 0.10 - 0.05
  CHECK(std::abs(out.wrenches[4].force - Complex(0.0, -0.35)) < 1e-4);
  CHECK(out.wrenches[0].force == 0.0);
  Complex sum = out.container_wrench.force;
  for (const Wrench& w : out.wrenches) sum += w.force;
  CHECK(std::abs(sum) < 1e-14);

  velocity[1].velocity = 0.0, velocity[3].velocity = -1.0;
  const NcpResult in = resolve({start, velocity, 1.0, 0.05});
  REQUIRE(in.solved);
  CHECK(std::abs(in.poses[1].centre - 5.55) < 1e-5);
  CHECK(std::abs(in.poses[3].centre - 7.65) < 1e-5);
  CHECK(std::abs(in.wrenches[0].force + 0.7) < 1e-4);  // 0.85 - 0.10 - 0.05
  CHECK(in.container_wrench.force == 0.0);
}

TEST_CASE("obstacles: crowds stirred in a container end separated, complementary and in balance with their walls") {
  for (const ContactModel contact : {ContactModel::gap, ContactModel::stiv}) {
    std::mt19937_64 generator(5);
    int with_container = 0, with_fixed = 0;
    for (int trial_number = 0; trial_number < 40; ++trial_number) {
      const double separation = 0.04, dt = 0.1;
      const Suspension start = random_drop(generator, separation);
      std::vector<RigidVelocity> velocity;
      for (const Body& b : start) {
        const double swirl = 2.0 * uniform(generator) - 1.0, radial = 4.0 * uniform(generator) - 2.0;
        const Complex factor = b.fixed ? Complex() : Complex(radial, swirl);
        velocity.push_back({factor * b.pose.centre, factor.imag()});
      }
      NcpOptions options;
      if (contact == ContactModel::stiv) options.increments_after = 8;
      const NcpResult result = resolve({start, velocity, dt, separation, options, contact});
      CAPTURE(result.failure);
      REQUIRE(result.solved);
      const Suspension end = at(start, result.poses);
      // Polygons are inside their curves by up to 0.3 % of the size.
      CHECK(smallest_gap(end).gap >= separation * (contact == ContactModel::gap ? 1.0 - 1e-4 : 0.8));
      std::vector<Wrench> wrenches(start.size());
      for (const ActiveContact& c : result.contacts) {
        CHECK(c.multiplier > 0.0);
        const int a = c.constraint.a, b = c.constraint.b;
        const bool mobile_b = b != container_index && !start[b].fixed;
        CHECK((mobile_b || !start[a].fixed));
        with_container += b == container_index;
        with_fixed += start[a].fixed;
      }
      Complex force = result.container_wrench.force;
      double torque = result.container_wrench.torque, size = 0.0;
      for (std::size_t i = 0; i < start.size(); ++i) {
        const Wrench& w = result.wrenches[i];
        force += w.force, torque += w.torque + cross(start[i].pose.centre, w.force), size += std::abs(w.force);
        const Complex response = result.motion.velocity[i].velocity - velocity[i].velocity;
        CHECK(std::abs(response - (start[i].fixed ? Complex() : w.force)) < 1e-12 * (1.0 + size));
        if (!start[i].fixed) continue;
        CHECK(end[i].pose.centre == start[i].pose.centre);
        CHECK(end[i].pose.angle == start[i].pose.angle);
      }
      CHECK(std::abs(force) <= 1e-12 * size);
      if (contact == ContactModel::gap) CHECK(std::abs(torque) <= 1e-12 * size);
    }
    CHECK(with_container > 20);
    CHECK(with_fixed > 10);
  }
}

TEST_CASE("obstacles: a body that is jammed between obstacles fails clearly, in few iterations") {
  // A disc of diameter 2 in a gap of 1.9, then one that would just fit but for the separation, then one between an
  // obstacle and the container, then one held by three.
  const Suspension tight = {fixed(1, 1, -1.95), mobile(1, 1, 0.02), fixed(1, 1, 1.95)};
  const Suspension no_margin = {fixed(1, 1, -2.05), mobile(1, 1, 0.0), fixed(1, 1, 2.05)};
  const Suspension annulus = in_container({fixed(1, 1, 0.0), mobile(1, 1, {0.0, 2.05})}, {0.0, 3.1});
  const Suspension three = {mobile(1, 1, 0.01), fixed(1, 1, 2.0), fixed(1, 1, std::polar(2.0, 2.1)),
                            fixed(1, 1, std::polar(2.0, -2.1))};
  // Slightly off the line, the way out is so narrow a wedge that only extremely large forces would find it.
  int wedges = 0;
  for (const Suspension* shape : {&tight, &no_margin, &annulus, &three}) {
    for (const double aside : {0.0, 1e-12, 1e-8, 1e-5}) {
      Suspension start = *shape;
      const bool first = !start[0].fixed;
      start[first ? 0 : 1].pose.centre += start.container ? Complex(aside) : Complex(0.0, aside);
      const NcpResult result = resolve({start, std::vector<RigidVelocity>(start.size()), 1.0, 0.1});
      CHECK_FALSE(result.solved);
      CHECK(result.iterations <= 3);
      CAPTURE(result.failure);
      CHECK(result.failure.find("jammed") != std::string::npos);
      wedges += result.failure.find("times those that part a pair") != std::string::npos;
    }
    const NcpOptions increments{50, false, 8};
    const Problem polygons{*shape, std::vector<RigidVelocity>(shape->size()), 1.0, 0.1, increments, ContactModel::stiv};
    const NcpResult result = resolve(polygons);
    CHECK_FALSE(result.solved);
    CAPTURE(result.failure);
    CHECK(result.failure.find("jammed") != std::string::npos);
  }
  CHECK(wedges > 0);
}

TEST_CASE("obstacles: a body squeezed out of a wedge between two obstacles finds its way") {
  const Suspension start = {fixed(1, 1, {-1.9, 0.0}), mobile(1, 1, {0.0, 0.8}), fixed(1, 1, {1.9, 0.0})};
  const NcpResult result = resolve({start, {{}, {{0.0, -0.3}, 0.0}, {}}, 1.0, 0.1});
  REQUIRE(result.solved);
  CHECK(std::abs(result.poses[1].centre - Complex(0.0, std::sqrt(2.1 * 2.1 - 1.9 * 1.9))) < 2e-4);
  CHECK(std::abs(result.wrenches[0].force + std::conj(result.wrenches[2].force)) < 1e-4);
}
