// Figures 5 and 6: where the discs of section 4.3 go, and how far from their starts they come back.
// Cases: seed1 to seed3, random starts; _stiv: interference volumes; _plain: 32 nodes at equal steps, without clusters
// near contacts; _wall64: fewer nodes on the walls; delta*h: seed 1 with other separations; near*h: starts up to the
// ring; free_dt*: no contact, other steps; undisturbed: a lone disc; quick: only to t = 1.
//
// The folder of a case holds a case file and its bodies, which `simulate` reads too, and the run; an interrupted run goes
// on from its checkpoint. Of the run, <case>_steps.csv has every step, <case>_snapshots.csv the bodies at some times.

#include <numeric>

#include "gap.hpp"
#include "injection.hpp"

namespace {

using namespace stokes;

const std::vector<double> snapshot_times = {0.0, 2.0, 3.9, 4.0, 4.1, 6.0, 8.0};

struct InjectionCase {
  std::string name;
  Injection parameters;
};

std::vector<InjectionCase> all_cases() {
  std::vector<InjectionCase> all;
  const auto add = [&](const std::string& name) -> Injection& {
    all.push_back({name, {}});
    return all.back().parameters;
  };
  for (const int seed : {1, 2, 3}) add(concat("seed", seed)).seed = static_cast<std::uint32_t>(seed);
  add("seed1_stiv").contact = ContactModel::stiv;
  add("seed1_wall64").wall_points = 64;
  add("seed1_dt0.01").time_step = 0.01;
  for (const char* separation : {"0.2", "0.5", "1", "2.5", "3"})
    add(concat("delta", separation, "h")).separation_over_h = *parse_number(separation);
  for (const char* step : {"0.02", "0.04", "0.08"}) {
    Injection& free = add(concat("free_dt", step));
    free.contact = ContactModel::none;
    free.time_step = *parse_number(step);
  }
  Injection& quick = add("quick");
  quick.reverse_at = 0.5, quick.end_time = 1.0, quick.separation_over_h = 3.0;
  return all;
}

// Smallest gaps of free discs in a state.
struct FreeGaps {
  double to_ring = 1e300, between = 1e300;
};

FreeGaps free_gaps(const std::vector<RecordedBody>& bodies) {
  const auto disc = [&](int i) { return Body{injection_disc, bodies[i].pose, {}, {}}; };
  FreeGaps smallest;
  for (int i = 0; i < free_count; ++i)
    for (int j = i + 1; j < free_count + ring_count; ++j) {
      double& of_kind = j < free_count ? smallest.between : smallest.to_ring;
      of_kind = std::min(of_kind, gap(disc(i), disc(j)).value);
    }
  return smallest;
}

// in_contact: in the step that led here, at the start in the first one; forces: of the step from here.
void write_snapshots(const std::string& name, const Suspension& start, const RecordedRun& run, const Results& results) {
  const std::vector<double> time = run.states("time");
  std::vector<std::vector<double>> rows;
  for (const std::size_t k : run.states_at(snapshot_times))
    for (std::size_t i = 0; i < start.size(); ++i) {
      const auto& [pose, contact] = run.bodies()[k][i];
      rows.push_back({time[k], static_cast<double>(i), pose.centre.real(), pose.centre.imag(), pose.angle, start[i].shape.a,
                      start[i].fixed ? 1.0 : 0.0, run.was_in_contact(k, i) ? 1.0 : 0.0, contact.force.real(),
                      contact.force.imag(), contact.torque});
    }
  results.write(name + "_snapshots",
                {"time", "body", "x", "y", "theta", "radius", "fixed", "in_contact", "force_x", "force_y", "torque"}, rows);
}

// How far the free discs come back from their starts.
Quantities displacements(const RecordedRun& run) {
  std::vector<double> moved;
  double sum = 0.0;
  for (int i = 0; i < free_count; ++i) {
    moved.push_back(std::abs(run.bodies().back()[i].pose.centre - run.bodies()[0][i].pose.centre));
    sum += moved.back();
  }
  const auto farthest = std::max_element(moved.begin(), moved.end()) - moved.begin();
  bool was_in_contact = false;
  for (std::size_t k = 0; k < run.bodies().size(); ++k) was_in_contact |= run.in_contact(k, farthest);
  std::sort(moved.begin(), moved.end());
  return {{"mean_displacement", sum / free_count},
          {"median_displacement", 0.5 * (moved[free_count / 2 - 1] + moved[free_count / 2])},
          {"largest_displacement", moved.back()},
          {"farthest_was_in_contact", was_in_contact ? 1.0 : 0.0}};
}

Quantities contacts_of(const RecordedRun& run) {
  const std::vector<double> time = run.states("time"), dt = run.steps("dt"), contacts = run.steps("contacts");
  const std::vector<double> ncp = run.steps("ncp_iterations"), gmres = run.steps("gmres_iterations");
  double first = std::nan(""), last = std::nan(""), ever = 0.0, force = 0.0;
  for (std::size_t k = 0; k < time.size(); ++k) {
    for (const RecordedBody& body : run.bodies()[k]) force = std::max(force, std::abs(body.contact.force));
    if (contacts[k] == 0.0) continue;
    if (std::isnan(first)) first = time[k];
    last = time[k] + dt[k];
  }
  for (int i = 0; i < free_count; ++i) {
    std::size_t k = 0;
    while (k < time.size() && !run.in_contact(k, i)) ++k;
    ever += k < time.size();
  }
  Quantities row = {{"first_contact", first},
                    {"last_contact", last},
                    {"bodies_ever_in_contact", ever},
                    {"largest_contact_force", force},
                    {"largest_ncp_iterations", *std::max_element(ncp.begin(), ncp.end())},
                    {"gmres_iterations_per_step", std::accumulate(gmres.begin(), gmres.end(), 0.0) / (gmres.size() - 1.0)}};
  const std::vector<std::size_t> snapshots = run.states_at(snapshot_times);
  for (std::size_t s = 0; s < snapshots.size(); ++s) {
    double touching = 0.0;
    for (int i = 0; i < free_count; ++i) touching += run.was_in_contact(snapshots[s], i);
    row.push_back({concat("in_contact_at_", snapshot_times[s]), touching});
  }
  return row;
}

void report(const InjectionCase& chosen, const Suspension& start, const RecordedRun& run, const Results& results) {
  const double h = injection_spacing();
  const std::vector<double> time = run.states("time"), gaps = run.states("min_gap"), contacts = run.steps("contacts");
  const std::vector<double> gmres = run.steps("gmres_iterations"), ncp = run.steps("ncp_iterations");
  FreeGaps smallest;
  std::vector<std::vector<double>> rows;
  for (std::size_t k = 0; k < time.size(); ++k) {
    const FreeGaps now = free_gaps(run.bodies()[k]);
    smallest = {std::min(smallest.to_ring, now.to_ring), std::min(smallest.between, now.between)};
    rows.push_back({time[k], contacts[k], gaps[k] / h, now.to_ring / h, now.between / h, gmres[k], ncp[k]});
  }
  write_snapshots(chosen.name, start, run, results);
  results.write(chosen.name + "_steps",
                {"time", "contacts", "gap_over_h", "gap_to_ring_over_h", "gap_between_free_over_h", "gmres_iterations",
                 "ncp_iterations"},
                rows);
  const Injection& parameters = chosen.parameters;
  const double gap = *std::min_element(gaps.begin(), gaps.end());
  Quantities row = displacements(run);
  row.push_back({"smallest_gap_over_separation", gap / (parameters.separation_over_h * h)});
  row.push_back({"smallest_gap_over_h", gap / h});
  row.push_back({"smallest_gap_to_ring_over_h", smallest.to_ring / h});
  row.push_back({"smallest_gap_between_free_over_h", smallest.between / h});
  for (const auto& quantity : contacts_of(run)) row.push_back(quantity);
  results.write(chosen.name, row,
                {{"seed", format_number(static_cast<double>(parameters.seed))},
                 {"time_step", format_number(parameters.time_step)},
                 {"separation_over_h", format_number(parameters.separation_over_h)}});
}

// The driving by itself: the flow without bodies at points, and lone discs, which a potential flow carries along like
// points, r^2 - r0^2 = t, but for what the walls reflect of their disturbance, proportional to their area.
void run_undisturbed(const Results& results) {
  const Injection parameters;
  const Suspension walls = between_walls({}, injection_annulus(parameters));
  const SimulationOptions options = options_of(injection_case(parameters), walls);
  ShapeCache shapes;
  const StokesSystem system(walls, injection_points, shapes, options.stepper.stokes);
  const BackgroundFlow driving{FlowKind::none, 1.0, 1.0};
  std::vector<Complex> points;
  for (int k = 0; k <= 15; ++k) points.push_back(std::polar(1.0 + 0.25 * k, 0.4 * k));
  const std::vector<PointFlow> flows = system.flow(points, system.solve(driving, {}).density, driving, {});
  double error = 0.0;
  for (std::size_t k = 0; k < points.size(); ++k)
    error = std::max(error, std::abs(2.0 * flows[k].velocity * std::conj(points[k]) - 1.0));
  Quantities row = {{"flow_error", error}};
  std::vector<double> growth;
  for (const double radius : {0.01, 0.5 * injection_disc.a, injection_disc.a}) {
    const Body disc{{radius, radius}, {{2.0, 0.0}, 0.0}, {}, {}};
    double outward = 0.0, back = 0.0;
    simulate(between_walls({disc}, injection_annulus(parameters)), options, [&](const StepRecord& record) {
      const Complex c = record.bodies[0].pose.centre;
      if (std::abs(record.time - parameters.reverse_at) < 1e-9) outward = std::norm(c) - 4.0;
      back = std::abs(c - 2.0);
    });
    row.push_back({concat("growth_of_r2_radius", radius), outward});
    row.push_back({concat("displacement_radius", radius), back});
    growth.push_back(outward);
  }
  row.push_back({"order_of_reflections", std::log2((growth[2] - growth[0]) / (growth[1] - growth[0]))});
  results.write("undisturbed", row);
}

void run_case(const std::string& name, const Results& results) {
  if (name == "undisturbed") return run_undisturbed(results);
  const std::vector<InjectionCase> all = all_cases();
  const InjectionCase& chosen = *std::find_if(all.begin(), all.end(), [&](const auto& c) { return c.name == name; });
  const Suspension start = injection_bodies(chosen.parameters);
  const Case c = write_case(name, injection_case(chosen.parameters), start, results);
  simulate_case(c, name);
  report(chosen, start, RecordedRun(c.output), results);
}

// delta_scan.csv: the separations from the same start; summary.csv: the order of the reversal error, and the seeds.
void collect(const Results& results) {
  const std::vector<std::string> columns = {"mean_displacement", "median_displacement", "largest_displacement",
                                            "first_contact", "last_contact", "bodies_ever_in_contact",
                                            "in_contact_at_2", "in_contact_at_4", "in_contact_at_6", "in_contact_at_8"};
  std::vector<std::vector<double>> scan;
  for (const auto& [name, separation] : std::vector<std::pair<std::string, double>>{
           {"delta0.2h", 0.2}, {"delta0.5h", 0.5}, {"delta1h", 1.0}, {"seed1", 2.0}, {"delta2.5h", 2.5}, {"delta3h", 3.0}}) {
    if (!results.has(name)) continue;
    scan.push_back({separation});
    for (const std::string& column : columns) scan.back().push_back(results.quantity(name, column));
  }
  std::vector<std::string> header = columns;
  header.insert(header.begin(), "separation_over_h");
  if (!scan.empty()) results.write("delta_scan", header, scan);

  Quantities row;
  if (results.has("free_dt0.02") && results.has("free_dt0.04") && results.has("free_dt0.08")) {
    const auto error = [&](const char* step) { return results.quantity(concat("free_dt", step), "mean_displacement"); };
    row.push_back({"order_coarse", std::log2(error("0.08") / error("0.04"))});
    row.push_back({"order_fine", std::log2(error("0.04") / error("0.02"))});
  }
  if (results.has("seed1") && results.has("seed2") && results.has("seed3"))
    for (const char* column : {"mean_displacement", "median_displacement", "largest_displacement"}) {
      double sum = 0.0;
      for (const char* seed : {"seed1", "seed2", "seed3"}) sum += results.quantity(seed, column) / 3.0;
      row.push_back({concat(column, "_of_seeds"), sum});
    }
  if (!row.empty()) results.write("summary", row);
}

std::vector<std::string> cases() {
  std::vector<std::string> names = {"undisturbed"};
  for (const InjectionCase& c : all_cases()) names.push_back(c.name);
  return names;
}

}  // namespace

int main(int argc, char** argv) { return run_experiment({"fig6_injection", cases(), run_case, collect}, argc, argv); }
