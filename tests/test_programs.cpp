// Every program has a help text: those that `make test` builds, and all others that exist.
#include <doctest/doctest.h>

#include "program.hpp"

using namespace stokes;

namespace {

namespace fs = std::filesystem;

// Sources with a main(), by name.
std::vector<std::string> programs() {
  std::vector<std::string> names;
  for (const char* folder : {"src", "experiments", "tests"})
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".cpp" && content_of(entry.path()).find("\nint main(") != std::string::npos)
        if (entry.path().stem() != "main") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("--help of every program says how to use it and what it makes, and is no error") {
  const fs::path folder = simulate_program().parent_path();
  const TemporaryFolder elsewhere;
  int tried = 0;
  for (const std::string& name : programs()) {
    const bool is_needed = name == "simulate" || name == "verify" || name == "local_coupling" || name == "fig6_injection";
    CAPTURE(name);
    if (!is_needed && !fs::exists(folder / name)) continue;
    ++tried;
    for (const char* option : {"--help", "-h"}) {
      const ProgramRun run = run_program(folder / name, {option}, elsewhere.path());
      CHECK(run.status == 0);
      CHECK(run.errors == "");
      CHECK(run.output.starts_with(concat("usage: ", name, " ")));
      CHECK(std::count(run.output.begin(), run.output.end(), '\n') >= 3);
    }
  }
  CHECK(tried >= 4);
  CHECK(fs::is_empty(elsewhere.path()));
}

TEST_CASE("an experiment names its cases, and refuses others with the nearest one") {
  const fs::path program = simulate_program().parent_path() / "local_coupling";
  const TemporaryFolder elsewhere;
  const ProgramRun list = run_program(program, {"list"}, elsewhere.path());
  CHECK(list.status == 0);
  CHECK(contains(list.output, "rate2_global\n"));
  const ProgramRun help = run_program(program, {"--help"}, elsewhere.path());
  for (const std::string_view name : split(trim(list.output), '\n'))
    CHECK(contains(help.output, concat("\n  ", name, "\n")));
  CHECK(contains(help.output, "Section 4.1"));

  const ProgramRun nothing = run_program(program, {}, elsewhere.path());
  CHECK(nothing.status == 2);
  CHECK(nothing.output == "");
  CHECK(contains(nothing.errors, "usage: local_coupling case=NAME"));
  const ProgramRun wrong = run_program(program, {"case=rate2_globl"}, elsewhere.path());
  CHECK(wrong.status == 2);
  CHECK(contains(wrong.errors, "rate2_global"));
  CHECK(fs::is_empty(elsewhere.path()));
}

TEST_CASE("an experiment refuses a wrong interval of its checkpoints and writes nothing") {
  const fs::path program = simulate_program().parent_path() / "fig6_injection";
  for (const char* argument : {"checkpoint_every=often", "checkpoint_every=-1", "check_every=1"}) {
    CAPTURE(argument);
    const TemporaryFolder elsewhere;
    const ProgramRun run = run_program(program, {"case=quick", argument}, elsewhere.path());
    CHECK(run.status == 2);
    CHECK(contains(run.errors, argument));
    for (const auto& [name, content] : everything_in(elsewhere.path())) CHECK(content == "(not a file)");
  }
}
