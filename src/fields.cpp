#include "fields.hpp"

#include <algorithm>
#include <cmath>

#include "csv.hpp"

namespace stokes {

namespace {

Square square_around(const Suspension& bodies) {
  if (bodies.container) {
    const double r = bodies.container->radius;
    return {bodies.container->centre - Complex(r, r), 2.0 * r};
  }
  Complex low = bodies[0].pose.centre, high = low;
  double radius = 0.0;
  for (const Body& body : bodies) {
    const Complex c = body.pose.centre;
    low = {std::min(low.real(), c.real()), std::min(low.imag(), c.imag())};
    high = {std::max(high.real(), c.real()), std::max(high.imag(), c.imag())};
    radius = std::max(radius, body.shape.circumradius());
  }
  const double side = std::max((high - low).real(), (high - low).imag()) + 6.0 * radius;
  return {0.5 * (low + high) - 0.5 * Complex(side, side), side};
}

bool in_fluid(const Suspension& bodies, Complex x) {
  if (bodies.container && std::abs(x - bodies.container->centre) > bodies.container->radius) return false;
  return std::none_of(bodies.begin(), bodies.end(), [x](const Body& body) {
    const Complex z = std::conj(body.pose.axis()) * (x - body.pose.centre);
    return std::hypot(z.real() / body.shape.a, z.imag() / body.shape.b) < 1.0;
  });
}

}  // namespace

GridFlow flow_on_grid(const Suspension& bodies, const StepperOptions& options, double driving,
                      const std::vector<Wrench>& contact, const Square& square, int points) {
  GridFlow grid;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Wrench more = contact.empty() ? Wrench{} : contact[i];
    grid.wrenches.push_back({bodies[i].force + more.force, bodies[i].torque + more.torque});
  }
  ShapeCache shapes(options.near_singular);
  const BackgroundFlow flow{options.flow.kind, driving * options.flow.rate, driving};
  ResolvedSystem resolved;
  if (options.accuracy > 0.0) {
    ShapeResolution alone;
    std::vector<Resolution> resolution;
    resolved = solve_to_accuracy({bodies, flow, grid.wrenches, {}}, options.accuracy, options.stokes, shapes, alone, resolution);
  } else {
    const std::vector<Discretisation> nodes = options.refine == Refine::near
                                                  ? refined_nodes(bodies, options.points_per_body, near_tolerance)
                                                  : equal_nodes(bodies, options.points_per_body);
    resolved.system = std::make_unique<StokesSystem>(bodies, nodes, shapes, options.stokes);
    resolved.solution = resolved.system->solve(flow, grid.wrenches);
  }
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (bodies[i].fixed) grid.wrenches[i] = resolved.solution.reaction[i];

  std::vector<Complex> fluid;
  for (int j = 0; j < points; ++j)
    for (int i = 0; i < points; ++i) {
      const Complex x = square.corner + square.side / (points - 1) * Complex(i, j);
      grid.points.push_back({x, !in_fluid(bodies, x), {}});
      if (!grid.points.back().inside) fluid.push_back(x);
    }
  const std::vector<PointFlow> flows = resolved.system->flow(fluid, resolved.solution.density, flow, grid.wrenches);
  std::size_t next = 0;
  for (GridPoint& point : grid.points)
    if (!point.inside) point.flow = flows[next++];
  return grid;
}

void write_fields(const std::filesystem::path& path, const Suspension& bodies, const StepperOptions& options,
                  double driving, const std::vector<Wrench>& contact, int points) {
  std::string text = "x,y,u,v,p,sigma_xx,sigma_xy,sigma_yy,inside\n";
  const GridFlow grid = flow_on_grid(bodies, options, driving, contact, square_around(bodies), points);
  for (const GridPoint& point : grid.points) {
    std::vector<double> row{point.x.real(), point.x.imag()};
    if (point.inside) {
      row.resize(8, std::nan(""));
      row.push_back(1.0);
    } else {
      const PointFlow& f = point.flow;
      const Stress s = stress(f);
      for (double value : {f.velocity.real(), f.velocity.imag(), f.pressure, s.xx, s.xy, s.yy, 0.0}) row.push_back(value);
    }
    std::vector<std::string> fields;
    for (double value : row) fields.push_back(format_number(value));
    text += join(fields, ",") + "\n";
  }
  write_file_atomically(path, text);
}

}  // namespace stokes
