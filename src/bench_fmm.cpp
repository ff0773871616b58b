// bench_fmm [points=N] [tolerance=T] [threads=K] [distribution=uniform|discs|annulus]
//           [output=velocity|gradient]
// times the fast multipole method for stresslets, the targets being the sources, and prints one CSV row:
//   points,tolerance,threads,plan_seconds,evaluate_seconds,direct_seconds,max_relative_error
// Seconds of wall time, medians of five; direct_seconds is extrapolated from some of the targets where the
// whole sum takes long. The error is that at 1000 targets, over the largest value there, the largest one of
// velocity and, for output=gradient, pressure and gradient.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "fmm.hpp"
#include "point_sets.hpp"
#include "text.hpp"
#include "threads.hpp"

namespace {

using namespace stokes;

struct Options {
  int points = 100000;
  double tolerance = 1e-9;
  PointSet distribution = PointSet::uniform;
  FlowOutput output = FlowOutput::velocity;
};

constexpr const char* usage =
    "usage: bench_fmm [points=N] [tolerance=T] [threads=K] [distribution=uniform|discs|annulus] "
    "[output=velocity|gradient]";

[[noreturn]] void refuse(const std::string& argument) {
  throw InputError(concat("bench_fmm: ", quote(argument), " is not understood; ", usage));
}

int whole_number(const std::string& argument, const std::string& value, long long largest) {
  const auto number = parse_integer(value);
  if (!number || *number < 1 || *number > largest) refuse(argument);
  return static_cast<int>(*number);
}

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const std::size_t equals = argument.find('=');
    if (equals == std::string::npos) refuse(argument);
    const std::string key = argument.substr(0, equals), value = argument.substr(equals + 1);
    if (key == "points") {
      options.points = whole_number(argument, value, 100'000'000);
    } else if (key == "threads") {
      set_thread_count(whole_number(argument, value, most_threads));
    } else if (key == "tolerance" && parse_number(value)) {
      options.tolerance = *parse_number(value);
    } else if (argument == "distribution=uniform") {
      options.distribution = PointSet::uniform;
    } else if (argument == "distribution=discs") {
      options.distribution = PointSet::discs;
    } else if (argument == "distribution=annulus") {
      options.distribution = PointSet::annulus;
    } else if (argument == "output=velocity") {
      options.output = FlowOutput::velocity;
    } else if (argument == "output=gradient") {
      options.output = FlowOutput::gradient;
    } else {
      refuse(argument);
    }
  }
  return options;
}

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median_seconds(const std::function<void()>& work) {
  std::vector<double> seconds(5);
  for (double& s : seconds) s = seconds_of(work);
  std::sort(seconds.begin(), seconds.end());
  return seconds[2];
}

// Every so many-th target: `count` of them.
std::vector<int> sample(int targets, int count) {
  std::vector<int> chosen(std::min(targets, count));
  const long n = static_cast<long>(chosen.size());
  for (long k = 0; k < n; ++k) chosen[k] = static_cast<int>(k * targets / n);
  return chosen;
}

PointArray at(const PointArray& points, const std::vector<int>& chosen) {
  PointArray result;
  result.resize(static_cast<int>(chosen.size()));
  for (int k = 0; k < result.size(); ++k) result.set(k, points[chosen[k]]);
  return result;
}

template <class Values>
double relative_error(const Values& approximate, const Values& exact, const std::vector<int>& chosen) {
  double error = 0.0, largest = 0.0;
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    error = std::max(error, std::abs(approximate[chosen[k]] - exact[k]));
    largest = std::max(largest, std::abs(exact[k]));
  }
  return error == 0.0 ? 0.0 : error / largest;
}

void run(const Options& options) {
  std::mt19937_64 generator(1);
  const NormalPoints nodes = make_points(options.distribution, options.points, generator);
  const ComplexVector density = random_vectors(options.points, generator);
  const SourceStrengths strengths{.weighted_normal = &nodes.weighted_normal, .density = &density};
  const FmmOptions fmm{options.tolerance};

  const double plan_seconds = median_seconds([&] { FmmPlan plan(nodes.points, fmm); });
  const FmmPlan plan(nodes.points, fmm);
  FlowFields fields, exact;
  plan.evaluate(strengths, options.output, fields);
  const double evaluate_seconds = median_seconds([&] { plan.evaluate(strengths, options.output, fields); });

  constexpr long pairs = 400'000'000;
  const auto timed = sample(options.points, static_cast<int>(std::max<long>(1000, pairs / options.points)));
  const PointArray timed_targets = at(nodes.points, timed);
  const double part = median_seconds([&] {
    if (options.output == FlowOutput::gradient) {
      direct_fields(timed_targets, nodes.points, strengths, options.output, exact);
    } else {
      double_layer_velocity(timed_targets, nodes.points, nodes.weighted_normal, density, exact.velocity);
    }
  });
  const double direct_seconds = part * options.points / static_cast<double>(timed.size());

  const auto chosen = sample(options.points, 1000);
  direct_fields(at(nodes.points, chosen), nodes.points, strengths, options.output, exact);
  double error = relative_error(fields.velocity, exact.velocity, chosen);
  if (options.output == FlowOutput::gradient) {
    error = std::max({error, relative_error(fields.pressure, exact.pressure, chosen),
                      relative_error(fields.velocity_x, exact.velocity_x, chosen),
                      relative_error(fields.velocity_y, exact.velocity_y, chosen)});
  }
  std::printf("points,tolerance,threads,plan_seconds,evaluate_seconds,direct_seconds,max_relative_error\n");
  std::printf("%d,%.3g,%d,%.4g,%.4g,%.4g,%.3g\n", options.points, options.tolerance, thread_count(),
              plan_seconds, evaluate_seconds, direct_seconds, error);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && (argv[1] == std::string("--help") || argv[1] == std::string("-h"))) {
    std::printf("%s\n\nTimes the fast multipole method for stresslets against the direct sum and prints one CSV row:\n"
                "points,tolerance,threads,plan_seconds,evaluate_seconds,direct_seconds,max_relative_error\n",
                usage);
    return 0;
  }
  try {
    run(parse(argc, argv));
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
