// Figure 8: the initial suspensions between cylinders: bodies, area fraction, alignment, smallest gap, and the number of
// tries for their placement; and one file of all bodies for the picture.

#include "couette.hpp"
#include "neighbours.hpp"

namespace {

using namespace stokes;

void run_start(const std::string& name, const Results& results) {
  const CouetteSuspension& suspension = couette_suspension(name);
  const Suspension bodies = CouetteCase{suspension}.bodies();
  std::vector<std::vector<double>> rows;
  for (const Body& body : bodies)
    if (!body.fixed)
      rows.push_back({body.shape.a, body.shape.b, body.pose.centre.real(), body.pose.centre.imag(), body.pose.angle});
  results.write(name + "_bodies", {"a", "b", "x", "y", "theta"}, rows);
  results.write(name, {{"bodies", static_cast<double>(rows.size())},
                       {"tries", static_cast<double>(couette_placement(suspension, suspension.paper_seed).tries)},
                       {"area_fraction", area_fraction(bodies, couette_annulus())},
                       {"order_parameter", order_parameter(bodies)},
                       {"smallest_gap", smallest_gap(bodies).gap}});
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
