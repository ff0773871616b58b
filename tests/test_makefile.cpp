// The makefiles on machines with less software than this one, and the output of the tests.
#include <doctest/doctest.h>

#include "program.hpp"

using namespace stokes;

namespace {

namespace fs = std::filesystem;

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// make ARGUMENTS here, after the shell has read `before`.
ProgramRun run_make(const std::vector<std::string>& arguments, const std::string& before) {
  return run_program("make", arguments, ".", "", concat("unset MAKEFLAGS; ", before));
}

bool is_installed(const std::string& program) {
  return std::system(concat("command -v ", program, " > /dev/null").c_str()) == 0;
}

}  // namespace

TEST_CASE("make deps without root and sudo says which packages to ask for, and how other systems call them") {
  const TemporaryFolder tools, build;
  const std::string fill = concat("cd ", shell_word(tools.path().string()),
                                  " && for tool in make sh grep seq mkdir cmp; do ln -s \"$(command -v $tool)\" .; done"
                                  " && printf '#!/bin/sh\\necho 1000\\n' > id && printf '#!/bin/sh\\nexit 1\\n' > apt-get"
                                  " && chmod +x id apt-get");
  REQUIRE(std::system(fill.c_str()) == 0);
  for (const char* target : {"deps", "deps-figures"}) {
    const ProgramRun run = run_make({target, "CXX=no-compiler", concat("BUILD=", build.path().string())},
                                    concat("export PATH=", shell_word(tools.path().string()), "; "));
    CAPTURE(run.errors);
    CHECK(run.status == 2);
    CHECK(contains(run.output, "Missing here: "));
    for (const char* line :
         {"\n  apt install ", "\n  dnf install ", "\n  brew install ", "\n  conda install ", "\n  module load "})
      CHECK(contains(run.errors, line));
    CHECK_FALSE(contains(run.errors, "not found"));
  }
}

TEST_CASE("figures are drawn without a locale in the environment") {
  if (!is_installed("gnuplot")) return;
  const TemporaryFolder folder;
  const ProgramRun run = run_make({"-f", "paper/Makefile", "fig1", concat("RESULTS=", folder.path().string())},
                                  "unset LANG LC_ALL LC_CTYPE; ");
  CAPTURE(run.errors);
  CHECK(run.status == 0);
  CHECK(fs::exists(folder.path() / "figures/fig1.pdf"));
}

TEST_CASE("a test that measures") { MESSAGE("as seen with VERBOSE=1 only"); }

#ifdef __linux__
TEST_CASE("the tests print a line for each file and the summary, and with VERBOSE=1 what they measure") {
  const fs::path tests = fs::read_symlink("/proc/self/exe");
  for (const bool verbose : {false, true}) {
    const ProgramRun run =
        run_program(tests, {"-tc=a test that measures"}, ".", "", verbose ? "export VERBOSE=1; " : "unset VERBOSE; ");
    CHECK(run.status == 0);
    CHECK(contains(run.output, "as seen with VERBOSE=1 only") == verbose);
    CHECK(run.output.ends_with("tests/test_makefile.cpp: 1 passed, 0 failed\n1 passed, 0 failed\n"));
    if (!verbose) CHECK(std::count(run.output.begin(), run.output.end(), '\n') == 2);
  }
}
#endif
