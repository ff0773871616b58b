// Figures 5 and 6: the paths of the discs of section 4.3, and their distances from their starts when they come back.
// Cases: paper, the published run; paper_stiv: with interference volumes; paper_delta*h, paper_dt*, paper_wall256: with
// other separations, steps, nodes on the walls; undisturbed: a lone disc; quick: only to t = 0.96, with early contact.
//
// The folder of a case holds a case file and its bodies, which `simulate` can read, too, and the run. An interrupted run
// continues from its checkpoint. <case>_snapshots.csv has the bodies at the times of the published frames.

#include "injection.hpp"

namespace {

using namespace stokes;

// Discs, by the order of placing, whose published centres are in reference_data/fig6_injection.csv.
constexpr int followed[] = {0, 3, 9, 14, 22, 30, 37, 46};

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
  add("paper");
  Injection& stiv = add("paper_stiv");
  stiv.contact = ContactModel::stiv, stiv.separation_over_h = 0.3;
  for (const char* separation : {"0.2", "0.3"})
    add(concat("paper_delta", separation, "h")).separation_over_h = *parse_number(separation);
  for (const char* step : {"0.04", "0.02"}) add(concat("paper_dt", step)).time_step = *parse_number(step);
  add("paper_wall256").wall_points = 256;
  Injection& quick = add("quick");
  quick.reverse_at = 0.48, quick.end_time = 0.96, quick.separation_over_h = 1.2;
  return all;
}

// in_contact: in the step from there.
void write_snapshots(const std::string& name, const Suspension& start, const RecordedRun& run, const Results& results) {
  std::vector<double> times = frame_times;
  times.insert(times.end(), stress_times.begin(), stress_times.end());
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  const std::vector<double> time = run.states("time");
  std::vector<std::vector<double>> rows;
  for (const std::size_t k : run.states_at(times))
    for (std::size_t i = 0; i < start.size(); ++i) {
      const bool is_wall = start[i].points > 0;  // the run does not record it, since it does not move
      const Pose& pose = is_wall ? start[i].pose : run.bodies()[k][i].pose;
      const bool in_contact = !is_wall && run.in_contact(k, i);
      rows.push_back({time[k], static_cast<double>(i), pose.centre.real(), pose.centre.imag(), start[i].shape.a,
                      start[i].fixed ? 1.0 : 0.0, in_contact ? 1.0 : 0.0});
    }
  results.write(name + "_snapshots", {"time", "body", "x", "y", "radius", "fixed", "in_contact"}, rows);
}

// The centres of the followed discs in a frame, and their mean distance from the published ones.
void add_centres(const RecordedRun& run, std::size_t state, double time, Quantities& row) {
  double distance = 0.0;
  for (const int i : followed) {
    const Complex centre = run.bodies()[state][i].pose.centre;
    const std::string x = concat("disc", i, "_x_at_", time), y = concat("disc", i, "_y_at_", time);
    row.push_back({x, centre.real()});
    row.push_back({y, centre.imag()});
    const auto published = [](const std::string& quantity) { return published_value("fig6_injection", "paper", quantity); };
    distance += std::abs(centre - Complex(published(x), published(y))) / std::size(followed);
  }
  row.push_back({concat("mean_distance_at_", time), distance});
}

// Distances of the free discs from their starts in the last frame.
void add_return(const RecordedRun& run, std::size_t last, Quantities& row) {
  const std::vector<double> distance = distances_from_start(run, last);
  const auto farthest = std::max_element(distance.begin(), distance.end()) - distance.begin();
  bool was_in_contact = false;
  for (std::size_t k = 0; k < last; ++k) was_in_contact |= run.in_contact(k, farthest);
  add_returns(distance, row);
  row.push_back({"farthest_was_in_contact", was_in_contact ? 1.0 : 0.0});
}

Quantities contacts_of(const RecordedRun& run) {
  const std::vector<double> time = run.states("time"), dt = run.steps("dt"), contacts = run.steps("contacts");
  const std::vector<double> ncp = run.steps("ncp_iterations");
  double first = std::nan(""), last = std::nan(""), ever = 0.0;
  for (std::size_t k = 0; k < time.size(); ++k) {
    if (contacts[k] == 0.0) continue;
    if (std::isnan(first)) first = time[k];
    last = time[k] + dt[k];
  }
  for (int i = 0; i < free_count; ++i) {
    bool was_in_contact = false;
    for (std::size_t k = 0; k < time.size(); ++k) was_in_contact |= run.in_contact(k, i);
    ever += was_in_contact;
  }
  return {{"first_contact", first},
          {"last_contact", last},
          {"discs_ever_in_contact", ever},
          {"largest_ncp_iterations", *std::max_element(ncp.begin(), ncp.end())}};
}

void report(const InjectionCase& chosen, const Suspension& start, const RecordedRun& run, const Results& results) {
  write_snapshots(chosen.name, start, run, results);
  Quantities row = contacts_of(run);
  const std::vector<std::size_t> states = run.states_at(frame_times);
  for (std::size_t f = 0; f < states.size(); ++f) {
    row.push_back({concat("in_contact_at_", frame_times[f]), discs_in_contact(run, states[f])});
    if (f > 0) add_centres(run, states[f], frame_times[f], row);
  }
  if (states.size() == frame_times.size()) add_return(run, states.back(), row);
  const Injection& parameters = chosen.parameters;
  results.write(chosen.name, row,
                {{"time_step", format_number(parameters.time_step)},
                 {"separation_over_h", format_number(parameters.separation_over_h)}});
}

// The driving alone: the flow without bodies at points, and lone discs. A potential flow carries a disc along like a
// point, r^2 - r0^2 = t, except for the walls' reflection of its disturbance, which is proportional to its area.
void run_undisturbed(const Results& results) {
  const Injection parameters{.time_step = 0.02};
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

std::vector<std::string> cases() {
  std::vector<std::string> names = {"undisturbed"};
  for (const InjectionCase& c : all_cases()) names.push_back(c.name);
  return names;
}

}  // namespace

int main(int argc, char** argv) {
  return run_experiment({"fig6_injection", cases(), run_case, [](const Results&) {}}, argc, argv);
}
