// Figures 5 and 6: where the discs of section 4.3 go, and how far from their starts they come back.
// Cases: seed1 to seed3, random starts; _stiv: interference volumes; _plain: 32 nodes at equal steps, without clusters
// near contacts; _wall64: fewer nodes on the walls; delta*h: seed 1 with other separations; near*h: starts up to the
// ring; free_dt*: no contact, other steps; undisturbed: a lone disc; quick: only to t = 1.

#include "experiment.hpp"
#include "injection.hpp"
#include "neighbours.hpp"

namespace {

using namespace stokes;

const std::vector<double> snapshot_times = {0.0, 2.0, 3.9, 4.0, 4.1, 6.0, 8.0};

struct Case {
  std::string name;
  Injection parameters;
};

std::vector<Case> all_cases() {
  std::vector<Case> all;
  const auto add = [&](const std::string& name) -> Injection& {
    all.push_back({name, {}});
    return all.back().parameters;
  };
  for (const int seed : {1, 2, 3}) add(concat("seed", seed)).seed = seed;
  add("seed1_stiv").contact = ContactModel::stiv;
  add("seed1_wall64").wall_points = 64;
  add("seed1_dt0.01").time_step = 0.01;
  for (const char* separation : {"0.2", "0.5", "1", "2.5", "3"})
    add(concat("delta", separation, "h")).separation_over_h = *parse_number(separation);
  const auto add_near = [&](const std::string& name, double separation) -> Injection& {
    Injection& near = add(name);
    near.outermost = 5.0 - injection_disc.a;
    near.least_distance_over_h = near.separation_over_h = separation;
    return near;
  };
  add_near("near0.2h", 0.2), add_near("near0.5h", 0.5), add_near("near1h", 1.0);
  add_near("near0.2h_stiv", 0.2).contact = ContactModel::stiv;
  add_near("near0.2h_plain", 0.2).refine = Refine::none;
  for (const char* step : {"0.02", "0.04", "0.08"}) {
    Injection& free = add(concat("free_dt", step));
    free.contact = ContactModel::none;
    free.time_step = *parse_number(step);
  }
  Injection& quick = add("quick");
  quick.reverse_at = 0.5, quick.end_time = 1.0, quick.separation_over_h = 3.0;
  return all;
}

// What happened in a run, state by state.
class Log {
 public:
  Log(const Suspension& start, const Injection& parameters)
      : start_(start), parameters_(parameters), in_contact_(start.size()), ever_in_contact_(start.size()) {}

  void add(const StepRecord& record) {
    last_ = record.bodies;
    gap_ = std::min(gap_, record.min_gap);
    double to_ring = 1e300, between = 1e300;
    for (int i = 0; i < free_count; ++i)
      for (int j = i + 1; j < free_count + ring_count; ++j) {
        double& smallest = j < free_count ? between : to_ring;
        smallest = std::min(smallest, gap(record.bodies[i], record.bodies[j]).value);
      }
    to_ring_ = std::min(to_ring_, to_ring), between_ = std::min(between_, between);
    if (record.step == 0) mark_contacts(record);
    const long contacts = record.outcome ? static_cast<long>(record.outcome->contacts.size()) : 0;
    if (next_ < snapshot_times.size() && record.time > snapshot_times[next_] - 1e-9) {
      take_snapshot(record);
      ++next_;
    }
    const double h = injection_spacing();
    steps_.push_back({record.time, static_cast<double>(contacts), record.min_gap / h, to_ring / h, between / h,
                      record.outcome ? record.outcome->gmres_iterations : 0.0,
                      record.outcome ? record.outcome->ncp_iterations : 0.0});
    mark_contacts(record);
    if (record.outcome) add_outcome(*record.outcome, record.time);
  }

  void write(const std::string& name, const Results& results) const {
    results.write(name + "_snapshots",
                  {"time", "body", "x", "y", "theta", "radius", "fixed", "in_contact", "force_x", "force_y", "torque"},
                  snapshots_);
    results.write(name + "_steps",
                  {"time", "contacts", "gap_over_h", "gap_to_ring_over_h", "gap_between_free_over_h",
                   "gmres_iterations", "ncp_iterations"},
                  steps_);
    results.write(name, summary(),
                  {{"seed", format_number(static_cast<double>(parameters_.seed))},
                   {"time_step", format_number(parameters_.time_step)},
                   {"separation_over_h", format_number(parameters_.separation_over_h)}});
  }

 private:
  void mark_contacts(const StepRecord& record) {
    std::fill(in_contact_.begin(), in_contact_.end(), false);
    if (!record.outcome) return;
    for (const ActiveContact& c : record.outcome->contacts)
      for (const int body : {c.constraint.a, c.constraint.b})
        if (body != container_index) in_contact_[body] = ever_in_contact_[body] = true;
  }

  // in_contact: in the step that led here, at the start in the first one; forces: of the step from here.
  void take_snapshot(const StepRecord& record) {
    double touching = 0.0;
    for (std::size_t i = 0; i < record.bodies.size(); ++i) {
      const Body& body = record.bodies[i];
      const Wrench w = record.outcome ? record.outcome->contact_wrench[i] : Wrench{};
      snapshots_.push_back({record.time, static_cast<double>(i), body.pose.centre.real(), body.pose.centre.imag(),
                            body.pose.angle, body.shape.a, body.fixed ? 1.0 : 0.0, in_contact_[i] ? 1.0 : 0.0,
                            w.force.real(), w.force.imag(), w.torque});
      if (!body.fixed && in_contact_[i]) ++touching;
    }
    touching_.push_back({concat("in_contact_at_", snapshot_times[next_]), touching});
  }

  void add_outcome(const StepOutcome& outcome, double time) {
    for (const Wrench& w : outcome.contact_wrench) largest_force_ = std::max(largest_force_, std::abs(w.force));
    largest_ncp_ = std::max<double>(largest_ncp_, outcome.ncp_iterations);
    gmres_ += outcome.gmres_iterations;
    if (outcome.contacts.empty()) return;
    if (std::isnan(first_contact_)) first_contact_ = time;
    last_contact_ = time + outcome.dt;
  }

  Quantities summary() const {
    std::vector<double> moved;
    double sum = 0.0;
    for (int i = 0; i < free_count; ++i) {
      moved.push_back(std::abs(last_[i].pose.centre - start_[i].pose.centre));
      sum += moved.back();
    }
    const auto farthest = std::max_element(moved.begin(), moved.end()) - moved.begin();
    std::vector<double> sorted = moved;
    std::sort(sorted.begin(), sorted.end());
    const double h = injection_spacing();
    Quantities row = {{"mean_displacement", sum / free_count},
                      {"median_displacement", 0.5 * (sorted[free_count / 2 - 1] + sorted[free_count / 2])},
                      {"largest_displacement", sorted.back()},
                      {"farthest_was_in_contact", ever_in_contact_[farthest] ? 1.0 : 0.0},
                      {"smallest_gap_over_separation", gap_ / (parameters_.separation_over_h * h)},
                      {"smallest_gap_over_h", gap_ / h},
                      {"smallest_gap_to_ring_over_h", to_ring_ / h},
                      {"smallest_gap_between_free_over_h", between_ / h},
                      {"first_contact", first_contact_},
                      {"last_contact", last_contact_},
                      {"bodies_ever_in_contact", static_cast<double>(std::count(ever_in_contact_.begin(), ever_in_contact_.begin() + free_count, true))},
                      {"largest_contact_force", largest_force_},
                      {"largest_ncp_iterations", largest_ncp_},
                      {"gmres_iterations_per_step", gmres_ / static_cast<double>(steps_.size() - 1)}};
    row.insert(row.end(), touching_.begin(), touching_.end());
    return row;
  }

  const Suspension& start_;
  Injection parameters_;
  Suspension last_;
  std::vector<bool> in_contact_, ever_in_contact_;
  std::vector<std::vector<double>> snapshots_, steps_;
  Quantities touching_;
  std::size_t next_ = 0;
  double gap_ = 1e300, to_ring_ = 1e300, between_ = 1e300;
  double first_contact_ = std::nan(""), last_contact_ = std::nan(""), largest_force_ = 0.0, largest_ncp_ = 0.0, gmres_ = 0.0;
};

// The driving by itself: the flow without bodies at points, and lone discs, which a potential flow carries along like
// points, r^2 - r0^2 = t, but for what the walls reflect of their disturbance, proportional to their area.
void run_undisturbed(const Results& results) {
  const Injection parameters;
  const SimulationOptions options = injection_options(parameters);
  const Suspension walls = between_walls({}, injection_annulus(parameters));
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
  const std::vector<Case> all = all_cases();
  const Injection& parameters = std::find_if(all.begin(), all.end(), [&](const Case& c) { return c.name == name; })->parameters;
  const Suspension start = injection_bodies(parameters);
  Log log(start, parameters);
  simulate(start, injection_options(parameters), [&](const StepRecord& record) { log.add(record); });
  log.write(name, results);
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
  for (const Case& c : all_cases()) names.push_back(c.name);
  return names;
}

}  // namespace

int main(int argc, char** argv) { return run_experiment({"fig6_injection", cases(), run_case, collect}, argc, argv); }
