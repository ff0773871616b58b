// The number of linear complementarity problems per contact, with the full mobility in their matrix and with
// each body's own: two discs pressed together, and the encounter of Table 1 at 2h and 3h.

#include "experiment.hpp"
#include "two_discs.hpp"

namespace {

using namespace stokes;

// Discs of radius 0.5 at a distance of 0.04 in u = 2(-x, y), delta = 0.02.
TwoDiscRun press_together(LcpMatrix matrix) {
  TwoDiscs parameters;
  parameters.flow = FlowKind::extension;
  parameters.rate = -2.0;
  parameters.first = {-0.52, 0.0};
  parameters.second = {0.52, 0.0};
  parameters.separation_over_h = 0.02 / disc_spacing;
  parameters.time_step = 0.1;
  parameters.end_time = 2.0;
  parameters.lcp_matrix = matrix;
  return run_two_discs(parameters);
}

TwoDiscRun pass(double separation_over_h, LcpMatrix matrix) {
  TwoDiscs parameters;
  parameters.rate = 2.0;
  parameters.separation_over_h = separation_over_h;
  parameters.time_step = 0.1;
  parameters.end_time = 20.0;
  parameters.reverse_at = 10.0;
  parameters.lcp_matrix = matrix;
  return run_two_discs(parameters);
}

void run_case(const std::string& name, const Results& results) {
  const LcpMatrix matrix = name.ends_with("full") ? LcpMatrix::full : LcpMatrix::self;
  const TwoDiscRun run = name.starts_with("head_on") ? press_together(matrix)
                         : name.starts_with("shear_2h") ? pass(2.0, matrix)
                                                        : pass(3.0, matrix);
  results.write(name, {{"mean_ncp_iterations", run.mean_ncp_iterations()},
                       {"largest_ncp_iterations", static_cast<double>(run.largest_ncp_iterations)},
                       {"contact_steps", static_cast<double>(run.contact_steps)},
                       {"gmres_iterations", static_cast<double>(run.gmres_iterations)},
                       {"smallest_gap_over_h", run.smallest_gap_over_h},
                       {"completed", run.failure.empty() ? 1.0 : 0.0}});
}

}  // namespace

int main(int argc, char** argv) {
  return run_experiment(
      {"ncp_iterations",
       {"head_on_full", "head_on_self", "shear_2h_full", "shear_2h_self", "shear_3h_full", "shear_3h_self"},
       run_case,
       [](const Results&) {}},
      argc, argv);
}
