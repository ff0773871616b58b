// Contact problems with the mobility of the bodies around each contact: its columns, and the steps it leads to.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "container_gap.hpp"
#include "couette_bodies.hpp"
#include "gap.hpp"
#include "neighbours.hpp"
#include "random_suspension.hpp"
#include "stokes_system.hpp"

using namespace stokes;

namespace {

constexpr int nearby_iterations = 48;  // after these the stepper uses full columns

// Two ellipses close to each other and, if there is one, a third body.
Suspension pair_and(const std::vector<Body>& third) {
  Suspension bodies{body_at({1.0, 0.5}, {}), body_at({1.0, 0.5}, {0.3, 1.1}, 0.1)};
  bodies.insert(bodies.end(), third.begin(), third.end());
  return bodies;
}

// Wrenches that part the pair along its normal.
std::vector<Wrench> parting(const Suspension& bodies) {
  const GapGradient g = gradient(gap(bodies[0], bodies[1]), bodies[0].pose, bodies[1].pose);
  std::vector<Wrench> wrenches(bodies.size());
  wrenches[0] = {g.centre_a, g.angle_a};
  wrenches[1] = {g.centre_b, g.angle_b};
  return wrenches;
}

struct Answers {
  StokesSolution full, nearby;
};
Answers answers(const Suspension& bodies, double tolerance) {
  ShapeCache shapes;
  const StokesSystem system(bodies, 64, shapes, {1e-11});
  return {system.solve({}, parting(bodies)), system.solve_nearby(parting(bodies), tolerance)};
}

// Differences of a suspension's steps with the mobility of nearby bodies from those with the full one.
struct Comparison {
  int steps = 0, contacts = 0, wall_contacts = 0, solves = 0, full_solves = 0, iterations = 0;
  int with_full_columns = 0;  // steps
  int firm_steps = 0;         // whose contact forces undo at least a fifth of the separation
  double gap = 0.0;           // of the contacts, in units of the separation
  double pose = 0.0;          // the same
  double multiplier = 0.0;    // of firm steps, over the largest of the step
};

// The violation of the separation without contact forces.
double violation(const Suspension& bodies, StepperOptions options, double dt) {
  options.contact = ContactModel::none;
  Stepper stepper(bodies, options);
  stepper.step(dt, 1.0, {});
  return options.separation - smallest_gap(stepper.bodies()).gap;
}

void compare(const StepOutcome& near, const StepOutcome& full, double separation, bool firm, Comparison& c) {
  REQUIRE(near.contacts.size() == full.contacts.size());
  double largest = 0.0;
  for (const ActiveContact& contact : full.contacts) largest = std::max(largest, contact.multiplier);
  for (std::size_t k = 0; k < near.contacts.size(); ++k) {
    const ActiveContact &a = near.contacts[k], &b = full.contacts[k];
    REQUIRE(a.constraint.a == b.constraint.a);
    REQUIRE(a.constraint.b == b.constraint.b);
    c.gap = std::max(c.gap, std::abs(a.constraint.value - b.constraint.value) / separation);
    if (firm) c.multiplier = std::max(c.multiplier, std::abs(a.multiplier - b.multiplier) / largest);
    c.wall_contacts += a.constraint.b == container_index;
  }
  c.contacts += static_cast<int>(near.contacts.size());
  c.firm_steps += firm;
}

// Every step is made from the same poses with either mobility.
Comparison compare_steps(const Suspension& start, StepperOptions options, double dt, int steps) {
  Comparison c;
  options.lcp_matrix = LcpMatrix::near;
  Stepper stepper(start, options);
  options.lcp_matrix = LcpMatrix::full;
  for (int k = 0; k < steps; ++k) {
    const bool firm = violation(stepper.bodies(), options, dt) > 0.2 * options.separation;
    Stepper other(stepper.bodies(), options);
    const StepOutcome near = stepper.step(dt, 1.0, {}), full = other.step(dt, 1.0, {});
    REQUIRE(near.failure == "");
    REQUIRE(full.failure == "");
    for (std::size_t i = 0; i < start.size(); ++i) {
      const Pose &a = stepper.bodies()[i].pose, &b = other.bodies()[i].pose;
      const double turned = std::abs(a.angle - b.angle) * start[i].shape.circumradius();
      c.pose = std::max({c.pose, std::abs(a.centre - b.centre) / options.separation, turned / options.separation});
    }
    compare(near, full, options.separation, firm, c);
    ++c.steps, c.solves += near.stokes_solves, c.full_solves += full.stokes_solves, c.iterations += near.ncp_iterations;
    c.with_full_columns += near.ncp_iterations > nearby_iterations;
    // One for the flow and one for each iteration, however many contacts there are.
    if (near.ncp_iterations <= nearby_iterations) CHECK(near.stokes_solves <= 1 + near.ncp_iterations);
  }
  MESSAGE(c.steps, " steps (", c.firm_steps, " firm), ", c.contacts, " contacts, ", c.wall_contacts, " at the wall; ",
          c.solves, " Stokes solves against ", c.full_solves, ", ", c.iterations, " iterations, ", c.with_full_columns,
          " steps with full columns; differences: poses ", c.pose, ", gaps ", c.gap, " separations, multipliers ",
          c.multiplier);
  return c;
}

// A step is accepted when its contacts satisfy the separation to 1e-4 of it. The gaps of two accepted steps can therefore
// differ by twice that, and multipliers that undo a fifth of the separation by 1e-3.
void check(const Comparison& c) {
  CHECK(c.gap <= 2e-4);
  CHECK(c.pose < 4e-4);  // a body also moves along its contact
  CHECK(c.multiplier < 1e-3);
  CHECK(c.firm_steps > 0);
}

// A disc pushed against the outer cylinder, and 49 ellipses at random places nearby.
Suspension crowd_at_wall(double separation) {
  std::vector<Body> bodies{body_at({0.375, 0.375}, 9.625 - separation, 0.0, 600.0)};
  const Container wall = *between_cylinders({}).container;
  std::mt19937_64 generator(3);
  while (bodies.size() < 50) {
    const double angle = 0.8 * uniform(generator) - 0.4, radius = 5.5 + 4.0 * uniform(generator);
    const Body next = body_at({0.375, 0.125}, std::polar(radius, angle), 2.0 * pi * uniform(generator));
    if (gap(next, wall).value >= separation &&
        std::all_of(bodies.begin(), bodies.end(), [&](const Body& other) { return gap(next, other).value >= separation; }))
      bodies.push_back(next);
  }
  return between_cylinders(bodies);
}

// Discs in a row at the separation from each other, pressed together from both ends.
Suspension pressed_row(int count, double separation, double push) {
  Suspension row;
  for (int k = 0; k < count; ++k) row.push_back(body_at({0.5, 0.5}, (1.0 + separation) * k));
  row.front().force = push, row.back().force = -push;
  return row;
}

}  // namespace

TEST_CASE("where all bodies are within reach the nearby answer is the full one, to its tolerance") {
  for (const double tolerance : {1e-6, 1e-9}) {
    for (const std::vector<Body>& third : {std::vector<Body>{}, {body_at({0.5, 0.5}, {1.9, 0.5})}}) {
      const Answers a = answers(pair_and(third), tolerance);
      const double error = velocity_difference(a.nearby.velocity, a.full.velocity, a.full.velocity.size());
      MESSAGE(a.full.velocity.size(), " bodies, tolerance ", tolerance, ": ", error);
      CHECK(error < 10.0 * tolerance);
      CHECK((a.nearby.density - a.full.density).norm() < 100.0 * tolerance * a.full.density.norm());
    }
  }
}

TEST_CASE("a body beyond reach stays at rest, and leaving it out changes the pair's answer by a few per cent") {
  std::vector<double> errors;
  for (const double x : {4.5, 6.0, 12.0}) {
    const Answers a = answers(pair_and({body_at({1.0, 1.0}, {x, 0.5})}), 1e-9);
    errors.push_back(velocity_difference(a.nearby.velocity, a.full.velocity, 2));
    CHECK(a.nearby.velocity[2].velocity == 0.0);
    CHECK(a.nearby.velocity[2].omega == 0.0);
    CHECK(std::abs(a.full.velocity[2].velocity) > 0.0);
  }
  MESSAGE("a disc at x = 4.5, 6, 12 would change it by ", errors[0], ", ", errors[1], ", ", errors[2]);
  CHECK(errors[0] < 0.1);
  CHECK(errors[1] < 0.05);
  CHECK(errors[2] < 0.01);
  CHECK(errors[2] > 1e-4);
}

TEST_CASE("dense drops in extension: steps with nearby mobilities are those with full ones") {
  for (const int seed : {11, 14}) {
    std::mt19937_64 generator(seed);
    StepperOptions options = accurate_steps(32, 0.1);
    options.flow.kind = FlowKind::extension;
    options.refine = Refine::near;
    options.stokes.gmres_tolerance = 1e-8;
    const Comparison c = compare_steps(random_drop(generator, 30, 4.8, 0.1), options, 0.2, 4);
    check(c);
    CHECK(c.contacts > 4 * c.steps);
  }
}

TEST_CASE("in an annulus, one body on its outer wall: the same steps, in at most three solves on average") {
  const double separation = 0.0245;
  StepperOptions options = accurate_steps(32, separation);
  options.refine = Refine::near;
  options.stokes.gmres_tolerance = 1e-8;
  const Comparison c = compare_steps(crowd_at_wall(separation), options, 0.01, 5);
  check(c);
  CHECK(c.wall_contacts >= c.steps);
  CHECK(c.contacts > c.wall_contacts);
  CHECK(c.solves <= 3 * c.steps);
}

// The forces on all others move each disc of a row, but the nearby mobility includes only the next discs: a row of 40 would
// take 16 iterations.
TEST_CASE("where nearby mobilities do not lead to a solution the step is made with full ones") {
  StepperOptions options = accurate_steps(32, 0.01);
  options.stokes.gmres_tolerance = 1e-9;
  options.refine = Refine::near;
  for (const auto& [count, most] : {std::pair(3, nearby_iterations), {12, nearby_iterations}, {40, 8}}) {
    const NcpOptions ncp{.max_iterations = most};
    const Suspension row = pressed_row(count, 0.01, 10.0);
    options.lcp_matrix = LcpMatrix::near;
    Stepper near(row, options);
    const StepOutcome a = near.step(0.01, 1.0, ncp);
    options.lcp_matrix = LcpMatrix::full;
    Stepper full(row, options);
    const StepOutcome b = full.step(0.01, 1.0, ncp);
    REQUIRE(a.failure == "");
    REQUIRE(b.failure == "");
    CHECK(b.contacts.size() == row.size() - 1);
    CHECK(a.contacts.size() == b.contacts.size());
    MESSAGE(count, " discs in a row: ", a.ncp_iterations, " iterations and ", a.stokes_solves, " Stokes solves, ",
            b.ncp_iterations, " and ", b.stokes_solves, " with full mobilities");
    if (most == nearby_iterations) {
      CHECK(a.ncp_iterations <= most);
      continue;
    }
    CHECK(a.ncp_iterations > most);
    // With full columns the same step, bit for bit.
    for (int i = 0; i < count; ++i) CHECK(near.bodies()[i].pose.centre == full.bodies()[i].pose.centre);
    CHECK(a.contacts[0].multiplier == b.contacts[0].multiplier);
  }
}

// Two discs driven together, moved by forces as if alone; one number stands for the density.
TEST_CASE("answers to contact forces start from the nearest combination of known ones, and teach the matrix") {
  const Suspension discs{body_at({0.5, 0.5}, {-0.6, 0.0}), body_at({0.5, 0.5}, {0.6, 0.0})};
  const Response contact_free{{{{1.0, 0.0}, 0.0}, {{-1.0, 0.0}, 0.0}}, ComplexVector::Zero(1)};
  const double separation = 0.1, dt = 0.1;
  const GapCollector collector(discs, separation);
  const auto constraints = [&](const auto& trial, const auto& tracked) { return collector.collect(trial, tracked); };
  const auto answer = [](const std::vector<Wrench>& w, double mobility, double density) {
    return Response{{{mobility * w[0].force, 0.0}, {mobility * w[1].force, 0.0}},
                    ComplexVector::Constant(1, density * w[0].force)};
  };
  std::vector<Complex> guesses;
  int columns = 0;
  const auto column = [&](const auto& w) { return ++columns, answer(w, 0.9, 3.0); };  // nearly the one that moves the bodies
  const auto response = [&](const auto& w, const ComplexVector& guess) {
    guesses.push_back(guess[0]);
    return answer(w, 1.0, 2.0);
  };
  const auto resolve = [&](const ContactResponseFactory& how) {
    guesses.clear();
    columns = 0;
    return resolve_contacts(discs, contact_free, dt, constraints, how, {});
  };
  const NcpResult fresh = resolve(solved(column, response));
  REQUIRE(fresh.solved);
  REQUIRE(fresh.contacts.size() == 1);
  // The gap of 0.2 would be 0; a force f on either disc gives back 2 dt f.
  CHECK(std::abs(fresh.contacts[0].multiplier - 0.5) < 1e-4);
  const double first = 0.05 / (0.9 * dt);  // multiplier of the first iterate
  CHECK(std::abs(guesses[0] + 3.0 * first) < 1e-12);
  // The second starts from the answer to the first.
  REQUIRE(guesses.size() > 1);
  CHECK(std::abs(guesses[1] + 2.0 * (first + (0.5 - first) / 0.9)) < 1e-5);

  KnownContacts known{{{0, 1, 0}}, Matrix::Constant(1, 1, 2.0 * 0.9), Matrix::Constant(1, 1, 0.2)};
  const auto resolve_knowing = [&] {
    return resolve(learned(column, response, known, {ComplexVector::Constant(1, 7.0)}));
  };
  const NcpResult taught = resolve_knowing();
  REQUIRE(taught.solved);
  CHECK(std::abs(guesses[0] - 7.0 * first / 0.2) < 1e-4);
  CHECK(columns == 0);  // its rate is known
  CHECK(taught.iterations == 2);
  REQUIRE(taught.known.contacts.size() == 1);
  CHECK(std::abs(taught.known.rates(0, 0) - 2.0) < 1e-12);
  CHECK(std::abs(taught.contacts[0].multiplier - 0.5) < 1e-12);
  REQUIRE(taught.known.multipliers.cols() == 2);
  CHECK(taught.known.multipliers(0, 0) == 0.2);
  CHECK(taught.known.multipliers(0, 1) == taught.contacts[0].multiplier);

  known.rates = taught.known.rates;
  CHECK(resolve_knowing().iterations == 1);

  // A matrix without a positive diagonal is replaced by columns.
  known.rates = Matrix::Constant(1, 1, -2.0);
  const NcpResult anew = resolve_knowing();
  CHECK(anew.failure == "");
  CHECK(columns == 1);
  CHECK(std::abs(anew.contacts.at(0).multiplier - 0.5) < 1e-4);
}

TEST_CASE("what steps leave to the next one changes it by less than the contacts' tolerance") {
  StepperOptions options = accurate_steps(32, 0.0245);
  options.refine = Refine::near;
  options.stokes.gmres_tolerance = 1e-9;
  options.lcp_matrix = LcpMatrix::near;
  Stepper stepper(crowd_at_wall(options.separation), options);
  for (int k = 0; k < 4; ++k) REQUIRE(stepper.step(0.003, 1.0, {}).accepted);
  const std::vector<Pose> poses = poses_of(stepper.bodies());
  Stepper forgetful(stepper.bodies(), options);
  const StepOutcome a = stepper.step(0.003, 1.0, {}), b = forgetful.step(0.003, 1.0, {});
  REQUIRE(a.accepted);
  REQUIRE(b.accepted);
  REQUIRE(a.contacts.size() == b.contacts.size());
  MESSAGE(a.contacts.size(), " contacts, ", a.ncp_iterations, " and ", b.ncp_iterations, " iterations; ", a.gmres_iterations,
          " of GMRES against ", b.gmres_iterations, ", of which ", a.background_iterations, " without contact forces");
  CHECK(a.ncp_iterations <= b.ncp_iterations);
  for (std::size_t i = 0; i < poses.size(); ++i)
    CHECK(std::abs(stepper.bodies()[i].pose.centre - forgetful.bodies()[i].pose.centre) < 1e-4 * options.separation);
}

TEST_CASE("a rejected attempt changes nothing of what the next one starts from") {
  StepperOptions options = accurate_steps(32, 0.01);
  options.refine = Refine::near;
  options.stokes.gmres_tolerance = 1e-9;
  options.lcp_matrix = LcpMatrix::near;
  Stepper disturbed(pressed_row(3, 0.01, 10.0), options), untouched(pressed_row(3, 0.01, 10.0), options);
  for (int k = 0; k < 2; ++k) {
    REQUIRE(disturbed.step(0.01, 1.0, {}).accepted);
    REQUIRE(untouched.step(0.01, 1.0, {}).accepted);
  }
  const auto state_of = [](const Stepper& stepper) {
    StateWriter writer;
    stepper.save(writer);
    return writer.text();
  };
  CHECK(state_of(untouched).find("\ncontact ") != std::string::npos);  // which the matrix has learnt from
  CHECK_FALSE(disturbed.attempt(0.01, 1.0, {0, false}).accepted);
  CHECK(disturbed.attempt(0.02, 1.0, {}).accepted);  // but not taken
  CHECK(state_of(disturbed) == state_of(untouched));
  REQUIRE(disturbed.step(0.005, 1.0, {}).accepted);
  REQUIRE(untouched.step(0.005, 1.0, {}).accepted);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(disturbed.bodies()[i].pose.centre == untouched.bodies()[i].pose.centre);
    CHECK(disturbed.bodies()[i].pose.angle == untouched.bodies()[i].pose.angle);
  }
}
