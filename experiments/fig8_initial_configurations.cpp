// Figure 8: the suspensions between cylinders as they start: area fraction, alignment, smallest gap. One file for each
// seed, and one of all bodies for the picture.

#include "couette.hpp"
#include "neighbours.hpp"

namespace {

using namespace stokes;

constexpr int shown_seeds = 5;

void run_start(const std::string& name, const Results& results) {
  const auto suspension = std::find_if(couette_suspensions.begin(), couette_suspensions.end(),
                                       [&](const CouetteSuspension& s) { return s.name() == name; });
  double mean = 0.0, squares = 0.0, gap = std::numeric_limits<double>::infinity(), fraction = 0.0;
  for (int seed = 1; seed <= shown_seeds; ++seed) {
    const Suspension bodies = couette_bodies(*suspension, static_cast<std::uint64_t>(seed));
    const double S = order_parameter(bodies);
    mean += S / shown_seeds, squares += S * S / shown_seeds;
    gap = std::min(gap, smallest_gap(bodies).gap);
    fraction = area_fraction(bodies, couette_annulus());
    if (seed > 1) continue;
    std::vector<std::vector<double>> rows;
    for (const Body& body : bodies)
      if (!body.fixed)
        rows.push_back({body.shape.a, body.shape.b, body.pose.centre.real(), body.pose.centre.imag(), body.pose.angle});
    results.write(name + "_bodies", {"a", "b", "x", "y", "theta"}, rows);
  }
  // Of n bodies with random directions S has the variance 1/(2n).
  results.write(name, {{"bodies", static_cast<double>(suspension->count)},
                       {"area_fraction", fraction},
                       {"mean_order_parameter", mean},
                       {"mean_square_times_2n", squares * 2.0 * suspension->count},
                       {"smallest_gap", gap}});
}

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (const CouetteSuspension& s : couette_suspensions) result.push_back(s.name());
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  return run_experiment({"fig8_initial_configurations", names(), run_start, [](const Results&) {}}, argc, argv);
}
