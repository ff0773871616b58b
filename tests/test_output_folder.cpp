// The folder of a run: one run at a time, no results replaced by those of another case, and a record of the run.
#include <doctest/doctest.h>

#include <unistd.h>

#include <algorithm>
#include <csignal>

#include "output_folder.hpp"
#include "refusal.hpp"
#include "running_program.hpp"

using namespace stokes;

namespace {

namespace fs = std::filesystem;

const std::string discs = "a,b,x,y,theta\n.5,.5,-1.3,.25,0\n.5,.5,0,0,0.1\n";

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

void check_refused(const Workspace& here, const std::vector<std::string>& arguments,
                   const std::vector<std::string>& parts) {
  const auto before = here.everything();
  const ProgramRun run = here.run(arguments);
  CAPTURE(run.errors);
  CHECK(run.status == 2);
  for (const std::string& part : parts) {
    CAPTURE(part);
    CHECK(contains(run.errors, part));
  }
  CHECK(here.everything() == before);
}

}  // namespace

TEST_CASE("a second run into a folder is refused while the first is there, which ends undisturbed") {
  const Workspace here(case_text("shear", 16, 0.01, 1e6), discs);
  RunningProgram running(here, {"case.txt", "checkpoint_every=0"});
  REQUIRE(running.wait() != 0);
  const ProgramRun second = here.run({"case.txt", "end_time=0.1"});
  const ProgramRun first = running.end_by(SIGTERM, [] { return true; });
  CAPTURE(second.errors);
  CHECK(second.status == 2);
  CHECK(contains(second.errors, "'out' is in use: process "));
  CHECK(first.status == 143);
  const std::vector<double> step = here.results().step_column("step");
  for (std::size_t k = 0; k < step.size(); ++k) REQUIRE(step[k] == static_cast<double>(k));
  CHECK_FALSE(fs::exists(here.path() / "out/lock"));
}

TEST_CASE("a folder lock names its process, keeps a second one out and goes with its owner") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "out/lock";
  {
    const FolderLock lock(folder.path() / "out");
    CHECK(content_of(file).starts_with(concat("process ", getpid(), " on ")));
    const std::string why = refusal([&] { const FolderLock other(folder.path() / "out"); });
    CHECK(contains(why, concat("is in use: process ", getpid())));
    CHECK(fs::exists(file));
  }
  CHECK_FALSE(fs::exists(file));
  const FolderLock again(folder.path() / "out");
}

TEST_CASE("the lock of a killed run keeps nobody out") {
  const Workspace here(case_text("shear", 16, 0.01, 1e6), discs);
  CHECK(stopped(here, SIGKILL, {"case.txt", "checkpoint_every=1e-9"}).status == 137);
  CHECK(fs::exists(here.path() / "out/lock"));
  const ProgramRun next = stopped(here, SIGTERM, {"case.txt"});
  CHECK(next.status == 143);
  CHECK(contains(next.errors, "going on from step "));
}

TEST_CASE("results of another case are kept unless overwrite = yes, and the difference is named") {
  const Workspace here(case_text("shear", 16, 0.1, 0.3), discs);
  REQUIRE(here.run({"case.txt"}).status == 0);
  check_refused(here, {"case.txt", "rate=2"}, {"out: another run", "'rate = 1'", "'rate = 2'", "overwrite = yes"});
  REQUIRE(here.run({"case.txt"}).status == 0);  // the same one again
  here.write("bodies.csv", "a,b,x,y,theta\n.5,.5,-1.3,.25,0\n.5,.5,0,0,0.2\n");
  check_refused(here, {"case.txt"}, {"'bodies = 2 with checksum "});
  const ProgramRun replaced = here.run({"case.txt", "rate=2", "overwrite=yes"});
  CHECK(replaced.status == 0);
  CHECK(here.results().body_column(1, "theta").front() == 0.2);

  fs::remove(here.path() / "out/run.txt");
  check_refused(here, {"case.txt", "rate=2"}, {"out/trajectory.csv", "without a record", "overwrite = yes"});
}

TEST_CASE("an unfinished run of another case is replaced where it may be overwritten") {
  const Workspace here(case_text("shear", 16, 0.01, 1e6), discs);
  REQUIRE(stopped(here, SIGTERM, {"case.txt"}).status == 143);
  check_refused(here, {"case.txt", "time_step=.2"}, {"out/checkpoint", "overwrite = yes"});
  const ProgramRun same = stopped(here, SIGTERM, {"case.txt", "overwrite=yes"});
  CHECK(contains(same.errors, "going on from step "));
  const ProgramRun other = here.run({"case.txt", "overwrite=yes", "end_time=0.1"});
  CHECK(other.status == 0);
  CHECK_FALSE(contains(other.errors, "going on from step "));
  CHECK(here.results().steps.rows.size() == 11);
}

TEST_CASE("an overwritten run leaves no pictures and no fields, and what is the user's stays") {
  const Workspace here(case_text("shear", 16, 0.1, 0.3), discs);
  REQUIRE(here.run({"case.txt", "vtk=yes", "fields_at=0 0.2", "field_points=2"}).status == 0);
  CHECK(fs::exists(here.path() / "out/vtk/step_000000.vtk"));
  CHECK(fs::exists(here.path() / "out/fields_0.2.csv"));
  here.write("out/fields_of_wheat.csv", "mine");
  REQUIRE(here.run({"case.txt", "overwrite=yes"}).status == 0);
  CHECK_FALSE(fs::exists(here.path() / "out/vtk"));
  CHECK_FALSE(fs::exists(here.path() / "out/fields_0.csv"));
  CHECK_FALSE(fs::exists(here.path() / "out/fields_0.2.csv"));
  CHECK(fs::exists(here.path() / "out/fields_of_wheat.csv"));
}

TEST_CASE("a run records its program, command, case and bodies, and the record makes the same run") {
  const Workspace here(case_text("shear", 16, 0.1, 0.3, "min_separation = 2\n"), discs);
  REQUIRE(here.run({"case.txt", "rate=1.5", "fields_at=0 0.1"}).status == 0);
  const std::string record = content_of(here.path() / "out/run.txt");
  CAPTURE(record);
  CHECK(contains(record, "version = 0."));
  CHECK(contains(record, "compiler = "));
  CHECK(contains(record, "simulate case.txt rate=1.5 'fields_at=0 0.1'\n"));
  CHECK(contains(record, "\nrate = 1.5\n"));
  CHECK(contains(record, "\nadaptive = no\n"));
  const std::string trajectory = content_of(here.path() / "out/trajectory.csv");
  REQUIRE(here.run({"out/case.txt", "output=again"}).status == 0);
  CHECK(content_of(here.path() / "again/trajectory.csv") == trajectory);
  CHECK(content_of(here.path() / "again/bodies.csv") == content_of(here.path() / "out/bodies.csv"));
  // From its record, into its own folder: the record stays as it is.
  const auto before = here.everything();
  REQUIRE(here.run({"out/case.txt"}).status == 0);
  auto after = here.everything();
  CHECK(contains(after.at("out/run.txt"), "simulate out/case.txt\n"));
  after.at("out/run.txt") = before.at("out/run.txt");
  CHECK(after == before);
}

TEST_CASE("a case and bodies beside the results stay as the user wrote them, others are not replaced") {
  const std::string text = "# mine\n" + case_text("shear", 16, 0.1, 0.3);
  const Workspace here(text, "# mine, too\n" + discs);
  REQUIRE(here.run({"case.txt", "output=."}).status == 0);
  CHECK(content_of(here.path() / "case.txt") == text);
  CHECK(content_of(here.path() / "bodies.csv") == "# mine, too\n" + discs);
  const Workspace other(text, discs);
  other.write("first.txt", text);
  check_refused(other, {"first.txt", "output=."}, {"case.txt", "without a record"});
}
