// The numbers of the report: as LaTeX, and as the document requests them.
#include <doctest/doctest.h>

#include <cmath>

#include "program.hpp"
#include "report_inputs.hpp"

using namespace stokes;
namespace fs = std::filesystem;

namespace {

// A folder of results with one experiment, and one of reference values.
class ReportFolder {
 public:
  ReportFolder() {
    for (const char* name : {"results/run", "reference"}) fs::create_directories(path(name));
    write("reference/run.csv", "id,value,source\nr-one,0.0200,paper_table\n");
    write("results/run/first.csv", "# version: 1\nsteps,error\n12,0.00123\n");
    write("results/run/table.csv", "phi,lambda,mean\n5,3,1.5\n10,3,nan\n");
  }
  fs::path path(const std::string& name) const { return folder_.path() / name; }
  void write(const std::string& name, const std::string& text) const { write_file_atomically(path(name), text); }
  Inputs inputs() const { return {path("results"), path("reference")}; }

 private:
  TemporaryFolder folder_;
};

}  // namespace

TEST_CASE("text keeps its meaning in LaTeX") {
  CHECK(tex_text("50 % of a_b & {x} #1 $2") == "50 \\% of a\\_b \\& \\{x\\} \\#1 \\$2");
  CHECK(tex_text("\\a^b~c<d") == "\\textbackslash{}a\\textasciicircum{}b\\textasciitilde{}c$<$d");
  CHECK(tex_prose("eta over rho^4, a beta in `a_b/pi.hpp`") ==
        "$\\eta$ over $\\rho$$^{4}$, a beta in \\texttt{a\\_b/pi.hpp}");
  CHECK(tex_prose("\"pi\" and sigma_S, but dt_max") == "``$\\pi$'' and $\\sigma$$_{S}$, but dt\\_max");
  CHECK(tex_prose("`open") == "\\texttt{open}");
}

TEST_CASE("numbers are written with the digits asked for") {
  CHECK(tex_number(0.13519, "4f") == "$0.1352$");
  CHECK(tex_number(-0.00123, "1e") == "$-1.2\\times10^{-3}$");
  CHECK(tex_number(1e-14, "2g") == "$1\\times10^{-14}$");
  CHECK(tex_number(30.0, "0f") == "$30$");
  CHECK(tex_decimal("4.80e-4") == "$4.80\\times10^{-4}$");
  CHECK(tex_number(std::nan(""), "2f") == "--");
  CHECK(tex_number(-HUGE_VAL, "2f") == "$-\\infty$");
  for (const char* format : {"", "f", "10f", "2x", "%2f"}) CHECK_THROWS_AS(tex_number(1.0, format), InputError);
}

TEST_CASE("requests are found once each, not in comments nor in definitions") {
  const std::string document =
      "\\newcommand{\\result}[3]{x}\n% \\result{no}{no}{0f}\nis \\result{a/b}{c}{2f}, \\result{a/d}{c}{2f} % "
      "\\result{no}{no}{0f}\n"
      "5\\,\\% & \\result{a/e}{c}{2f} \\% % \\result{no}{no}{0f}\n"
      "\\newcommand{\\again}[1]{\\result{#1}{c}{2f}} \\result{a/b}{c}{2f}\n\\resultant{x}{y}{z}";
  const auto requests = requests_in(document, "result", 3);
  REQUIRE(requests.size() == 3);
  CHECK(requests[2] == std::vector<std::string>{"a/e", "c", "2f"});
  CHECK(requests[0] == std::vector<std::string>{"a/b", "c", "2f"});
  CHECK(requests[1] == std::vector<std::string>{"a/d", "c", "2f"});
  CHECK_THROWS_AS(requests_in("\\result{a/b}{c}\n{2f}", "result", 3), InputError);
}

TEST_CASE("a number comes from the first row, or from the one that is named") {
  const ReportFolder here;
  Inputs inputs = here.inputs();
  CHECK(inputs.tex("run/first", "error", "2e") == "$1.23\\times10^{-3}$");
  CHECK(inputs.number("run/table[phi=5,lambda=3]", "mean") == 1.5);
  CHECK(inputs.tex("run/table[phi=10]", "mean", "1f") == "--");
  CHECK(inputs.published("r-one") == "$0.0200$");
  CHECK(inputs.problems().empty());
  CHECK_THROWS_AS(inputs.number("run/table[phi]", "mean"), InputError);
}

TEST_CASE("what is missing is told, each thing once") {
  const ReportFolder here;
  Inputs inputs = here.inputs();
  CHECK(inputs.tex("run/second", "error", "2f") == missing_mark);
  CHECK(inputs.tex("run/second", "steps", "2f") == missing_mark);
  CHECK(inputs.problems().size() == 1);
  CHECK(inputs.tex("run/first", "residual", "2f") == missing_mark);
  CHECK(inputs.tex("run/table[phi=15,lambda=3]", "mean", "2f") == missing_mark);
  CHECK(inputs.published("r-two") == missing_mark);
  CHECK(inputs.problems().size() == 4);
  CHECK_THROWS_AS(Inputs(here.path("results"), here.path("nothing")), InputError);
}

TEST_CASE("a table that is older than a case it was collected from is told") {
  const ReportFolder here;
  fs::last_write_time(here.path("results/run/table.csv"),
                      fs::last_write_time(here.path("results/run/first.csv")) - std::chrono::seconds(5));
  Inputs inputs = here.inputs();
  CHECK(inputs.number("run/table[phi=5]", "mean") == 1.5);
  REQUIRE(inputs.problems().size() == 1);
  CHECK(inputs.problems().begin()->find("older") != std::string::npos);
  Inputs cases = here.inputs();
  CHECK(cases.number("run/first", "steps") == 12.0);
  CHECK(cases.problems().empty());
}
