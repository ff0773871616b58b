// Figure 2: two discs in u = (y, 0), 200 steps of 0.2, for several minimum separations: the trajectories, the gaps
// at every step, and the displacement of the left disc across the flow after the encounter.
//
// The paper's contact steps end at gaps above delta. The cases `published_<delta>` take these gaps from the drawn paths,
// step by step, and compute the rest: the steps without contact after them, and the displacement.

#include "experiment.hpp"
#include "two_discs.hpp"

namespace {

using namespace stokes;

const std::vector<std::string> separations = {"0", "1", "2", "2.1", "2.5", "2.75", "3"};  // delta / h

std::string case_name(const std::string& separation) { return concat("delta", separation, "h"); }

// The contact steps of a path in the figure: the number of the first one, and the gaps at their ends.
struct DrawnContact {
  std::string name;
  int first_step;
  std::vector<double> gaps_over_h;
};
const std::vector<DrawnContact> drawn_contacts = {{"published_2h", 76, {2.279}},
                                                  {"published_2.1h", 75, {2.166, 2.356}},
                                                  {"published_2.5h", 74, {2.764, 2.603, 2.679}},
                                                  {"published_3h", 73, {3.302, 3.223, 3.152, 3.126, 3.119}}};

// The steps in which the discs of the figure pass each other.
constexpr int first_drawn_step = 72, last_drawn_step = 78;

std::string gap_after(int step) { return concat("gap_over_h_after_step_", step); }

// Mean gap of our run in the steps in which the figure has contact, without the first of them.
double mean_gap_after_later_steps(const DrawnContact& drawn, const TwoDiscRun& run) {
  const int later = static_cast<int>(drawn.gaps_over_h.size()) - 1;
  double sum = 0.0;
  for (int k = 1; k <= later; ++k) sum += run.gap_over_h[drawn.first_step + k];
  return sum / later;
}

// Every step is a run of its own, with the drawn gap as separation where the figure has contact and none elsewhere.
void run_drawn_contact(const DrawnContact& drawn, const Results& results) {
  TwoDiscs step;
  step.end_time = step.time_step;
  std::vector<std::pair<std::string, double>> row;
  const double start = step.first.imag();
  for (int k = 1; k <= 200; ++k) {
    const int contact = k - drawn.first_step;
    const bool touches = contact >= 0 && contact < static_cast<int>(drawn.gaps_over_h.size());
    step.separation_over_h = touches ? drawn.gaps_over_h[contact] : 0.0;
    const TwoDiscRun run = complete_two_discs(step);
    step.first = run.left.back();
    step.second = run.right.back();
    if (k >= first_drawn_step && k <= last_drawn_step) row.push_back({gap_after(k), run.gap_over_h.back()});
  }
  row.insert(row.begin(), {"displacement", step.first.imag() - start});
  results.write(drawn.name, row);
}

void run_case(const std::string& name, const Results& results) {
  for (const DrawnContact& drawn : drawn_contacts)
    if (drawn.name == name) return run_drawn_contact(drawn, results);
  for (const std::string& separation : separations) {
    if (case_name(separation) != name) continue;
    TwoDiscs parameters;
    parameters.separation_over_h = *parse_number(separation);
    const TwoDiscRun run = complete_two_discs(parameters);
    std::vector<std::pair<std::string, double>> row{
        {"separation_over_h", parameters.separation_over_h},
        {"displacement", run.left.back().imag() - run.left[0].imag()},
        {"smallest_gap_over_h", run.smallest_gap_over_h},
        {"force_balance", run.worst_force_balance},
        {"contact_steps", static_cast<double>(run.contact_steps)},
        {"largest_ncp_iterations", static_cast<double>(run.largest_ncp_iterations)}};
    for (int k = first_drawn_step; k <= last_drawn_step; ++k) row.push_back({gap_after(k), run.gap_over_h[k]});
    for (const DrawnContact& drawn : drawn_contacts)
      if (drawn.name == concat("published_", separation, "h") && drawn.gaps_over_h.size() > 1)
        row.push_back({"mean_gap_over_h_after_later_contact_steps", mean_gap_after_later_steps(drawn, run)});
    results.write(name, row);
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
  for (const DrawnContact& drawn : drawn_contacts) names.push_back(drawn.name);
  return names;
}

}  // namespace

int main(int argc, char** argv) { return run_experiment({"fig2_shear_separation", cases(), run_case, collect}, argc, argv); }
