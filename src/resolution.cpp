#include "resolution.hpp"

#include <algorithm>
#include <cmath>

#include "fourier.hpp"
#include "threads.hpp"

namespace stokes {

namespace {

// 24, 32, 48, 64, ...
int next_points(int points) { return (points & (points - 1)) == 0 ? points / 2 * 3 : points / 3 * 4; }

// An error e of the data changes velocities at a relative gap G by e / root(G) (a flux into the gap squeezes it).
double root(double relative_gap) { return std::min(1.0, std::sqrt(0.5 * relative_gap)); }
// Densities grow like 1 / root(G), and with them the round-off of the equations.
double round_off(double relative_gap) { return 4e-15 / root(relative_gap); }

// A density's tail shows what the flow excites, not what a force on the body would excite, and the error is the product of
// the two. Nodes are therefore chosen with a margin, which tails can only increase. In 2000 random drops of 2 to 6
// ellipses with an accuracy of 1e-6 these numbers leave 2 larger errors, at most 1.7e-6 of the size of their body. With
// 1.5, 1 and 100 one drop in six has a larger error, and nothing indicates it.
constexpr double first_factor = 2.5;        // of the digits
constexpr double least_of_clusters = 5e-8;  // 18 digits with the margin, more than densities have
constexpr double points_tolerance = 1e-3;   // of N_0, over the accuracy, for flows less smooth than shear
constexpr double tail_factor = 1000.0;

}  // namespace

const ShapeResolution::Alone& ShapeResolution::alone(double aspect, int points) {
  const auto [entry, is_new] = known_.try_emplace({aspect, points});
  if (!is_new) return entry->second;
  ShapeCache shapes;
  for (int k = 0; k < 2; ++k) {
    const Suspension body{{{1.0, aspect}, {0.0, 0.4 * k}}};
    const StokesSystem system(body, points, shapes, {1e-12});
    const StokesSolution solution = system.solve({FlowKind::shear}, {});
    entry->second.omega[k] = solution.velocity[0].omega;
    entry->second.stresslet[k] = system.stresslets(solution.density, {})[0];
  }
  return entry->second;
}

double ShapeResolution::error(const Shape& shape, int points) {
  const double aspect = shape.inradius() / shape.circumradius();
  if (aspect == 1.0) return 0.0;  // exact with any number
  const Alone &a = alone(aspect, points), &b = alone(aspect, next_points(points));
  double largest = 0.0;
  for (int k = 0; k < 2; ++k)
    largest = std::max({largest, std::abs(a.omega[k] - b.omega[k]), std::abs(a.stresslet[k] - b.stresslet[k])});
  return largest;
}

int ShapeResolution::points(const Shape& shape, double tolerance) {
  constexpr double round_off = 1e-12;
  tolerance = std::max(tolerance, round_off);
  int n = 24;
  while (n < most_points && error(shape, n) > tolerance) n = next_points(n);
  return n;
}

int close_upsampling(const Shape& shape, const Discretisation& nodes, double tolerance) {
  constexpr int most = 8;
  int factor = 2;
  for (; factor < most; ++factor) {
    const Curve fine = shape.curve(nodes, factor);
    const ComplexVector modes = fourier_coefficients(fine.derivative.conjugate().cwiseQuotient(fine.derivative));
    const Eigen::Index size = fine.size(), first = (factor - 1) * static_cast<Eigen::Index>(nodes.size()) / 2;
    if (modes.segment(first, size - 2 * first + 1).cwiseAbs().maxCoeff() < tolerance) break;
  }
  return factor;
}

int ResolvedSystem::clusters() const {
  int count = 0;
  for (const Discretisation& d : nodes) count += static_cast<int>(d.clusters.size());
  return count;
}

int ResolvedSystem::most_nodes() const {
  int most = 0;
  for (const Discretisation& d : nodes) most = std::max(most, d.size());
  return most;
}

namespace {

// Nodes, their close evaluation, and the tolerance of the solver.
struct Choice {
  std::vector<Discretisation> nodes;
  std::vector<double> relative_gap;
  double gmres_tolerance;
};

Choice choice(const Suspension& bodies, const std::vector<Shape>& shapes, const std::vector<Resolution>& resolution,
              const std::vector<double>& sizes, double accuracy) {
  auto [nodes, relative_gap] = clustered_nodes(bodies, resolution, accuracy, least_of_clusters);
  double least = 2.0, smallest = accuracy;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    least = std::min(least, relative_gap[i]);
    smallest = std::min(smallest, own_tolerance(accuracy, sizes[i]));
  }
  parallel_for(static_cast<long>(shapes.size()), [&, &nodes = nodes, &relative_gap = relative_gap](long i) {
    const double own = own_tolerance(accuracy, sizes[i]);
    const bool disc = shapes[i].a == shapes[i].b;
    const double tolerance = nodes[i].clusters.empty() ? 0.1 * std::sqrt(own) : own * root(relative_gap[i]);
    nodes[i].upsampling = disc ? 2 : close_upsampling(shapes[i], nodes[i], std::max(tolerance, 1e-13));
  });
  const double wanted = std::min(smallest * root(least), rate_tolerance(least));
  return {std::move(nodes), std::move(relative_gap), std::max({wanted, round_off(least), 1e-12})};
}

// Adds half as many nodes again. False at the largest number: a tail that stays is round-off, also in the next step.
bool add_nodes(Resolution& r) {
  constexpr double most_factor = 8.0;
  if (r.points >= most_points && r.factor >= most_factor) return false;
  r.points = std::min(most_points, 2 * static_cast<int>(std::ceil(0.75 * r.points)));
  r.factor = std::min(most_factor, 1.5 * r.factor);
  return true;
}

}  // namespace

ResolvedSystem solve_to_accuracy(const ResolvedProblem& problem, double accuracy, StokesOptions options, ShapeCache& shapes,
                                 ShapeResolution& alone, std::vector<Resolution>& resolution) {
  constexpr int most_solves = 4;
  const std::vector<Shape> forms = boundary_shapes(problem.bodies);
  const std::vector<double> sizes = relative_sizes(problem.bodies);
  if (resolution.empty())
    for (std::size_t i = 0; i < forms.size(); ++i)
      resolution.push_back({alone.points(forms[i], points_tolerance * own_tolerance(accuracy, sizes[i])), first_factor});
  ResolvedSystem result;
  int iterations = 0;
  for (;;) {
    Choice chosen = choice(problem.bodies, forms, resolution, sizes, accuracy);
    options.gmres_tolerance = chosen.gmres_tolerance;
    ComplexVector guess;
    if (result.solves > 0)
      guess = move_densities(result.solution.density, result.nodes, chosen.nodes);
    else if (problem.guess)
      guess = problem.guess(chosen.nodes);
    result.nodes = std::move(chosen.nodes);
    result.system = std::make_unique<StokesSystem>(problem.bodies, result.nodes, shapes, options);
    result.solution = result.system->solve(problem.flow, problem.wrenches, guess);
    iterations += result.solution.iterations;
    ++result.solves;
    result.error = 0.0;
    result.unresolved.clear();
    bool added = false;
    const double largest = *std::max_element(sizes.begin(), sizes.end());
    const std::vector<double> tails = result.system->density_tails(result.solution.density);
    for (std::size_t i = 0; i < tails.size(); ++i) {
      const double of_round_off = round_off(chosen.relative_gap[i]) / root(chosen.relative_gap[i]) * largest;
      const double of_nodes = tail_factor * tails[i] * tails[i] * sizes[i];
      const double error = std::max(of_round_off, of_nodes);
      result.error = std::max(result.error, error);
      if (error > accuracy) result.unresolved.push_back(static_cast<int>(i));
      if (error > accuracy && of_nodes > of_round_off && result.solves < most_solves) added |= add_nodes(resolution[i]);
    }
    if (!added) break;
  }
  result.solution.iterations = iterations;
  return result;
}

}  // namespace stokes
