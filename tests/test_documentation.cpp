// The commands in the pages work, and everything that the pages name exists.
#include <doctest/doctest.h>

#include <regex>
#include <set>

#include "case_keys.hpp"
#include "program.hpp"

using namespace stokes;

namespace {

namespace fs = std::filesystem;

struct Page {
  std::string name, text;
};

std::vector<Page> pages() {
  std::vector<Page> found;
  for (const char* folder : {".", "paper"})
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".md") found.push_back({entry.path().filename().string(), content_of(entry.path())});
  return found;
}

std::vector<std::string> matches(const std::string& text, const std::string& pattern, int group = 1) {
  const std::regex expression(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), expression), end; at != end; ++at) found.push_back(at->str(group));
  return found;
}

std::vector<std::string> words(const std::string& line) {
  std::vector<std::string> result;
  for (const std::string_view word : split(line, ' '))
    if (!trim(word).empty()) result.emplace_back(trim(word));
  return result;
}

// Lines of indented blocks, without their comments.
std::vector<std::string> commands(const std::string& page) {
  std::vector<std::string> lines;
  for (const std::string_view line : split(page, '\n')) {
    if (!line.starts_with("    ")) continue;
    const auto comment = line.find("   #");
    lines.emplace_back(trim(line.substr(0, comment)));
  }
  return lines;
}

std::vector<fs::path> example_cases() {
  std::vector<fs::path> cases;
  for (const auto& entry : fs::directory_iterator("experiments/cases"))
    if (entry.path().extension() == ".txt") cases.push_back(entry.path());
  std::sort(cases.begin(), cases.end());
  return cases;
}

std::string columns_of(const fs::path& table) {
  const std::string text = content_of(table);
  return text.substr(0, text.find('\n'));
}

// Runs two steps of a case, with the arguments that a page gives to simulate.
void check_runs(std::vector<std::string> arguments) {
  CAPTURE(join(arguments, " "));
  const TemporaryFolder folder;
  for (std::string& argument : arguments)
    if (argument.starts_with("start_from=")) {  // of a run of the same case, made here
      const std::string earlier = (folder.path() / "earlier").string();
      const std::string end = concat("end_time=", 2.0 * read_case(arguments[0]).time_step);
      REQUIRE(run_program(simulate_program(), {arguments[0], concat("output=", earlier), end}, ".").status == 0);
      argument = concat("start_from=", earlier);
    }
  std::vector<std::string> shortened = {fs::absolute(arguments[0]).string()};
  std::string step;
  for (std::size_t k = 1; k < arguments.size(); ++k) {
    if (arguments[k].starts_with("time_step=")) step = arguments[k].substr(10);
    if (!arguments[k].starts_with("end_time=")) shortened.push_back(arguments[k]);
  }
  const Case c = read_case(arguments[0], {arguments.begin() + 1, arguments.end()});
  shortened.push_back(concat("end_time=", c.start_time + 2.0 * c.time_step));
  const ProgramRun run = run_program(simulate_program(), shortened, folder.path());
  CAPTURE(run.errors);
  CHECK(run.status == 0);
  const Table steps = read_csv(folder.path() / c.output / "steps.csv");
  CHECK(steps.rows.size() == 3);
  for (const double gap : steps.numbers("min_gap")) CHECK(gap > 0.0);
}

}  // namespace

TEST_CASE("every case in experiments/cases runs") {
  const std::vector<fs::path> cases = example_cases();
  CHECK(cases.size() >= 5);
  for (const fs::path& file : cases) check_runs({file.string()});
}

TEST_CASE("the numbers that two of the cases promise come out") {
  const TemporaryFolder folder;
  const auto run = [&](const std::string& name) {
    const std::string output = concat("output=", (folder.path() / name).string());
    const ProgramRun result = run_program(simulate_program(), {concat("experiments/cases/", name, ".txt"), output}, ".");
    REQUIRE(result.status == 0);
    return read_csv(folder.path() / name / (name == "jeffery" ? "trajectory.csv" : "steps.csv"));
  };
  const Table orbit = run("jeffery");
  CHECK(std::abs(orbit.numbers("theta").back() + 2.0 * pi) < 1e-5);
  std::vector<double> omega = orbit.numbers("omega");
  omega.pop_back();  // of the final configuration
  CHECK(std::abs(*std::max_element(omega.begin(), omega.end()) + 0.1) < 1e-3);
  CHECK(std::abs(*std::min_element(omega.begin(), omega.end()) + 0.9) < 5e-3);  // rows are 0.2 apart
  const std::vector<double> gaps = run("passing").numbers("min_gap");
  CHECK(std::abs(*std::min_element(gaps.begin(), gaps.end()) - 0.1733) < 1e-4);
}

TEST_CASE("every documented command of simulate runs, and every case that a page names is there") {
  int tried = 0;
  for (const Page& page : pages()) {
    CAPTURE(page.name);
    for (const std::string& line : commands(page.text)) {
      if (!line.starts_with("build/simulate ")) continue;
      std::vector<std::string> arguments = words(line);
      arguments.erase(arguments.begin());
      check_runs(arguments);
      ++tried;
    }
  }
  CHECK(tried >= 3);
  const std::string readme = content_of("README.md");
  for (const fs::path& file : example_cases()) CHECK(readme.find(file.filename().string()) != std::string::npos);
}

TEST_CASE("every file that a page names is there") {
  const std::set<std::string> suffixes = {".cpp", ".hpp", ".csv", ".txt", ".md", ".sh"};
  for (const Page& page : pages()) {
    CAPTURE(page.name);
    for (const std::string& name : matches(page.text, "`((?:src|tests|experiments|paper|reference_data)/[^`]*)`")) {
      CAPTURE(name);
      if (name.find_first_of("*N") != std::string::npos && !name.ends_with(".md")) continue;  // a pattern, or NAME
      const bool is_program = fs::path(name).extension().empty() && fs::exists(name + ".cpp");
      CHECK((is_program || fs::exists(name)));
    }
    for (const std::string& name : matches(page.text, "\\]\\(([^):]*)\\)")) {
      CAPTURE(name);
      CHECK((fs::exists(name) || fs::exists(fs::path("paper") / name)));
    }
    for (const std::string& name : matches(page.text, "`((?:test|convergence|property)_[a-z_0-9]+)`")) {
      CAPTURE(name);
      CHECK(fs::exists(concat("tests/", name, ".cpp")));
    }
  }
}

TEST_CASE("the table of the README has every experiment and every table of reference values") {
  const std::string readme = content_of("README.md");
  for (const auto& entry : fs::directory_iterator("experiments")) {
    const std::string name = entry.path().stem().string();
    if (entry.path().extension() != ".cpp") continue;
    CAPTURE(name);
    CHECK(readme.find(concat("`experiments/", name, "`")) != std::string::npos);
  }
  for (const auto& entry : fs::directory_iterator("reference_data"))
    CHECK(readme.find(concat("`", entry.path().generic_string(), "`")) != std::string::npos);
}

TEST_CASE("every make target that a page names is one") {
  const std::string makefile = content_of("Makefile");
  std::set<std::string> targets;
  for (const std::string& line : matches(makefile, "\n([a-z][a-z0-9 _-]*):(?!=)"))
    for (const std::string& word : words(line)) targets.insert(word);
  for (const std::string& name : matches(makefile, "call experiment,([a-z0-9_]+)"))
    for (const char* cases : {"", "-quick", "-all"}) targets.insert(name + cases);
  for (const std::string& name : matches(makefile, "COUETTE_TABLES     = ([a-z0-9_ ]+)"))
    for (const std::string& word : words(name)) targets.insert(word);
  int tried = 0;
  for (const Page& page : pages()) {
    CAPTURE(page.name);
    std::vector<std::string> lines = commands(page.text);
    for (const std::string& inline_code : matches(page.text, "`(make [^`]*)`")) lines.push_back(inline_code);
    for (const std::string& line : lines) {
      if (!line.starts_with("make ")) continue;
      for (const std::string& word : words(line.substr(5))) {
        if (!std::regex_match(word, std::regex("[a-z][a-z0-9_-]*"))) continue;  // an option, a variable, NAME
        CAPTURE(word);
        CHECK(targets.contains(word));
        ++tried;
      }
    }
  }
  CHECK(tried > 10);
}

TEST_CASE("every key and every column that a page names is one") {
  std::set<std::string> keys;
  for (const CaseKey& key : case_keys()) keys.insert(key.name);
  const ProgramRun help = run_program(simulate_program(), {"--help"}, ".");
  for (const std::string& key : keys) CHECK(help.output.find(concat("\n  ", key, " ")) != std::string::npos);
  int tried = 0;
  for (const Page& page : pages()) {
    CAPTURE(page.name);
    for (const std::string& key : matches(page.text, "`([a-z_]+) ?= ?[^`]*`")) {
      CAPTURE(key);
      if (key == "key") continue;  // `key = value`
      CHECK(keys.contains(key));
      ++tried;
    }
  }
  CHECK(tried > 5);
  const TemporaryFolder folder;
  const std::string output = concat("output=", (folder.path() / "out").string());
  REQUIRE(run_program(simulate_program(), {"experiments/cases/couette.txt", "end_time=0.001", output}, ".").status == 0);
  const std::string columns =
      columns_of(folder.path() / "out/trajectory.csv") + "," + columns_of(folder.path() / "out/steps.csv") + ",";
  for (const char* column : {"min_gap", "contacts", "fx", "fy", "torque", "order_parameter", "effective_viscosity"})
    CHECK(columns.find(concat(column, ",")) != std::string::npos);
}

TEST_CASE("sources have fewer than 400 lines, and no line of code has more than 125 characters") {
  for (const char* folder : {"src", "experiments", "tests"})
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string kind = entry.path().extension().string(), file = entry.path().string();
      if (kind != ".cpp" && kind != ".hpp") continue;
      CAPTURE(file);
      const std::string text = content_of(entry.path());
      const auto lines = split(text, '\n');
      if (folder != std::string("tests")) CHECK(lines.size() < 400);
      for (const std::string_view line : lines) {
        CAPTURE(line);
        CHECK(line.size() <= 125);
      }
    }
}

TEST_CASE("the page on the structure lists every source once, and no header includes what stands behind it") {
  const std::string page = content_of("paper/ARCHITECTURE.md");
  std::map<std::string, int> layer;
  int rows = 0;
  for (const std::string_view line : split(page, '\n')) {
    if (!line.starts_with("| ") || line.starts_with("| layer")) continue;
    ++rows;
    for (const std::string& name : matches(std::string(line), "[`(, ]([a-z_]+)`")) {
      CAPTURE(name);
      CHECK(layer.emplace(name, rows).second);
    }
  }
  std::set<std::string> sources;
  for (const auto& entry : fs::directory_iterator("src")) sources.insert(entry.path().stem().string());
  for (const std::string& name : sources) {
    CAPTURE(name);
    CHECK(layer.contains(name));
    const fs::path header = concat("src/", name, ".hpp");
    if (!fs::exists(header)) continue;
    for (const std::string& other : matches(content_of(header), "#include \"([a-z_]+)\\.hpp\"")) {
      CAPTURE(other);
      CHECK(layer[other] <= layer[name]);
    }
  }
  for (const auto& [name, row] : layer) CHECK(sources.contains(name));
}
