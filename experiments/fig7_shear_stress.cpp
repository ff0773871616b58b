// Figure 7: log10 |sigma_xy| at six times of a run of Figure 6, whose positions and contact forces are read from its
// snapshots. Cases: those of fig6_injection that are shown; _free: the same positions without the contact forces.

#include "experiment.hpp"
#include "fields.hpp"
#include "injection.hpp"

namespace {

using namespace stokes;

const std::vector<double> frame_times = {0.0, 2.0, 3.9, 4.1, 6.0, 8.0};
constexpr Square view{{-8.0, -8.0}, 16.0};
constexpr int grid_points = 161;

struct Frame {
  Suspension bodies;
  std::vector<Wrench> contact;
};

Frame frame_at(double time, const Table& snapshots) {
  Frame frame{injection_bodies({}), {}};
  frame.contact.resize(frame.bodies.size());
  const auto column = [&](const char* name) { return snapshots.numbers(name); };
  const std::vector<double> t = column("time"), body = column("body"), x = column("x"), y = column("y");
  const std::vector<double> angle = column("theta"), fx = column("force_x"), fy = column("force_y"), torque = column("torque");
  std::size_t found = 0;
  for (std::size_t row = 0; row < t.size(); ++row) {
    if (std::abs(t[row] - time) > 1e-9) continue;
    const auto i = static_cast<std::size_t>(body[row]);
    frame.bodies.at(i).pose = {{x[row], y[row]}, angle[row]};
    frame.contact.at(i) = {{fx[row], fy[row]}, torque[row]};
    ++found;
  }
  if (found != frame.bodies.size())
    throw InputError(concat(snapshots.file, ": ", found, " of ", frame.bodies.size(), " bodies at time ", time));
  return frame;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

void run_case(const std::string& name, const Results& results) {
  const bool free = name.ends_with("_free");
  const std::string run = free ? name.substr(0, name.size() - 5) : name;
  const Table snapshots = read_csv(results.of("fig6_injection").path(run + "_snapshots"));
  const Injection parameters;
  Quantities row;
  for (const double time : frame_times) {
    const Frame frame = frame_at(time, snapshots);
    double largest = 0.0;
    for (const Wrench& w : frame.contact) largest = std::max(largest, std::abs(w.force));
    std::vector<std::vector<double>> grid;
    std::vector<double> fluid;
    for (const GridPoint& point :
         flow_on_grid(frame.bodies, injection_options(parameters).stepper, time < parameters.reverse_at ? 1.0 : -1.0,
                      free ? std::vector<Wrench>{} : frame.contact, view, grid_points)) {
      const double value = point.inside ? std::nan("") : std::log10(std::abs(stress(point.flow).xy));
      grid.push_back({point.x.real(), point.x.imag(), value, point.inside ? 1.0 : 0.0});
      if (!point.inside) fluid.push_back(value);
    }
    results.write(concat(name, "_t", time), {"x", "y", "log10_abs_sigma_xy", "inside"}, grid, {{"time", format_number(time)}});
    row.push_back({concat("median_at_", time), median(fluid)});
    row.push_back({concat("largest_contact_force_at_", time), largest});
  }
  results.write(name, row);
}

}  // namespace

int main(int argc, char** argv) {
  return run_experiment({"fig7_shear_stress", {"seed1", "seed1_free", "seed1_stiv", "delta3h"}, run_case, [](const Results&) {}}, argc, argv);
}
