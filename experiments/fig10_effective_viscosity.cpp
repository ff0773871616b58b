// Figure 10: the effective viscosity over two revolutions, unsmoothed and smoothed, for every existing run of couette_run,
// and the claims of the text about it. A spike is the difference of a step's value and the smoothed one.

#include "couette.hpp"
#include "smoothing.hpp"

namespace {

using namespace stokes;

// The window of the smoothing: 2^4 steps of pi/1000, and as long in time with other steps.
int levels_for(double step) { return std::max(1, 4 - static_cast<int>(std::lround(std::log2(step / (pi / 1000.0))))); }

struct Spikes {
  double in_contact = 0.0, without = 0.0;
};

// Spikes of a run without its first tenth of a revolution, in which the start relaxes.
Spikes write_series(const std::string& name, const Results& runs, const Results& results) {
  const Table series = read_csv(runs.path(name + "_series"));
  std::vector<double> time = series.numbers("revolutions"), raw = series.numbers("effective_viscosity");
  const std::vector<double> contacts = series.numbers("contacts");
  time.pop_back(), raw.pop_back();  // the end, from which no step starts
  const std::vector<double> when = series.numbers("time");
  const std::vector<double> smooth = smoothed(raw, levels_for(when[1] - when[0]));
  std::vector<std::vector<double>> rows;
  Spikes spikes;
  for (std::size_t k = 0; k < raw.size(); ++k) {
    rows.push_back({time[k], raw[k], smooth[k], contacts[k]});
    double& largest = contacts[k] > 0.0 ? spikes.in_contact : spikes.without;
    if (time[k] > 0.1) largest = std::max(largest, std::abs(raw[k] - smooth[k]));
  }
  results.write(name, {"revolutions", "raw", "smoothed", "contacts"}, rows);
  return spikes;
}

// contact_models.csv: spikes of both contact models. claims.csv: runs from the paper's starts against the claims of the
// text.
void collect(const Results& results) {
  const Results runs = couette_results(results);
  std::map<std::string, Spikes> spikes_of;
  bool complete = true;
  for (const CouetteSuspension& s : couette_suspensions) {
    for (const std::string& name : finished_runs(runs, s)) spikes_of[name] = write_series(name, runs, results);
    complete &= runs.has(CouetteCase{s}.name());
  }
  const CouetteSuspension& compared = couette_suspension("phi5_lambda3");
  const std::string stiv = CouetteCase{compared, 0, "stiv"}.name(), gap = CouetteCase{compared}.name();
  if (runs.has(stiv) && runs.has(gap)) {
    results.write("contact_models", {{"largest_spike_stiv", write_series(stiv, runs, results).in_contact},
                                     {"largest_spike_gap", spikes_of[gap].in_contact},
                                     {"torque_imbalance_stiv", runs.quantity(stiv, "torque_imbalance")}});
  }
  if (!complete) return;
  Spikes largest;
  for (const CouetteSuspension& s : couette_suspensions) {
    const Spikes& spikes = spikes_of[CouetteCase{s}.name()];
    largest = {std::max(largest.in_contact, spikes.in_contact), std::max(largest.without, spikes.without)};
  }
  Quantities row = {{"largest_spike_in_contact", largest.in_contact}, {"largest_spike_without", largest.without}};
  const auto mean = [&](int percent, int lambda) {
    return from_paper_start(runs, couette_suspension(concat("phi", percent, "_lambda", lambda)), "effective_viscosity");
  };
  for (const int lambda : {1, 3, 6}) {
    row.push_back({concat("rise_5_to_10_lambda", lambda), mean(10, lambda) - mean(5, lambda)});
    if (lambda < 6) row.push_back({concat("rise_10_to_15_lambda", lambda), mean(15, lambda) - mean(10, lambda)});
  }
  for (const int percent : {5, 10, 15}) {
    row.push_back({concat("fall_1_to_3_phi", percent), mean(percent, 1) - mean(percent, 3)});
    if (percent < 15) row.push_back({concat("fall_3_to_6_phi", percent), mean(percent, 3) - mean(percent, 6)});
  }
  results.write("claims", row);
}

}  // namespace

int main(int argc, char** argv) {
  return run_experiment({"fig10_effective_viscosity", {}, {}, collect}, argc, argv);
}
