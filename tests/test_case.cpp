#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <random>

#include "base.hpp"
#include "case.hpp"
#include "refusal.hpp"

using namespace stokes;
namespace fs = std::filesystem;

namespace {

// A fresh folder with a case file and a bodies' file.
struct Folder {
  fs::path path;
  Folder() {
    std::random_device random;
    do path = fs::temp_directory_path() / concat("stokes_case_", random());
    while (!fs::create_directory(path));
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  fs::path write(const char* name, std::string_view text) const {
    std::ofstream(path / name, std::ios::binary) << text;
    return path / name;
  }
};

const std::string complete =
    "bodies = bodies.csv\n"
    "flow = shear   # the simplest\n"
    "points_per_body = 32\n"
    "time_step = 0.1\n"
    "end_time = 2\n"
    "output = out\n";

using Overrides = std::vector<std::string>;

Case read(std::string_view text, const Overrides& overrides = {}) {
  const Folder folder;
  return read_case(folder.write("case.txt", text), overrides);
}

std::string case_refusal(std::string_view text, const Overrides& overrides = {}) {
  return refusal([&] { read(text, overrides); });
}

std::string bodies_refusal(std::string_view text) {
  const Folder folder;
  return refusal([&] { read_bodies(folder.write("bodies.csv", text)); });
}

#define CHECK_CONTAINS(text, part)                                            \
  do {                                                                        \
    const std::string message_ = (text);                                      \
    CHECK_MESSAGE(message_.find(part) != std::string::npos, message_);        \
    CHECK_MESSAGE(message_.find('\n') == std::string::npos, "one paragraph"); \
  } while (false)

// The message that refuses a line appended to a complete case, from the line number on.
#define CHECK_REFUSED(line, part) \
  CHECK_CONTAINS(case_refusal(complete + (line) + "\n"), concat("case.txt:7: ", part))

// The message that refuses an argument to a complete case.
#define CHECK_ARGUMENT(argument, part) CHECK_CONTAINS(case_refusal(complete, {argument}), part)

// The message that refuses a bodies' file, from the line number on.
#define CHECK_BODIES(text, part) CHECK_CONTAINS(bodies_refusal(text), concat("bodies.csv:", part))

}  // namespace

TEST_CASE("a case with the required keys has the defaults of the others") {
  const Case c = read(complete);
  CHECK(c.bodies == "bodies.csv");
  CHECK(c.bodies_path() == c.file.parent_path() / "bodies.csv");
  CHECK(c.flow == FlowKind::shear);
  CHECK(c.points_per_body == 32);
  CHECK(c.time_step == 0.1);
  CHECK(c.end_time == 2.0);
  CHECK(c.output == "out");
  CHECK(c.rate == 1.0);
  CHECK_FALSE(c.reverse_at.has_value());
  CHECK(c.min_separation == 0.0);
  CHECK_FALSE(c.min_separation_length.has_value());
  CHECK(c.contact == ContactModel::gap);
  CHECK(c.coupling == Coupling::global);
  CHECK(c.near_singular == NearSingular::cauchy);
  CHECK(c.gmres_tolerance == 1e-8);
  CHECK_FALSE(c.adaptive);
  CHECK(c.output_every == 1);
  CHECK_FALSE(c.threads.has_value());
  CHECK(c.time_counting == TimeCounting::exact);
}

TEST_CASE("every key sets its member") {
  const Case c = read(
      "bodies=../b c.csv\nflow=extension\npoints_per_body=+64\ntime_step=1e-3\nend_time=.5\noutput=my "
      "results/x\n"
      "rate=-2\nreverse_at=0\nmin_separation=2.5\ncontact=stiv\ncoupling=global\nnear_singular=cauchy\n"
      "gmres_tolerance=1e-13\noutput_every=10\nthreads=2\ntime_counting=accumulated\n");
  CHECK(c.bodies == "../b c.csv");
  CHECK(c.flow == FlowKind::extension);
  CHECK(c.points_per_body == 64);
  CHECK(c.time_step == 1e-3);
  CHECK(c.end_time == 0.5);
  CHECK(c.output == "my results/x");
  CHECK(c.rate == -2.0);
  CHECK(c.reverse_at == 0.0);
  CHECK(c.min_separation == 2.5);
  CHECK(c.contact == ContactModel::stiv);
  CHECK(c.gmres_tolerance == 1e-13);
  CHECK(c.output_every == 10);
  CHECK(c.threads == 2);
  CHECK(c.time_counting == TimeCounting::accumulated);
  CHECK(read(complete + "min_separation_length = .02\n").min_separation_length == 0.02);
  CHECK_FALSE(read(complete + "reverse_at = none\n").reverse_at.has_value());
  CHECK(read(complete, {"flow=none"}).flow == FlowKind::none);
  CHECK(read(complete, {"adaptive=yes", "contact=none"}).adaptive);
  CHECK(read(complete, {"contact=none"}).contact == ContactModel::none);
  CHECK(read(complete, {"overwrite=yes"}).overwrite);
}

TEST_CASE("line ends, byte order mark, blanks and comments do not matter in a case") {
  std::string windows = "\xEF\xBB\xBF# a case\r\n\r\n";
  for (const char c : complete) windows += c == '\n' ? std::string("\t\r\n") : std::string(1, c);
  CHECK(describe(read(windows)) == describe(read(complete)));
  CHECK(describe(read(complete.substr(0, complete.size() - 1))) == describe(read(complete)));
}

TEST_CASE("an argument counts as if written in the file and replaces what is there") {
  const Case c = read(complete + "rate = abc # wrong\n", {"rate = -3", "bodies=other.csv", "threads=4"});
  CHECK(c.rate == -3.0);
  CHECK_ARGUMENT("rate=2 # twice", "rate = '2 # twice' is not a finite number");
  CHECK(c.bodies_path() == c.file.parent_path() / "other.csv");
  CHECK(c.threads == 4);
  Overrides all;
  for (const auto& line : split(complete, '\n'))
    if (!line.empty()) all.emplace_back(line.substr(0, line.find('#')));
  CHECK(describe(read("", all)) == describe(read(complete)));
}

TEST_CASE("a '#' in an argument or in quotes is a part of the value, and a case that is written keeps it") {
  CHECK(read(complete, {"output=run#2"}).output == "run#2");
  CHECK(read(complete, {"output= my \"run\" "}).output == "my \"run\"");
  const std::string others = complete.substr(0, complete.find("output"));
  CHECK(read(others + "output = \"run #2\"  # the second\n").output == "run #2");
  CHECK(read(others + "output = \"a \"\"quoted\"\" # name\" # \"of\" two\n").output == "a \"quoted\" # name");
  CHECK(read(others + "output = run#2\n").output == "run");
  CHECK_CONTAINS(case_refusal(others + "output = \"run\n"), "case.txt:6: '\"run' begins with a quote");
  CHECK_CONTAINS(case_refusal(others + "output = \"run\" 2\n"), "begins with a quote");
  for (const char* name : {"run#2", "#", "my \"run\"", "\"run\"#", "plain"}) {
    Case c = read(complete);
    c.output = name, c.bodies = concat(name, ".csv");
    const Case again = read(format_case(c));
    CHECK(again.output == name);
    CHECK(again.bodies == c.bodies);
  }
}

TEST_CASE("a wrong argument is refused and named") {
  CHECK_ARGUMENT("rate", "argument 'rate': 'rate' has no '='");
  CHECK_ARGUMENT("", "argument '': '' has no '='");
  CHECK_ARGUMENT("rate=", "argument 'rate=': rate has no value");
  CHECK_ARGUMENT("=1", "argument '=1': unknown key ''");
  CHECK_CONTAINS(case_refusal(complete, {"rate=1", "rate=1"}),
                 "argument 'rate=1': rate = '1' is given twice");
  CHECK_ARGUMENT("rate=1e999", "argument 'rate=1e999': rate = '1e999' is not a finite");
  CHECK_ARGUMENT("timestep=1", "unknown key 'timestep'; did you mean 'time_step'?");
  CHECK_ARGUMENT("--threads=1", "did you mean 'threads'?");
  CHECK_ARGUMENT("output=a\nb", "control character");
}

TEST_CASE("a case without its required keys names every missing one") {
  CHECK_CONTAINS(case_refusal("flow = shear\nend_time = 1\n"),
                 "case.txt:2: the case is not complete; add a line `key = value` for each of: bodies, "
                 "time_step, output.");
  CHECK_CONTAINS(case_refusal(""), "case.txt:1: the case file is empty");
  CHECK_CONTAINS(case_refusal("\n# nothing\n"), "case.txt:2: the case file is empty");
  CHECK_CONTAINS(case_refusal("", {"rate=1"}), "case.txt:1: the case is not complete");
  for (const char* key : {"bodies", "flow", "time_step", "end_time", "output"}) {
    std::string text = complete;
    text.insert(text.find(concat(key, " =")), 1, '#');
    CHECK_CONTAINS(case_refusal(text), concat("for each of: ", key, "."));
  }
}

TEST_CASE("a case that cannot be read is refused") {
  const Folder folder;
  CHECK_CONTAINS(refusal([&] { read_case(folder.path / "c"); }), "c: cannot open the case file");
  CHECK_CONTAINS(refusal([&] { read_case(folder.path); }), "is a folder");
  CHECK_CONTAINS(refusal([&] { read_bodies(folder.path / "b"); }), "b: cannot open the bodies' file");
  CHECK_CONTAINS(refusal([&] { read_bodies(folder.path); }), "is a folder");
}

TEST_CASE("a malformed line of a case is refused with file and line") {
  CHECK_REFUSED("rte = 1", "unknown key 'rte'; did you mean 'rate'?");
  CHECK_REFUSED("Rate = 1", "unknown key 'Rate'; did you mean 'rate'?");
  CHECK_REFUSED("min_seperation = 1", "unknown key 'min_seperation'; did you mean 'min_separation'?");
  CHECK_REFUSED("hello", "'hello' has no '='");
  CHECK_REFUSED("rate = # 1", "rate has no value");
  CHECK_REFUSED("= 1", "unknown key ''");
  CHECK_REFUSED(std::string("rate = 1\0", 9), "there is a control character");
  CHECK_REFUSED("flow = none", "flow = 'none' is given twice; the first is 'shear' at ");
  CHECK_CONTAINS(case_refusal(complete + "\n\nrate = x\n"), "case.txt:9: rate = 'x'");
  CHECK_CONTAINS(case_refusal(complete + "flow = shear\n", {"flow=none"}),
                 "case.txt:7: flow = 'shear' is given twice");
}

TEST_CASE("a value out of its limits is refused with file, line and value") {
  for (const char* value : {"abc", "1e", "0x10", "nan", "inf", "-inf", "1,5", "1e999", "1 2", "1;"})
    CHECK_REFUSED(concat("rate = ", value), concat("rate = '", value, "' is not a finite number"));
  CHECK_ARGUMENT("time_step=0", "time_step = '0' must be greater than 0");
  CHECK_ARGUMENT("time_step=-0.1", "time_step = '-0.1' must be greater than 0");
  CHECK_ARGUMENT("time_step=1e-300", "time_step = '1e-300' makes more than 2e9 steps to end_time = 2");
  CHECK_ARGUMENT("end_time=0", "end_time = '0' must be greater than 0");
  CHECK_ARGUMENT("end_time=-1", "end_time = '-1' must be greater than 0");
  CHECK_ARGUMENT("points_per_body=33", "points_per_body = '33' is odd");
  CHECK_ARGUMENT("points_per_body=6", "points_per_body = '6' is below 8");
  CHECK_ARGUMENT("points_per_body=7", "points_per_body = '7' is below 8");
  CHECK_ARGUMENT("points_per_body=-32", "points_per_body = '-32' is below 8");
  CHECK_ARGUMENT("points_per_body=70000", "points_per_body = '70000' is above 65536");
  for (const char* value :
       {"32.0", "3e1", "abc", "99999999999", "9223372036854775808", "-9223372036854775808"})
    CHECK_ARGUMENT(concat("points_per_body=", value),
                   concat("points_per_body = '", value, "' is not a whole number"));
  CHECK(read(complete, {"points_per_body=8"}).points_per_body == 8);

  std::string free = complete;
  free.insert(free.find("points_per_body"), 1, '#');
  CHECK(read(free).accuracy == 1e-4);
  CHECK(read(free, {"accuracy=1e-8"}).accuracy == 1e-8);
  CHECK(!read(complete).accuracy);
  for (const char* value : {"0", "-1e-4", "1e-12", "0.2"})
    CHECK_CONTAINS(case_refusal(free, {concat("accuracy=", value)}),
                   concat("accuracy = '", value, "' must be between 1e-11 and 0.1; try 1e-4."));
  for (const char* key : {"refine=near", "gmres_tolerance=1e-8", "points_per_body=32"})
    CHECK_CONTAINS(case_refusal(free, {"accuracy=1e-6", key}), "is chosen by accuracy = 1e-06; keep one of them.");
  CHECK_CONTAINS(case_refusal(free, {"min_separation=0.1"}), "is in units of points_per_body; give min_separation_length.");
  CHECK_CONTAINS(case_refusal(free, {"coupling=local"}), "needs fixed nodes");

  CHECK_REFUSED("gmres_tolerance = 0", "gmres_tolerance = '0' must be greater than 0 and less than 1");
  CHECK_REFUSED("gmres_tolerance = 1", "gmres_tolerance = '1' must be greater than 0 and less than 1");
  CHECK_REFUSED("output_every = 0", "output_every = '0' must be at least 1");
  CHECK_REFUSED("output_every = 1.5", "output_every = '1.5' is not a whole number");
  CHECK_REFUSED("threads = 0", "threads = '0' must be at least 1");
  CHECK_REFUSED("threads = 100000", "threads = '100000' is above 1024");
  CHECK_REFUSED("reverse_at = -1", "reverse_at = '-1' must be at least 0");
  CHECK_REFUSED("reverse_at = soon", "reverse_at = 'soon' is not a finite number");
  CHECK_REFUSED("min_separation = -1", "min_separation = '-1' must be at least 0");
  CHECK_REFUSED("min_separation_length = -1", "min_separation_length = '-1' must be at least 0");
  CHECK_REFUSED("min_separation_length = 1\nmin_separation = 2",
                "min_separation_length = '1' and min_separation = '2' (");
  CHECK_CONTAINS(case_refusal(complete + "min_separation = 0\n", {"min_separation_length=1"}),
                 "case.txt:7) set the same thing");
}

TEST_CASE("a word that is not a value is refused with the values and the nearest one") {
  CHECK_REFUSED("contact = gab",
                "contact = 'gab' is unknown: it can be gap or stiv or none; did you mean 'gap'?");
  CHECK_ARGUMENT("flow=sheer",
                 "it can be shear or extension or linear or poiseuille or taylor_green or none; did you mean 'shear'?");
  CHECK_ARGUMENT("coupling=globl", "it can be global or local; did you mean 'global'?");
  CHECK_ARGUMENT("near_singular=Cauchy", "it can be cauchy or interpolation; did you mean 'cauchy'?");
  CHECK_ARGUMENT("time_counting=exactly", "it can be accumulated or exact; did you mean 'exact'?");
  CHECK_ARGUMENT("adaptive=y", "it can be yes or no; did you mean 'yes'?");
}

TEST_CASE("a case that is written as a file makes the same case again; its description lacks threads and output") {
  for (const Overrides& overrides :
       {Overrides{}, Overrides{"rate=0.1", "min_separation=3", "adaptive=yes", "reverse_at=.3"},
        Overrides{"min_separation_length=0.01", "contact=stiv", "time_counting=accumulated"}}) {
    const Case c = read(complete, overrides);
    const Case again = read(format_case(c));
    CHECK(describe(again) == describe(c));
    CHECK(again.output == c.output);
    for (const auto& [key, value] : describe(c)) {
      CHECK((key != "threads" && key != "output"));
      CHECK(value != "");
    }
    const bool in_units = format_case(c).find("min_separation = ") != std::string::npos;
    CHECK(in_units == !c.min_separation_length.has_value());
  }
  CHECK(describe(read(complete, {"threads=1", "output=a"})) ==
        describe(read(complete, {"threads=2", "output=b"})));
  CHECK(describe(read(complete, {"rate=2"})) != describe(read(complete)));
}

TEST_CASE("the help names every key with its default, and every column") {
  const std::string help = case_help();
  const auto line = [&help](std::string_view name) {
    const auto start = help.find(concat("\n  ", name, " "));
    return start == std::string::npos ? "missing"
                                      : help.substr(start + 1, help.find('\n', start + 1) - start - 1);
  };
  for (const char* name :
       {"bodies", "flow", "time_step", "end_time", "output", "theta"})
    CHECK_CONTAINS(line(name), " required ");
  Comments defaults = describe(read(complete));
  std::erase_if(defaults, [](const auto& given) {  // what the case gives
    return given.first == "bodies" || given.first == "flow" || given.first == "points_per_body" ||
           given.first == "time_step" || given.first == "end_time";
  });
  for (const auto& [key, value] : defaults) CHECK_CONTAINS(line(key), concat(" ", value, " "));
  CHECK_CONTAINS(line("threads"), " all ");
  CHECK_CONTAINS(line("flow"), "(shear | extension | linear | poiseuille | taylor_green | none)");
  for (const char* column : {"force_x", "force_y", "torque", "fixed"})
    CHECK_CONTAINS(line(column), " 0 ");
}

TEST_CASE("bodies are read by column name in any order") {
  const Folder folder;
  const fs::path file = folder.write("bodies.csv",
                                     "# two\r\n"
                                     "torque, y ,theta,a,b,x,force_x,fixed,force_y\r\n"
                                     "5,4,-7.5,1,2,3,0.5,0,1\r\n"
                                     "0,0,0,1,1,9,-0.5,0,-1\r\n");
  const Suspension bodies = read_bodies(file);
  REQUIRE(bodies.size() == 2);
  CHECK(bodies[0].shape == Shape{1.0, 2.0});
  CHECK(bodies[0].pose.centre == Complex(3.0, 4.0));
  CHECK(bodies[0].pose.angle == -7.5);
  CHECK(bodies[0].force == Complex(0.5, 1.0));
  CHECK(bodies[0].torque == 5.0);
  CHECK(bodies[1].pose.centre == Complex(9.0, 0.0));
  const Suspension free = read_bodies(folder.write("free.csv", "a,b,x,y,theta\n1,1,0,0,0\n"));
  REQUIRE(free.size() == 1);
  CHECK(free[0].force == Complex(0.0, 0.0));
  CHECK(free[0].torque == 0.0);
}

TEST_CASE("bodies that are written as a file are the same when they are read, bit for bit") {
  Suspension bodies = {{{1.0 / 3.0, 0.1}, {{1e-300, -2.0 / 7.0}, 0.3}, {0.1, 1e5}, -5.0},
                       {{2.0, 0.25}, {{9.0, 0.0}, -pi}, {-0.1, -1e5}, 1.0 / 3.0}};
  const Suspension again = parse_bodies(format_bodies(bodies), "bodies.csv");
  REQUIRE(again.size() == 2);
  for (const int i : {0, 1}) {
    CHECK(again[i].shape == bodies[i].shape);
    CHECK(again[i].pose.centre == bodies[i].pose.centre);
    CHECK(again[i].pose.angle == bodies[i].pose.angle);
    CHECK(again[i].force == bodies[i].force);
    CHECK(again[i].torque == bodies[i].torque);
  }
}

TEST_CASE("malformed bodies are refused with file and line") {
  const std::string header = "a,b,x,y,theta\n";
  CHECK_BODIES("", "1: the file is empty");
  CHECK_BODIES(header, "1: there are no bodies");
  CHECK_BODIES("a,b,x\n1,1,0\n", "1: the header lacks the required columns y, theta");
  CHECK_BODIES("a,b,x,y,thetta\n", "1: unknown column 'thetta'; did you mean 'theta'?");
  CHECK_BODIES("a,b,x,y,theta,force\n", "1: unknown column 'force'; did you mean 'force_x'?");
  CHECK_BODIES("a,b,x,y,theta,x\n", "1: column 'x' is there twice");
  CHECK_BODIES(header + "1,1,0,0,0\n1,1,5,0\n", "3: too few fields: 4 where 5");
  CHECK_BODIES(header + "1,1,0,0,0,0\n", "2: too many fields: 6 where 5");
  CHECK_BODIES(header + "1,1,0,0,0\n1,1,abc,0,0\n", "3: column 'x': 'abc' is not a finite");
  for (const char* value : {"nan", "inf", "1e999", "", "0x1", "1 2"})
    CHECK_BODIES(concat(header, "1,1,0,0,", value, "\n"), "2: column 'theta'");
  CHECK_BODIES(header + "1,1,0,0,0\n0,1,5,0,0\n",
               "3: the semi-axis a = 0 of body 1 must be greater than 0");
  CHECK_BODIES(header + "1,-2,0,0,0\n", "2: the semi-axis b = -2 of body 0");
}

TEST_CASE("fixed bodies and a net force are refused in unbounded flow") {
  const std::string header = "a,b,x,y,theta,fixed\n1,1,0,0,0,0\n";
  CHECK_BODIES(header + "1,1,5,0,0,1\n", "3: body 1 is fixed, but in unbounded flow");
  CHECK_BODIES(header + "1,1,5,0,0,2\n", "3: fixed = 2 of body 1 must be 0");
  const auto forces = [](std::string_view first, std::string_view second) {
    return concat("a,b,x,y,theta,force_x,force_y,torque\n1,1,0,0,0,", first, ",1\n1,1,5,0,0,", second,
                  ",1\n");
  };
  CHECK(bodies_refusal(forces("0.3,1e9", "-0.3,-1e9")) == "accepted");
  CHECK(bodies_refusal(forces("1e308,1e308", "-1e308,-1e308")) == "accepted");
  CHECK(bodies_refusal(forces("1,0", "-1.000000000001,0")) == "accepted");
  CHECK_BODIES(forces("1,0", "-0.5,0.25"), "1: the external forces sum to (0.5, 0.25)");
  CHECK_CONTAINS(bodies_refusal(forces("1,0", "-1.00000000001,0")), "in unbounded flow");
  for (const std::string& text : {forces("1e308,0", "1e308,0"), forces("1e-300,0", "0,0")})
    CHECK_BODIES(text, "1: the external forces sum to");
}

TEST_CASE("rounding does not make a balanced suspension unbalanced") {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int trial = 0; trial < 20; ++trial) {
    std::string text = "a,b,x,y,theta,force_x,force_y\n";
    Complex net = 0.0;
    for (int i = 0; i < 300; ++i) {
      const Complex force{uniform(random), uniform(random)};
      net += force;
      text += concat("1,1,", 3 * i, ",0,0,", force.real(), ",", force.imag(), "\n");
    }
    text += concat("1,1,-3,0,0,", -net.real(), ",", -net.imag(), "\n");
    CHECK(bodies_refusal(text) == "accepted");
  }
}

TEST_CASE("the separation is in units of the longest perimeter over the number of points") {
  Suspension bodies(3);
  bodies[0].shape = {0.5, 0.5};
  bodies[1].shape = {2.0, 2.0};
  const double h = 4.0 * pi / 32.0;
  CHECK(separation_length(read(complete), bodies) == 0.0);
  CHECK(std::abs(separation_length(read(complete + "min_separation = 3\n"), bodies) - 3.0 * h) < 1e-14);
  CHECK(separation_length(read(complete + "min_separation_length = 0.02\n"), bodies) == 0.02);
}
