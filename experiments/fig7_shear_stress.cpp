// Figure 7: log10 |sigma_xy| at six times of the run of Figure 6 (its case `paper`), on the published grid of 100 x 100
// points, of two fields:
//   stress   of the flow;
//   plotted  what the paper shows: the double layers of all boundaries, and Stokeslets and rotlets of the contact forces,
//            each at the body that follows in the list, without those of fixed bodies.
// In the paper's representation the flow is the double layers plus Stokeslets and rotlets of all forces and torques on the
// fluid, at the centres of their own bodies. The second field is therefore the first plus point forces and torques at the
// centres. Medians are over the fluid farther than 0.3 from the centres of the discs.

#include "direct_fields.hpp"
#include "experiment.hpp"
#include "fields.hpp"
#include "injection.hpp"

namespace {

using namespace stokes;

constexpr Square view{{-8.0, -8.0}, 16.0};
constexpr int grid_points = 100;
constexpr double least_distance = 0.3;  // from a disc's centre, of the points in the medians

// sigma_xy of the second field minus that of the first, on the grid: that of the contact forces and torques of free bodies
// at the next body, minus that of all forces and torques at their own bodies.
std::vector<double> shear_stress_of_shift(const GridFlow& flow, const Suspension& bodies,
                                          const std::vector<Wrench>& contact) {
  PointArray targets, centres;
  for (const GridPoint& point : flow.points) targets.x.push_back(point.x.real()), targets.y.push_back(point.x.imag());
  const auto count = static_cast<Eigen::Index>(bodies.size());
  ComplexVector force(count);
  Vector torque(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    centres.x.push_back(bodies[i].pose.centre.real()), centres.y.push_back(bodies[i].pose.centre.imag());
    const Wrench shifted = i > 0 && !bodies[i - 1].fixed ? contact[i - 1] : Wrench{};
    force[i] = shifted.force - flow.wrenches[i].force;
    torque[i] = shifted.torque - flow.wrenches[i].torque;
  }
  FlowFields fields;
  direct_fields(targets, centres, {.force = &force, .torque = &torque}, FlowOutput::gradient, fields);
  std::vector<double> shear_stress;
  for (Eigen::Index k = 0; k < fields.velocity_x.size(); ++k)
    shear_stress.push_back(fields.velocity_x[k].imag() + fields.velocity_y[k].real());
  return shear_stress;
}

bool is_counted(const GridPoint& point, const Suspension& bodies) {
  return !point.inside && std::none_of(bodies.begin(), bodies.begin() + free_count + ring_count, [&](const Body& disc) {
    return std::abs(point.x - disc.pose.centre) <= least_distance;
  });
}

void run_case(const std::string& name, const Results& results) {
  const RecordedRun run(results.of("fig6_injection").folder() / name);
  const Injection parameters;
  Suspension bodies = injection_bodies(parameters);
  const StepperOptions options = options_of(injection_case(parameters), bodies).stepper;
  const std::vector<std::size_t> states = run.states_at(stress_times);
  if (states.size() != stress_times.size())
    throw InputError(concat("the run ", quote(name), " of fig6_injection ends before t = ", stress_times.back()));
  Quantities row;
  for (std::size_t f = 0; f < states.size(); ++f) {
    const double time = stress_times[f];
    std::vector<Wrench> contact(bodies.size());  // none on the inner wall, which the run does not record
    const std::vector<RecordedBody>& recorded = run.bodies()[states[f]];
    for (std::size_t i = 0; i < recorded.size(); ++i) bodies[i].pose = recorded[i].pose, contact[i] = recorded[i].contact;
    const double driving = time < parameters.reverse_at ? 1.0 : -1.0;
    const GridFlow flow = flow_on_grid(bodies, options, driving, contact, view, grid_points);
    const std::vector<double> shift = shear_stress_of_shift(flow, bodies, contact);
    std::vector<std::vector<double>> grid;
    std::vector<double> stresses, plotted;
    for (std::size_t k = 0; k < flow.points.size(); ++k) {
      const GridPoint& point = flow.points[k];
      const double sigma = point.inside ? std::nan("") : stress(point.flow).xy;
      grid.push_back({point.x.real(), point.x.imag(), std::log10(std::abs(sigma)),
                      std::log10(std::abs(sigma + shift[k]))});
      if (!is_counted(point, bodies)) continue;
      stresses.push_back(grid.back()[2]);
      plotted.push_back(grid.back()[3]);
    }
    results.write(concat(name, "_t", time), {"x", "y", "log10_stress", "log10_plotted"}, grid,
                  {{"time", format_number(time)}});
    row.push_back({concat("stress_median_at_", time), median(stresses)});
    row.push_back({concat("plotted_median_at_", time), median(plotted)});
  }
  results.write(name, row);
}

}  // namespace

int main(int argc, char** argv) {
  return run_experiment({"fig7_shear_stress", {"paper"}, run_case, [](const Results&) {}}, argc, argv);
}
