#include "shortfall.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "fronts.hpp"
#include "text.hpp"

namespace stokes {

namespace {

constexpr double least_error = 1e-6;  // of velocities; smaller errors do not matter to a pair
constexpr double largest_of_pair = 0.1, largest_alone = 1e-3;

}  // namespace

std::vector<Shortfall> shortfalls(const Suspension& bodies, const std::vector<Discretisation>& nodes,
                                  ShapeResolution& alone) {
  const std::vector<Shape> shapes = boundary_shapes(bodies);
  const int count = static_cast<int>(bodies.size());
  std::vector<double> reach;
  for (std::size_t i = 0; i < shapes.size(); ++i)
    reach.push_back(resolved_distance(shapes[i], nodes[i].points, least_error));
  std::map<std::pair<int, int>, Shortfall> pairs;
  for (const Front& f : fronts(bodies, reach)) {
    const double missed = std::exp(-resolved_digits(shapes[f.boundary], nodes[f.boundary], f));
    const double error = missed / gap_mobility(f.gap * f.curvature);
    const auto [i, j] = std::minmax(f.boundary, f.other);
    Shortfall& found = pairs.try_emplace({i, j}, Shortfall{i, j == count ? container_index : j, f.gap, 0.0}).first->second;
    found.error = std::max(found.error, error);
  }
  std::vector<Shortfall> result;
  for (const auto& entry : pairs)
    if (entry.second.error > largest_of_pair) result.push_back(entry.second);
  for (int i = 0; i < count; ++i)
    if (const double error = alone.error(bodies[i].shape, nodes[i].points); error > largest_alone)
      result.push_back({i, i, 0.0, error});
  std::stable_sort(result.begin(), result.end(), [](const Shortfall& s, const Shortfall& t) { return s.error > t.error; });
  return result;
}

std::string describe(const Shortfall& s) {
  if (s.a == s.b)
    return concat("the nodes of body ", s.a, " do not resolve its own form: the estimated error of its velocities is ",
                  brief(s.error),
                  " of the rate; write accuracy = 1e-4 in place of points_per_body, or more points_per_body");
  return concat("the nodes of ", pair_name(s.a, s.b), " do not resolve their gap of ", brief(s.gap),
                ": the estimated relative error of its rate is ", brief(s.error),
                "; write accuracy = 1e-4 in place of points_per_body (and wall_points)");
}

}  // namespace stokes
