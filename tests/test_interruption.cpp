// Causes of an early end of a run: signals, at any time, and checkpoints that cannot be written.
#include <doctest/doctest.h>

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "interruption.hpp"
#include "run.hpp"
#include "running_program.hpp"

using namespace stokes;

namespace {

namespace fs = std::filesystem;

const std::string discs = "a,b,x,y,theta\n.5,.5,-1.3,.25,0\n.5,.5,0,0,0.1\n";

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

double seconds_of(const std::function<void()>& action) {
  const auto begin = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// Rows of discs pressed together so closely that the contact problem of one step takes a minute with lcp_matrix = self.
Workspace long_step() {
  std::string bodies = "a,b,x,y,theta,force_x\n";
  for (int i = 0; i < 60; ++i) {
    const int force = i % 12 == 0 ? 50 : i % 12 == 11 ? -50 : 0;
    bodies += concat(".5,.5,", 1.02 * (i % 12), ",", 1.02 * (i / 12), ",0,", force, "\n");
  }
  return {case_text("none", 64, 0.5, 1, "lcp_matrix = self\nmin_separation_length = .01\n"), bodies};
}

}  // namespace

TEST_CASE("each signal leaves a checkpoint, from which the run goes on to the same bytes") {
  const Workspace here(case_text("shear", 64, 0.01, 10), discs);
  REQUIRE(here.run({"case.txt", "output=whole"}).status == 0);
  for (const int signal : {SIGHUP, SIGINT, SIGPIPE, SIGTERM}) {
    CAPTURE(signal);
    fs::remove_all(here.path() / "out");
    const ProgramRun run = stopped(here, signal, {"case.txt", "checkpoint_every=0"});
    CAPTURE(run.errors);
    CHECK(run.status == 128 + signal);
    CHECK(contains(run.errors, "; the same command goes on from out/checkpoint\n"));
    const ProgramRun rest = here.run({"case.txt"});
    CHECK(rest.status == 0);
    CHECK(contains(rest.errors, "going on from step "));
    for (const char* name : {"trajectory.csv", "steps.csv"})
      CHECK(content_of(here.path() / "out" / name) == content_of(here.path() / "whole" / name));
  }
}

TEST_CASE("a closed pipe leaves a checkpoint") {
  const Workspace here(case_text("shear", 16, 0.01, 100), discs);
  const std::string command = concat("cd ", shell_word(here.path().string()), " && ",
                                     shell_word(simulate_program().string()),
                                     " case.txt checkpoint_every=0 2>&1 | head -n 1 > first_line");
  REQUIRE(std::system(command.c_str()) == 0);
  CHECK(fs::exists(here.path() / "out/checkpoint"));
}

TEST_CASE("a signal ends a long step within seconds") {
  const Workspace here = long_step();
  for (const char* beginning : {"interrupted at step 0, time 0", "going on from step 0, time 0"}) {
    RunningProgram running(here, {"case.txt"});
    REQUIRE(running.wait() != 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    ProgramRun run{};
    const double seconds = seconds_of([&] { run = running.end_by(SIGTERM, [] { return true; }); });
    CAPTURE(run.errors);
    CHECK(run.status == 143);
    CHECK(contains(run.errors, beginning));
    CHECK(contains(run.errors, "interrupted at step 0, time 0; the same command goes on from out/checkpoint\n"));
    CHECK(seconds < 6.0);
  }
}

TEST_CASE("an interruption while a state is recorded is told with that state") {
  const Workspace here(case_text("shear", 16, 0.1, 1), discs);
  const Case c = read_case(here.path() / "case.txt");
  const Suspension bodies = read_suspension(c);
  SimulationOptions options = options_of(c, bodies);
  std::vector<std::pair<long, RunStage>> told;
  options.observe_state = [&](const RunState& state, RunStage stage) { told.push_back({state.step(), stage}); };
  const auto stop = [](const StepRecord& record) {
    if (record.step == 2) throw Interruption{SIGTERM};
  };
  CHECK_THROWS_AS(simulate(bodies, options, stop), Interruption);
  const std::vector<std::pair<long, RunStage>> expected = {
      {1, RunStage::under_way}, {2, RunStage::under_way}, {2, RunStage::interrupted}};
  CHECK(told == expected);
}

TEST_CASE("a checkpoint that cannot be written is a warning, and the run ends with its results") {
  const Workspace here(case_text("shear", 16, 0.1, 1), discs);
  fs::create_directories(here.path() / "out/checkpoint.tmp/in_the_way");
  const ProgramRun run = here.run({"case.txt", "checkpoint_every=1e-9"});
  CAPTURE(run.errors);
  CHECK(run.status == 0);
  CHECK(contains(run.errors, "warning: there is no checkpoint of step 1: out/checkpoint: cannot create the file"));
  CHECK(here.results().steps.rows.size() == 11);
}

TEST_CASE("a checkpoint that cannot be written hides neither a failure nor a signal") {
  const Workspace failing(case_text("shear", 32, 0.1, 1, "gmres_tolerance = 1e-17\n"), discs);
  fs::create_directories(failing.path() / "out/checkpoint.tmp/in_the_way");
  const ProgramRun failed = failing.run({"case.txt"});
  CAPTURE(failed.errors);
  CHECK(failed.status == 3);
  CHECK(contains(failed.errors, "simulate: step 0, time 0: GMRES"));
  const Workspace endless(case_text("shear", 16, 0.1, 1e6), discs);
  fs::create_directories(endless.path() / "out/checkpoint.tmp/in_the_way");
  const ProgramRun ended = stopped(endless, SIGTERM, {"case.txt"});
  CAPTURE(ended.errors);
  CHECK(ended.status == 143);
  CHECK(contains(ended.errors, "there is no checkpoint, so that the same command starts again"));
}

TEST_CASE("a second run in one process does not end by the signal of the first") {
  const Workspace here(case_text("shear", 16, 0.01, 1e3), discs);
  Case c = read_case(here.path() / "case.txt");
  c.output = (here.path() / "out").string();
  std::thread killer([&] {
    while (!fs::exists(here.path() / "out/steps.csv")) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    kill(getpid(), SIGHUP);
  });
  std::signal(SIGHUP, SIG_DFL);  // it is ignored where the tests run without a terminal
  int signal = 0;
  try {
    simulate_case(c);
  } catch (const Interruption& end) {
    signal = end.signal;
  }
  killer.join();
  CHECK(signal == SIGHUP);
  c.end_time = 0.05;
  c.overwrite = true;
  CHECK(simulate_case(c).steps == 5);
}
