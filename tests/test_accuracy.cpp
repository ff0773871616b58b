// The key `accuracy`: errors of velocities against the requested ones, warnings of fixed nodes, runs whose nodes change.
#include <doctest/doctest.h>

#include <cmath>
#include <ctime>
#include <set>

#include "gap.hpp"
#include "resolution.hpp"
#include "running_program.hpp"

using namespace stokes;

namespace {

ResolvedSystem resolved(const Suspension& bodies, FlowKind flow, double accuracy) {
  ShapeCache shapes;
  ShapeResolution alone;
  std::vector<Resolution> resolution;
  return solve_to_accuracy({bodies, {flow}, {}, {}}, accuracy, {}, shapes, alone, resolution);
}

// The speed of each of two free unit discs towards the other in u = (x, -y), by bipolar coordinates.
double approach(double gap) {
  const double half = std::asinh(std::sqrt(0.25 * gap)), alpha = 2.0 * half;
  return 2.0 * std::pow(std::sinh(alpha), 3) / std::cosh(2.0 * alpha);
}

// A pair on the y axis, turned by an angle about the origin.
Suspension turned(Suspension pair, double angle) {
  for (Body& body : pair) body.pose = {body.pose.centre * std::polar(1.0, angle), body.pose.angle + angle};
  return pair;
}

double largest_difference(const std::vector<RigidVelocity>& u, const std::vector<RigidVelocity>& v) {
  double largest = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i)
    largest = std::max({largest, std::abs(u[i].velocity - v[i].velocity), std::abs(u[i].omega - v[i].omega)});
  return largest;
}

// One disc and the six around it.
Suspension hexagon(double distance) {
  Suspension discs{{{1.0, 1.0}, {}}};
  for (int k = 0; k < 6; ++k) discs.push_back({{1.0, 1.0}, {std::polar(2.0 + distance, k * pi / 3.0), 0.0}});
  return discs;
}

const std::string squeeze = "a,b,x,y,theta\n1,1,0,1.05,0\n1,1,0,-1.05,0\n";

std::string squeeze_case(const std::string& resolution, const std::string& end_time) {
  return concat("bodies = bodies.csv\nflow = extension\ntime_step = .02\nend_time = ", end_time,
                "\noutput = out\ncontact = none\n", resolution, "\n");
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

// Reference: closed forms for discs, an accuracy of 1e-11 for the others. The error may be the estimated round-off.
TEST_CASE("velocities keep the accuracy at gaps of .1 to 1e-6, and the estimated error at 1e-8") {
  struct Kind {
    const char* name;
    Shape shape;
    double distance, angle;  // of the upper body
  };
  for (const Kind& kind : {Kind{"discs", {1.0, 1.0}, 2.0, 0.0}, Kind{"2:1 flank to flank", {1.0, 0.5}, 1.0, 0.0},
                           Kind{"3:1 tip on flank", {1.0, 1.0 / 3.0}, 4.0 / 3.0, 0.5 * pi}})
    for (const double gap : {1e-1, 1e-2, 1e-4, 1e-6, 1e-8})
      for (const double turn : {0.0, 0.7}) {
        const Suspension pair = turned({{kind.shape, {}}, {kind.shape, {{0.0, kind.distance + gap}, kind.angle}}}, turn);
        std::vector<RigidVelocity> exact = resolved(pair, FlowKind::extension, 1e-11).solution.velocity;
        if (kind.shape.a == kind.shape.b && turn == 0.0)
          exact = {{{0.0, approach(gap) - 0.5 * (2.0 + gap)}, 0.0}, {{0.0, -approach(gap) - 0.5 * (2.0 + gap)}, 0.0}};
        for (const double accuracy : {1e-4, 1e-6, 1e-8}) {
          const std::clock_t start = std::clock();
          const ResolvedSystem found = resolved(pair, FlowKind::extension, accuracy);
          const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
          const double error = largest_difference(found.solution.velocity, exact);
          MESSAGE(std::string(kind.name), ", gap ", gap, ", turned by ", turn, ", accuracy ", accuracy, ": error ", error,
                  ", estimated ", found.error, "; ", found.most_nodes(), " nodes, ", found.solves, " solves, ",
                  found.solution.iterations, " iterations, ", seconds, " s");
          CHECK(error <= std::max(accuracy, found.error));
          if (gap >= 1e-6) CHECK(error <= accuracy);
        }
      }
}

TEST_CASE("2:1 flank to flank at a gap of .01 and beside each other: the velocities of 384 equal nodes") {
  const Shape oval{1.0, 0.5};
  for (const Suspension& pair : {Suspension{{oval, {}}, {oval, {{0.0, 1.01}, 0.0}}},
                                 Suspension{{oval, {}}, {oval, {{0.2, 1.1}, 0.3}}}}) {
    REQUIRE(gap(pair[0], pair[1]).value > 0.0);
    ShapeCache shapes;
    const StokesSystem equal(pair, 384, shapes, {1e-12});
    const std::vector<RigidVelocity> exact = equal.solve({FlowKind::shear}, {}).velocity;
    CHECK(largest_difference(resolved(pair, FlowKind::shear, 1e-11).solution.velocity, exact) < 1e-10);
  }
}

TEST_CASE("a disc in front of one 100 to 10000 times as large keeps an accuracy in units of its own size") {
  for (const double ratio : {1e2, 1e3, 1e4}) {
    CAPTURE(ratio);
    const Suspension discs{{{ratio, ratio}, {}}, {{1.0, 1.0}, {std::polar(ratio + 1.1, 0.4), 0.0}}};
    const RigidVelocity fine = resolved(discs, FlowKind::extension, 1e-8).solution.velocity[1];
    for (const double accuracy : {1e-4, 1e-6}) {
      const ResolvedSystem found = resolved(discs, FlowKind::extension, accuracy);
      CHECK(std::abs(found.solution.velocity[1].velocity - fine.velocity) < accuracy);
      CHECK(std::abs(found.solution.velocity[1].omega - fine.omega) < accuracy);
      CHECK(found.unresolved.empty());
      CHECK(found.most_nodes() < 250);
    }
  }
}

TEST_CASE("hexagons at gaps of 1e-4 and 1e-6 take at most 25 and 30 iterations at a tolerance of 1e-8") {
  struct Row {
    double gap;
    int limit;
  };
  for (const Row& row : {Row{1e-4, 25}, Row{1e-6, 30}}) {
    const Suspension discs = hexagon(row.gap);
    std::vector<Discretisation> nodes = clustered_nodes(discs, std::vector<Resolution>(7, Resolution{48, 1.5}), 1e-8).nodes;
    for (Discretisation& d : nodes) d.upsampling = 2;
    ShapeCache shapes;
    const int iterations = StokesSystem(discs, nodes, shapes, {1e-8}).solve({FlowKind::shear}, {}).iterations;
    MESSAGE("gap ", row.gap, ": ", iterations, " iterations with ", nodes[0].size(), " and ", nodes[1].size(), " nodes");
    CHECK(iterations <= row.limit);
  }
}

// The discs approach as g' = -2 approach(g); 64 nodes at equal steps are compared with that at every step.
TEST_CASE("64 fixed nodes warn in or before the first step in which the rate of the gap is off by 10 %") {
  for (const char* refine : {"none", "near"}) {
    CAPTURE(refine);
    const Workspace here(squeeze_case(concat("points_per_body = 64\nrefine = ", refine), "4"), squeeze);
    const ProgramRun run = here.run({"case.txt"});
    REQUIRE(run.status == 0);
    const Results results = here.results();
    const std::vector<double> gaps = results.step_column("min_gap"), unresolved = results.step_column("unresolved");
    const std::vector<double> up = results.body_column(0, "uy"), down = results.body_column(1, "uy");
    bool warned = false;
    for (std::size_t k = 0; k + 1 < gaps.size(); ++k) {
      warned |= unresolved[k] > 0.0;
      if (std::abs(0.5 * (down[k] - up[k]) / approach(gaps[k]) - 1.0) > 0.1) REQUIRE(warned);
    }
    CHECK(warned == (refine == std::string("none")));
    CHECK(warned == contains(run.errors, "do not resolve their gap"));
  }
}

TEST_CASE("a slender body on 32 nodes is warned of in the first step, and resolved turns as it should") {
  const Workspace here(case_text("shear", 32, 0.01, 0.02), "a,b,x,y,theta\n1,.05,0,0,.3\n");
  const ProgramRun run = here.run({"case.txt"});
  CHECK(run.status == 0);
  CHECK(contains(run.errors, "at time 0 the nodes of body 0 do not resolve its own form"));
  for (const double angle : {0.0, 0.3, 1.2, 2.9}) {
    const Suspension body{{{1.0, 0.05}, {{}, angle}}};
    const double exact = -(std::pow(std::sin(angle), 2) + 0.0025 * std::pow(std::cos(angle), 2)) / 1.0025;
    CHECK(std::abs(resolved(body, FlowKind::shear, 1e-6).solution.velocity[0].omega - exact) < 1e-6);
  }
}

TEST_CASE("runs whose nodes change have the same bytes for 1, 2 and 4 threads and after an interruption") {
  const std::string three = squeeze + "1,.4,2.3,.2,.5\n";
  const Workspace here(squeeze_case("accuracy = 1e-5", "2"), three);
  REQUIRE(here.run({"case.txt", "threads=1", "output=whole"}).status == 0);
  const std::vector<double> nodes = here.results("whole").step_column("nodes");
  CHECK(std::set<double>(nodes.begin(), nodes.end() - 1).size() >= 3);
  const auto same = [&](const std::string& output) {
    for (const char* name : {"trajectory.csv", "steps.csv"})
      CHECK(content_of(here.path() / output / name) == content_of(here.path() / "whole" / name));
  };
  for (const char* threads : {"2", "4"}) {
    REQUIRE(here.run({"case.txt", concat("threads=", threads), "output=threads"}).status == 0);
    same("threads");
    std::filesystem::remove_all(here.path() / "threads");
  }
  CHECK(stopped(here, SIGTERM, {"case.txt", "checkpoint_every=0"}).status == 128 + SIGTERM);
  const ProgramRun rest = here.run({"case.txt"});
  CHECK(rest.status == 0);
  CHECK(contains(rest.errors, "going on from step "));
  same("out");
}
