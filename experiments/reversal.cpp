// The run of Table 1, two discs in u = (2y, 0) that is reversed at t = 10, with every integrator: the distance of the error
// at t = 20 from its limit for small steps, and the number of Stokes problems solved. Without contact the limit is 0. With
// contact it is not, because a contact does not pull on the way back. The limits were computed in the two-disc model with
// exact mobilities.
//
// A figure shows table.csv as work against error.

#include "experiment.hpp"
#include "two_discs.hpp"

namespace {

using namespace stokes;

struct Limit {
  const char* separation;  // in h
  double error;
};
const std::vector<Limit> limits = {{"0", 0.0}, {"2", 0.095364181}, {"3", 0.359264352}};

struct Scheme {
  const char* name;
  IntegratorKind integrator;
  std::vector<const char*> steps, tolerances;
};
const std::vector<Scheme> schemes = {
    {"euler", IntegratorKind::euler, {"0.04", "0.02", "0.01", "0.005", "0.0025"}, {}},
    {"ab2", IntegratorKind::ab2, {"0.08", "0.04", "0.02", "0.01", "0.005"}, {}},
    {"rk3", IntegratorKind::rk3, {"0.08", "0.04", "0.02", "0.01"}, {"1e-3", "1e-4", "1e-5", "1e-6", "1e-7"}},
    {"midpoint", IntegratorKind::midpoint, {"0.08", "0.04", "0.02", "0.01"}, {}}};

TwoDiscRun run_of(const Scheme& scheme, const Limit& limit, const char* step, const char* tolerance) {
  TwoDiscs parameters;
  parameters.rate = 2.0;
  parameters.end_time = 20.0;
  parameters.reverse_at = 10.0;
  parameters.separation_over_h = *parse_number(limit.separation);
  parameters.integrator = scheme.integrator;
  parameters.time_step = *parse_number(step);
  parameters.gmres_tolerance = 1e-10;
  if (tolerance) parameters.tolerance = *parse_number(tolerance);
  return complete_two_discs(parameters);
}

// One row: for each separation and each step or tolerance the reversal error and the solves.
void run_case(const std::string& name, const Results& results) {
  Quantities row;
  for (const Scheme& scheme : schemes) {
    if (scheme.name != name) continue;
    for (const Limit& limit : limits) {
      const auto add = [&](const std::string& how, const TwoDiscRun& run) {
        const std::string which = concat(limit.separation, "h_", how), error = concat("error_", which);
        row.push_back({error, reversal_error(run)});
        row.push_back({concat("off_limit_", which), std::abs(reversal_error(run) - limit.error)});
        row.push_back({concat("solves_", which), static_cast<double>(run.stokes_solves)});
      };
      for (const char* step : scheme.steps) add(concat("dt", step), run_of(scheme, limit, step, nullptr));
      for (const char* tolerance : scheme.tolerances)
        add(concat("tolerance", tolerance), run_of(scheme, limit, "0.2", tolerance));
    }
  }
  results.write(name, row);
}

// table.csv: scheme (its number in the list above), separation, step or tolerance (the other is 0), solves, off_limit.
// summary.csv: the solves for an error of 1e-3 in Table 1 at 3 h, by forward Euler, whose error is extrapolated in
// proportion to the step, and by rk3 with the largest tolerance that achieves it.
void collect(const Results& results) {
  std::vector<std::vector<double>> rows;
  for (std::size_t s = 0; s < schemes.size(); ++s) {
    if (!results.has(schemes[s].name)) return;
    const auto add = [&](const Limit& limit, const std::string& how, double step, double tolerance) {
      const auto value = [&](const char* what) {
        return results.quantity(schemes[s].name, concat(what, "_", limit.separation, "h_", how));
      };
      rows.push_back(
          {static_cast<double>(s), *parse_number(limit.separation), step, tolerance, value("solves"), value("off_limit")});
    };
    for (const Limit& limit : limits) {
      for (const char* step : schemes[s].steps) add(limit, concat("dt", step), *parse_number(step), 0.0);
      for (const char* tolerance : schemes[s].tolerances)
        add(limit, concat("tolerance", tolerance), 0.0, *parse_number(tolerance));
    }
  }
  results.write("table", {"scheme", "separation_over_h", "time_step", "tolerance", "solves", "off_limit"}, rows);

  constexpr double wanted = 1e-3;
  const double finest = results.quantity("euler", "off_limit_3h_dt0.0025");
  const double euler = results.quantity("euler", "solves_3h_dt0.0025") * finest / wanted;
  double rk3 = std::nan("");
  for (const char* tolerance : {"1e-3", "1e-4", "1e-5"})
    if (results.quantity("rk3", concat("off_limit_3h_tolerance", tolerance)) <= wanted) {
      rk3 = results.quantity("rk3", concat("solves_3h_tolerance", tolerance));
      break;
    }
  results.write("summary", {{"solves_euler", euler}, {"solves_rk3", rk3}, {"ratio", rk3 / euler}});
}

std::vector<std::string> cases() {
  std::vector<std::string> names;
  for (const Scheme& scheme : schemes) names.push_back(scheme.name);
  return names;
}

}  // namespace

int main(int argc, char** argv) { return run_experiment({"reversal", cases(), run_case, collect}, argc, argv); }
