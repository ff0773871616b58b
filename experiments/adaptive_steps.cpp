// Adaptive steps (section 3.3): the runs of Table 1 at delta = 3h with fixed steps, and with adaptive steps. These start
// four times as large, are halved when contact is not resolved in ten iterations, and grow again by 1.5. Variants: the
// exact gap, interference volumes, and the self-mobility in the LCP matrix, which converges slowly.

#include "experiment.hpp"
#include "two_discs.hpp"

namespace {

using namespace stokes;

const std::vector<std::string> time_steps = {"0.04", "0.02", "0.01"};

void run_case(const std::string& name, const Results& results) {
  TwoDiscs parameters;
  parameters.adaptive = name.starts_with("adaptive");
  parameters.rate = 2.0;
  parameters.separation_over_h = 3.0;
  const std::size_t number = name.find("_dt") + 3;
  parameters.time_step = *parse_number(name.substr(number, name.find('_', number) - number));
  if (name.ends_with("_stiv")) parameters.contact = ContactModel::stiv;
  if (name.ends_with("_self")) parameters.lcp_matrix = LcpMatrix::self;
  parameters.end_time = 20.0;
  parameters.reverse_at = 10.0;
  const TwoDiscRun run = complete_two_discs(parameters);
  double smallest_step = parameters.time_step;
  for (std::size_t k = 0; k + 1 < run.time.size(); ++k)
    smallest_step = std::min(smallest_step, run.time[k + 1] - run.time[k]);
  results.write(name, {{"time_step", parameters.time_step},
                       {"accepted", static_cast<double>(run.steps)},
                       {"rejected", static_cast<double>(run.rejected)},
                       {"smallest_step", smallest_step},
                       {"gmres_iterations", static_cast<double>(run.gmres_iterations)},
                       {"largest_ncp_iterations", static_cast<double>(run.largest_ncp_iterations)},
                       {"smallest_gap_over_h", run.smallest_gap_over_h},
                       {"reversal_error", reversal_error(run)},
                       {"end_time", run.time.back()}});
}

std::vector<std::string> cases() {
  std::vector<std::string> names;
  for (const std::string& time_step : time_steps)
    for (const char* model : {"", "_stiv", "_self"}) {
      names.push_back(concat("fixed_dt", time_step, model));
      names.push_back(concat("adaptive_dt", 4.0 * *parse_number(time_step), model));
    }
  return names;
}

}  // namespace

int main(int argc, char** argv) {
  return run_experiment({"adaptive_steps", cases(), run_case, [](const Results&) {}}, argc, argv);
}
