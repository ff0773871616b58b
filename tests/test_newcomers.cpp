// Messages about a new user's first mistakes, and about values that are possible but probably not intended.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "program.hpp"

using namespace stokes;

namespace {

const std::string header = "a,b,x,y,theta\n", discs = header + ".5,.5,-2,.5,0\n.5,.5,0,0,0.1\n";
const std::string shear = case_text("shear", 16, 0.1, 0.2), at_rest = case_text("none", 16, 0.1, 0.2);
const std::string annulus =
    "bodies = bodies.csv\ngeometry = annulus\ninner_radius = 1\nouter_radius = 4\npoints_per_body = 16\nwall_points = 32\n"
    "outer_angular_velocity = 1\ntime_step = 0.1\nend_time = 0.2\noutput = out\n";

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

void check_refused(const std::string& text, const std::string& bodies, const std::vector<std::string>& arguments,
                   const std::vector<std::string>& parts) {
  const Workspace here(text, bodies);
  const auto before = here.everything();
  std::vector<std::string> all = {"case.txt"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  const ProgramRun run = here.run(all);
  CAPTURE(run.errors);
  CHECK(run.status == 2);
  CHECK(std::count(run.errors.begin(), run.errors.end(), '\n') == 1);
  for (const std::string& part : parts) {
    CAPTURE(part);
    CHECK(contains(run.errors, part));
  }
  CHECK(here.everything() == before);
}

// The messages on stderr of a run that succeeds.
std::string said(const std::string& text, const std::string& bodies, const std::vector<std::string>& arguments = {}) {
  const Workspace here(text, bodies);
  std::vector<std::string> all = {"case.txt"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  const ProgramRun run = here.run(all);
  CAPTURE(run.errors);
  CHECK(run.status == 0);
  return run.errors;
}

std::string in_utf16(const std::string& text) {
  std::string wide = "\xFF\xFE";
  for (const char c : text) wide += c, wide += '\0';
  return wide;
}

std::string replaced(std::string text, char from, char to) {
  std::replace(text.begin(), text.end(), from, to);
  return text;
}

}  // namespace

TEST_CASE("bodies in another kind of table are told what it is") {
  check_refused(shear, replaced(discs, ',', ';'), {}, {"bodies.csv:1", "separated by semicolons", "commas"});
  check_refused(shear, "# mine\na;b;x;y;theta\n0,5;0,5;0;0;0\n", {}, {"bodies.csv:2", "separated by semicolons"});
  check_refused(shear, replaced(discs, ',', '\t'), {}, {"bodies.csv:1", "separated by tabs"});
  check_refused(shear, replaced(discs, ',', ' '), {}, {"bodies.csv:1", "separated by spaces"});
  check_refused(shear, ".5,.5,-2,.5,0\n.5,.5,0,0,0.1\n", {}, {"bodies.csv:1", "numbers only", "a,b,x,y,theta"});
  check_refused(shear, in_utf16(discs), {}, {"bodies.csv", "UTF-16", "UTF-8"});
  check_refused(in_utf16(shear), discs, {}, {"case.txt", "UTF-16", "UTF-8"});
  CHECK(said(replaced(shear, '\n', '\r'), replaced(discs, '\n', '\r')) == said(shear, discs));
}

TEST_CASE("a table in the place of the case, dashes, '~' and names of other programs are answered") {
  check_refused(discs, discs, {}, {"case.txt:1", "A table is no case", "bodies = FILE.csv"});
  check_refused(shear, discs, {"--threads=2"}, {"keys have no dashes", "'threads'"});
  check_refused(shear, discs, {"output=~/run"}, {"output = '~/run' begins with '~'"});
  check_refused(shear, discs, {"dt=0.1"}, {"'dt'", "time_step"});
  check_refused(shear, discs, {"tol=1e-6"}, {"gmres_tolerance"});
  check_refused(shear, discs, {"radius=1"}, {"inner_radius", "columns a and b"});
  check_refused(shear, discs, {"period=1"}, {"no periodic domains"});
  check_refused(shear, discs, {"flow=channel"}, {"flow = poiseuille", "shear or extension"});
  check_refused(shear, discs, {"geometry=channel"}, {"there are no channels"});
  const Workspace here(shear, discs);
  CHECK_FALSE(contains(here.run({"case.txt", "colour=red"}).errors, "did you mean"));
}

TEST_CASE("a name in quotes has spaces, and a missing file says where it was looked for") {
  const Workspace here(shear, discs);
  CHECK(here.run({"case.txt", "output=\"my run\""}).status == 0);
  CHECK(std::filesystem::exists(here.path() / "my run/trajectory.csv"));
  std::filesystem::create_directory(here.path() / "cases");
  here.write("cases/deep.txt", shear);
  const ProgramRun run = here.run({"cases/deep.txt"});
  CAPTURE(run.errors);
  CHECK(run.status == 2);
  CHECK(contains(run.errors, "cases/bodies.csv: cannot open the bodies' file"));
  CHECK(contains(run.errors, "in the folder of the case file, 'cases'"));
  CHECK(contains(run.errors, concat("write bodies = ", (here.path() / "bodies.csv").string())));
}

TEST_CASE("numbers in messages have four digits") {
  check_refused(shear, header + "1,1,0,0,0\n1,.7,1.23456789,.3,0\n", {}, {"overlap by 0."});
  const Workspace here(shear, header + "1,1,0,0,0\n1,1,1.23456789,0,0\n");
  CHECK(contains(here.run({"case.txt"}).errors, "overlap by 0.7654,"));
}

TEST_CASE("a key that does nothing is refused, where an argument has left it without effect it is a warning") {
  check_refused(annulus, "a,b,x,y,theta\n.3,.3,2,0,0\n", {"rate=2"}, {"'rate=2'", "rate = '2'", "annulus"});
  check_refused(at_rest + "rate = 2\n", discs, {}, {"case.txt:7", "rate = '2' does nothing with flow = none"});
  check_refused(shear, discs, {"stiv_vertices=64"}, {"without contact = stiv"});
  check_refused(shear + "stiv_gradient = frozen\n", discs, {}, {"case.txt:7", "without contact = stiv"});
  check_refused(shear + "contact = none\nmin_separation = 1\n", discs, {}, {"case.txt:8", "contact = none"});
  check_refused(shear, discs, {"field_points=10"}, {"without fields_at"});
  check_refused(shear, discs, {"adaptive=yes", "time_counting=accumulated"}, {"adaptive = yes"});
  CHECK(said(shear + "stiv_vertices = 0\nfield_points = 200\n", discs) == said(shear, discs));
  const std::string warning = said(shear + "min_separation = 1\n", discs, {"contact=none"});
  CHECK(contains(warning, "warning: case.txt:7: min_separation = '1' has no effect: argument 'contact=none'"));
}

TEST_CASE("degrees and steps too large for the flow are warned of, radians and usual steps are not") {
  CHECK(contains(said(shear, header + ".5,.5,-2,.5,0\n.5,.25,0,0,90\n"), "warning: theta = 90 of body 1"));
  CHECK_FALSE(contains(said(shear, header + ".5,.25,0,0,6.28\n"), "warning"));
  const std::string large = said(shear, header + ".5,.5,0,0,0\n", {"time_step=5", "end_time=10"});
  CHECK(contains(large, "warning: in a step of 5 the flow deforms by 5 (more than 0.5)"));
  CHECK_FALSE(contains(said(shear, discs, {"time_step=0.5"}), "warning"));
  CHECK(contains(said(annulus, header + ".3,.3,2,0,0\n"), "iterations"));
  CHECK(contains(said(annulus, header + ".3,.3,2,0,0\n", {"time_step=1", "end_time=1"}), "the flow deforms by 2.133"));
}

TEST_CASE("limits of vertices and of multipole sums are said") {
  check_refused(shear + "contact = stiv\n", discs, {"stiv_vertices=70000"}, {"above 65536"});
  check_refused(shear, discs, {"summation=fmm", "gmres_tolerance=1e-13"}, {"1e-12", "summation = direct"});
}

TEST_CASE("bodies far from the origin are as right as near it, or refused") {
  const auto velocity = [](double far) {
    const Workspace here(at_rest, concat("a,b,x,y,theta,force_x\n.5,.5,", far, ",0,0,1\n.5,.5,", far + 1.5, ",0,0,-1\n"));
    const ProgramRun run = here.run({"case.txt"});
    CAPTURE(run.errors);
    REQUIRE(run.status == 0);
    CHECK(here.results().step_column("contacts").front() == 0.0);
    return here.results().body_column(0, "ux").front();
  };
  const double near = velocity(0.0);
  for (const double far : {1e3, 1e6, 4e7}) {
    CAPTURE(far);
    CHECK(std::abs(velocity(far) / near - 1.0) < 100.0 * 1.1e-16 * far + 1e-9);
  }
  check_refused(at_rest, header + ".5,.5,1e10,0,0\n.5,.5,10000000002.5,0,0\n", {}, {"bodies.csv", "body 0", "1e+10"});
  check_refused(at_rest, header + ".5,.5,0,0,1e9\n", {}, {"body 0 has the angle 1e+09"});
  // A body that is carried away ends the run when it is too far.
  const Workspace here(case_text("extension", 16, 1, 40), header + ".5,.5,1,0,0\n");
  const ProgramRun run = here.run({"case.txt", "rate=9"});
  CAPTURE(run.errors);
  CHECK(run.status == 3);
  CHECK(contains(run.errors, "step 8, time 8: body 0 is 1e+08 away from the origin"));
}

TEST_CASE("strengths of any scale give the scaled motion, or are refused") {
  const auto moved = [](const std::string& text, const std::string& bodies, const std::vector<std::string>& arguments) {
    const Workspace here(text, bodies);
    std::vector<std::string> all = {"case.txt"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const ProgramRun run = here.run(all);
    CAPTURE(run.errors);
    REQUIRE(run.status == 0);
    return here.results().body_column(0, "uy").front();
  };
  const auto forced = [](double force) {
    return concat("a,b,x,y,theta,force_x,force_y\n.5,.5,0,0,0,", force, ",", force, "\n",
                  ".5,.5,1.2,.3,0,", -force, ",", -force, "\n");
  };
  const double by_flow = moved(shear, discs, {}), by_force = moved(at_rest, forced(1.0), {"contact=none"});
  REQUIRE(std::abs(by_flow) > 1e-4);
  for (const double scale : {1e-98, 1e-30, 1e30, 1e97}) {
    CAPTURE(scale);
    const std::vector<std::string> times = {concat("time_step=", 0.1 / scale), concat("end_time=", 0.2 / scale)};
    CHECK(std::abs(moved(shear, discs, {concat("rate=", scale), times[0], times[1]}) / scale / by_flow - 1.0) < 1e-7);
    CHECK(std::abs(moved(at_rest, forced(scale), {times[0], times[1], "contact=none"}) / scale / by_force - 1.0) < 1e-7);
  }
  for (const char* rate : {"1e155", "1e-200", "-1e120"}) check_refused(shear, discs, {concat("rate=", rate)}, {"rate = "});
  for (const double force : {1e160, 1e-165}) check_refused(at_rest, forced(force), {}, {"the force on body 0"});
  check_refused(at_rest, "a,b,x,y,theta,torque\n.5,.5,0,0,0,1e170\n", {}, {"the torque on body 0"});
  check_refused(annulus, "a,b,x,y,theta\n.3,.3,2,0,0\n", {"inner_angular_velocity=1e120"}, {"angular velocity"});
}
