// Contact forces do work on the bodies; if they do not, the nodes are too sparse and the step fails.
#include <doctest/doctest.h>

#include "contact_work.hpp"
#include "couette_bodies.hpp"
#include "ncp.hpp"
#include "program.hpp"

using namespace stokes;

TEST_CASE("the work of contact forces may be negative on one body but not on all, and torques count") {
  const std::vector<RigidVelocity> without = {{{1.0, 0.0}, 0.5}, {{0.0, 0.0}, 0.0}};
  const std::vector<Wrench> contact = {{{2.0, 0.0}, 0.0}, {{-2.0, 0.0}, 3.0}};
  // Both are carried along the force on the first.
  CHECK(negative_work(contact, {{{4.0, 0.0}, 0.5}, {{2.0, 0.0}, 0.0}}, without).empty());
  CHECK(negative_work(contact, without, without).empty());
  const std::string pushed = negative_work(contact, {{{2.0, 0.0}, 0.5}, {{2.0, 0.0}, 0.0}}, without);
  CHECK(pushed.find("(power -2)") != std::string::npos);
  CHECK(pushed.find("on body 1") != std::string::npos);
  CHECK(pushed.find("write accuracy = ") != std::string::npos);
  CHECK(negative_work(contact, {{{2.0, 0.0}, 0.5}, {{2.0, 0.0}, 1.0}}, without).empty());
}

// Two discs driven together. The matrix is that of single discs; the discs themselves move against the force.
TEST_CASE("contact forces that pull bodies against themselves end the contact problem, whatever the matrix") {
  const Suspension discs{body_at({0.5, 0.5}, {-0.6, 0.0}), body_at({0.5, 0.5}, {0.6, 0.0})};
  const Response contact_free{{{{1.0, 0.0}, 0.0}, {{-1.0, 0.0}, 0.0}}, ComplexVector::Zero(1)};
  const GapCollector collector(discs, 0.1);
  const auto constraints = [&](const auto& trial, const auto& tracked) { return collector.collect(trial, tracked); };
  const auto answer = [](const std::vector<Wrench>& w, double mobility) {
    return Response{{{mobility * w[0].force, 0.0}, {mobility * w[1].force, 0.0}}, ComplexVector::Zero(1)};
  };
  for (const double sign : {1.0, -1.0})
    for (const bool learns : {false, true}) {
      const auto column = [&](const auto& w) { return answer(w, 0.9); };
      const auto response = [&](const auto& w, const ComplexVector&) { return answer(w, sign); };
      const NcpResult result = resolve_contacts(discs, contact_free, 0.1, constraints,
                                                learns ? learned(column, response, {}, {}) : solved(column, response), {});
      CHECK(result.solved == (sign > 0.0));
      CHECK(result.unresolved == (sign < 0.0));
      if (sign < 0.0) CHECK(result.failure.find(finer_nodes) != std::string::npos);
      if (sign < 0.0 && !learns) CHECK(result.failure.find("negative work") != std::string::npos);
    }
}

// The 6:1 ellipse of test_refinement, which 32 nodes move towards the wall when it is pushed away, here in a run.
TEST_CASE("a body along a wall that moves against its contact force ends the run with a message that names it") {
  const std::string text =
      "bodies = bodies.csv\ngeometry = annulus\ninner_radius = 5\nouter_radius = 10\nwall_points = 1024\ntime_step = .01\n"
      "end_time = .02\noutput = out\npoints_per_body = 32\nmin_separation_length = .03\n";
  const Workspace here(text, "a,b,x,y,theta\n.375,.0625,0,9.9128,0\n");
  for (const char* matrix : {"full", "near", "self"}) {
    CAPTURE(matrix);
    const ProgramRun run = here.run({"case.txt", concat("lcp_matrix=", matrix), "overwrite=yes"});
    CAPTURE(run.errors);
    CHECK(run.status == 3);
    CHECK(run.errors.find("body 0") != std::string::npos);
    CHECK(run.errors.find("write accuracy = 1e-4 in place of points_per_body") != std::string::npos);
  }
}
