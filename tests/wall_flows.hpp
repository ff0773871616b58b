// A manufactured flow between fixed boundaries, and errors of flows in a container.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "completion.hpp"
#include "random_suspension.hpp"
#include "stokes_system.hpp"

namespace stokes {

struct WallFlowErrors {
  double velocity = 0.0, pressure = 0.0, stress = 0.0;  // largest, relative to the largest value
};

// Pressures are compared up to a constant, chosen at the first point.
inline WallFlowErrors wall_flow_errors(const std::vector<PointFlow>& flow, const std::vector<PointFlow>& exact) {
  WallFlowErrors e;
  double u = 0.0, p = 0.0, sigma = 0.0;
  const double constant = flow[0].pressure - exact[0].pressure;
  for (std::size_t i = 0; i < flow.size(); ++i) {
    PointFlow shifted = flow[i];
    shifted.pressure -= constant;
    const Stress a = stress(shifted), b = stress(exact[i]);
    e.velocity = std::max(e.velocity, std::abs(flow[i].velocity - exact[i].velocity));
    e.pressure = std::max(e.pressure, std::abs(shifted.pressure - exact[i].pressure));
    e.stress = std::max({e.stress, std::abs(a.xx - b.xx), std::abs(a.xy - b.xy), std::abs(a.yy - b.yy)});
    u = std::max(u, std::abs(exact[i].velocity));
    p = std::max(p, std::abs(exact[i].pressure));
    sigma = std::max({sigma, std::abs(b.xx), std::abs(b.xy), std::abs(b.yy)});
  }
  return {e.velocity / u, e.pressure / std::max(p, sigma), e.stress / sigma};
}

// Two inner walls and three ellipses in a container, all held, and a flow between them: stokeslets, rotlets and
// stresslets in every hole, stresslets beyond the container.
struct ManufacturedFlow {
  struct Points {
    int first_wall, second_wall, ellipses, container;
  };
  Suspension bodies;

  explicit ManufacturedFlow(const Points& points) {
    const auto hold = [this](Shape shape, Complex centre, double angle, int nodes) {
      bodies.push_back({shape, {centre, angle}, 0.0, 0.0, true, {}, nodes});
    };
    hold({0.6, 0.6}, {-1.5, 0.5}, 0.2, points.first_wall);
    hold({0.4, 0.4}, {1.2, 1.6}, 0.0, points.second_wall);
    hold({0.5, 0.25}, {1.3, -0.4}, 0.7, points.ellipses);
    hold({0.4, 0.2}, {-0.3, -1.7}, -0.4, points.ellipses);
    hold({0.3, 0.3}, {-0.2, 1.9}, 0.0, points.ellipses);
    bodies.container = Container{0.0, 3.0, points.container, {}};
  }

  // Of body j on the fluid.
  Complex force(std::size_t j) const { return std::pow(-0.8, static_cast<double>(j)) * Complex(1.0, 0.4); }

  PointFlow at(Complex x) const {
    PointFlow f;
    for (std::size_t j = 0; j < bodies.size(); ++j) {
      const Body& body = bodies[j];
      const double strength = std::pow(-0.8, static_cast<double>(j));
      const Complex place = body.pose.centre + 0.1 * body.shape.b * Complex(1.0, -0.5);
      const double tiny = 1e-3 * body.shape.b;  // a small disc: its completion flow has a force and a torque
      f += completion_flow({tiny, tiny}, {place, 0.0}, {force(j), 0.7 * strength}, x);
      f += stresslet_flow(x - place, Complex(0.3, strength), Complex(-0.5, 0.2));
    }
    f += stresslet_flow(x - Complex(3.5, 1.5), {2.0, 1.0}, {1.0, -0.5});
    f += stresslet_flow(x - Complex(-2.0, -3.2), {1.0, -1.0}, {0.5, 2.0});
    return f;
  }

  ComplexVector boundary_velocity(const StokesSystem& system) const {
    ComplexVector data(system.node_count());
    for (const PlacedShape& b : system.boundaries())
      for (int k = 0; k < b.size(); ++k) data[b.offset + k] = at(b.node(k)).velocity;
    return data;
  }

  // `count` random points at a distance from each boundary.
  std::vector<Complex> points_beside(double distance, int count) const {
    std::mt19937_64 generator(9);
    std::vector<Complex> points;
    const auto add = [&](const Shape& shape, const Pose& pose, double into_fluid) {
      for (int k = 0; k < count; ++k) {
        const double alpha = 2.0 * pi * uniform(generator);
        const Complex on(shape.a * std::cos(alpha), shape.b * std::sin(alpha));
        const Complex normal(shape.b * std::cos(alpha), shape.a * std::sin(alpha));
        points.push_back(pose.centre + pose.axis() * (on + into_fluid / std::abs(normal) * normal));
      }
    };
    for (const Body& body : bodies) add(body.shape, body.pose, distance);
    const Container& wall = *bodies.container;
    add({wall.radius, wall.radius}, {wall.centre, 0.0}, -distance);
    return points;
  }
};

}  // namespace stokes
