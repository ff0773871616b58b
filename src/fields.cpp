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

// Wrench of each body on the fluid: the given and the contact force of a free body, the reaction of a fixed one.
std::vector<Wrench> wrenches_on_fluid(const Suspension& bodies, const std::vector<Wrench>& contact,
                                      const std::vector<Wrench>& reaction) {
  std::vector<Wrench> wrenches;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Wrench more = contact.empty() ? Wrench{} : contact[i];
    wrenches.push_back({bodies[i].force + more.force, bodies[i].torque + more.torque});
    if (bodies[i].fixed && !reaction.empty()) wrenches[i] = reaction[i];
  }
  return wrenches;
}

GridFlow on_grid(const Suspension& bodies, const StokesSystem& system, const ComplexVector& density,
                 const BackgroundFlow& flow, std::vector<Wrench> wrenches, const Square& square, int points) {
  GridFlow grid;
  std::vector<Complex> fluid;
  for (int j = 0; j < points; ++j)
    for (int i = 0; i < points; ++i) {
      const Complex x = square.corner + square.side / (points - 1) * Complex(i, j);
      grid.points.push_back({x, !in_fluid(bodies, x), {}});
      if (!grid.points.back().inside) fluid.push_back(x);
    }
  const std::vector<PointFlow> flows = system.flow(fluid, density, flow, wrenches);
  std::size_t next = 0;
  for (GridPoint& point : grid.points)
    if (!point.inside) point.flow = flows[next++];
  grid.wrenches = std::move(wrenches);
  return grid;
}

}  // namespace

GridFlow flow_on_grid(const Suspension& bodies, const StepperOptions& options, double driving,
                      const std::vector<Wrench>& contact, const Square& square, int points) {
  const std::vector<Wrench> given = wrenches_on_fluid(bodies, contact, {});
  ShapeCache shapes(options.near_singular);
  const BackgroundFlow flow = options.flow.driven(driving);
  ResolvedSystem resolved;
  if (options.accuracy > 0.0) {
    ShapeResolution alone;
    std::vector<Resolution> resolution;
    resolved = solve_to_accuracy({bodies, flow, given, {}}, options.accuracy, options.stokes, shapes, alone, resolution);
  } else {
    resolved.system = std::make_unique<StokesSystem>(bodies, given_nodes(bodies, options), shapes, options.stokes);
    resolved.solution = resolved.system->solve(flow, given);
  }
  return on_grid(bodies, *resolved.system, resolved.solution.density, flow,
                 wrenches_on_fluid(bodies, contact, resolved.solution.reaction), square, points);
}

GridFlow flow_on_grid(const StepRecord& record, const StepperOptions& options, const Square& square, int points) {
  if (!record.outcome) return flow_on_grid(record.bodies, options, record.driving, {}, square, points);
  const StepOutcome& step = *record.outcome;
  if (!step.at_start)
    return flow_on_grid(record.bodies, options, record.driving, step.contact_wrench, square, points);
  return on_grid(record.bodies, step.at_start->system(), step.density, options.flow.driven(record.driving),
                 wrenches_on_fluid(record.bodies, step.contact_wrench, step.reaction), square, points);
}

void write_fields(const std::filesystem::path& path, const StepRecord& record, const StepperOptions& options, int points) {
  std::string text = "x,y,u,v,p,sigma_xx,sigma_xy,sigma_yy,inside\n";
  const GridFlow grid = flow_on_grid(record, options, square_around(record.bodies), points);
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
