#include "scales.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "text.hpp"

namespace stokes {

namespace {

constexpr double farthest = 1e8;  // in the smallest semi-axis; radians
constexpr double largest = 1e100, smallest = 1e-100;

double smallest_axis(const Suspension& bodies) {
  double axis = std::numeric_limits<double>::infinity();
  for (const Body& body : bodies) axis = std::min(axis, body.shape.inradius());
  return axis;
}

// A velocity, and its change over a length.
std::string judged(const std::string& what, double speed, double length) {
  for (const double x : {std::abs(speed), std::abs(speed) / length}) {
    if (x == 0.0 || (x >= smallest && x <= largest)) continue;
    return concat(what, " makes velocities of ", brief(speed), " over lengths of ", brief(length), ", which are beyond ",
                  x < smallest ? smallest : largest, "; choose other units of time, length or force.");
  }
  return {};
}

}  // namespace

std::string lost_precision(const Suspension& bodies) {
  const double limit = farthest * smallest_axis(bodies);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Pose& pose = bodies[i].pose;
    const double distance = std::abs(pose.centre);
    if (!(distance <= limit))
      return concat("body ", i, " is ", brief(distance), " away from the origin, more than ", farthest,
                    " of the smallest semi-axis: its position is not known precisely; move the origin to the bodies.");
    if (!(std::abs(pose.angle) <= farthest))
      return concat("body ", i, " has the angle ", pose.angle, ", more than ", farthest,
                    ": its direction is not known precisely; take whole turns away.");
  }
  return {};
}

std::string out_of_scale(const Suspension& bodies, const BackgroundFlow& flow) {
  const double axis = smallest_axis(bodies);
  double reach = 1.0;  // of the vortices of Taylor-Green flow
  if (flow.kind != FlowKind::taylor_green) reach = axis;
  for (const Body& body : bodies)
    if (flow.kind != FlowKind::taylor_green)
      reach = std::max(reach, std::abs(body.pose.centre) + body.shape.circumradius());
  std::string why;
  const auto judge = [&](const std::string& what, double speed, double length) {
    if (why.empty()) why = judged(what, speed, length);
  };
  const auto judge_wall = [&](const SurfaceMotion& surface, double radius) {
    judge(concat("angular velocity ", surface.angular_velocity, " of a wall"), surface.angular_velocity * radius, axis);
    judge(concat("injection_rate ", surface.source), surface.source / (2.0 * pi * radius), axis);
  };
  if (flow.kind != FlowKind::none) {
    double speed = flow.rate * reach;
    if (flow.kind == FlowKind::poiseuille) speed *= reach;
    if (flow.kind == FlowKind::linear) speed *= flow.gradient.largest();
    judge(concat("rate = ", flow.rate), speed, reach);
    judge(concat("rate = ", flow.rate), speed, axis);
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Body& body = bodies[i];
    if (body.points > 0) {
      judge_wall(body.surface, body.shape.a);
      continue;
    }
    judge(concat("the velocity of body ", i), std::abs(body.surface.translation), axis);
    judge(concat("the angular velocity of body ", i), body.surface.angular_velocity * body.shape.circumradius(), axis);
    judge(concat("the force on body ", i), std::hypot(body.force.real(), body.force.imag()), axis);
    judge(concat("the torque on body ", i), body.torque / body.shape.inradius(), axis);
  }
  if (bodies.container) judge_wall(bodies.container->surface, bodies.container->radius);
  return why;
}

}  // namespace stokes
