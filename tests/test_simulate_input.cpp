// The program's answers to input that it cannot use and to computations that cannot continue.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include "program.hpp"

using namespace stokes;

namespace {

const std::string complete_case = case_text("shear", 16, 0.1, 0.3);
const std::string two_discs = "a,b,x,y,theta\n.5,.5,-2,.5,0\n.5,.5,0,0,0\n";

Workspace workspace(const std::string& case_file = complete_case, const std::string& bodies = two_discs) {
  return {case_file, bodies};
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// Exit status 2, one paragraph with these parts on stderr, nothing on stdout, no file made or changed.
void check_refused(const Workspace& here, const std::vector<std::string>& arguments,
                   const std::vector<std::string>& parts) {
  const auto before = here.everything();
  const ProgramRun run = here.run(arguments);
  CAPTURE(join(arguments, " "));
  CAPTURE(run.errors);
  CHECK(run.status == 2);
  CHECK(run.output == "");
  CHECK(std::count(run.errors.begin(), run.errors.end(), '\n') == 1);
  CHECK(run.errors.ends_with("\n"));
  for (const std::string& part : parts) {
    CAPTURE(part);
    CHECK(contains(run.errors, part));
  }
  CHECK(here.everything() == before);
}

void check_refused_case(const std::string& case_file, const std::vector<std::string>& parts) {
  check_refused(workspace(case_file), {"case.txt"}, parts);
}

// A line after the six of a complete case.
void check_refused_line(const std::string& line, std::vector<std::string> parts) {
  parts.push_back("case.txt:7");
  check_refused_case(concat(complete_case, line, "\n"), parts);
}

void check_refused_bodies(const std::string& bodies, const std::vector<std::string>& parts) {
  check_refused(workspace(complete_case, bodies), {"case.txt"}, parts);
}

// A complete case with the line of one key replaced: the line number of that key, and what is there now.
void check_refused_value(const std::string& key, const std::string& value) {
  std::string text;
  int line = 0, found = 0;
  for (const std::string_view old : split(complete_case, '\n')) {
    if (old.empty()) continue;
    ++line;
    const bool replaced = old.starts_with(key + " ");
    if (replaced) found = line;
    text += replaced ? concat(key, " = ", value, "\n") : concat(old, "\n");
  }
  REQUIRE(found > 0);
  check_refused_case(text, {concat("case.txt:", found), key, value});
}

// Everything up to the failure is written, each row once: steps 0 to `last`, of which the last was not made.
void check_written_up_to(const Workspace& here, int last, int bodies) {
  const Results results = here.results();
  const std::vector<double> step = results.step_column("step"), dt = results.step_column("dt");
  REQUIRE(static_cast<int>(step.size()) == last + 1);
  for (int k = 0; k <= last; ++k) {
    CHECK(step[k] == k);
    CHECK(std::isnan(dt[k]) == (k == last));
  }
  CHECK(static_cast<int>(results.trajectory.rows.size()) == (last + 1) * bodies);
  for (int i = 0; i < bodies; ++i) {
    const std::vector<double> x = results.body_column(i, "x"), ux = results.body_column(i, "ux");
    REQUIRE(static_cast<int>(x.size()) == last + 1);
    CHECK(std::isfinite(x[last]));
    CHECK(std::isnan(ux[last]));
  }
}

std::string pushed_together(double force, double offset) {
  return concat("a,b,x,y,theta,force_x\n.5,.5,-2,0,0,", force, "\n.5,.5,2,", offset, ",0,", -force, "\n");
}

}  // namespace

TEST_CASE("the complete case of these tests is accepted") {
  const Workspace here = workspace();
  CHECK(here.run({"case.txt"}).status == 0);
  CHECK(here.everything().size() == 8);  // a case and bodies; a folder, two tables and three files of the record
}

TEST_CASE("a file that is missing is bad input") {
  check_refused(workspace(), {"casee.txt"}, {"casee.txt"});
  check_refused(workspace(), {"."}, {"folder"});
  check_refused(workspace(), {"case.txt", "bodies=other.csv"}, {"other.csv"});
  check_refused(workspace(), {"case.txt", "bodies=."}, {"folder"});
}

TEST_CASE("without arguments the program refuses and explains its use, and --help is not an error") {
  const Workspace here = workspace();
  const ProgramRun nothing = here.run({}), help = here.run({"--help"});
  CHECK(nothing.status == 2);
  CHECK(nothing.output == "");
  CHECK(contains(nothing.errors, "usage: simulate CASE.txt [key=value ...]"));
  CHECK(help.status == 0);
  CHECK(help.errors == "");
  for (const char* key : {"points_per_body", "min_separation_length", "time_counting", "force_x"})
    CHECK(contains(help.output, key));
}

TEST_CASE("an empty case or one that lacks a key is bad input") {
  check_refused_case("", {"case.txt:1", "empty", "bodies", "flow", "time_step", "end_time"});
  check_refused_case("\n# only words\n", {"case.txt:2", "empty"});
  for (const char* key : {"bodies", "flow", "time_step", "end_time", "output"}) {
    std::string text = complete_case;
    text.insert(text.find(concat(key, " =")), "# ");
    check_refused_case(text, {"case.txt:6", key});
  }
}

TEST_CASE("an unknown key is bad input, and the nearest known one is named") {
  check_refused_line("rat = 1", {"'rat'", "'rate'"});
  check_refused_line("min_seperation = 1", {"'min_separation'"});
  check_refused_line("reverseat = 1", {"'reverse_at'"});
  check_refused_line("Contact = gap", {"'contact'"});
  check_refused(workspace(), {"case.txt", "ouput=x"}, {"ouput=x", "'output'"});
  check_refused_line("rate 1", {"rate 1", "="});
}

TEST_CASE("a key given twice in the file is bad input, one replaced by an argument is not") {
  check_refused_line("flow = extension", {"flow", "twice", "case.txt:2"});
  const Workspace here = workspace();
  CHECK(here.run({"case.txt", "flow=extension"}).status == 0);
  CHECK(here.results().body_column(0, "uy").front() < -0.1);  // shear would give almost nothing
  check_refused(workspace(), {"case.txt", "rate=1", "rate=2"}, {"rate=2", "twice"});
}

TEST_CASE("a number that is malformed, not finite or out of range is bad input") {
  for (const char* value : {"fast", "1e", "0x1", "nan", "inf", "-inf", "1e999", "1,5", "1 2"})
    check_refused_line(concat("rate = ", value), {"rate", value});
  for (const char* key : {"time_step", "end_time"})
    for (const char* value : {"0", "-0.1", "-0", "nan"}) check_refused_value(key, value);
  for (const char* value : {"33", "6", "7", "0", "-32", "32.5"}) check_refused_value("points_per_body", value);
  for (const char* line :
       {"output_every = 0", "threads = 0", "gmres_tolerance = 0", "gmres_tolerance = 2", "min_separation = -1",
        "min_separation_length = -1", "adaptive = maybe", "contact = gab", "coupling = golbal",
        "near_singular = chauchy", "time_counting = exactly", "refine = far", "summation = slow",
        "fields_at = 0,1", "field_points = 1", "checkpoint_every = -1", "geometry = dics"})
    check_refused_line(line, {std::string(line).substr(0, std::string_view(line).find(' '))});
  check_refused_value("flow", "sheer");
  check_refused(workspace(), {"case.txt", "time_step=-1"}, {"time_step=-1"});
  check_refused_line("min_separation = 1\nmin_separation_length = 1", {"min_separation_length", "case.txt:8"});
}

TEST_CASE("a bodies' file that is empty, torn or has a wrong column is bad input") {
  const std::string header = "a,b,x,y,theta\n", one = "1,1,0,0,0\n";
  check_refused_bodies("", {"bodies.csv:1"});
  check_refused_bodies(header, {"bodies.csv:1", "no bodies"});
  check_refused_bodies(header + one + "1,1,9,0\n", {"bodies.csv:3", "too few", "4", "5"});
  check_refused_bodies(header + one + "1,1,9,0,0,0\n", {"bodies.csv:3", "too many", "6", "5"});
  check_refused_bodies("a,b,x,y\n1,1,0,0\n", {"bodies.csv:1", "theta"});
  check_refused_bodies("a,b,x,y,tetha\n" + one, {"bodies.csv:1", "'tetha'", "'theta'"});
  for (const char* value : {"nan", "inf", "", "one"})
    check_refused_bodies(concat(header, one, "1,1,", value, ",9,0\n"), {"bodies.csv:3", "'x'", value});
  for (const char* value : {"0", "-1"}) {
    check_refused_bodies(concat(header, one, value, ",1,9,9,0\n"), {"bodies.csv:3", " a ", value});
    check_refused_bodies(concat(header, one, "1,", value, ",9,9,0\n"), {"bodies.csv:3", " b ", value});
  }
}

TEST_CASE("fixed bodies and a net force are bad input in unbounded flow") {
  check_refused_bodies("a,b,x,y,theta,fixed\n1,1,0,0,0,0\n1,1,9,0,0,1\n",
                       {"bodies.csv:3", "fixed", "unbounded"});
  check_refused_bodies("a,b,x,y,theta,force_x\n1,1,0,0,0,1\n1,1,9,0,0,-.5\n",
                       {"bodies.csv:", "0.5", "unbounded"});
  check_refused_bodies("a,b,x,y,theta,force_y\n1,1,0,0,0,1\n", {"bodies.csv:", "unbounded"});
}

TEST_CASE("an annulus that cannot be, or that the bodies do not fit in, is bad input") {
  const std::string annulus =
      "bodies = bodies.csv\ngeometry = annulus\ninner_radius = 1\nouter_radius = 4\npoints_per_body = 16\n"
      "time_step = 0.1\nend_time = 0.3\noutput = out\n";
  const std::string header = "a,b,x,y,theta,fixed\n";
  const auto refused = [&](const std::string& bodies, const std::string& argument,
                           const std::vector<std::string>& parts) {
    check_refused(workspace(annulus, header + bodies), {"case.txt", argument}, parts);
  };
  const std::string inside = ".5,.5,2,0,0,0\n";
  refused(inside, "inner_radius=0", {"'inner_radius=0'", "greater than 0"});
  refused(inside, "inner_radius=4.5", {"case.txt:4", "outer_radius = '4'", "inner_radius = 4.5"});
  refused(inside, "wall_points=15", {"wall_points = '15'", "16"});
  refused(inside, "flow=shear", {"flow = 'shear'", "annulus"});
  refused(inside, "fields_at=1", {"fields_at = '1'", "0.3"});
  refused(inside, "geometry=unbounded", {"case.txt:8", "flow"});
  refused(inside + ".5,.5,-3.75,0,0,0\n", "threads=1", {"bodies.csv:3", "body 1", "0.25", "outer wall of radius 4"});
  refused(inside + ".5,.5,-1.25,0,0,1\n", "threads=1", {"bodies.csv:3", "body 1", "0.25", "inner wall of radius 1"});
  refused(inside + ".5,.5,2.5,0,0,1\n", "threads=1", {"bodies.csv:3", "bodies 0 and 1", "overlap by 0.5"});
  check_refused_line("outer_radius = 3", {"outer_radius", "geometry = annulus"});
}

TEST_CASE("bodies that overlap at the start are bad input with both of them, the depth and the line") {
  const auto overlapping = [](const std::string& third, const std::vector<std::string>& numbers) {
    const Workspace here = workspace(complete_case, "a,b,x,y,theta\n1,1,-9,0,0\n1,.5,0,0,0\n" + third + "\n");
    std::vector<std::string> parts = {"bodies.csv:", "1 and 2", "overlap"};
    parts.insert(parts.end(), numbers.begin(), numbers.end());
    check_refused(here, {"case.txt"}, parts);
    check_refused(here, {"case.txt", "contact=none"}, parts);
    const std::string errors = here.run({"case.txt"}).errors;
    CHECK_MESSAGE(std::regex_search(errors, std::regex("bodies\\.csv:[34]")), errors);
  };
  overlapping("1,1,1.75,0,0", {"0.25"});
  overlapping("1,.5,0,.875,0", {"0.125"});
  overlapping(".125,.125,0,0,0", {"0.625"});  // inside: the shortest way out
  overlapping("1,.5,0,0,0", {"1"});           // coincident
  overlapping("8,8,0,0,0", {"8.5"});          // around
}

TEST_CASE("an output folder that cannot be written is bad input, and leaves what is there alone") {
  const std::string old = "step,old\n0,1\n";
  Workspace here = workspace();
  here.write("taken", "a file");
  check_refused(here, {"case.txt", "output=taken"}, {"taken"});
  check_refused(here, {"case.txt", "output=taken/below"}, {"taken"});
  for (const auto& [blocked, other] :
       {std::pair("steps.csv", "trajectory.csv"), {"trajectory.csv", "steps.csv"}}) {
    std::filesystem::create_directories(here.path() / blocked / blocked);
    check_refused(here, {"case.txt", concat("output=", blocked)}, {blocked});  // nothing made
    here.write(std::filesystem::path(blocked) / other, old);
    check_refused(here, {"case.txt", concat("output=", blocked)}, {blocked});  // nothing changed
  }
  const Workspace in_file = workspace(case_text("shear", 16, 0.1, 0.3, "threads = 1\n"));
  in_file.write("out", "a file");
  check_refused(in_file, {"case.txt"}, {"case.txt:6", "out"});
}

TEST_CASE("numbers too large to compute with are bad input, before anything is written") {
  check_refused_bodies("a,b,x,y,theta\n1e160,1e160,0,0,0\n", {"bodies.csv"});
  check_refused_bodies("a,b,x,y,theta\n1,1,1e200,0,0\n1,1,0,0,0\n", {"bodies.csv"});
}

TEST_CASE("bodies that overlap without a contact model end the run with step, time and bodies") {
  const Workspace here = workspace(case_text("none", 32, 1, 20, "contact = none\n"), pushed_together(8, 0));
  const ProgramRun run = here.run({"case.txt"});
  CHECK(run.status == 3);
  const Results results = here.results();
  const int last = static_cast<int>(results.steps.rows.size()) - 1;
  CHECK(last == 2);
  check_written_up_to(here, last, 2);
  const double depth = -results.step_column("min_gap").back();
  CHECK(depth > 0.0);
  CAPTURE(run.errors);
  CHECK(contains(run.errors, "step 2, time 2: "));
  CHECK(contains(run.errors, concat("bodies 0 and 1 overlap by ", brief(depth))));
  CHECK(here.run({"case.txt", "contact=gap"}).status == 0);
}

TEST_CASE("an unsolved contact problem ends the run with step, time, bodies and cause, rows written once") {
  // So large a step takes the discs past each other, where their contact force would pull them back.
  const Workspace here = workspace(case_text("none", 64, 1, 3, "min_separation_length = .02\n"),
                                   pushed_together(100, 0.3));
  const ProgramRun run = here.run({"case.txt"});
  CHECK(run.status == 3);
  check_written_up_to(here, 0, 2);
  CAPTURE(run.errors);
  CHECK(contains(run.errors, "step 0, time 0: "));
  CHECK_FALSE(contains(run.errors, "step 0, time 0: step 0, time 0: "));
  CHECK(contains(run.errors, "bodies 0 and 1"));
  CHECK(contains(run.errors, "adaptive"));
  CHECK(here.run({"case.txt", "adaptive=yes"}).status == 0);
}

TEST_CASE("an unsolved Stokes problem ends the run with step, time and cause") {
  const Workspace here = workspace(case_text("shear", 32, 0.1, 1, "gmres_tolerance = 1e-17\n"));
  const ProgramRun run = here.run({"case.txt"});
  CHECK(run.status == 3);
  check_written_up_to(here, 0, 2);
  CAPTURE(run.errors);
  CHECK(contains(run.errors, "step 0, time 0: GMRES"));
  CHECK(contains(run.errors, "1e-17"));
}

TEST_CASE("positions beyond all bounds end the run as a numerical failure, with every row written") {
  const std::string one = "a,b,x,y,theta\n1,1,0,1e3,0\n", two = one + "1,1,0,0,0\n";
  for (const std::string& bodies : {one, two})
    for (const char* contact : {"contact=none", "contact=gap"}) {
      const Workspace here = workspace(case_text("extension", 16, 1, 4), bodies);
      const ProgramRun run = here.run({"case.txt", "rate=1e50", contact});
      CAPTURE(std::string(contact));
      CAPTURE(run.errors);
      CHECK(run.status == 3);
      // With two bodies and contact it is the first step that finds no contact forces.
      if (bodies == two && std::string(contact) == "contact=gap")
        CHECK((contains(run.errors, "simulate: step 0, time 0: contact") ||
               contains(run.errors, "simulate: step 0, time 0: the contact force between bodies 0 and 1")));
      else
        CHECK(contains(run.errors, "simulate: step 1, time 1: "));
      const Results results = here.results();
      CHECK(std::isnan(results.step_column("dt").back()));
      CHECK(std::isnan(results.body_column(0, "ux").back()));
    }
}

TEST_CASE("adaptive steps that would have to be too small end the run with the limit and the smallest step") {
  const Workspace here = workspace(case_text("shear", 16, 1, 2, "adaptive = yes\n"));
  const ProgramRun run = here.run_until(20.0, "KILL", {"case.txt", "rate=1e8"});
  CAPTURE(run.errors);
  CHECK(run.status == 3);
  check_written_up_to(here, 0, 2);
  CHECK(contains(run.errors, "step 0, time 0: bodies turn by 0.2 or close half a width in "));
  CHECK(contains(run.errors, "below the smallest step of 1e-06; try a smaller time_step"));
}
