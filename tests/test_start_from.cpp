// Runs that start from a state of an earlier one.
#include <doctest/doctest.h>

#include <cmath>

#include "program.hpp"

using namespace stokes;

namespace {

const std::string discs = "a,b,x,y,theta\n.5,.3,-1.6,.4,0\n.5,.5,0,0,0.1\n";

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// Over the rows of both bodies from a time on.
std::vector<double> from_time(const Table& trajectory, double time, const char* column) {
  const std::vector<double> times = trajectory.numbers("time"), all = trajectory.numbers(column);
  std::vector<double> values;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (times[k] > time - 1e-9) values.push_back(all[k]);
  return values;
}

}  // namespace

TEST_CASE("a run that starts from the middle or the end of another one goes on as that would have") {
  // Shear and a reversal: the clock is the earlier run's, too.
  const Workspace here(case_text("shear", 32, 0.05, 1.0, "reverse_at = 0.7\nmin_separation = 1\n"), discs);
  REQUIRE(here.run({"case.txt"}).status == 0);
  REQUIRE(here.run({"case.txt", "output=half", "start_from=out 0.5"}).status == 0);
  REQUIRE(here.run({"case.txt", "output=longer", "start_from=out", "end_time=1.2"}).status == 0);
  REQUIRE(here.run({"case.txt", "output=whole", "end_time=1.2"}).status == 0);
  const Table whole = here.results("whole").trajectory;
  for (const bool is_half : {true, false}) {
    const char* const folder = is_half ? "half" : "longer";
    const double start = is_half ? 0.5 : 1.0;
    CAPTURE(folder);
    const Table rest = here.results(folder).trajectory;
    CHECK(rest.numbers("step").front() == 0.0);
    CHECK(rest.numbers("time").front() == start);
    for (const char* column : {"time", "x", "y", "theta", "ux"}) {
      std::vector<double> expected = from_time(whole, start, column);
      const std::vector<double> got = rest.numbers(column);
      if (is_half) expected.resize(got.size());
      REQUIRE(got.size() == expected.size());
      // The solver begins anew, so that the results agree to its tolerance of 1e-8.
      for (std::size_t k = 0; k + 2 < got.size(); ++k) CHECK(std::abs(got[k] - expected[k]) < 1e-6);
    }
  }
  CHECK(here.results("longer").trajectory.numbers("time").back() == 1.2);
}

TEST_CASE("the poses that a run starts from are those of the trajectory, bit for bit, and its record makes it again") {
  const Workspace here(case_text("shear", 16, 0.1, 0.3), discs);
  REQUIRE(here.run({"case.txt"}).status == 0);
  REQUIRE(here.run({"case.txt", "start_from=out 0.2", "time_step=0.02", "output=fine"}).status == 0);
  const Table before = here.results("out").trajectory, after = here.results("fine").trajectory;
  for (const char* column : {"x", "y", "theta"})
    for (int body = 0; body < 2; ++body) CHECK(after.numbers(column)[body] == before.numbers(column)[4 + body]);
  const std::string record = content_of(here.path() / "fine/case.txt");
  CHECK(contains(record, "start_time = 0.2\n"));
  CHECK_FALSE(contains(record, "start_from"));
  const std::string bytes = content_of(here.path() / "fine/trajectory.csv");
  std::filesystem::remove_all(here.path() / "out");
  REQUIRE(here.run({"fine/case.txt", "output=again"}).status == 0);
  CHECK(content_of(here.path() / "again/trajectory.csv") == bytes);
}

TEST_CASE("forces, fixed bodies and walls of the earlier run are kept; other walls and flows are the new case's") {
  const std::string annulus = "bodies = bodies.csv\ngeometry = annulus\ninner_radius = 1\nouter_radius = 4\noutput = out\n"
                              "points_per_body = 16\nwall_points = 32\ntime_step = 0.1\nend_time = 0.2\n";
  const Workspace here(annulus, "a,b,x,y,theta,torque,fixed\n.3,.3,2,0,0,0.5,0\n.3,.3,-2,0,0,0,1\n");
  REQUIRE(here.run({"case.txt"}).status == 0);
  REQUIRE(here.run({"case.txt", "start_from=out", "end_time=0.4", "outer_radius=5", "output=next"}).status == 0);
  const Results next = here.results("next");
  CHECK(next.body_column(1, "x") == std::vector<double>{-2.0, -2.0, -2.0});
  CHECK(next.body_column(0, "omega")[0] > 0.1);
  CHECK(contains(content_of(here.path() / "next/case.txt"), "outer_radius = 5\n"));
}

TEST_CASE("a start that is not there is refused, with what there is") {
  const Workspace here(case_text("shear", 16, 0.1, 0.3, "output_every = 2\n"), discs);
  REQUIRE(here.run({"case.txt"}).status == 0);
  const auto check = [&](const std::vector<std::string>& arguments, const std::string& part) {
    std::vector<std::string> all = {"case.txt", "output=new"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const ProgramRun run = here.run(all);
    CAPTURE(run.errors);
    CHECK(run.status == 2);
    CHECK(contains(run.errors, part));
    CHECK_FALSE(std::filesystem::exists(here.path() / "new"));
  };
  check({"start_from=nowhere"}, "there is no nowhere/bodies.csv");
  check({"start_from=out 0.1"}, "there is no state at time 0.1; the nearest is at 0");
  check({"start_from=out"}, "end_time = '0.3' is not after the start at 0.3");
  check({"start_from=out", "end_time=1", "bodies=bodies.csv"}, "bodies = 'bodies.csv' does nothing with start_from");
  check({"start_time=0.3"}, "end_time = '0.3' is not after the start at 0.3");
  here.write("out/bodies.csv", discs + "1,1,5,5,0\n");
  check({"start_from=out", "end_time=1"}, "is not the row of body 2 of a state of 3 bodies");
  std::filesystem::remove(here.path() / "out/trajectory.csv");
  check({"start_from=out", "end_time=1"}, "there is no out/trajectory.csv");
}

TEST_CASE("a run from an earlier state that is interrupted goes on to the same bytes") {
  const std::string text = case_text("shear", 64, 0.01, 8.0, "min_separation = 1\n");
  const Workspace here(text, discs);
  REQUIRE(here.run({"case.txt", "end_time=1"}).status == 0);
  const std::vector<std::string> arguments = {"case.txt", "start_from=out 0.5"};
  const auto with_output = [&](const char* output) {
    std::vector<std::string> all = arguments;
    all.push_back(concat("output=", output));
    return all;
  };
  REQUIRE(here.run(with_output("whole")).status == 0);
  int stops = 0;
  while (here.run_until(0.1 + 0.05 * stops, "TERM", with_output("parts")).status != 0) REQUIRE(++stops < 200);
  CHECK(stops > 0);
  for (const char* file : {"trajectory.csv", "steps.csv"})
    CHECK(content_of(here.path() / "parts" / file) == content_of(here.path() / "whole" / file));
}
