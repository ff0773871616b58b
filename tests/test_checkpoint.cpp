// Runs that are interrupted and continued write the same bytes as uninterrupted ones.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "checkpoint.hpp"
#include "program.hpp"
#include "run.hpp"

using namespace stokes;

namespace {

namespace fs = std::filesystem;

const std::string passing_discs = "a,b,x,y,theta\n.5,.5,-1.3,.25,0\n.5,.5,0,0,0\n";
const std::string colliding = "a,b,x,y,theta,force_x\n1,.4,-2.5,0,.3,20\n.5,.5,0,.1,0,0\n.8,.5,2.5,0,-.2,-20\n";
const std::string squeezed = "a,b,x,y,theta,force_x\n.5,.5,-.504,0,0,1\n.5,.5,.504,0,0,-1\n";

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// The files of a run that has ended; there are no others.
std::map<std::string, std::string> files_of(const Workspace& here, const std::string& output) {
  return everything_in(here.path() / output);
}

// The same without the record, which names the folder and the command.
std::map<std::string, std::string> tables_of(const Workspace& here, const std::string& output) {
  std::map<std::string, std::string> files = files_of(here, output);
  for (const char* name : {"run.txt", "case.txt", "bodies.csv"}) CHECK(files.erase(name) == 1);
  return files;
}

// Every state between two steps, and the final record, of a run that may begin in one of them.
struct Course {
  std::vector<SavedRun> states;
  std::vector<double> record;  // all numbers that a recorder would write
  long contacts = 0;
};

Course course(const Suspension& bodies, SimulationOptions options, const std::optional<SavedRun>& start) {
  Course result;
  options.start = start;
  options.observe_state = [&](const RunState& state, RunStage) { result.states.push_back(state.save()); };
  simulate(bodies, options, [&](const StepRecord& r) {
    for (const double x : {static_cast<double>(r.step), r.time, r.min_gap}) result.record.push_back(x);
    for (const Body& body : r.bodies)
      for (const double x : {body.pose.centre.real(), body.pose.centre.imag(), body.pose.angle})
        result.record.push_back(x);
    if (!r.outcome) return;
    result.record.push_back(r.outcome->dt);
    result.contacts += static_cast<long>(r.outcome->contacts.size());
    for (const RigidVelocity& u : r.outcome->velocity)
      for (const double x : {u.velocity.real(), u.velocity.imag(), u.omega}) result.record.push_back(x);
    for (const Wrench& f : r.outcome->contact_wrench) result.record.push_back(f.force.real());
  });
  return result;
}

// From each state, written and read again, the run continues to the same end.
void check_every_restart(const std::vector<std::string>& settings, const std::string& rows, const std::string& more) {
  const Workspace here(case_text("shear", 32, 0.1, 2.5, more), rows);
  fs::create_directory(here.path() / "out");
  const Case c = read_case(here.path() / "case.txt", settings);
  Case written = c;
  written.output = (here.path() / "out").string();
  const Suspension bodies = read_suspension(c);
  const SimulationOptions options = options_of(c, bodies);
  const Course whole = course(bodies, options, {});
  REQUIRE(whole.states.size() > 10);
  REQUIRE(whole.contacts > 0);
  const CheckpointFile file(written, bodies);
  for (std::size_t k = 0; k < whole.states.size(); k += 3) {
    file.write({whole.states[k], RunStage::under_way, {}});
    const Course rest = course(bodies, options, file.read().value().run);
    CHECK(rest.states.size() == whole.states.size() - k - 1);
    REQUIRE(rest.record.size() < whole.record.size());
    CHECK(std::equal(rest.record.rbegin(), rest.record.rend(), whole.record.rbegin()));
  }
}

// Interrupts a run by each of the signals in turn, after random fractions of its total time, until it
// has continued from `interruptions` checkpoints; then it may end. Its results are those of an undisturbed run.
void check_interrupted(const Workspace& here, const std::vector<std::string>& signals, int interruptions,
                       const std::string& checkpoint_every) {
  const auto begin = std::chrono::steady_clock::now();
  const ProgramRun undisturbed = here.run({"case.txt", "output=whole"});
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  CAPTURE(undisturbed.errors);
  REQUIRE(undisturbed.status == 0);
  std::mt19937_64 random(9);
  int continued = 0;
  for (int attempt = 0; attempt < 100 && continued < interruptions; ++attempt) {
    const double part = 0.2 + 0.6 * static_cast<double>(random() >> 11) * 0x1p-53;
    const bool was_there = fs::exists(here.path() / "out" / "checkpoint");
    const ProgramRun run = here.run_until(part * seconds, signals[attempt % signals.size()],
                                          {"case.txt", concat("threads=", 1 + attempt % 2), checkpoint_every});
    CAPTURE(run.errors);
    const bool goes_on = contains(run.errors, "going on from step ");
    CHECK((was_there || !goes_on));
    CHECK((goes_on || !was_there || run.status == 137));  // or it was killed before it could say so
    continued += goes_on;
    if (run.status == 0) {
      CHECK(tables_of(here, "out") == tables_of(here, "whole"));
    } else {
      CHECK((run.status == 137 || run.status == 143 || run.status == 130));
    }
  }
  CHECK(continued == interruptions);
  CHECK(here.run({"case.txt"}).status == 0);
  CHECK(tables_of(here, "out") == tables_of(here, "whole"));
  CHECK(tables_of(here, "out").size() == 2);
}

// A folder with a run that was stopped before its end.
struct Stopped : Workspace {
  explicit Stopped(const std::string& signal = "TERM", int status = 143);
};

Stopped::Stopped(const std::string& signal, int status) : Workspace(case_text("shear", 16, 0.1, 1e7), passing_discs) {
  const Workspace& here = *this;
  ProgramRun run{};
  for (double seconds = 0.1; seconds < 20.0 && !contains(run.errors, "goes on"); seconds *= 2.0) {
    fs::remove_all(here.path() / "out");
    run = here.run_until(seconds, signal, {"case.txt"});
  }
  CAPTURE(run.errors);
  CHECK(run.status == status);
  CHECK(run.output == "");
  CHECK(contains(run.errors, "simulate: interrupted at step "));
  CHECK(contains(run.errors, "; the same command goes on from out/checkpoint\n"));
  CHECK(fs::exists(here.path() / "out" / "checkpoint"));
}

void check_refused(const Workspace& here, const std::vector<std::string>& arguments,
                   const std::vector<std::string>& parts) {
  const auto before = here.everything();
  const ProgramRun run = here.run(arguments);
  CAPTURE(run.errors);
  CHECK(run.status == 2);
  CHECK(std::count(run.errors.begin(), run.errors.end(), '\n') == 1);
  for (const std::string& part : parts) {
    CAPTURE(part);
    CHECK(contains(run.errors, part));
  }
  CHECK(here.everything() == before);
}

}  // namespace

TEST_CASE("a run goes on from any of its steps to the same bits") {
  check_every_restart({}, passing_discs, "min_separation_length = .3\nreverse_at = 1.7\n");
  check_every_restart({"adaptive=yes", "time_step=.3", "end_time=5"}, passing_discs, "min_separation_length = .3\n");
  check_every_restart({"coupling=local"}, passing_discs, "min_separation_length = .3\n");
  check_every_restart({"contact=stiv"}, passing_discs, "min_separation_length = .3\n");
  check_every_restart({"lcp_matrix=near", "refine=near"}, squeezed, "min_separation_length = .01\n");
  for (const char* integrator : {"ab2", "rk3", "midpoint"})
    check_every_restart({concat("integrator=", integrator)}, passing_discs,
                        "min_separation_length = .3\nreverse_at = 1.7\n");
  check_every_restart({"integrator=ab2", "lcp_matrix=near", "refine=near"}, squeezed, "min_separation_length = .01\n");
  check_every_restart({"integrator=rk3", "tolerance=1e-4", "time_step=.3", "end_time=5"}, passing_discs,
                      "min_separation_length = .3\nreverse_at = 1.7\n");
}

TEST_CASE("what rejected steps leave is kept") {
  const Workspace here(case_text("shear", 8, 0.5, 2, "adaptive = yes\n"), passing_discs);
  fs::create_directory(here.path() / "out");
  Case c = read_case(here.path() / "case.txt");
  c.output = (here.path() / "out").string();
  const Suspension bodies = read_suspension(c);
  // Step 5 at 1/4, the next of 1/48; two easy steps, four since the latest of seven rejections.
  StateWriter writer;
  writer.line("clock", 5, 0.25, 1.0 / 48.0, 2, 4, 7, 0);
  Stepper(bodies, options_of(c, bodies).stepper).save(writer);
  const CheckpointFile file(c, bodies);
  const double nan = std::nan("");
  file.write({{5, 0.25, writer.text()}, RunStage::under_way, {1234567890123, 99, {{1.0, nan}, {-0.0, 1e-310}}}});
  const Checkpoint read = file.read().value();
  CHECK(read.recorder.trajectory_bytes == 1234567890123);
  CHECK(read.recorder.steps_bytes == 99);
  REQUIRE(read.recorder.skipped.size() == 2);
  CHECK(std::isnan(read.recorder.skipped[0][1]));
  CHECK(std::signbit(read.recorder.skipped[1][0]));
  CHECK(read.recorder.skipped[1][1] == 1e-310);
  CHECK(read.run.step == 5);
  CHECK(read.run.time == 0.25);
  // One more easy step and two more since the rejection let the step grow by a half.
  SimulationOptions options = options_of(c, bodies);
  options.start = read.run;
  std::vector<double> steps;
  const RunSummary summary = simulate(bodies, options, [&](const StepRecord& r) {
    if (r.outcome) steps.push_back(r.outcome->dt);
    CHECK(r.step >= 5);
  });
  CHECK(summary.rejected == 7);
  REQUIRE(steps.size() > 3);
  CHECK(steps[0] == 1.0 / 48.0);
  CHECK(steps[1] == 1.0 / 48.0);
  CHECK(steps[2] == 1.5 / 48.0);
  CHECK(steps[3] == 1.5 / 48.0);
}

TEST_CASE("a run that is killed again and again ends with the bytes of an undisturbed one") {
  const std::string settings = "min_separation_length = .2\nreverse_at = 9\noutput_every = 7\n";
  const Workspace here(case_text("shear", 64, 0.02, 16, settings), passing_discs);
  check_interrupted(here, {"KILL"}, 4, "checkpoint_every=1e-9");
}

TEST_CASE("an adaptive run that is stopped by any signal ends with the bytes of an undisturbed one") {
  const Workspace here(case_text("none", 64, 0.05, 12, "min_separation_length = .05\nadaptive = yes\n"), colliding);
  check_interrupted(here, {"TERM", "KILL", "INT"}, 4, "checkpoint_every=0.01");
}

TEST_CASE("a run between walls that is killed ends with the bytes of an undisturbed one") {
  const Workspace here(
      "bodies = bodies.csv\ngeometry = annulus\ninner_radius = 1\nouter_radius = 4\nwall_points = 32\n"
      "outer_angular_velocity = 2\ninjection_rate = .5\nreverse_at = 0.7\npoints_per_body = 32\ntime_step = 0.02\n"
      "end_time = 1\nmin_separation_length = .35\noutput = out\n",
      "a,b,x,y,theta,fixed,force_y\n.5,.25,2.2,0,0,0,9\n.5,.25,2.4,.9,0,0,-9\n.3,.3,0,-2.5,0,1,0\n");
  check_interrupted(here, {"KILL", "TERM"}, 2, "checkpoint_every=1e-9");
  const std::vector<double> contacts = here.results().step_column("contacts");
  CHECK(*std::max_element(contacts.begin(), contacts.end() - 1) > 0.0);
}

TEST_CASE("a case of an experiment that is killed again and again ends with the bytes of an undisturbed one") {
  const fs::path program = simulate_program().parent_path() / "fig6_injection";
  const TemporaryFolder whole, parts;
  const auto begin = std::chrono::steady_clock::now();
  REQUIRE(run_program(program, {"case=quick"}, whole.path()).status == 0);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::mt19937_64 random(4);
  int continued = 0;
  for (int attempt = 0; attempt < 100 && continued < 2; ++attempt) {
    const double part = 0.1 + 0.4 * static_cast<double>(random() >> 11) * 0x1p-53;
    const ProgramRun run = run_program(program, {"case=quick", "checkpoint_every=1e-9"}, parts.path(),
                                       concat("timeout --preserve-status -s KILL ", part * seconds, " "));
    CAPTURE(run.errors);
    CHECK((run.status == 137 || run.status == 0));
    continued += contains(run.errors, "going on from step ");
  }
  CHECK(continued == 2);
  CHECK(run_program(program, {"case=quick"}, parts.path()).status == 0);
  CHECK(everything_in(parts.path()) == everything_in(whole.path()));
  CHECK(everything_in(whole.path()).size() == 10);  // seven files in three folders
}

TEST_CASE("a run that is killed before its first checkpoint starts again") {
  const Workspace here(case_text("shear", 64, 0.02, 6), passing_discs);
  CHECK(here.run({"case.txt", "output=whole"}).status == 0);
  here.run_until(0.06, "KILL", {"case.txt", "checkpoint_every=0"});
  CHECK_FALSE(fs::exists(here.path() / "out" / "checkpoint"));
  CHECK_FALSE(contains(here.run({"case.txt"}).errors, "going on"));
  CHECK(tables_of(here, "out") == tables_of(here, "whole"));
}

TEST_CASE("SIGTERM and SIGINT leave a checkpoint and say so") {
  const Stopped terminated("TERM", 143), interrupted("INT", 130);
}

TEST_CASE("an unfinished run of another case is refused with what differs, and nothing is changed") {
  const Stopped here;
  check_refused(here, {"case.txt", "time_step=.2"},
                {"out/checkpoint", "'time_step = 0.1'", "'time_step = 0.2'", "overwrite = yes"});
  check_refused(here, {"case.txt", "rate=-1"}, {"'rate = 1'", "'rate = -1'"});
  here.write("bodies.csv", passing_discs + ".5,.5,9,9,0\n");
  check_refused(here, {"case.txt"}, {"'body 2: 0.5 0.5 9 9 0 0 0 0'", "no further body"});
  here.write("bodies.csv", "a,b,x,y,theta\n.5,.5,-1.3,.25,0\n.5,.5,0,0,1e-300\n");
  check_refused(here, {"case.txt"}, {"'body 1: 0.5 0.5 0 0 0 0 0 0'", "'body 1: 0.5 0.5 0 0 1e-300 0 0 0'"});
  CHECK(here.run({"case.txt", "output=other", "end_time=1"}).status == 0);
  fs::remove(here.path() / "out" / "checkpoint");
  CHECK(here.run({"case.txt", "end_time=1", "overwrite=yes"}).status == 0);
}

TEST_CASE("a damaged checkpoint is refused") {
  const Stopped here;
  const std::string checkpoint = content_of(here.path() / "out" / "checkpoint");
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 20; ++trial) {
    std::string text = checkpoint;
    text[random() % text.size()] ^= 1;
    here.write("out/checkpoint", text);
    check_refused(here, {"case.txt"}, {"out/checkpoint", "damaged", "delete"});
  }
  for (const std::size_t size : {std::size_t{0}, checkpoint.size() / 2, checkpoint.size() - 1}) {
    here.write("out/checkpoint", checkpoint.substr(0, size));
    check_refused(here, {"case.txt"}, {"out/checkpoint", "damaged"});
  }
}

TEST_CASE("a run whose results do not fit its checkpoint starts again with a warning, to the same bytes") {
  const Workspace here(case_text("shear", 64, 0.02, 8), passing_discs);
  REQUIRE(here.run({"case.txt", "output=whole"}).status == 0);
  for (const char* name : {"trajectory.csv", "steps.csv"}) {
    const fs::path table = here.path() / "out" / name;
    for (const char* misfit : {"gone", "short", "other columns", "no row ends there"}) {
      CAPTURE(std::string(misfit));
      // Killed, so that its checkpoint is older than the tables.
      for (double seconds = 0.1; !fs::exists(here.path() / "out/checkpoint"); seconds *= 1.5) {
        REQUIRE(seconds < 20.0);
        here.run_until(seconds, "KILL", {"case.txt", "checkpoint_every=1e-9"});
      }
      const std::string text = content_of(table), why = misfit;
      if (why == "gone") fs::remove(table);
      if (why == "short") here.write(fs::path("out") / name, text.substr(0, 70));
      if (why == "other columns") here.write(fs::path("out") / name, "s" + text);
      if (why == "no row ends there") here.write(fs::path("out") / name, text.substr(0, text.find('\n') + 1) + text);
      const ProgramRun run = here.run({"case.txt"});
      CAPTURE(run.errors);
      CHECK(run.status == 0);
      CHECK(contains(run.errors, "warning: the results do not fit their checkpoint (out/"));
      CHECK(contains(run.errors, "starting from the beginning"));
      CHECK(tables_of(here, "out") == tables_of(here, "whole"));
    }
  }
}

TEST_CASE("a run that failed fails again in the same way, unless its case is changed") {
  const std::string towards = "a,b,x,y,theta,force_x\n.5,.5,-2,0,0,8\n.5,.5,2,0,0,-8\n";
  const Workspace overlapping(case_text("none", 32, 1, 20, "contact = none\noutput_every = 3\n"), towards);
  const Workspace unsolved(case_text("shear", 32, 0.1, 1, "gmres_tolerance = 1e-17\n"), passing_discs);
  for (const auto& [here, change] : {std::pair(&overlapping, "contact=gap"), {&unsolved, "gmres_tolerance=1e-8"}}) {
    const ProgramRun first = here->run({"case.txt"});
    CHECK(first.status == 3);
    const auto files = files_of(*here, "out");
    CHECK(files.contains("checkpoint"));
    const ProgramRun again = here->run({"case.txt"});
    CHECK(again.status == 3);
    CHECK(contains(again.errors, "going on from step "));
    CHECK(again.errors.ends_with(first.errors.substr(first.errors.rfind("simulate: step "))));
    CHECK(files_of(*here, "out") == files);
    const ProgramRun changed = here->run({"case.txt", change});
    CHECK(changed.status == 0);
    CHECK_FALSE(contains(changed.errors, "going on"));
    CHECK_FALSE(files_of(*here, "out").contains("checkpoint"));
  }
}

TEST_CASE("a finished run leaves no checkpoint, and is made anew by the same command") {
  const Workspace here(case_text("shear", 16, 0.1, 1, "checkpoint_every = 1e-9\n"), passing_discs);
  CHECK(here.run({"case.txt"}).status == 0);
  const auto files = here.everything();
  CHECK(tables_of(here, "out").size() == 2);
  const ProgramRun again = here.run({"case.txt"});
  CHECK(again.status == 0);
  CHECK_FALSE(contains(again.errors, "going on"));
  CHECK(here.everything() == files);
}
