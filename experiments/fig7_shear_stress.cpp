// Figure 7: log10 |sigma_xy| at six times of a run of Figure 6, whose positions and contact forces are read from its
// snapshots. Cases: those of fig6_injection that are shown; _free: the same positions without the contact forces;
// _unanswered: that flow plus the Stokeslets of the contact forces, which no boundary answers to.

#include "completion.hpp"
#include "experiment.hpp"
#include "fields.hpp"
#include "injection.hpp"

namespace {

using namespace stokes;

const std::vector<double> frame_times = {0.0, 2.0, 3.9, 4.1, 6.0, 8.0};
constexpr Square view{{-8.0, -8.0}, 16.0};
// Half of the side of the square in which the frame at t = 0, before any contact, has the published median.
constexpr double narrow = 6.9;
constexpr int grid_points = 161;

enum class Contacts { answered, none, unanswered };

struct Case {
  std::string run;
  Contacts contacts;
};

Case parse(const std::string& name) {
  for (const auto& [suffix, contacts] : {std::pair("_free", Contacts::none), std::pair("_unanswered", Contacts::unanswered)})
    if (name.ends_with(suffix)) return {name.substr(0, name.rfind('_')), contacts};
  return {name, Contacts::answered};
}

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

std::vector<GridPoint> flow_of(const Frame& frame, double driving, Contacts contacts) {
  std::vector<GridPoint> grid =
      flow_on_grid(frame.bodies, options_of(injection_case({}), frame.bodies).stepper, driving,
                   contacts == Contacts::answered ? frame.contact : std::vector<Wrench>{}, view, grid_points).points;
  if (contacts != Contacts::unanswered) return grid;
  for (int i = 0; i < free_count; ++i)
    for (GridPoint& point : grid)
      if (!point.inside)
        point.flow += completion_flow(frame.bodies[i].shape, frame.bodies[i].pose, frame.contact[i], point.x, 1.0);
  return grid;
}

// Of the driving alone, u = Q/(2 pi) x/|x|^2 with Q = pi.
double source_shear_stress(Complex x) { return -2.0 * x.real() * x.imag() / (std::norm(x) * std::norm(x)); }

void run_case(const std::string& name, const Results& results) {
  const auto [run, contacts] = parse(name);
  const Table snapshots = read_csv(results.of("fig6_injection").path(run + "_snapshots"));
  Quantities row;
  for (const double time : frame_times) {
    const Frame frame = frame_at(time, snapshots);
    double largest = 0.0;
    for (int i = 0; i < free_count; ++i) largest = std::max(largest, std::abs(frame.contact[i].force));
    std::vector<std::vector<double>> grid;
    std::vector<double> fluid, fluid_narrow, source;
    for (const GridPoint& point : flow_of(frame, time < Injection{}.reverse_at ? 1.0 : -1.0, contacts)) {
      const double value = point.inside ? std::nan("") : std::log10(std::abs(stress(point.flow).xy));
      grid.push_back({point.x.real(), point.x.imag(), value, point.inside ? 1.0 : 0.0});
      if (point.inside) continue;
      fluid.push_back(value);
      source.push_back(std::log10(std::abs(source_shear_stress(point.x))));
      if (std::abs(point.x.real()) <= narrow && std::abs(point.x.imag()) <= narrow) fluid_narrow.push_back(value);
    }
    results.write(concat(name, "_t", time), {"x", "y", "log10_abs_sigma_xy", "inside"}, grid, {{"time", format_number(time)}});
    row.push_back({concat("median_at_", time), median(fluid)});
    row.push_back({concat("median_narrow_at_", time), median(fluid_narrow)});
    row.push_back({concat("median_of_source_at_", time), median(source)});
    row.push_back({concat("largest_contact_force_at_", time), largest});
  }
  results.write(name, row);
}

std::vector<std::string> cases() {
  std::vector<std::string> names;
  for (const char* run : {"seed1", "seed1_stiv", "delta2.5h"})
    for (const char* suffix : {"", "_free", "_unanswered"}) names.push_back(concat(run, suffix));
  return names;
}

}  // namespace

int main(int argc, char** argv) {
  return run_experiment({"fig7_shear_stress", cases(), run_case, [](const Results&) {}}, argc, argv);
}
