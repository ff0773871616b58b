// Limits of the flow on the curve by singularity subtraction, against those of the Cauchy integrals.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "boundary_limits.hpp"
#include "close_flow.hpp"
#include "flow_checks.hpp"
#include "wall_flows.hpp"

using namespace stokes;

namespace {

std::vector<PointFlow> every(std::size_t stride, const std::vector<PointFlow>& flows) {
  std::vector<PointFlow> some;
  for (std::size_t k = 0; k < flows.size(); k += stride) some.push_back(flows[k]);
  return some;
}

}  // namespace

TEST_CASE("the limits on discs and ellipses converge spectrally, and both methods to the same values") {
  std::string table =
      "relative errors of the limits of velocity, pressure and gradient on ellipses of semi-axes 1, 1/aspect:\n"
      "  aspect  side      N  alternate points         Cauchy integrals\n";
  for (int aspect : {1, 2, 3})
    for (Side side : {Side::exterior, Side::interior}) {
      const Boundary boundary = ellipse_boundary(1.0, 1.0 / aspect);
      const auto exact = CloseFlow(boundary(256), side, 3, smooth_density(256)).at_nodes();
      double previous = 0.0;
      for (int points : {16, 32, 64, 128}) {
        const Curve curve = boundary(points);
        const ComplexVector eta = smooth_density(points);
        const CloseFlow cauchy(curve, side, flow_upsampling(aspect, points), eta);
        const auto expected = every(256 / points, exact);
        const FlowErrors a = flow_errors(boundary_limits(curve, side, eta), expected);
        const FlowErrors b = flow_errors(cauchy.at_nodes(), expected);
        char line[120];
        std::snprintf(line, sizeof line, "  %6d  %-7s %3d  %.1e %.1e %.1e  %.1e %.1e %.1e\n", aspect,
                      side == Side::interior ? "inside" : "outside", points, a.velocity, a.pressure, a.gradient,
                      b.velocity, b.pressure, b.gradient);
        table += line;
        // Spectral: twice the nodes square the error, or nearly so, down to round-off.
        if (points > 16) CHECK(a.largest() < 10.0 * std::pow(previous, 1.7) + 1e-11);
        if (points == 64) CHECK(a.largest() < std::max(0.01 * previous, 1e-8));
        previous = a.largest();
        if (points >= 32) CHECK(b.largest() < 3e-12);
        if (points == 128) CHECK(a.largest() < 3e-12);
      }
    }
  MESSAGE(table);
}

TEST_CASE("on the boundaries of a flow between walls both methods agree ever better with N, by 100 from 32 to 64") {
  std::string table = "relative differences of velocity, pressure and gradient, largest over the boundaries:\n";
  double previous = 0.0;
  for (const int points : {32, 64, 128}) {
    const ManufacturedFlow flow{{points, points, points, 2 * points}};
    ShapeCache shapes;
    const StokesSystem system(flow.bodies, points, shapes, {1e-12, 1000});
    const ComplexVector density = system.solve_for_velocity(flow.boundary_velocity(system)).density;
    FlowErrors largest;
    for (const PlacedShape& b : system.boundaries()) {
      const Shape& shape = b.shape->shape;
      const ComplexVector eta = density.segment(b.offset, b.size());
      const int upsampling = flow_upsampling(shape.circumradius() / shape.inradius(), b.size());
      const FlowErrors e = flow_errors(boundary_limits(b.shape->curve, b.shape->side(), eta),
                                       CloseFlow(b.shape->curve, b.shape->side(), upsampling, eta).at_nodes());
      largest = {std::max(largest.velocity, e.velocity), std::max(largest.pressure, e.pressure),
                 std::max(largest.gradient, e.gradient)};
    }
    char line[100];
    std::snprintf(line, sizeof line, "  %3d  %.1e %.1e %.1e\n", points, largest.velocity, largest.pressure,
                  largest.gradient);
    table += line;
    if (points == 64) CHECK(largest.largest() < 0.01 * previous);
    if (points == 128) CHECK(largest.largest() < 1e-8);
    previous = largest.largest();
  }
  MESSAGE(table);
}

TEST_CASE("on an ellipse of 6:1 and on a curve that is not convex both methods agree to 1e-10 at N = 256") {
  for (const Boundary& boundary : {ellipse_boundary(1.0, 1.0 / 6.0), Boundary(three_lobed_curve)})
    for (Side side : {Side::exterior, Side::interior}) {
      const Curve curve = boundary(256);
      const ComplexVector eta = smooth_density(256);
      const auto expected = CloseFlow(curve, side, 3, eta).at_nodes();
      CHECK(flow_errors(boundary_limits(curve, side, eta), expected).largest() < 1e-10);
    }
}

TEST_CASE("the limits are those of the double layer off the curve") {
  const Curve curve = three_lobed_curve(256);
  for (Side side : {Side::exterior, Side::interior}) {
    const auto limits = boundary_limits(curve, side, smooth_density(256));
    const Curve fine = three_lobed_curve(65536);
    const ComplexVector eta = smooth_density(65536);
    // Extrapolated to the curve from 1, 2 and 3 times 1e-3.
    std::vector<PointFlow> at[3], extrapolated, expected;
    for (int k = 0; k < 3; ++k) at[k] = direct_flow(fine, side, eta, points_beside(curve, side, 1e-3 * (k + 1), 16));
    for (int k = 0; k < 16; ++k) {
      extrapolated.push_back(3.0 * at[0][k] - 3.0 * at[1][k] + at[2][k]);
      expected.push_back(limits[16 * k]);
    }
    const FlowErrors error = flow_errors(extrapolated, expected);
    CHECK(error.velocity < 1e-5);
    CHECK(error.pressure < 1e-5);
    CHECK(error.gradient < 1e-5);
  }
}

TEST_CASE("a curve with an odd number of nodes is refused") {
  CHECK_THROWS_AS(boundary_limits(Shape{}.curve(17), Side::exterior, ComplexVector::Ones(17)), InputError);
}
