// bench [threads=K]: times the kernels and the solver; one CSV table on stdout.
//   quantity,size,threads,value,unit      value: median of five

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numeric>
#include <optional>
#include <string>

#include "direct_sum.hpp"
#include "gmres.hpp"
#include "stepper.hpp"
#include "text.hpp"
#include "threads.hpp"

namespace {

using namespace stokes;

double median_seconds(const std::function<void()>& work) {
  std::vector<double> seconds;
  for (int run = 0; run < 5; ++run) {
    const auto start = std::chrono::steady_clock::now();
    work();
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::sort(seconds.begin(), seconds.end());
  return seconds[2];
}

void report(const char* quantity, long size, double value, const char* unit) {
  std::printf("%s,%ld,%d,%.4g,%s\n", quantity, size, thread_count(), value, unit);
  std::fflush(stdout);
}

void bench_direct_sum(int points) {
  PointArray nodes, normals;
  nodes.resize(points), normals.resize(points);
  ComplexVector density(points), velocity;
  for (int k = 0; k < points; ++k) {
    nodes.set(k, std::polar(std::sqrt(k + 1.0), 2.4 * k));
    normals.set(k, std::polar(0.1, 1.0 * k));
    density[k] = std::polar(1.0, 0.3 * k);
  }
  const double seconds = median_seconds([&] { double_layer_velocity(nodes, nodes, normals, density, velocity); });
  report("direct_sum", points, 1e-9 * points * points / seconds, "1e9 pairs per second");
}

// Ellipses of aspect 3 on a square lattice, gaps of about half a semi-axis.
Suspension lattice(int side) {
  Suspension bodies;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      bodies.push_back({{0.45, 0.15}, {{1.1 * i, 0.6 * j}, 0.02 * (i + 2 * j)}, {}, {}});
  return bodies;
}

void bench_step(int side, int points) {
  StepperOptions options;
  options.flow = {FlowKind::shear, 1.0};
  options.points_per_body = points;
  options.stokes.gmres_tolerance = 1e-6;
  Stepper stepper(lattice(side), options);
  int iterations = 0;
  stepper.step(1e-3, 1.0, {});
  const double seconds = median_seconds([&] { iterations = stepper.step(1e-3, 1.0, {}).gmres_iterations; });
  report("step", static_cast<long>(side) * side * points, seconds, "seconds");
  report("step_gmres_iterations", static_cast<long>(side) * side * points, iterations, "1");
}

// One iteration of GMRES by part, for free discs on a square lattice, a tenth of a radius apart, tolerance 1e-6:
// multipole sum, the rest of the operator (near corrections, diagonal), the preconditioner, and the orthogonalisation
// in the mean over 20 iterations.
void bench_iteration(int side, int points) {
  Suspension discs;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) discs.push_back({{1.0, 1.0}, {{2.1 * i, 2.1 * j}, 0.0}, {}, {}});
  const long nodes = static_cast<long>(side) * side * points;
  ShapeCache shapes;
  StokesOptions options;
  options.gmres_tolerance = 1e-6;
  options.summation = Summation::fmm;
  std::optional<StokesSystem> system;
  report("setup", nodes, median_seconds([&] { system.emplace(discs, points, shapes, options); }), "seconds");
  Vector in = Vector::LinSpaced(2 * nodes, -1.0, 1.0), out(2 * nodes);
  BoundarySet set(system->boundaries(), [&] {
    std::vector<int> all(discs.size());
    std::iota(all.begin(), all.end(), 0);
    return all;
  }());
  const FmmPlan plan(set.nodes, {0.1 * options.gmres_tolerance});
  const ComplexVector density = ComplexVector::Ones(nodes);
  SourceStrengths strengths;
  strengths.weighted_normal = &set.weighted_normal, strengths.density = &density;
  FlowFields fields;
  const double sum = median_seconds([&] { plan.evaluate(strengths, FlowOutput::velocity, fields); });
  const double whole = median_seconds([&] { system->apply(in, out); });
  const double preconditioner = median_seconds([&] { system->precondition(in, out); });
  constexpr int iterations = 20;
  const Vector spectrum = Vector::LinSpaced(2 * nodes, 1.0, 1e6);
  const double orthogonalisation = median_seconds([&] {
    gmres([&](const Vector& v, Vector& w) { w = spectrum.cwiseProduct(v); }, [](const Vector& v, Vector& w) { w = v; }, in,
          {}, {.tolerance = 1e-15, .max_iterations = iterations});
  });
  report("iteration_multipole_sum", nodes, sum, "seconds");
  report("iteration_rest_of_operator", nodes, whole - sum, "seconds");
  report("iteration_preconditioner", nodes, preconditioner, "seconds");
  report("iteration_orthogonalisation", nodes, orthogonalisation / iterations, "seconds");
}

}  // namespace

constexpr const char* usage = "usage: bench [threads=K]\n";

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--help" || argument == "-h") {
      std::printf("%s\nTimes the kernels and the solver and prints one CSV table: quantity,size,threads,value,unit,\n"
                  "each value the median of five.\n", usage);
      return 0;
    }
    const auto threads = argument.starts_with("threads=") ? parse_integer(argument.substr(8)) : std::nullopt;
    if (!threads || *threads < 1 || *threads > most_threads) {
      std::fputs(usage, stderr);
      return 2;
    }
    set_thread_count(static_cast<int>(*threads));
  }
  std::printf("quantity,size,threads,value,unit\n");
  for (int points : {64, 1024, 4096}) bench_direct_sum(points);
  bench_step(2, 32);
  bench_step(7, 32);
  bench_iteration(71, 32);
}
