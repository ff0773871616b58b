// Figure 3: pathlines of the left of two discs in u = (y, 0), 400 steps of 0.1, from three heights with
// delta = 3h; each also without contact, for the smallest distance of the free encounter.

#include "experiment.hpp"
#include "two_discs.hpp"

namespace {

using namespace stokes;

const std::vector<std::string> heights = {"0.75", "0.755", "0.76"};

void run_case(const std::string& name, const Results& results) {
  TwoDiscs parameters;
  parameters.first = {-8.0, *parse_number(name.substr(1))};
  parameters.time_step = 0.1;
  const TwoDiscRun free = complete_two_discs(parameters);
  parameters.separation_over_h = 3.0;
  const TwoDiscRun run = complete_two_discs(parameters);
  results.write(name, {{"start_y", parameters.first.imag()},
                       {"end_y", run.left.back().imag()},
                       {"free_end_y", free.left.back().imag()},
                       {"free_smallest_gap_over_h", free.smallest_gap_over_h},
                       {"smallest_gap_over_h", run.smallest_gap_over_h},
                       {"force_balance", run.worst_force_balance},
                       {"contact_steps", static_cast<double>(run.contact_steps)},
                       {"largest_ncp_iterations", static_cast<double>(run.largest_ncp_iterations)}});
  std::vector<std::vector<double>> rows;
  for (std::size_t k = 0; k < run.time.size(); ++k)
    rows.push_back({run.time[k], run.left[k].real(), run.left[k].imag(), free.left[k].real(), free.left[k].imag(),
                    run.gap_over_h[k], k < run.multiplier.size() ? run.multiplier[k] : 0.0});
  results.write(name + "_trajectory",
                {"time", "left_x", "left_y", "free_left_x", "free_left_y", "gap_over_h", "contact_force"}, rows);
}

std::string case_name(const std::string& height) { return "y" + height; }

// summary.csv: do the paths end in the order they started in?
void collect(const Results& results) {
  bool ordered = true;
  double previous = 0.0;
  for (const std::string& height : heights) {
    const double end = results.quantity(case_name(height), "end_y");
    ordered = ordered && end > previous;
    previous = end;
  }
  results.write("summary", {{"order_kept", ordered ? 1.0 : 0.0}});
}

std::vector<std::string> cases() {
  std::vector<std::string> names;
  for (const std::string& height : heights) names.push_back(case_name(height));
  return names;
}

}  // namespace

int main(int argc, char** argv) { return run_experiment({"fig3_pathlines", cases(), run_case, collect}, argc, argv); }
