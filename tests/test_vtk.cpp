// The pictures of a run: every number of a file, and the set of files.
#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "program.hpp"
#include "shape.hpp"

using namespace stokes;

namespace {

namespace fs = std::filesystem;

const std::string bodies = "a,b,x,y,theta\n.6,.3,-1.4,.25,.4\n.5,.5,0,0,0\n";

// Reads a legacy VTK file line by line, with blocks of numbers in between.
class VtkReader {
 public:
  explicit VtkReader(const fs::path& file) : text_(content_of(file)) {}

  std::string line() {
    const std::size_t end = text_.find('\n', at_);
    REQUIRE(end != std::string::npos);
    const std::string result = text_.substr(at_, end - at_);
    at_ = end + 1;
    return result;
  }
  std::vector<double> doubles(std::size_t count) { return block<double, std::uint64_t>(count); }
  std::vector<std::int32_t> integers(std::size_t count) { return block<std::int32_t, std::uint32_t>(count); }
  bool at_end() const { return at_ == text_.size(); }

 private:
  template <class Number, class Bits>
  std::vector<Number> block(std::size_t count) {
    REQUIRE(at_ + count * sizeof(Bits) < text_.size());
    std::vector<Number> numbers;
    for (std::size_t k = 0; k < count; ++k) {
      Bits bits = 0;
      for (std::size_t byte = 0; byte < sizeof(Bits); ++byte) bits = (bits << 8) | static_cast<unsigned char>(text_[at_++]);
      numbers.push_back(std::bit_cast<Number>(bits));
    }
    REQUIRE(text_[at_++] == '\n');
    return numbers;
  }

  std::string text_;
  std::size_t at_ = 0;
};

std::vector<std::string> files_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string shear_case(const std::string& settings) {
  return case_text("shear", 16, 0.1, 1.2, concat("min_separation = 2\nvtk = yes\n", settings));
}

}  // namespace

TEST_CASE("a picture holds the outlines and the numbers of trajectory.csv, bit for bit") {
  const Workspace here(shear_case(""), bodies);
  REQUIRE(here.run({"case.txt"}).status == 0);
  const Results results = here.results();
  REQUIRE(results.body_column(0, "fx")[9] != 0.0);  // in contact
  constexpr int corners = 96;
  VtkReader file(here.path() / "out/vtk/step_000009.vtk");
  CHECK(file.line() == "# vtk DataFile Version 3.0");
  CHECK(file.line() == concat("step 9, time ", results.step_column("time")[9]));
  for (const char* expected : {"BINARY", "DATASET POLYDATA", "FIELD FieldData 1", "TIME 1 1 double"})
    CHECK(file.line() == expected);
  CHECK(file.doubles(1)[0] == results.step_column("time")[9]);
  CHECK(file.line() == "POINTS 192 double");
  const std::vector<double> points = file.doubles(3 * 2 * corners);
  const Shape shapes[] = {{.6, .3}, {.5, .5}};
  for (int k = 0; k < 2 * corners; ++k) {
    const int body = k / corners;
    const Complex centre(results.body_column(body, "x")[9], results.body_column(body, "y")[9]);
    const Complex corner(points[3 * k], points[3 * k + 1]);
    const Complex z = std::polar(1.0, -results.body_column(body, "theta")[9]) * (corner - centre);
    CHECK(std::abs(std::hypot(z.real() / shapes[body].a, z.imag() / shapes[body].b) - 1.0) < 1e-14);
    CHECK(points[3 * k + 2] == 0.0);
  }
  CHECK(file.line() == "POLYGONS 2 194");
  const std::vector<std::int32_t> polygons = file.integers(194);
  for (int body = 0; body < 2; ++body) {
    CHECK(polygons[97 * body] == corners);
    for (int k = 0; k < corners; ++k) CHECK(polygons[97 * body + 1 + k] == corners * body + k);
  }
  CHECK(file.line() == "CELL_DATA 2");
  CHECK(file.line() == "FIELD FieldData 6");
  CHECK(file.line() == "body 1 2 int");
  CHECK(file.integers(2) == std::vector<std::int32_t>{0, 1});
  CHECK(file.line() == "fixed 1 2 int");
  CHECK(file.integers(2) == std::vector<std::int32_t>{0, 0});
  const auto check = [&](const std::string& header, int components, const std::vector<std::string>& columns) {
    CHECK(file.line() == header);
    const std::vector<double> values = file.doubles(2 * components);
    for (int body = 0; body < 2; ++body)
      for (std::size_t k = 0; k < columns.size(); ++k)
        CHECK(values[components * body + k] == results.body_column(body, columns[k])[9]);
  };
  check("velocity 3 2 double", 3, {"ux", "uy"});
  check("omega 1 2 double", 1, {"omega"});
  check("contact_force 3 2 double", 3, {"fx", "fy"});
  check("contact_torque 1 2 double", 1, {"torque"});
  CHECK(file.at_end());
}

TEST_CASE("there is a picture of every output_every-th step and of the end, and none of an earlier run") {
  const Workspace here(shear_case("output_every = 5\n"), bodies);
  REQUIRE(here.run({"case.txt", "end_time=3"}).status == 0);
  CHECK(files_in(here.path() / "out/vtk").size() == 7);
  here.write("out/vtk/notes.txt", "mine");
  REQUIRE(here.run({"case.txt", "overwrite=yes"}).status == 0);
  const std::vector<std::string> expected = {"notes.txt", "step_000000.vtk", "step_000005.vtk", "step_000010.vtk",
                                             "step_000012.vtk"};
  CHECK(files_in(here.path() / "out/vtk") == expected);
  CHECK(content_of(here.path() / "out/vtk/step_000012.vtk").find("step 12, time 1.2\n") != std::string::npos);
}

TEST_CASE("a series names the pictures with their times, also those before an interruption, and goes with an earlier run") {
  const Workspace here(shear_case("output_every = 5\n"), bodies);
  REQUIRE(here.run({"case.txt"}).status == 0);
  const std::string expected =
      "{\"file-series-version\": \"1.0\", \"files\": [\n{\"name\": \"vtk/step_000000.vtk\", \"time\": 0},\n"
      "{\"name\": \"vtk/step_000005.vtk\", \"time\": 0.5},\n{\"name\": \"vtk/step_000010.vtk\", \"time\": 1},\n"
      "{\"name\": \"vtk/step_000012.vtk\", \"time\": 1.2}\n]}\n";
  CHECK(content_of(here.path() / "out/run.vtk.series") == expected);
  REQUIRE(here.run({"case.txt", "vtk=no", "overwrite=yes"}).status == 0);
  CHECK_FALSE(fs::exists(here.path() / "out/run.vtk.series"));
}

TEST_CASE("the container is a closed line before the bodies, the inner wall the last polygon, held in place") {
  const Workspace here("bodies = bodies.csv\ngeometry = annulus\ninner_radius = 1\nouter_radius = 3\nwall_points = 64\n"
                       "outer_angular_velocity = .5\npoints_per_body = 16\ntime_step = .1\nend_time = .1\noutput = out\n"
                       "vtk = yes\n",
                       "a,b,x,y,theta\n.3,.2,2,0,0\n");
  REQUIRE(here.run({"case.txt"}).status == 0);
  VtkReader file(here.path() / "out/vtk/step_000000.vtk");
  while (file.line() != "TIME 1 1 double") {}
  file.doubles(1);
  CHECK(file.line() == "POINTS 576 double");
  const std::vector<double> points = file.doubles(3 * 576);
  for (int k = 0; k < 384; ++k) CHECK(std::abs(std::hypot(points[3 * k], points[3 * k + 1]) - 3.0) < 1e-14);
  for (int k = 480; k < 576; ++k) CHECK(std::abs(std::hypot(points[3 * k], points[3 * k + 1]) - 1.0) < 1e-14);
  CHECK(file.line() == "LINES 1 386");
  const std::vector<std::int32_t> line = file.integers(386);
  CHECK(line[0] == 385);
  CHECK(line[385] == line[1]);
  CHECK(file.line() == "POLYGONS 2 194");
  file.integers(194);
  CHECK(file.line() == "CELL_DATA 3");
  file.line(), file.line();
  CHECK(file.integers(3) == std::vector<std::int32_t>{-1, 0, 1});
  file.line();
  CHECK(file.integers(3) == std::vector<std::int32_t>{1, 0, 1});
}

TEST_CASE("a run that is stopped and goes on ends with the pictures of an undisturbed one") {
  const std::string text = shear_case("time_counting = accumulated\n");
  const Workspace whole(text, bodies), here(text, bodies);
  const std::vector<std::string> arguments = {"case.txt", "points_per_body=64", "end_time=8", "time_step=.01",
                                              "output_every=7"};
  REQUIRE(whole.run(arguments).status == 0);
  int stops = 0;  // later each time, so that it ends on any machine
  while (here.run_until(0.1 + 0.05 * stops, "TERM", arguments).status != 0) REQUIRE(++stops < 200);
  CHECK(stops > 0);
  const std::vector<std::string> names = files_in(whole.path() / "out/vtk");
  CHECK(names.size() > 100);
  CHECK(files_in(here.path() / "out/vtk") == names);
  CHECK(content_of(here.path() / "out/run.vtk.series") == content_of(whole.path() / "out/run.vtk.series"));
  for (const std::string& name : names)
    CHECK(content_of(here.path() / "out/vtk" / name) == content_of(whole.path() / "out/vtk" / name));
}

TEST_CASE("a folder of pictures that cannot be made is bad input, before anything is written") {
  const Workspace here(shear_case(""), bodies);
  fs::create_directory(here.path() / "out");
  here.write("out/vtk", "a file in the way");
  const auto before = here.everything();
  const ProgramRun run = here.run({"case.txt"});
  CHECK(run.status == 2);
  CHECK(run.errors.find("is not a folder") != std::string::npos);
  CHECK(here.everything() == before);
}

TEST_CASE("walls turn in the pictures as in the steps, back after reverse_at") {
  const Workspace here("bodies = bodies.csv\ngeometry = annulus\ninner_radius = 1\nouter_radius = 3\nwall_points = 64\n"
                       "outer_angular_velocity = .5\ninner_angular_velocity = -.25\nreverse_at = .1\npoints_per_body = 16\n"
                       "time_step = .1\nend_time = .2\noutput = out\nvtk = yes\n",
                       "a,b,x,y,theta\n.3,.2,2,0,0\n");
  REQUIRE(here.run({"case.txt"}).status == 0);
  const Results results = here.results();
  for (const int step : {0, 1}) {
    VtkReader file(here.path() / concat("out/vtk/step_00000", step, ".vtk"));
    while (file.line() != "omega 1 3 double") {}
    const std::vector<double> omega = file.doubles(3);
    const double driving = step == 0 ? 1.0 : -1.0;
    CHECK(omega[0] == 0.5 * driving);
    CHECK(omega[1] == results.body_column(0, "omega")[step]);
    CHECK(omega[2] == -0.25 * driving);
  }
}
