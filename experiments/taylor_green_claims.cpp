// Claims of section 4.2 about the Taylor-Green suspension:
//   local_*, global_*   steps from the first contact on with locally implicit stepping, and with each body's own mobility
//                       in the matrix of the contact problem
//   free_*              no contact forces: when do bodies overlap?
//   extrapolated_*      iterations of GMRES per step of a run, by preconditioner and tolerance
//   cold                the same without an initial guess, at configurations of a run: flow, and contact forces
//   points              the same at one configuration for 16 to 256 points per body

#include "experiment.hpp"
#include "neighbours.hpp"
#include "taylor_green.hpp"

namespace {

using namespace stokes;

const std::vector<std::pair<std::string, PreconditionerKind>> preconditioners = {
    {"none", PreconditionerKind::none}, {"block", PreconditionerKind::block}, {"pair", PreconditionerKind::pair}};

// --- local coupling -------------------------------------------------------------------------------------

constexpr int continued_steps = 200;
// Each body's own mobility takes hundreds of Stokes solves for one step.
constexpr int self_mobility_steps = 5, self_mobility_limit = 1000;

// The suspension at the end of the first step with contact of the run with dt = 0.025, where the contacts just found
// hold their separation exactly.
Suspension first_contact() {
  Suspension bodies;
  bool met = false;
  TaylorGreen parameters;
  parameters.end_time = 4.0;
  run_taylor_green(taylor_green_bodies(), parameters, [&](const StepRecord& record) {
    if (met && bodies.empty()) bodies = record.bodies;
    met = met || (record.outcome && !record.outcome->contacts.empty());
  });
  if (bodies.empty()) throw NumericalError(concat("no contact up to t = ", parameters.end_time));
  return bodies;
}

// The factor by which a step multiplies the largest speed, over the last ten steps.
double growth(const std::vector<std::vector<double>>& rows) {
  constexpr std::size_t fastest = 4, over = 10;
  const std::size_t n = rows.size();
  return n > over ? std::pow(rows[n - 1][fastest] / rows[n - 1 - over][fastest], 1.0 / over) : std::nan("");
}

void continue_from(const Suspension& start, const TaylorGreen& parameters, const std::string& name,
                   const Results& results) {
  const bool self = parameters.lcp_matrix == LcpMatrix::self;
  const int wanted = self ? self_mobility_steps : continued_steps;
  NcpOptions ncp;
  if (self) ncp.max_iterations = self_mobility_limit;
  Stepper stepper(start, taylor_green_options(parameters).stepper);
  std::vector<std::vector<double>> rows;
  std::string failure;
  double gap = smallest_gap(start).gap, total_ncp = 0.0, largest_ncp = 0.0, fastest = 0.0, first_fastest = 0.0;
  int steps = 0;
  while (steps < wanted && failure.empty()) try {
      const Suspension before = stepper.bodies();
      const StepOutcome outcome = stepper.step(parameters.time_step, 1.0, ncp);
      largest_ncp = std::max<double>(largest_ncp, outcome.ncp_iterations);
      total_ncp += outcome.ncp_iterations;
      failure = outcome.failure;
      if (!outcome.accepted) break;
      const TaylorGreenStep step = describe({steps, steps * parameters.time_step, before, gap, &outcome});
      if (steps++ == 0) first_fastest = step.fastest;
      fastest = std::max(fastest, step.fastest);
      rows.push_back({step.time, step.gap_over_h, static_cast<double>(step.contacts),
                      static_cast<double>(step.ncp_iterations), step.fastest, step.largest_multiplier});
      gap = smallest_gap(stepper.bodies()).gap;
      if (gap < 0.0) failure = concat("bodies overlap by ", -gap);
    } catch (const NumericalError& error) {
      failure = error.what();
    }
  results.write(name + "_steps", {"time", "gap_over_h", "contacts", "ncp_iterations", "fastest", "largest_multiplier"},
                rows);
  results.write(name,
                {{"completed", failure.empty() ? 1.0 : 0.0},
                 {"steps", static_cast<double>(steps)},
                 {"end_time", steps * parameters.time_step},
                 {"mean_ncp_iterations", total_ncp / std::max(steps, 1)},
                 {"largest_ncp_iterations", largest_ncp},
                 {"speed_at_first", first_fastest},
                 {"largest_speed", fastest},
                 {"speed_growth_per_step", growth(rows)},
                 {"gap_over_h", gap / taylor_green_spacing()}},
                {{"ending", failure.empty() ? concat(wanted, " steps") : failure}});
}

void run_continued(const std::string& name, const Results& results) {
  TaylorGreen parameters;
  parameters.time_step = *parse_number(name.substr(name.find("_dt") + 3));
  parameters.coupling = name.starts_with("local") ? Coupling::local : Coupling::global;
  if (name.starts_with("global_self")) parameters.lcp_matrix = LcpMatrix::self;
  continue_from(name.starts_with("local_start") ? taylor_green_bodies() : first_contact(), parameters, name, results);
}

// --- iterations of GMRES --------------------------------------------------------------------------------

struct Solve {
  int points = taylor_green_points;
  Refine refine = Refine::near;
  PreconditionerKind preconditioner = PreconditionerKind::pair;
  double tolerance = 1e-8;
};

StokesSystem system_of(const Suspension& bodies, const Solve& solve, ShapeCache& shapes) {
  const std::vector<Discretisation> nodes =
      solve.refine == Refine::near ? refined_nodes(bodies, solve.points, near_tolerance) : equal_nodes(bodies, solve.points);
  return {bodies, nodes, shapes, {.gmres_tolerance = solve.tolerance, .preconditioner = solve.preconditioner}};
}

// NaN when GMRES fails, which can happen where the nodes do not resolve the gaps.
double cold_iterations(const Suspension& bodies, const Solve& solve, ShapeCache& shapes) try {
  return system_of(bodies, solve, shapes).solve({FlowKind::taylor_green}, {}).iterations;
} catch (const NumericalError&) {
  return std::nan("");
}

std::vector<Wrench> unit_forces(const ContactConstraint& c, std::size_t count) {
  std::vector<Wrench> wrenches(count);
  wrenches[c.a] = {c.force.centre_a, c.force.angle_a};
  wrenches[c.b] = {c.force.centre_b, c.force.angle_b};
  return wrenches;
}

struct Mean {
  double sum = 0.0, largest = 0.0;
  int count = 0;

  void add(double value) { sum += value, largest = std::max(largest, value), ++count; }
  double value() const { return count > 0 ? sum / count : std::nan(""); }
};

// At every 40th configuration of the run up to t = 10: the flow, and the force of one contact, by preconditioner and
// tolerance.
void run_cold(const Results& results) {
  TaylorGreen parameters;
  parameters.end_time = 10.0;
  const std::pair<const char*, double> tolerances[] = {{"1e-6", 1e-6}, {"1e-8", 1e-8}};
  std::map<std::string, Mean> iterations;
  Mean configurations;
  ShapeCache shapes;
  run_taylor_green(taylor_green_bodies(), parameters, [&](const StepRecord& record) {
    if (record.step % 40 != 0 || !record.outcome) return;
    configurations.add(1.0);
    for (const auto& [kind_name, kind] : preconditioners)
      for (const auto& [tolerance_name, tolerance] : tolerances) {
        const StokesSystem system = system_of(record.bodies, {.preconditioner = kind, .tolerance = tolerance}, shapes);
        iterations[concat(kind_name, "_background_", tolerance_name)].add(
            system.solve({FlowKind::taylor_green}, {}).iterations);
        if (record.outcome->contacts.empty()) continue;
        const std::vector<Wrench> forces = unit_forces(record.outcome->contacts[0].constraint, record.bodies.size());
        iterations[concat(kind_name, "_contact_", tolerance_name)].add(system.solve({}, forces).iterations);
      }
  });
  Quantities row = {{"configurations", static_cast<double>(configurations.count)}};
  for (const auto& [name, mean] : iterations) row.push_back({name, mean.value()});
  results.write("cold", row);
}

// Without a preconditioner a step takes seconds: these runs are shorter.
void run_extrapolated(const std::string& name, const Results& results) {
  TaylorGreen parameters;
  parameters.end_time = name.find("none") == std::string::npos ? 10.0 : 3.0;
  parameters.gmres_tolerance = *parse_number(name.substr(name.find_last_of('_') + 1));
  for (const auto& [kind_name, kind] : preconditioners)
    if (name.find(kind_name) != std::string::npos) parameters.preconditioner = kind;
  const TaylorGreenRun run = run_taylor_green(taylor_green_bodies(), parameters);
  const double background =
      mean_over_steps(run, [](const TaylorGreenStep& step) { return step.background_iterations; });
  Mean per_column;
  for (const TaylorGreenStep& step : run.steps)
    if (step.contacts > 0)
      per_column.add(static_cast<double>(step.gmres_iterations - step.background_iterations) / step.contacts);
  results.write(name, {{"completed", run.failure.empty() ? 1.0 : 0.0},
                       {"end_time", run.steps.back().time},
                       {"background_iterations", background},
                       {"contact_iterations", per_column.value()},
                       {"first_background_iterations", static_cast<double>(run.steps[0].background_iterations)}});
}

// The configuration of the run at t = 0.5: later gaps are too small for nodes at equal steps.
void run_points(const std::string& name, const Results& results) {
  TaylorGreen parameters;
  parameters.end_time = 0.5;
  Suspension bodies;
  run_taylor_green(taylor_green_bodies(), parameters, [&](const StepRecord& record) { bodies = record.bodies; });
  Quantities row;
  std::vector<std::vector<double>> rows;
  ShapeCache shapes;
  Mean fine[3];  // 32 points and more
  double least[3] = {1e9, 1e9, 1e9};
  for (int points : {16, 32, 64, 128, 256}) {
    rows.push_back({static_cast<double>(points)});
    for (std::size_t k = 0; k < preconditioners.size(); ++k) {
      const double iterations = cold_iterations(bodies, {points, Refine::none, preconditioners[k].second, 1e-8}, shapes);
      rows.back().push_back(iterations);
      row.push_back({concat(preconditioners[k].first, "_", points), iterations});
      if (points < 32) continue;
      fine[k].add(iterations);
      least[k] = std::min(least[k], iterations);
    }
  }
  for (std::size_t k = 0; k < preconditioners.size(); ++k)
    row.push_back({preconditioners[k].first + "_largest_over_least", fine[k].largest / least[k]});
  results.write(name, row);
  results.write(name + "_table", {"points", "none", "block", "pair"}, rows);
}

// --- without contact ------------------------------------------------------------------------------------

void run_free(const std::string& name, const Results& results) {
  TaylorGreen parameters;
  parameters.contact = ContactModel::none;
  parameters.refine = name.ends_with("near") ? Refine::near : Refine::none;
  parameters.points = name.find("points64") != std::string::npos ? 64 : 32;
  const std::size_t number = name.find("_dt") + 3;
  parameters.time_step = *parse_number(name.substr(number, name.find('_', number) - number));
  parameters.end_time = 6.0;
  Suspension last;  // before the overlap
  const TaylorGreenRun run = run_taylor_green(taylor_green_bodies(), parameters, [&](const StepRecord& record) {
    if (record.min_gap > 0.0) last = record.bodies;
  });
  double gap = run.steps[0].gap_over_h;
  for (const TaylorGreenStep& step : run.steps)
    if (step.gap_over_h > 0.0) gap = std::min(gap, step.gap_over_h);
  ShapeCache shapes;
  Solve solve{parameters.points, parameters.refine, PreconditionerKind::block, 1e-8};
  const double early = cold_iterations(taylor_green_bodies(), solve, shapes), late = cold_iterations(last, solve, shapes);
  results.write(name,
                {{"overlaps", run.steps.back().gap_over_h < 0.0 ? 1.0 : 0.0},
                 {"end_time", run.steps.back().time},
                 {"steps", static_cast<double>(run.steps.size() - 1)},
                 {"smallest_gap_over_h", gap},
                 {"cold_iterations_at_start", early},
                 {"cold_iterations_at_end", late}},
                {{"ending", run.failure.empty() ? "end_time" : run.failure}});
}

// --- all ------------------------------------------------------------------------------------------------

std::vector<std::string> cases() {
  std::vector<std::string> names = {"global_full_dt0.01", "global_self_dt0.01", "local_start_dt0.025",
                                    "local_start_dt0.0025"};
  for (const char* time_step : {"1e-2", "1e-4", "1e-6", "1e-8"}) names.push_back(concat("local_contact_dt", time_step));
  for (const char* points : {"points32", "points64", "points32_near"})
    for (const char* time_step : {"0.025", "0.01", "0.0025"}) {
      const std::string all = points;
      const std::size_t end = all.find('_');
      names.push_back(
          concat("free_", all.substr(0, end), "_dt", time_step, end == std::string::npos ? "" : all.substr(end)));
    }
  for (const auto& [kind, ignored] : preconditioners)
    for (const char* tolerance : {"1e-6", "1e-8"}) names.push_back(concat("extrapolated_", kind, "_", tolerance));
  names.push_back("cold");
  names.push_back("points");
  return names;
}

void run_case(const std::string& name, const Results& results) {
  if (name == "points") return run_points(name, results);
  if (name == "cold") return run_cold(results);
  if (name.starts_with("extrapolated")) return run_extrapolated(name, results);
  if (name.starts_with("free")) return run_free(name, results);
  run_continued(name, results);
}

}  // namespace

int main(int argc, char** argv) {
  return run_experiment({"taylor_green_claims", cases(), run_case, [](const Results&) {}}, argc, argv);
}
