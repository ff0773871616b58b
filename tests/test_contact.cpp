// Contact constraints, the collector that finds them, and the complementarity problem of a step.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "neighbours.hpp"
#include "ncp.hpp"
#include "random_suspension.hpp"

using namespace stokes;

namespace {

using Pairs = std::vector<std::pair<int, int>>;

Body body(double a, double b, Complex centre, double angle = 0.0) { return {{a, b}, {centre, angle}, {}, {}}; }

std::vector<Pose> poses_of(const Suspension& bodies) {
  std::vector<Pose> poses;
  for (const Body& b : bodies) poses.push_back(b.pose);
  return poses;
}

Pairs pairs_of(const std::vector<ContactConstraint>& contacts) {
  Pairs pairs;
  for (const ContactConstraint& c : contacts) pairs.push_back({c.a, c.b});
  return pairs;
}

// Every body by itself, as in a very viscous bed: velocity = force, omega = torque / 2. Symmetric positive
// definite, and simple enough that positions after a contact are known in closed form.
struct Bed {
  int columns = 0;
  ContactResponseFactory response = superposed([this](const std::vector<Wrench>& wrenches) {
    ++columns;
    return respond(wrenches);
  });

  static Response respond(const std::vector<Wrench>& wrenches) {
    Response response;
    for (const Wrench& w : wrenches) response.velocity.push_back({w.force, 0.5 * w.torque});
    response.density.setZero(1);
    return response;
  }
};

Response moving(std::vector<RigidVelocity> velocity) { return {std::move(velocity), ComplexVector::Zero(1)}; }

ConstraintFunction constraints_of(const GapCollector& collector) {
  return [&](const std::vector<Pose>& trial, const Pairs& tracked) { return collector.collect(trial, tracked); };
}

NcpResult resolve(const Suspension& start, const std::vector<RigidVelocity>& velocity, double dt,
                  double separation, const NcpOptions& options = {}) {
  Bed bed;
  const GapCollector collector(start, separation);
  return resolve_contacts(start, moving(velocity), dt, constraints_of(collector), bed.response, options);
}

void add(std::vector<Wrench>& wrenches, const ActiveContact& contact) {
  const ContactConstraint& c = contact.constraint;
  wrenches[c.a].force += contact.multiplier * c.force.centre_a;
  wrenches[c.a].torque += contact.multiplier * c.force.angle_a;
  wrenches[c.b].force += contact.multiplier * c.force.centre_b;
  wrenches[c.b].torque += contact.multiplier * c.force.angle_b;
}

Suspension random_ellipses(std::mt19937_64& generator, int count, double side, double least) {
  Suspension bodies;
  while (static_cast<int>(bodies.size()) < count) {
    const double a = 0.3 + 0.5 * uniform(generator), b = 0.2 + 0.3 * uniform(generator);
    const Complex centre{side * uniform(generator), side * uniform(generator)};
    const Body next = body(a, b, centre, 7.0 * uniform(generator));
    if (std::all_of(bodies.begin(), bodies.end(), [&](const Body& other) { return gap(other, next).value >= least; }))
      bodies.push_back(next);
  }
  return bodies;
}

}  // namespace

TEST_CASE("the collector lists violated pairs and tracked ones, sorted, and no others") {
  const Suspension start = {body(1, 1, 0.0), body(1, 1, 3.0), body(1, 1, 6.0), body(1, 1, 40.0)};
  const GapCollector collector(start, 0.5);
  CHECK(collector.separation() == 0.5);
  CHECK(collector.collect(poses_of(start), {}).empty());
  CHECK(pairs_of(collector.collect(poses_of(start), {{0, 3}, {1, 2}})) == Pairs{{0, 3}, {1, 2}});

  std::vector<Pose> trial = poses_of(start);
  trial[1].centre = 2.25;
  trial[2].centre = 4.5;
  const auto contacts = collector.collect(trial, {{2, 3}});
  CHECK(pairs_of(contacts) == Pairs{{0, 1}, {1, 2}, {2, 3}});
  CHECK(std::abs(contacts[0].value + 0.25) < 1e-14);
  CHECK(std::abs(contacts[1].value + 0.25) < 1e-14);
  CHECK(std::abs(contacts[2].value - 33.0) < 1e-13);
  for (const ContactConstraint& c : contacts) {
    CHECK(c.region == 0);
    CHECK(std::abs(c.tolerance - 0.5e-4) < 1e-18);
  }
  trial[1].centre = 2.5 - 0.9 * 0.5e-4;  // within the tolerance
  trial[2].centre = 6.0;
  CHECK(collector.collect(trial, {}).empty());
  trial[1].centre = 2.5 - 1.1 * 0.5e-4;
  CHECK(pairs_of(collector.collect(trial, {})) == Pairs{{0, 1}});
}

TEST_CASE("without a separation bodies are kept 1e-7 of the smallest semi-axis apart") {
  const Suspension start = {body(1, 0.5, 0.0), body(2, 0.25, 4.0)};
  const GapCollector collector(start, 0.0);
  CHECK(std::abs(collector.separation() - 0.25e-7) < 1e-20);
  std::vector<Pose> trial = poses_of(start);
  trial[1].centre = 3.0 + 1e-7;
  CHECK(collector.collect(trial, {}).empty());
  trial[1].centre = 3.0 + 1e-8;
  REQUIRE(collector.collect(trial, {}).size() == 1);
  trial[1].centre = 2.5;
  REQUIRE(collector.collect(trial, {}).size() == 1);
  CHECK(collector.collect(trial, {})[0].value < -0.4);  // 0.5 along the line of centres
}

TEST_CASE("a constraint's gradient is that of its value") {
  std::mt19937_64 generator(3);
  int passed = 0, overlapping = 0;
  for (int trial_number = 0; trial_number < 200; ++trial_number) {
    const double angle = 6.0 * uniform(generator), y = 0.4 * uniform(generator);
    const Suspension start = {body(0.8, 0.3, 0.0, angle), body(0.6, 0.5, {-1.6, y}, 6.0 * uniform(generator))};
    const GapCollector collector(start, 0.05);
    std::vector<Pose> end = poses_of(start);
    end[0].angle += 0.3 * uniform(generator);
    end[1].centre += Complex(4.0 * uniform(generator), 0.2);
    end[1].angle -= 0.3 * uniform(generator);
    const auto found = collector.collect(end, {{0, 1}});
    REQUIRE(found.size() == 1);
    const ContactConstraint& c = found[0];
    const double end_gap = gap(start[0].shape, end[0], start[1].shape, end[1]).value;
    const bool pass = std::abs(c.value - (end_gap - 0.05)) > 1e-12;
    passed += pass;
    overlapping += !pass && c.value < 0.0;
    // After a pass the plane is frozen for the gradient, but the value's own plane moves with the poses.
    if (pass) CHECK(c.value < -0.02);
    if (pass) continue;
    const double step = 1e-6;
    const auto value_at = [&](int which, Complex move, double turn) {
      std::vector<Pose> moved = end;
      moved[which].centre += move, moved[which].angle += turn;
      return gap(start[0].shape, moved[0], start[1].shape, moved[1]).value;
    };
    const auto derivative = [&](int which, Complex move, double turn) {
      const double ahead = value_at(which, step * move, step * turn);
      return (ahead - value_at(which, -step * move, -step * turn)) / (2.0 * step);
    };
    if (end_gap < -0.1) continue;  // deep overlap has kinks
    CHECK(std::abs(derivative(0, 1.0, 0.0) - c.gradient.centre_a.real()) < 1e-7);
    CHECK(std::abs(derivative(0, imaginary_unit, 0.0) - c.gradient.centre_a.imag()) < 1e-7);
    CHECK(std::abs(derivative(0, 0.0, 1.0) - c.gradient.angle_a) < 1e-7);
    CHECK(std::abs(derivative(1, 1.0, 0.0) - c.gradient.centre_b.real()) < 1e-7);
    CHECK(std::abs(derivative(1, imaginary_unit, 0.0) - c.gradient.centre_b.imag()) < 1e-7);
    CHECK(std::abs(derivative(1, 0.0, 1.0) - c.gradient.angle_b) < 1e-7);
  }
  CHECK(passed > 20);
  CHECK(overlapping > 20);
}

TEST_CASE("a contact's force is that of the gap at the start: opposite, on one line, pushing apart") {
  std::mt19937_64 generator(4);
  for (int trial_number = 0; trial_number < 100; ++trial_number) {
    const Suspension start = random_ellipses(generator, 2, 3.0, 0.01);
    std::vector<Pose> end = poses_of(start);
    for (Pose& pose : end) pose.centre += Complex{uniform(generator), uniform(generator)}, pose.angle += 0.5;
    const ContactConstraint c = GapCollector(start, 0.1).collect(end, {{0, 1}}).at(0);
    const GapGradient& f = c.force;
    CHECK(f.centre_a == -f.centre_b);
    CHECK(std::abs(std::abs(f.centre_a) - 1.0) < 1e-14);
    CHECK(dot(f.centre_b, gap(start[0], start[1]).normal) > 1.0 - 1e-14);
    const double torque = f.angle_a + f.angle_b + cross(start[0].pose.centre, f.centre_a) +
                          cross(start[1].pose.centre, f.centre_b);
    CHECK(std::abs(torque) < 1e-13);
  }
}

TEST_CASE("bodies that pass through each other within a step are found, whatever way and time they take") {
  for (double distance : {3.0, 300.0, 3e5})
    for (double separation : {0.0, 1e-3, 0.3}) {
      const Suspension start = {body(0.5, 0.4, -distance), body(0.6, 0.2, distance, 1.0),
                                body(1, 1, {0.0, 30.0})};
      std::vector<Pose> end = poses_of(start);
      std::swap(end[0].centre, end[1].centre);
      const GapCollector collector(start, separation);
      const auto contacts = collector.collect(end, {});
      REQUIRE(pairs_of(contacts) == Pairs{{0, 1}});
      CHECK(std::abs(contacts[0].value / (4.0 * distance) + 0.5) < 0.5);
      CHECK(dot(contacts[0].gradient.centre_b, contacts[0].force.centre_b) > 0.5);  // back
      end[1].centre += Complex(0.0, 8.0);  // past each other, but not far enough aside to meet the third body
      CHECK(collector.collect(end, {}).empty());
    }
}

TEST_CASE("contacts are the same when bodies are numbered otherwise") {
  std::mt19937_64 generator(5);
  const Suspension start = random_ellipses(generator, 12, 4.0, 0.02);
  std::vector<Pose> end = poses_of(start);
  for (Pose& pose : end) pose.centre *= 0.8, pose.angle += 0.2;
  Suspension reversed(start.rbegin(), start.rend());
  std::vector<Pose> reversed_end(end.rbegin(), end.rend());
  const auto contacts = GapCollector(start, 0.05).collect(end, {});
  const auto mirrored = GapCollector(reversed, 0.05).collect(reversed_end, {});
  CHECK(contacts.size() > 3);
  REQUIRE(mirrored.size() == contacts.size());
  for (const ContactConstraint& c : contacts) {
    const auto same = std::find_if(mirrored.begin(), mirrored.end(),
                                   [&](const auto& m) { return m.a == 11 - c.b && m.b == 11 - c.a; });
    REQUIRE(same != mirrored.end());
    CHECK(std::abs(same->value - c.value) < 1e-13);
    CHECK(std::abs(same->force.centre_a - c.force.centre_b) < 1e-7);
  }
}

TEST_CASE("bodies that stay apart need no complementarity problem") {
  const Suspension start = {body(1, 1, 0.0), body(1, 1, 3.0)};
  const NcpResult result = resolve(start, {{0.1, 0.5}, {-0.1, -0.5}}, 1.0, 0.5);
  CHECK(result.solved);
  CHECK(result.iterations == 0);
  CHECK(result.contacts.empty());
  CHECK(result.poses[0].centre == Complex(0.1));
  CHECK(result.poses[1].angle == -0.5);
  for (const Wrench& w : result.wrenches) CHECK((w.force == Complex(0.0) && w.torque == 0.0));
}

TEST_CASE("two discs head on share the missing distance, with the force that closes it") {
  const Suspension start = {body(1, 1, 0.0), body(1, 1, 3.0)};
  const NcpResult result = resolve(start, {{1.0, 0.0}, {-1.0, 0.0}}, 0.5, 0.5);  // gap 0 without contact
  REQUIRE(result.solved);
  CHECK(result.iterations == 1);
  REQUIRE(result.contacts.size() == 1);
  CHECK(std::abs(result.contacts[0].multiplier - 0.5) < 1e-12);  // 0.5 = dt (lambda + lambda)
  CHECK(std::abs(result.poses[0].centre - 0.25) < 1e-12);
  CHECK(std::abs(result.poses[1].centre - 2.75) < 1e-12);
  CHECK(std::abs(result.wrenches[0].force + 0.5) < 1e-12);
  CHECK(result.wrenches[1].force == -result.wrenches[0].force);
  CHECK(std::abs(result.motion.velocity[1].velocity + 0.5) < 1e-12);
}

TEST_CASE("a row of discs pushed from one end moves as far as each contact asks") {
  Suspension start;
  for (int i = 0; i < 6; ++i) start.push_back(body(0.5, 0.5, 1.1 * i));
  std::vector<RigidVelocity> velocity(6);
  velocity[0].velocity = 1.0;
  const NcpResult result = resolve(start, velocity, 0.4, 0.1);
  REQUIRE(result.solved);
  CHECK(result.contacts.size() == 5);
  // All drags are equal: the row shares the push, and stays 1.1 apart.
  for (int i = 0; i < 6; ++i) CHECK(std::abs(result.poses[i].centre - (1.1 * i + 0.4 / 6.0)) < 1e-5);
  for (int l = 0; l < 5; ++l) CHECK(std::abs(result.contacts[l].multiplier - (5.0 - l) / 6.0) < 1e-4);
}

TEST_CASE("a contact that others relieve carries no force and does not hold its bodies") {
  // Body 1 would touch body 2, but body 0 pushes it aside.
  const Suspension start = {body(0.5, 0.5, -1.15), body(0.5, 0.5, 0.0), body(0.5, 0.5, {0.0, 1.3})};
  const RigidVelocity fast{3.5, 0.0}, up{{0.0, 0.6}, 0.0}, none{};
  const NcpResult alone = resolve(start, {none, up, none}, 0.5, 0.1);
  const NcpResult pushed = resolve(start, {fast, up, none}, 0.5, 0.1);
  REQUIRE(alone.solved);
  REQUIRE(alone.contacts.size() == 1);
  CHECK(alone.contacts[0].constraint.b == 2);
  REQUIRE(pushed.solved);
  REQUIRE(pushed.contacts.size() == 1);
  CHECK(pushed.contacts[0].constraint.a == 0);
  CHECK(pushed.poses[2].centre == start[2].pose.centre);
  CHECK(gap(start[1].shape, pushed.poses[1], start[2].shape, pushed.poses[2]).value > 0.2);
}

TEST_CASE("random drops that shrink onto their centre end separated, complementary and balanced") {
  std::mt19937_64 generator(6);
  int contacts = 0;
  for (int trial_number = 0; trial_number < 30; ++trial_number) {
    const double separation = 0.06 * uniform(generator) + 0.01;
    const Suspension start = random_ellipses(generator, 12, 4.5, 0.5 * separation);  // some start too close
    std::vector<RigidVelocity> velocity;
    for (const Body& b : start)
      velocity.push_back({Complex(2.25, 2.25) - b.pose.centre, 2.0 * uniform(generator) - 1.0});
    const NcpResult result = resolve(start, velocity, 0.15, separation);
    CAPTURE(result.failure);
    REQUIRE(result.solved);
    Suspension end = start;
    for (std::size_t i = 0; i < end.size(); ++i) end[i].pose = result.poses[i];
    CHECK(smallest_gap(end).gap >= separation * (1.0 - 1e-4));
    std::vector<Wrench> wrenches(start.size());
    for (const ActiveContact& c : result.contacts) {
      ++contacts;
      CHECK(c.multiplier > 0.0);
      CHECK(std::abs(gap(end[c.constraint.a], end[c.constraint.b]).value - separation) <= 1e-4 * separation);
      add(wrenches, c);
    }
    Complex force = 0.0;
    double torque = 0.0;
    for (std::size_t i = 0; i < start.size(); ++i) {
      CHECK(std::abs(wrenches[i].force - result.wrenches[i].force) < 1e-12);
      CHECK(std::abs(wrenches[i].torque - result.wrenches[i].torque) < 1e-12);
      force += result.wrenches[i].force;
      torque += result.wrenches[i].torque + cross(start[i].pose.centre, result.wrenches[i].force);
      // The motion is that of the contact-free velocities and these forces, and leads to these poses.
      const RigidVelocity& u = result.motion.velocity[i];
      CHECK(std::abs(u.velocity - velocity[i].velocity - result.wrenches[i].force) < 1e-12);
      CHECK(std::abs(u.omega - velocity[i].omega - 0.5 * result.wrenches[i].torque) < 1e-12);
      CHECK(std::abs(start[i].pose.centre + 0.15 * u.velocity - end[i].pose.centre) < 1e-14);
    }
    CHECK(std::abs(force) < 1e-12);
    CHECK(std::abs(torque) < 1e-12);
  }
  CHECK(contacts > 100);
}

TEST_CASE("each contact costs one mobility problem, however many iterations there are") {
  std::mt19937_64 generator(8);
  const Suspension start = random_ellipses(generator, 10, 4.5, 0.02);
  std::vector<RigidVelocity> velocity;
  for (const Body& b : start) velocity.push_back({Complex(2.2, 2.2) - b.pose.centre, 1.0});
  Bed bed;
  std::vector<std::pair<int, int>> seen;
  const GapCollector collector(start, 0.04);
  const NcpResult result = resolve_contacts(
      start, moving(velocity), 0.2,
      [&](const std::vector<Pose>& trial, const Pairs& tracked) {
        const auto found = collector.collect(trial, tracked);
        for (const auto& pair : pairs_of(found))
          if (std::find(seen.begin(), seen.end(), pair) == seen.end()) seen.push_back(pair);
        return found;
      },
      bed.response, {});
  REQUIRE(result.solved);
  CHECK(result.iterations > 1);
  CHECK(bed.columns <= static_cast<int>(seen.size()));
  CHECK(bed.columns >= static_cast<int>(result.contacts.size()));
}

TEST_CASE("an approximate mobility in the matrix changes the iterations, not the answer") {
  const Suspension start = {body(1, 0.5, 0.0, 0.2), body(0.8, 0.4, {2.1, 0.3}, -0.4)};
  const Response free = moving({{1.0, 0.0}, {-1.0, 0.0}});
  const GapCollector collector(start, 0.3);
  const ConstraintFunction constraints = constraints_of(collector);
  const MobilityFunction exact = [](const std::vector<Wrench>& w) { return Bed::respond(w); };
  const ResponseFunction whole = [](const std::vector<Wrench>& w, const ComplexVector&) { return Bed::respond(w); };
  const MobilityFunction stronger = [](const std::vector<Wrench>& w) {
    Response response = Bed::respond(w);
    for (RigidVelocity& u : response.velocity) u.velocity *= 1.5, u.omega *= 1.5;
    return response;
  };
  const NcpResult full = resolve_contacts(start, free, 0.5, constraints, superposed(exact), {});
  const NcpResult approximate = resolve_contacts(start, free, 0.5, constraints, solved(stronger, whole), {});
  REQUIRE(full.solved);
  REQUIRE(approximate.solved);
  CHECK(approximate.iterations > full.iterations);
  REQUIRE(full.contacts.size() == 1);
  REQUIRE(approximate.contacts.size() == 1);
  CHECK(std::abs(approximate.contacts[0].multiplier / full.contacts[0].multiplier - 1.0) < 1e-3);
  for (int i : {0, 1}) CHECK(std::abs(approximate.poses[i].centre - full.poses[i].centre) < 1e-4);
}

TEST_CASE("a contact problem that is given up says how far it came and between which bodies") {
  const Suspension start = {body(1, 1, 30.0), body(1, 1, 0.0), body(1, 1, 3.0)};
  const std::vector<RigidVelocity> velocity = {{0.0, 0.0}, {1.0, 0.0}, {-1.0, 0.0}};
  const NcpResult stopped = resolve(start, velocity, 1.0, 0.5, {0, false});
  CHECK_FALSE(stopped.solved);
  CHECK(stopped.failure.find("bodies 1 and 2") != std::string::npos);

  // A mobility that moves bodies against the force.
  const MobilityFunction adhesive = [](const std::vector<Wrench>& wrenches) {
    Response response = Bed::respond(wrenches);
    for (RigidVelocity& u : response.velocity) u.velocity = -u.velocity, u.omega = -u.omega;
    return response;
  };
  const GapCollector collector(start, 0.5);
  const NcpResult wrong =
      resolve_contacts(start, moving(velocity), 1.0, constraints_of(collector), superposed(adhesive), {});
  CHECK_FALSE(wrong.solved);
  CHECK(wrong.failure.find("bodies 1 and 2") != std::string::npos);
}

TEST_CASE("without progress the contact problem is given up early only when progress is demanded") {
  // A matrix from a mobility 20 times too large: each iteration removes a twentieth of the violation.
  const Suspension start = {body(1, 1, 0.0), body(1, 1, 3.0)};
  const GapCollector collector(start, 0.5);
  const ConstraintFunction constraints = constraints_of(collector);
  const ResponseFunction exact = [](const std::vector<Wrench>& w, const ComplexVector&) { return Bed::respond(w); };
  const MobilityFunction slow = [](const std::vector<Wrench>& w) {
    Response response = Bed::respond(w);
    for (RigidVelocity& u : response.velocity) u.velocity *= 20.0, u.omega *= 20.0;
    return response;
  };
  const Response free = moving({{1.0, 0.0}, {-1.0, 0.0}});
  const NcpResult patient = resolve_contacts(start, free, 0.5, constraints, solved(slow, exact), {1000, false});
  CHECK(patient.solved);
  CHECK(patient.iterations > 50);
  const NcpResult demanding = resolve_contacts(start, free, 0.5, constraints, solved(slow, exact), {1000, true});
  CHECK_FALSE(demanding.solved);
  CHECK(demanding.iterations == 2);
}
