// A claim of section 4.1: with delta = 0 and dt = 0.4 the discs pass each other with the globally implicit scheme and
// collide with the locally implicit one. Two discs from (-8, 0.5) in u = (2y, 0), and in u = (y, 0), where both schemes
// pass.

#include "experiment.hpp"
#include "two_discs.hpp"

namespace {

using namespace stokes;

void run_case(const std::string& name, const Results& results) {
  TwoDiscs parameters;
  parameters.rate = name.starts_with("rate2") ? 2.0 : 1.0;
  parameters.coupling = name.ends_with("local") ? Coupling::local : Coupling::global;
  parameters.contact = ContactModel::none;
  parameters.time_step = 0.4;
  parameters.end_time = 40.0 / parameters.rate;
  const TwoDiscRun run = run_two_discs(parameters);
  results.write(name, {{"rate", parameters.rate},
                       {"collides", run.smallest_gap_over_h < 0.0 ? 1.0 : 0.0},
                       {"steps", static_cast<double>(run.steps)},
                       {"smallest_gap_over_h", run.smallest_gap_over_h}});
}

}  // namespace

int main(int argc, char** argv) {
  return run_experiment({"local_coupling",
                         {"rate2_global", "rate2_local", "rate1_global", "rate1_local"},
                         run_case,
                         [](const Results&) {}},
                        argc, argv);
}
