// The coloured body of Figure 4 up to t = 10 with several integrators and steps: its distance from its limit for small
// steps, and the cost. Cases <integrator>_dt<step>; the limit is the track of rk3_dt0.0125.
//
// <case>.csv holds the body's track at t = 1, 2, ..., 10 and the work, <case>_timing.csv the seconds.

#include <chrono>

#include "experiment.hpp"
#include "taylor_green.hpp"

namespace {

using namespace stokes;

struct Scheme {
  const char* name;
  IntegratorKind integrator;
  std::vector<const char*> steps;
};
const std::vector<Scheme> schemes = {{"euler", IntegratorKind::euler, {"0.025", "0.0125", "0.00625", "0.003125"}},
                                     {"ab2", IntegratorKind::ab2, {"0.1", "0.05", "0.025"}},
                                     {"rk3", IntegratorKind::rk3, {"0.2", "0.1", "0.05", "0.0125"}}};
constexpr const char* limit = "rk3_dt0.0125";
constexpr int last_time = 10;

std::string x_at(int time) { return concat("x_at_", time); }
std::string y_at(int time) { return concat("y_at_", time); }

void run_case(const std::string& name, const Results& results) {
  for (const Scheme& scheme : schemes)
    for (const char* step : scheme.steps) {
      if (concat(scheme.name, "_dt", step) != name) continue;
      Case c = taylor_green_case({.time_step = *parse_number(step), .end_time = last_time});
      c.integrator = scheme.integrator;
      Quantities row;
      double gmres = 0.0, solves = 0.0, contacts = 0.0, smallest = std::numeric_limits<double>::infinity();
      int next = 1;
      const Suspension bodies = taylor_green_bodies();
      const auto start = std::chrono::steady_clock::now();
      simulate(bodies, options_of(c, bodies), [&](const StepRecord& record) {
        if (record.time > next - 1e-9) {
          const Complex centre = record.bodies[coloured_body].pose.centre;
          row.push_back({x_at(next), centre.real()});
          row.push_back({y_at(next), centre.imag()});
          ++next;
        }
        smallest = std::min(smallest, record.min_gap);
        if (!record.outcome) return;
        gmres += record.outcome->gmres_iterations;
        solves += record.outcome->stokes_solves;
        contacts += !record.outcome->contacts.empty();
      });
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
      row.insert(row.end(), {{"gmres_iterations", gmres}, {"solves", solves}, {"steps_in_contact", contacts},
                             {"smallest_gap_over_separation", smallest / *c.min_separation_length}});
      results.write(name, row);
      results.write(name + "_timing", {{"seconds", seconds.count()}});
    }
}

// table.csv: scheme (its number in the list), step, largest distance of the coloured body from its limit, GMRES iterations.
void collect(const Results& results) {
  if (!results.has(limit)) return;
  std::vector<std::vector<double>> rows;
  for (std::size_t s = 0; s < schemes.size(); ++s)
    for (const char* step : schemes[s].steps) {
      const std::string name = concat(schemes[s].name, "_dt", step);
      if (!results.has(name) || name == limit) continue;
      double largest = 0.0;
      for (int time = 1; time <= last_time; ++time)
        largest = std::max(largest, std::hypot(results.quantity(name, x_at(time)) - results.quantity(limit, x_at(time)),
                                               results.quantity(name, y_at(time)) - results.quantity(limit, y_at(time))));
      rows.push_back({static_cast<double>(s), *parse_number(step), largest, results.quantity(name, "gmres_iterations")});
    }
  results.write("table", {"scheme", "time_step", "distance_from_limit", "gmres_iterations"}, rows);
}

std::vector<std::string> cases() {
  std::vector<std::string> names;
  for (const Scheme& scheme : schemes)
    for (const char* step : scheme.steps) names.push_back(concat(scheme.name, "_dt", step));
  return names;
}

}  // namespace

int main(int argc, char** argv) { return run_experiment({"taylor_green_order", cases(), run_case, collect}, argc, argv); }
