// Figure 2: two discs in u = (y, 0), 200 steps of 0.2, for several minimum separations: the trajectories, and
// how far the left disc is displaced across the flow after the encounter.

#include "experiment.hpp"
#include "two_discs.hpp"

namespace {

using namespace stokes;

const std::vector<std::string> separations = {"0", "1", "2", "2.1", "2.5", "2.75", "3"};  // delta / h

std::string case_name(const std::string& separation) { return concat("delta", separation, "h"); }

void run_case(const std::string& name, const Results& results) {
  for (const std::string& separation : separations) {
    if (case_name(separation) != name) continue;
    TwoDiscs parameters;
    parameters.separation_over_h = *parse_number(separation);
    const TwoDiscRun run = complete_two_discs(parameters);
    results.write(name, {{"separation_over_h", parameters.separation_over_h},
                         {"displacement", run.left.back().imag() - run.left[0].imag()},
                         {"smallest_gap_over_h", run.smallest_gap_over_h},
                         {"force_balance", run.worst_force_balance},
                         {"contact_steps", static_cast<double>(run.contact_steps)},
                         {"largest_ncp_iterations", static_cast<double>(run.largest_ncp_iterations)}});
    std::vector<std::vector<double>> rows;
    for (std::size_t k = 0; k < run.time.size(); ++k)
      rows.push_back({run.time[k], run.left[k].real(), run.left[k].imag(), run.right[k].real(), run.right[k].imag(),
                      run.left[k].imag() - run.right[k].imag(), run.gap_over_h[k]});
    results.write(name + "_trajectory",
                  {"time", "left_x", "left_y", "right_x", "right_y", "difference_y", "gap_over_h"}, rows);
  }
}

// displacement.csv: the bottom right panel.
void collect(const Results& results) {
  std::vector<std::vector<double>> rows;
  for (const std::string& separation : separations)
    if (results.has(case_name(separation)))
      rows.push_back({*parse_number(separation), results.quantity(case_name(separation), "displacement")});
  results.write("displacement", {"separation_over_h", "displacement"}, rows);
}

std::vector<std::string> cases() {
  std::vector<std::string> names;
  for (const std::string& separation : separations) names.push_back(case_name(separation));
  return names;
}

}  // namespace

int main(int argc, char** argv) { return run_experiment({"fig2_shear_separation", cases(), run_case, collect}, argc, argv); }
