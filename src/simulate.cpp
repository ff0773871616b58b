// simulate CASE.txt [key=value ...]: runs a suspension described by a case file (case.hpp).
// Exit status: 0 done; 2 bad input, nothing written; 3 numerical failure, everything up to it written.

#include <cstdio>
#include <string>
#include <vector>

#include "case.hpp"
#include "neighbours.hpp"
#include "progress.hpp"
#include "recorder.hpp"
#include "threads.hpp"

namespace {

using namespace stokes;

constexpr double resolved_tail = 1e-3;  // share of the density's energy in its top modes

SimulationOptions options_of(const Case& c, double separation) {
  SimulationOptions options;
  options.stepper.flow = {c.flow, c.rate};
  options.stepper.points_per_body = c.points_per_body;
  options.stepper.stokes.gmres_tolerance = c.gmres_tolerance;
  options.stepper.near_singular = c.near_singular;
  options.stepper.contact = c.contact;
  options.stepper.separation = separation;
  options.stepper.coupling = c.coupling;
  options.stepper.lcp_matrix = c.lcp_matrix;
  options.stepper.stiv_vertices = c.stiv_vertices;
  options.stepper.stiv_gradient = c.stiv_gradient;
  options.time_step = c.time_step;
  options.end_time = c.end_time;
  options.reverse_at = c.reverse_at;
  options.time_counting = c.time_counting;
  options.adaptive = c.adaptive;
  return options;
}

void warn_of_small_gaps(const Case& c, const Suspension& bodies, double separation, Progress& progress) {
  const ClosestPair closest = smallest_gap(bodies);
  if (c.contact != ContactModel::none && closest.gap < separation)
    progress.message(concat("warning: bodies ", closest.a, " and ", closest.b, " start ", closest.gap,
                            " apart, below the minimum separation ", separation, "; the first step restores it"));
}

int run(const std::vector<std::string>& arguments) {
  const Case c = read_case(arguments[0], {arguments.begin() + 1, arguments.end()});
  const Suspension bodies = read_suspension(c);
  const double separation = separation_length(c, bodies);
  if (c.threads) set_thread_count(*c.threads);
  Progress progress(c.end_time);
  warn_of_small_gaps(c, bodies, separation, progress);

  Recorder recorder(c.output, c.output_every);
  bool warned = false;
  const RunSummary summary = simulate(bodies, options_of(c, separation), [&](const StepRecord& record) {
    recorder.record(record);
    progress.show(record);
    if (!warned && record.outcome && record.outcome->density_tail > resolved_tail) {
      warned = true;
      progress.message(concat("warning: at time ", record.time, " the top third of the Fourier modes holds ",
                              record.outcome->density_tail, " of a density's energy (more than ", resolved_tail,
                              "); more points_per_body would resolve it"));
    }
  });
  std::printf("%ld steps, %ld rejected\n", summary.steps, summary.rejected);
  std::printf("preconditioner factorisations: %d (distinct shapes: %d)\n", summary.factorisations, summary.shapes);
  std::printf("results in %s\n", c.output.c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.empty() || arguments[0] == "--help" || arguments[0] == "-h") {
    std::fprintf(arguments.empty() ? stderr : stdout, "usage: simulate CASE.txt [key=value ...]\n\n%s", case_help().c_str());
    return arguments.empty() ? 2 : 0;
  }
  try {
    return run(arguments);
  } catch (const InputError& error) {
    std::fprintf(stderr, "simulate: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "simulate: %s\n", error.what());
    return 3;
  }
}
