// Folders that fill up or cannot be written: the run ends with a message, and no completed step is lost.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "program.hpp"
#include "recorder.hpp"

using namespace stokes;

namespace {

namespace fs = std::filesystem;

const std::string passing_discs = "a,b,x,y,theta\n.5,.5,-1.3,.25,0\n.5,.5,0,0,0\n";

std::string lines(const std::string& text, std::size_t count) {
  std::size_t end = 0;
  for (; count > 0; --count) end = text.find('\n', end) + 1;
  return text.substr(0, end);
}

// A run whose files may not exceed so many blocks of 512 bytes writes the beginning of the output of an undisturbed run:
// whole steps, the same in both tables. The same command without the limit completes it to the byte.
void check_limit(int blocks, const std::string& settings, std::size_t bodies) {
  const std::string text = case_text("shear", 16, 0.1, 4, concat("min_separation = 2\n", settings));
  const Workspace whole(text, passing_discs), here(text, passing_discs);
  REQUIRE(whole.run({"case.txt"}).status == 0);
  const ProgramRun stopped = here.run_limited(blocks, {"case.txt"});
  CAPTURE(stopped.errors);
  CHECK(stopped.status == 3);
  CHECK(stopped.errors.find("cannot write") != std::string::npos);
  CHECK(stopped.errors.find("complete up to here") != std::string::npos);

  const Results results = here.results();
  const std::size_t steps = results.steps.rows.size();
  REQUIRE(steps > 0);
  CHECK(results.trajectory.rows.size() == bodies * steps);
  for (const auto& [name, rows] : {std::pair("trajectory.csv", bodies * steps), std::pair("steps.csv", steps)})
    CHECK(content_of(here.path() / "out" / name) == lines(content_of(whole.path() / "out" / name), 1 + rows));

  CHECK(here.run({"case.txt"}).status == 0);
  for (const auto& entry : fs::recursive_directory_iterator(whole.path() / "out")) {
    if (!entry.is_regular_file()) continue;
    const fs::path name = fs::relative(entry.path(), whole.path());
    CHECK(content_of(here.path() / name) == content_of(entry.path()));
  }
  CHECK(!fs::exists(here.path() / "out/checkpoint"));
}

}  // namespace

TEST_CASE("a file that may not grow ends the run after a whole step, and the run can be completed") {
  for (const int blocks : {4, 5, 6, 8}) check_limit(blocks, "", 2);
  check_limit(6, "adaptive = yes\n", 2);
}

TEST_CASE("a picture that cannot be written ends the run after a whole step, too") {
  check_limit(8, "vtk = yes\n", 2);   // less than the first picture, of 6 kB
  check_limit(14, "vtk = yes\n", 2);  // enough for every picture, not for the tables
}

TEST_CASE("a row for which there is no room is a failure that says what to do") {
  if (!fs::exists("/dev/full")) return;
  CsvWriter writer("/dev/full", {"a"});
  writer.row(1.0);
  CHECK_THROWS_WITH_AS(writer.flush(), doctest::Contains("free some space"), NumericalError);
}

TEST_CASE("after a write error a table ends with its latest whole row") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "t.csv";
  CsvWriter writer(path, {"a", "b"});
  writer.row(1.0, 2.0);
  writer.flush();
  const std::uintmax_t whole = writer.bytes();
  writer.row(3.0, 4.0);
  writer.close_after(whole);
  CHECK(content_of(path) == "a,b\n1,2\n");
  CHECK_THROWS_AS(writer.row(3.0, 4.0), std::logic_error);
}
