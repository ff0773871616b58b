// The program from outside: its output, its counting of time, and known motions.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "program.hpp"

using namespace stokes;

namespace {

const std::string one_disc = "a,b,x,y,theta\n.5,.5,0,2,0\n";
const std::string two_discs = "a,b,x,y,theta\n.5,.5,-2,.5,0.25\n.5,.5,0,0,-7.5\n";

Results run(const Workspace& here, const std::vector<std::string>& settings = {}) {
  std::vector<std::string> arguments = {"case.txt", "overwrite=yes"};
  arguments.insert(arguments.end(), settings.begin(), settings.end());
  const ProgramRun done = here.run(arguments);
  CAPTURE(done.errors);
  REQUIRE(done.status == 0);
  return here.results();
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

using Numbers = std::vector<double>;

// Over the numbers that are not nan.
double largest(const Numbers& values) {
  double result = 0.0;
  for (double v : values) result = std::fmax(result, std::abs(v));
  return result;
}

double largest_difference(const Numbers& u, const Numbers& v) {
  REQUIRE(u.size() == v.size());
  double result = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) result = std::max(result, std::abs(u[i] - v[i]));
  return result;
}

// Times at which the steps of a disc in shear start, the length of each, the number of steps in which the flow has the
// other sign, and the number of changes of sign.
struct Counted {
  Numbers time, dt;
  int reversed = 0, changes = 0;
  int steps() const { return static_cast<int>(time.size()) - 1; }
};
Counted count(double time_step, double end_time, const std::vector<std::string>& settings = {}) {
  const Workspace here(case_text("shear", 8, time_step, end_time), one_disc);
  const Results results = run(here, settings);
  Counted counted{results.step_column("time"), results.step_column("dt")};
  const Numbers omega = results.body_column(0, "omega"), time = results.body_column(0, "time");
  CHECK(time == counted.time);
  for (int k = 0; k < counted.steps(); ++k) {
    CHECK(std::abs(std::abs(omega[k]) - 0.5) < 1e-12);
    counted.reversed += omega[k] > 0.0;
    counted.changes += k > 0 && omega[k] * omega[k - 1] < 0.0;
  }
  return counted;
}

}  // namespace

TEST_CASE("trajectory.csv and steps.csv begin with their columns and have the documented rows") {
  const Workspace here(case_text("shear", 16, 0.1, 0.3), two_discs);
  const Results results = run(here);
  const std::string trajectory = content_of(here.path() / "out/trajectory.csv");
  const std::string steps = content_of(here.path() / "out/steps.csv");
  CHECK(trajectory.starts_with(
      "step,time,body,x,y,theta,ux,uy,omega,fx,fy,torque,stresslet_11,stresslet_12\n0,0,0,-2,0.5,0.25,"));
  CHECK(steps.starts_with(
      "step,time,dt,gmres_iterations,ncp_iterations,contacts,min_gap,density_tail,stokes_solves,"
      "smallest_multiplier,largest_multiplier,estimated_error,nodes,clusters,most_nodes,unresolved,"
      "local_error,rejected_by_error,rejected_by_failure,"
      "stresslet_sum_11,stresslet_sum_12,contact_sum_11,contact_sum_12,bulk_stress_11,bulk_stress_12,effective_viscosity\n"
      "0,0,0.1,"));
  CHECK(results.trajectory.numbers("step") == Numbers{0, 0, 1, 1, 2, 2, 3, 3});
  CHECK(results.trajectory.numbers("body") == Numbers{0, 1, 0, 1, 0, 1, 0, 1});
  CHECK(results.step_column("step") == Numbers{0, 1, 2, 3});
  CHECK(largest_difference(results.step_column("time"), {0, 0.1, 0.2, 0.3}) < 1e-15);
  for (const Table& table : {results.trajectory, results.steps})
    for (const std::string& name : table.header) {
      const Numbers values = table.numbers(name);  // throws for a field that is neither a number nor empty
      CHECK(content_of(table.file).find("nan") == std::string::npos);
      const bool known = name == "step" || name == "time" || name == "body" || name == "x" || name == "y" ||
                         name == "theta" || name == "min_gap";
      // There are neither contacts, nor a tolerance, nor an area.
      const bool is_unknown = name.ends_with("_multiplier") || name == "local_error" || name.starts_with("bulk_stress") ||
                              name == "effective_viscosity";
      const std::size_t last_rows = table.has_column("body") ? 2 : 1;
      for (std::size_t row = 0; row < values.size(); ++row) {
        CAPTURE(name);
        CAPTURE(row);
        CHECK(std::isnan(values[row]) == (is_unknown || (!known && row + last_rows >= values.size())));
      }
    }
}

TEST_CASE("every output_every-th step, the last step and the final configuration have rows, once") {
  const Workspace here(case_text("shear", 16, 0.1, 1), two_discs);
  const Results all = run(here);
  CHECK(all.steps.rows.size() == 11);
  for (const auto& [every, expected] : {std::pair("1", Numbers{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}),
                                        {"3", {0, 3, 6, 9, 10}},
                                        {"4", {0, 4, 8, 9, 10}},
                                        {"5", {0, 5, 9, 10}},
                                        {"10", {0, 9, 10}},
                                        {"1000", {0, 9, 10}}}) {
    const std::string label = every;
    CAPTURE(label);
    const Results results = run(here, {concat("output_every=", every)});
    for (int body : {0, 1}) CHECK(results.body_column(body, "step") == expected);
    CHECK(results.trajectory.rows.size() == 2 * expected.size());
    CHECK(results.steps.rows.size() == 11);
    const Numbers x = results.body_column(1, "x"), all_x = all.body_column(1, "x");
    for (std::size_t row = 0; row < expected.size(); ++row) CHECK(x[row] == all_x[std::size_t(expected[row])]);
  }
}

TEST_CASE("the velocities in a row are those that moved the bodies, contacts included") {
  const Workspace here(case_text("shear", 32, 0.25, 8, "min_separation_length = .4\n"), two_discs);
  const Results results = run(here);
  const Numbers dt = results.step_column("dt");
  CHECK(largest(results.body_column(0, "fx")) > 0.01);
  const int steps = static_cast<int>(dt.size()) - 1;
  for (int body : {0, 1})
    for (const auto& [position, velocity] : {std::pair("x", "ux"), {"y", "uy"}, {"theta", "omega"}}) {
      const Numbers p = results.body_column(body, position), u = results.body_column(body, velocity);
      for (int k = 0; k < steps; ++k) CHECK(std::abs(p[k + 1] - (p[k] + dt[k] * u[k])) < 1e-14);
    }
}

TEST_CASE("the smallest gap, the contacts and their forces are those of the configuration in the row") {
  const Workspace here(case_text("shear", 32, 0.25, 8, "min_separation_length = .4\n"), two_discs);
  const Results results = run(here);
  const Numbers gaps = results.step_column("min_gap"), contacts = results.step_column("contacts");
  const Numbers multiplier = results.step_column("smallest_multiplier");
  const Numbers x0 = results.body_column(0, "x"), y0 = results.body_column(0, "y");
  const Numbers x1 = results.body_column(1, "x"), y1 = results.body_column(1, "y");
  const Numbers fx0 = results.body_column(0, "fx"), fy0 = results.body_column(0, "fy");
  const Numbers fx1 = results.body_column(1, "fx"), fy1 = results.body_column(1, "fy");
  int touching = 0;
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    const Complex d(x1[k] - x0[k], y1[k] - y0[k]);
    CHECK(std::abs(gaps[k] - (std::abs(d) - 1.0)) < 1e-14);
    if (k + 1 == gaps.size()) break;
    const bool contact = contacts[k] == 1.0;
    touching += contact;
    if (contact) CHECK(std::abs(gaps[k + 1] - 0.4) <= 0.4e-4);
    // Repulsive, along the line of centres at the start of the step, opposite.
    CHECK((std::hypot(fx0[k], fy0[k]) > 0.0) == contact);
    CHECK(std::isnan(multiplier[k]) != contact);
    if (contact) CHECK(std::abs(multiplier[k] - std::hypot(fx0[k], fy0[k])) <= 1e-14 * multiplier[k]);
    const Complex force(fx1[k], fy1[k]);
    CHECK(std::abs(dot(force, d) - std::abs(force) * std::abs(d)) <= 1e-12 * std::abs(force) * std::abs(d));
    CHECK(fx0[k] == -fx1[k]);
    CHECK(fy0[k] == -fy1[k]);
  }
  CHECK(touching > 2);
  CHECK(touching < static_cast<int>(gaps.size()) - 5);
}

TEST_CASE("the smallest and the largest multiplier are the forces at the ends of a row pressed together") {
  const Workspace here(case_text("none", 32, 0.1, 0.3, "min_separation_length = .1\n"),
                       "a,b,x,y,theta,force_x\n.5,.5,-1.1,0,0,3\n.5,.5,0,0,0,-2\n.5,.5,1.1,0,0,-1\n");
  const Results results = run(here);
  const Numbers smallest = results.step_column("smallest_multiplier"), largest = results.step_column("largest_multiplier");
  const Numbers first = results.body_column(0, "fx"), last = results.body_column(2, "fx");
  for (std::size_t k = 0; k + 1 < smallest.size(); ++k) {
    REQUIRE(results.step_column("contacts")[k] == 2.0);
    CHECK(last[k] > 0.0);
    CHECK(-first[k] > last[k]);
    CHECK(std::abs(smallest[k] - last[k]) <= 1e-12 * largest[k]);
    CHECK(std::abs(largest[k] + first[k]) <= 1e-12 * largest[k]);
  }
}

TEST_CASE("exact counting takes round(end_time / time_step) steps and ends at end_time") {
  const Counted shortened = count(0.35, 1.0);
  CHECK(largest_difference(shortened.time, {0, 0.35, 0.7, 1}) < 1e-15);
  CHECK(largest_difference({shortened.dt.begin(), shortened.dt.end() - 1}, {0.35, 0.35, 0.3}) < 1e-15);
  CHECK(shortened.time.back() == 1.0);
  CHECK(count(0.3, 1.0).time.size() == 4);
  CHECK(count(0.3, 1.0).time.back() == 1.0);
  CHECK(count(5.0, 1.0).time == Numbers{0, 1});
  const Counted many = count(0.1, 7.0);  // 0.1 + ... + 0.1 is not 7
  CHECK(many.steps() == 70);
  for (int k = 0; k < 70; ++k) CHECK(many.time[k] == k * 0.1);
  CHECK(many.time.back() == 7.0);
}

TEST_CASE("accumulated counting adds time_step while the time is below end_time") {
  const std::vector<std::string> accumulated = {"time_counting=accumulated"};
  CHECK(count(0.35, 1.0, accumulated).time == Numbers{0, 0.35, 0.35 + 0.35, 0.35 + 0.35 + 0.35});
  CHECK(count(5.0, 1.0, accumulated).time == Numbers{0, 5});
  for (const auto& [dt, steps, forward] :
       {std::tuple(0.04, 501, 251), {0.02, 1001, 501}, {0.01, 2000, 1001}}) {
    const Counted counted = count(dt, 20.0, {"time_counting=accumulated", "reverse_at=10"});
    CHECK(counted.steps() == steps);
    CHECK(counted.steps() - counted.reversed == forward);
    CHECK(counted.changes == 1);
  }
  const Counted exact = count(0.04, 20.0, {"reverse_at=10"});
  CHECK(exact.steps() == 500);
  CHECK(exact.reversed == 250);
}

TEST_CASE("the flow is reversed once, from the first step that starts at reverse_at or later") {
  for (const auto& [when, reversed] : {std::pair("0", 10), {"0.05", 9}, {"0.3", 7}, {"0.35", 6}, {"0.6", 4},
                                       {"0.7", 3}, {"0.9", 1}, {"0.95", 0}, {"1", 0}, {"50", 0}, {"none", 0}}) {
    const std::string label = when;
    CAPTURE(label);
    const Counted counted = count(0.1, 1.0, {concat("reverse_at=", when)});
    CHECK(counted.steps() == 10);
    CHECK(counted.reversed == reversed);
    CHECK(counted.changes == (reversed > 0 && reversed < 10 ? 1 : 0));
  }
  CHECK(count(0.29, 58.0, {"reverse_at=29"}).reversed == 100);  // 100 * 0.29 < 29 in floating point
}

TEST_CASE("a disc on which a torque acts turns with omega = torque / (4 pi a^2) and stays in its place") {
  const Workspace here(case_text("none", 32, 1, 3),
                       "torque,theta,y,x,b,a,fixed\n2.5,100,-3,1,.75,.75,0\n");
  const Results results = run(here);
  const double expected = 2.5 / (4.0 * pi * 0.75 * 0.75);
  const Numbers omega = results.body_column(0, "omega"), theta = results.body_column(0, "theta");
  for (int k : {0, 1, 2}) CHECK(std::abs(omega[k] - expected) < 1e-13);
  CHECK(std::abs(theta[3] - (100.0 + 3.0 * expected)) < 1e-12);
  CHECK(std::abs(results.body_column(0, "x").back() - 1.0) < 1e-13);
  CHECK(std::abs(results.body_column(0, "y").back() + 3.0) < 1e-13);
  for (double gap_value : results.step_column("min_gap")) CHECK(gap_value == INFINITY);
  CHECK(contains(content_of(here.path() / "out/steps.csv"), ",inf,"));
}

TEST_CASE("opposite forces push two discs to the minimum separation, where the contact balances them") {
  const Workspace here(case_text("none", 64, 0.1, 6, "min_separation_length = .1\n"),
                       "force_x,force_y,theta,a,b,y,x\n3,4,0,.5,.5,0,0\n-3,-4,0,.5,.5,1.2,.9\n");
  const Results results = run(here);
  CHECK(std::abs(results.step_column("min_gap").back() - 0.1) <= 1e-5);
  const std::size_t last = results.step_column("dt").size() - 2;
  for (const auto& [component, force] : {std::pair("fx", 3.0), {"fy", 4.0}}) {
    CHECK(std::abs(results.body_column(0, component)[last] + force) < 1e-6);
    CHECK(std::abs(results.body_column(1, component)[last] - force) < 1e-6);
  }
  // Before they meet there is no contact force: the external one is not part of these columns.
  CHECK(results.body_column(0, "fx").front() == 0.0);
  CHECK(results.body_column(0, "ux").front() > 0.0);
}

TEST_CASE("head-on compression is held at the separation with at most two contact iterations a step") {
  const Workspace here(case_text("extension", 64, 0.1, 2, "rate = -2\nmin_separation_length = 0.02\n"),
                       "a,b,x,y,theta\n.5,.5,0,-.52,0\n.5,.5,0,.52,0\n");
  for (const char* rate : {"rate=2", "rate=-2"}) {  // pulled apart and pushed together, in this order
    const Results results = run(here, {rate});
    const Numbers iterations = results.step_column("ncp_iterations"), gaps = results.step_column("min_gap");
    const bool pushed = std::string(rate) == "rate=2";
    for (std::size_t k = 0; k + 1 < gaps.size(); ++k) {
      CHECK(iterations[k] <= 2.0);
      CHECK(gaps[k + 1] >= 0.02 * (1.0 - 1e-4));
    }
    CHECK((gaps.back() <= 0.02 * (1.0 + 1e-4)) == pushed);
    CHECK((iterations[iterations.size() - 2] >= 1.0) == pushed);
  }
}

TEST_CASE("an initial gap below the separation is a warning, and the first step restores it") {
  const Workspace here(case_text("shear", 64, 0.1, 0.5, "min_separation_length = 0.1\n"),
                       "a,b,x,y,theta\n.5,.5,0,0,0\n.5,.25,.02,.78,0\n");
  const ProgramRun done = here.run({"case.txt"});
  CHECK(done.status == 0);
  CAPTURE(done.errors);
  CHECK(contains(done.errors, "warning: bodies 0 and 1"));
  CHECK(contains(done.errors, "0.1"));
  const Numbers gaps = here.results().step_column("min_gap");
  CHECK(gaps[0] < 0.031);
  for (std::size_t k = 1; k < gaps.size(); ++k) CHECK(gaps[k] >= 0.1 * (1.0 - 1e-4));
  for (const char* setting : {"contact=none", "min_separation_length=.02"}) {
    const ProgramRun without = here.run({"case.txt", "overwrite=yes", setting});
    CHECK(without.status == 0);
    CHECK_FALSE(contains(without.errors, "minimum separation"));
  }
}

TEST_CASE("discs shot at each other with a huge time step do not change sides") {
  const Workspace here(case_text("none", 32, 1, 1, "min_separation_length = .1\n"),
                       "a,b,x,y,theta,force_x\n.5,.5,-2,0,0,100\n.5,.5,2,0,0,-100\n");
  for (double time_step : {0.5, 5.0, 500.0}) {
    const Results results =
        run(here, {concat("time_step=", time_step), concat("end_time=", 3.0 * time_step)});
    const Numbers x0 = results.body_column(0, "x"), x1 = results.body_column(1, "x");
    REQUIRE(x0.size() == 4);
    for (int k : {1, 2, 3}) CHECK(std::abs(x1[k] - x0[k] - 1.1) < 1e-5);
  }
  // Without a given separation: a run that ends early, because 32 points do not resolve it, changes none either.
  here.run({"case.txt", "overwrite=yes", "min_separation_length=none"});
  const Numbers x0 = here.results().body_column(0, "x"), x1 = here.results().body_column(1, "x");
  for (std::size_t k = 0; k < x0.size(); ++k) CHECK(x1[k] - x0[k] > 1.0);
}

TEST_CASE("moving the frame far along the flow moves the trajectory with it") {
  const auto positions = [](double shift) {
    const Workspace here(case_text("shear", 32, 0.1, 3, "min_separation_length = .15\n"),
                         concat("a,b,x,y,theta\n.6,.3,", shift, ",0,0\n.5,.5,", shift - 1.0, ",.6,1\n"));
    const Results results = run(here);
    CHECK(largest(results.step_column("contacts")) == 1.0);
    std::vector<Numbers> columns;
    for (int body : {0, 1})
      for (const char* name : {"x", "y", "theta"}) columns.push_back(results.body_column(body, name));
    return columns;
  };
  const double far = 16384.0;
  std::vector<Numbers> here = positions(0.0), there = positions(far);
  for (std::size_t c = 0; c < here.size(); ++c) {
    if (c % 3 == 0)
      for (double& x : there[c]) x -= far;
    CAPTURE(largest_difference(here[c], there[c]));
    CHECK(largest_difference(here[c], there[c]) < 1e-9);
  }
}

// Jeffery's orbit in u = (y, 0): in the angle phi with tan(theta) = (b/a) tan(phi) the rotation is uniform.
TEST_CASE("a 3:1 ellipse follows Jeffery's orbit over several turns, unwrapped, to first order in the step") {
  const double a = 0.9, b = 0.3, start = 20.0, end = 60.0;
  const auto unrolled = [](double angle, double reference) {  // the representative next to `reference`
    return angle + 2.0 * pi * std::round((reference - angle) / (2.0 * pi));
  };
  const double phi = unrolled(std::atan2(a * std::sin(start), b * std::cos(start)), start);
  const double later = phi - a * b / (a * a + b * b) * end;
  const double expected = unrolled(std::atan2(b * std::sin(later), a * std::cos(later)), later);
  REQUIRE(start - expected > 4.0 * pi);

  Numbers errors;
  for (const char* time_step : {"0.1", "0.05", "0.025"}) {
    const Workspace here(case_text("shear", 32, 1, end),
                         concat("a,b,x,y,theta\n", a, ",", b, ",0,0,", start, "\n"));
    const Results results = run(here, {concat("time_step=", time_step), "output_every=100000"});
    errors.push_back(std::abs(results.body_column(0, "theta").back() - expected));
    CHECK(std::abs(results.body_column(0, "x").back()) < 1e-9);
  }
  MESSAGE("errors for dt = 0.1, 0.05, 0.025: ", errors[0], " ", errors[1], " ", errors[2]);
  CHECK(errors[2] < 0.1);
  for (int k : {0, 1}) {
    const double order = std::log2(errors[k] / errors[k + 1]);
    CHECK(order > 0.8);
    CHECK(order < 1.2);
  }
}

TEST_CASE("one and two threads write the same bytes, with contacts") {
  // 32 bodies of 64 points: enough for the loops to be shared.
  std::string bodies = "a,b,x,y,theta\n";
  for (int i = 0; i < 32; ++i)
    bodies += concat(i % 3 ? ".5" : ".45", ",.3,", 1.15 * (i % 8), ",", 0.95 * (i / 8), ",", 0.7 * i, "\n");
  const Workspace here(case_text("extension", 64, 0.1, 0.2, "min_separation_length = .1\n"), bodies);
  const Results results = run(here, {"threads=1"});
  CHECK(largest(results.step_column("contacts")) >= 3.0);
  const std::string trajectory = content_of(here.path() / "out/trajectory.csv");
  const std::string steps = content_of(here.path() / "out/steps.csv");
  run(here, {"threads=2"});
  CHECK((content_of(here.path() / "out/trajectory.csv") == trajectory));
  CHECK((content_of(here.path() / "out/steps.csv") == steps));
}

TEST_CASE("adaptive steps are cut at reverse_at and end_time, and get past what a fixed step cannot") {
  const Workspace here(case_text("none", 64, 1, 3, "min_separation_length = .02\nadaptive = yes\n"),
                       "a,b,x,y,theta,force_x\n.5,.5,-2,0,0,100\n.5,.5,2,.3,0,-100\n");
  const ProgramRun done = here.run({"case.txt", "reverse_at=.7"});
  CHECK(done.status == 0);
  CAPTURE(done.output);
  CHECK_FALSE(contains(done.output, " 0 rejected"));
  const Results results = here.results();
  const Numbers time = results.step_column("time"), dt = results.step_column("dt"),
                gaps = results.step_column("min_gap");
  CHECK(time.back() == 3.0);
  CHECK(std::count(time.begin(), time.end(), 0.7) == 1);
  for (std::size_t k = 0; k + 1 < time.size(); ++k) {
    CHECK(time[k + 1] > time[k]);
    CHECK(std::abs(time[k + 1] - time[k] - dt[k]) < 1e-12);
    CHECK(dt[k] <= 1.0);
    CHECK(gaps[k + 1] >= 0.02 * (1.0 - 1e-4));
  }
}

TEST_CASE("fields of the step that is not made are empty in the last rows") {
  const Workspace here(case_text("shear", 8, 0.1, 0.2), one_disc);
  run(here);
  CHECK(content_of(here.path() / "out/trajectory.csv").ends_with(",,,,,,,,\n"));
  CHECK(contains(content_of(here.path() / "out/steps.csv"), "\n2,0.2,,,,,inf,,,,,,,,,,,,,,,,,,,\n"));
}

TEST_CASE("--help columns explains every column that a run writes, and so does the page for users") {
  const Workspace here("bodies = bodies.csv\ngeometry = annulus\ninner_radius = 1\nouter_radius = 3\nwall_points = 32\n"
                       "outer_angular_velocity = .5\npoints_per_body = 16\ntime_step = .1\nend_time = .1\noutput = out\n",
                       "a,b,x,y,theta\n.3,.2,2,0,0\n");
  const Results results = run(here);
  here.write("disc.txt",
             "bodies = bodies.csv\ngeometry = disc\nouter_radius = 3\ntime_step = .1\nend_time = .1\noutput = disc\n");
  REQUIRE(here.run({"disc.txt"}).status == 0);
  here.write("open.txt", "bodies = bodies.csv\nflow = shear\ntime_step = .1\nend_time = .1\noutput = open\n");
  REQUIRE(here.run({"open.txt"}).status == 0);
  const ProgramRun help = here.run({"--help", "columns"});
  CHECK(help.status == 0);
  const std::string page = content_of("paper/RESULTS.md");
  for (const Table& table : {results.trajectory, results.steps, here.results("disc").steps, here.results("open").steps})
    for (const std::string& name : table.header) {
      CAPTURE(name);
      const std::size_t at = help.output.find(concat("\n  ", padded(name, 29)));
      REQUIRE(at != std::string::npos);
      const std::size_t meaning = at + 3 + 29, end = help.output.find('\n', meaning);
      CHECK(end > meaning + 5);
      CHECK(contains(page, concat("| `", name, "` | ", help.output.substr(meaning, end - meaning), " |")));
    }
  // The inner wall is not in the table of bodies.
  CHECK(results.trajectory.numbers("body") == Numbers{0, 0});
}
