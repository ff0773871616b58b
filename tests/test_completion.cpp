// The flow of a rigid ellipse with a force and a torque, against its defining properties.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "completion.hpp"
#include "flow_checks.hpp"

using namespace stokes;

namespace {

const std::vector<Shape> shapes{{1.0, 1.0}, {1.0, 0.8}, {1.5, 0.5}, {2.0, 0.1}, {0.4, 1.2}, {0.1, 2.0}};
const Wrench wrench{{0.7, -1.9}, 2.3};

using Flow = std::function<Complex(Complex)>;

Flow flow_of(const Shape& shape, const Pose& pose, const Wrench& w) {
  return [=](Complex x) { return completion_velocity(shape, pose, w, x); };
}

Complex boundary_point(const Shape& shape, const Pose& pose, double alpha) {
  return pose.centre + pose.axis() * Complex(shape.a * std::cos(alpha), shape.b * std::sin(alpha));
}

// u_x and u_y, the derivatives along the axes, by differences of sixth order.
struct Gradient {
  Complex x, y;

  double divergence() const { return x.real() + y.imag(); }
  double vorticity() const { return x.imag() - y.real(); }
  // sigma n + p n, for a unit vector n.
  Complex viscous_traction(Complex n) const {
    const double shear = x.imag() + y.real();
    return {2.0 * x.real() * n.real() + shear * n.imag(), shear * n.real() + 2.0 * y.imag() * n.imag()};
  }
};
Gradient gradient_of(const Flow& u, Complex z, double step) {
  const auto along = [&](Complex e) {
    const auto difference = [&](double k) { return u(z + k * step * e) - u(z - k * step * e); };
    return (45.0 * difference(1.0) - 9.0 * difference(2.0) + difference(3.0)) / (60.0 * step);
  };
  return {along(1.0), along(imaginary_unit)};
}

// Force and torque about `centre` of the inside of a circle around it on the fluid outside, by
// the traction. The velocity's gradient alone gives the pressure: -p + i vorticity is analytic outside
// and decays, so that the vorticity's Fourier modes determine it.
Wrench traction_integral(const Flow& u, Complex centre, double radius) {
  const int points = 96;
  std::vector<Gradient> gradients;
  for (int j = 0; j < points; ++j)
    gradients.push_back(gradient_of(u, centre + std::polar(radius, 2.0 * pi * j / points), 2e-3 * radius));
  std::vector<Complex> mode(points / 2);  // vorticity = Im Sum_k mode_k e^{-i k alpha}
  for (int k = 1; k < points / 2; ++k)
    for (int j = 0; j < points; ++j)
      mode[k] += gradients[j].vorticity() * std::polar(2.0 / points, pi * (0.5 + 2.0 * k * j / points));
  Wrench exerted;
  for (int j = 0; j < points; ++j) {
    const double alpha = 2.0 * pi * j / points;
    const Complex n = std::polar(1.0, alpha);
    double pressure = 0.0;
    for (int k = 1; k < points / 2; ++k) pressure -= (mode[k] * std::polar(1.0, -k * alpha)).real();
    const Complex traction = gradients[j].viscous_traction(n) - pressure * n;
    exerted.force -= traction * (2.0 * pi * radius / points);
    exerted.torque -= cross(radius * n, traction) * (2.0 * pi * radius / points);
  }
  return exerted;
}

// (1/4 pi) ( -ln|r| F + (r.F) r/|r|^2 ) + L perp(r)/(4 pi |r|^2)
Complex stokeslet_and_rotlet(const Wrench& w, Complex r) {
  const double rr = std::norm(r);
  return (-0.5 * std::log(rr) * w.force + dot(r, w.force) * r / rr + w.torque * perp(r) / rr) / (4.0 * pi);
}

}  // namespace

TEST_CASE("the trace of a force is a translation to round-off, for aspect ratios from 1 to 20") {
  for (const Shape& shape : shapes)
    for (double angle : {0.0, 0.9, -2.0}) {
      const Pose pose{{3.0, -1.0}, angle};
      const double A = 0.5 * (shape.a + shape.b), B = 0.5 * (shape.a - shape.b);
      // In the body frame (1/4 pi) ( F (1/2 - ln A) + conj(F) B/(2A) ).
      const Complex F = std::conj(pose.axis()) * wrench.force;
      const Complex U = pose.axis() * (F * (0.5 - std::log(A)) + std::conj(F) * B / (2.0 * A)) / (4.0 * pi);
      for (int k = 0; k < 50; ++k) {
        const Complex x = boundary_point(shape, pose, 0.1257 * k);
        const Complex u = completion_velocity(shape, pose, {wrench.force, 0.0}, x);
        INFO("semi-axes ", shape.a, " ", shape.b, " error ", std::abs(u - U));
        CHECK(std::abs(u - U) < 1e-13);
      }
    }
}

TEST_CASE("the trace of a torque is a rotation by L / (2 pi (a^2 + b^2)) to round-off") {
  for (const Shape& shape : shapes)
    for (double angle : {0.0, 0.9, -2.0}) {
      const Pose pose{{3.0, -1.0}, angle};
      const double omega = wrench.torque / (2.0 * pi * (shape.a * shape.a + shape.b * shape.b));
      for (int k = 0; k < 50; ++k) {
        const Complex x = boundary_point(shape, pose, 0.1257 * k);
        const Complex u = completion_velocity(shape, pose, {0.0, wrench.torque}, x);
        INFO("semi-axes ", shape.a, " ", shape.b, " error ", std::abs(u - omega * perp(x - pose.centre)));
        CHECK(std::abs(u - omega * perp(x - pose.centre)) < 1e-13);
      }
    }
}

TEST_CASE("the flow is free of divergence and its vorticity is harmonic") {
  for (const Shape& shape : shapes) {
    const Pose pose{{0.5, 0.2}, 0.6};
    for (const Wrench& w : {Wrench{wrench.force, 0.0}, Wrench{0.0, wrench.torque}}) {
      const Flow u = flow_of(shape, pose, w);
      for (int k = 0; k < 8; ++k) {
        // Not nearer than about 0.3 to a tip, where differences of 4e-3 are accurate.
        const Shape larger{shape.a + 0.5, shape.b + 0.5};
        const Complex z = boundary_point(larger, pose, 0.8 * k);
        const double radius = 0.1;
        double mean = 0.0;
        for (int j = 0; j < 32; ++j)
          mean += gradient_of(u, z + std::polar(radius, 2.0 * pi * j / 32.0), 4e-3).vorticity() / 32.0;
        const Gradient here = gradient_of(u, z, 4e-3);
        INFO("semi-axes ", shape.a, " ", shape.b, " k ", k);
        CHECK(std::abs(here.divergence()) < 1e-9);
        CHECK(std::abs(here.vorticity() - mean) < 1e-9);
        CHECK(std::abs(here.x) + std::abs(here.y) > 1e-3);
      }
    }
  }
}

TEST_CASE("the traction on a circle around the body adds up to its force and torque") {
  for (const Shape& shape : shapes) {
    const Pose pose{{-2.0, 1.0}, 1.1};
    for (double radius : {3.0, 10.0}) {
      const Wrench got = traction_integral(flow_of(shape, pose, wrench), pose.centre, radius);
      INFO("semi-axes ", shape.a, " ", shape.b, " radius ", radius);
      CHECK(std::abs(got.force - wrench.force) < 1e-9);
      CHECK(std::abs(got.torque - wrench.torque) < 1e-9);
    }
  }
}

TEST_CASE("far away a force is a Stokeslet, without a constant, up to the inverse square of the distance") {
  for (const Shape& shape : shapes) {
    const Pose pose{{1.0, 1.0}, 0.7};
    for (double distance : {30.0, 300.0, 3000.0})
      for (int k = 0; k < 7; ++k) {
        const Complex r = std::polar(distance, 0.3 + 0.9 * k);
        const Complex u = completion_velocity(shape, pose, {wrench.force, 0.0}, pose.centre + r);
        const double size = std::norm(shape.circumradius()) * std::abs(wrench.force) / (distance * distance);
        CHECK(std::abs(u - stokeslet_and_rotlet({wrench.force, 0.0}, r)) < 0.3 * size + 1e-15 * distance);
      }
  }
}

TEST_CASE("far away a torque is a rotlet and the stresslet that completion_stresslet states") {
  // A stresslet S makes -(1/2 pi) r (r.S r)/|r|^4, with r.S r = Re(S conj(r)^2).
  for (const Shape& shape : shapes) {
    const Pose pose{{1.0, 1.0}, 0.7};
    const Wrench torque{0.0, wrench.torque};
    const Complex S = completion_stresslet(shape, pose, torque);
    for (double distance : {30.0, 300.0, 3000.0})
      for (int k = 0; k < 7; ++k) {
        const Complex r = std::polar(distance, 0.3 + 0.9 * k);
        const Complex stresslet = -r * dot(S, r * r) / (2.0 * pi * std::pow(distance, 4));
        const Complex u = completion_velocity(shape, pose, torque, pose.centre + r);
        const double size = std::pow(shape.circumradius() / distance, 3);
        CHECK(std::abs(u - stokeslet_and_rotlet(torque, r) - stresslet) < size + 1e-16);
      }
  }
}

TEST_CASE("the stresslet vanishes for a disc and for a force, and turns with the body") {
  CHECK(std::abs(completion_stresslet({1.0, 1.0}, {0.0, 0.4}, wrench)) == 0.0);
  CHECK(std::abs(completion_stresslet({2.0, 1.0}, {0.0, 0.4}, {wrench.force, 0.0})) == 0.0);
  const Complex S = completion_stresslet({2.0, 1.0}, {{5.0, 1.0}, 0.0}, wrench);
  CHECK(std::abs(S - Complex(0.0, -0.5 * wrench.torque * 3.0 / 5.0)) < 1e-15);
  const Complex turned = completion_stresslet({2.0, 1.0}, {{-1.0, 2.0}, 0.4}, wrench);
  CHECK(std::abs(turned - S * std::polar(1.0, 0.8)) < 1e-15);
}

TEST_CASE("a disc's flow is a Stokeslet with its degenerate quadrupole, and a rotlet") {
  const double radius = 1.7;
  const Pose pose{{2.0, -3.0}, 0.8};
  for (int k = 0; k < 12; ++k) {
    const Complex r = std::polar(radius * (1.0 + 0.3 * k), 1.3 * k);
    // The quadrupole makes a^2/(4 pi |r|^2) ( F/2 - (r.F) r/|r|^2 ).
    const double rr = std::norm(r);
    const Complex quadrupole =
        radius * radius / (4.0 * pi * rr) * (0.5 * wrench.force - dot(r, wrench.force) * r / rr);
    const Complex u = completion_velocity({radius, radius}, pose, wrench, pose.centre + r);
    CHECK(std::abs(u - stokeslet_and_rotlet(wrench, r) - quadrupole) < 1e-14);
  }
}

TEST_CASE("the axes' order and the angle describe the same body") {
  for (int k = 0; k < 20; ++k) {
    const Complex x = Complex(1.0, 2.0) + std::polar(1.6 + 0.2 * k, 0.7 * k);
    const Complex flat = completion_velocity({1.5, 0.5}, {{1.0, 2.0}, 0.4}, wrench, x);
    const Complex tall = completion_velocity({0.5, 1.5}, {{1.0, 2.0}, 0.4 + 0.5 * pi}, wrench, x);
    const Complex half_turn = completion_velocity({1.5, 0.5}, {{1.0, 2.0}, 0.4 + pi}, wrench, x);
    CHECK(std::abs(flat - tall) < 1e-14);
    CHECK(std::abs(flat - half_turn) < 1e-14);
  }
}

TEST_CASE("turning the body and its load about any point turns the flow") {
  const Complex turn = std::polar(1.0, 2.1), shift(-4.0, 9.0);
  const Pose pose{{1.0, 0.5}, -0.6}, moved{turn * pose.centre + shift, pose.angle + 2.1};
  for (int k = 0; k < 20; ++k) {
    const Complex x = pose.centre + std::polar(1.6 + 0.2 * k, 0.7 * k);
    const Complex u = completion_velocity({1.5, 0.3}, pose, wrench, x);
    const Wrench turned{turn * wrench.force, wrench.torque};
    const Complex there = completion_velocity({1.5, 0.3}, moved, turned, turn * x + shift);
    CHECK(std::abs(there - turn * u) < 1e-14);
  }
}

TEST_CASE("the flow is linear in force and torque") {
  const Complex x(2.0, 1.0);
  const auto u = [&](const Wrench& w) { return completion_velocity({1.5, 0.3}, {0.0, 0.2}, w, x); };
  const Complex parts = wrench.force.real() * u({1.0, 0.0}) + wrench.force.imag() * u({imaginary_unit, 0.0}) +
                        wrench.torque * u({0.0, 1.0});
  CHECK(std::abs(u(wrench) - parts) < 1e-15);
}

TEST_CASE("the flow is continuous across both axes of the body, where the square roots have their cuts") {
  for (const Shape& shape : shapes)
    for (double angle : {0.0, -0.0}) {  // signed zeros choose sides of a cut
      const Flow u = flow_of(shape, {0.0, angle}, wrench);
      for (double beyond : {1e-8, 1e-3, 0.1, 1.0, 100.0})
        for (double sign : {1.0, -1.0}) {
          // The velocity's gradient is at most of order 1/(the tip's radius of curvature).
          const double x = sign * (shape.a + beyond), y = sign * (shape.b + beyond), step = 1e-12;
          INFO("semi-axes ", shape.a, " ", shape.b, " x ", x, " y ", y);
          CHECK(std::abs(u({x, step}) - u({x, -step})) < 1e-9);
          CHECK(std::abs(u({step, y}) - u({-step, y})) < 1e-9);
          for (double zero : {0.0, -0.0}) {
            CHECK(std::abs(u({x, zero}) - u({x, step})) < 1e-9);
            CHECK(std::abs(u({zero, y}) - u({step, y})) < 1e-9);
          }
        }
    }
}

TEST_CASE("pressure and gradient are those of the velocity, and solve the Stokes equations") {
  for (const Shape& shape : shapes)
    for (const Wrench& w : {Wrench{wrench.force, 0.0}, Wrench{0.0, wrench.torque}}) {
      const Pose pose{{0.5, 0.2}, 0.6};
      const auto flow = [&](Complex x) { return completion_flow(shape, pose, w, x); };
      const Shape larger{shape.a + 0.3, shape.b + 0.3};
      for (int k = 0; k < 8; ++k) {
        const Complex x = boundary_point(larger, pose, 0.8 * k);
        const StokesResidual residual = stokes_residual(flow, x, 2e-3);
        INFO("semi-axes ", shape.a, " ", shape.b, " k ", k);
        CHECK(std::abs(flow(x).velocity - completion_velocity(shape, pose, w, x)) < 1e-14);
        CHECK(residual.gradient < 1e-9);
        CHECK(residual.divergence < 1e-14);
        CHECK(residual.momentum < 1e-8);
        CHECK(gradient_size(flow(x)) > 1e-3);
      }
    }
}

TEST_CASE("the traction on any circle around the body, and on the body itself, adds up to force and torque") {
  for (const Shape& shape : shapes) {
    const Pose pose{{-2.0, 1.0}, 1.1};
    // The normal points into the fluid outside, on which the inside exerts minus the traction.
    const auto exerted = [&](int points, const auto& point, const auto& weighted_normal) {
      Wrench sum;
      for (int k = 0; k < points; ++k) {
        const double alpha = 2.0 * pi * k / points;
        const Complex x = point(alpha);
        const Complex f = traction(stress(completion_flow(shape, pose, wrench, x)), weighted_normal(alpha));
        sum.force -= 2.0 * pi / points * f;
        sum.torque -= 2.0 * pi / points * cross(x - pose.centre, f);
      }
      return sum;
    };
    const auto check = [&](const Wrench& sum) {
      INFO("semi-axes ", shape.a, " ", shape.b);
      CHECK(std::abs(sum.force - wrench.force) < 1e-12);
      CHECK(std::abs(sum.torque - wrench.torque) < 1e-12);
    };
    for (double radius : {3.0, 10.0})
      check(exerted(128, [&](double alpha) { return pose.centre + std::polar(radius, alpha); },
                    [&](double alpha) { return std::polar(radius, alpha); }));
    check(exerted(1024, [&](double alpha) { return boundary_point(shape, pose, alpha); },
                  [&](double alpha) {
                    return pose.axis() * Complex(shape.b * std::cos(alpha), shape.a * std::sin(alpha));
                  }));
  }
}

TEST_CASE("around a disc the pressure is F.r/(2 pi r^2), and a torque makes none") {
  for (Complex r : {Complex(1.7, 0.0), Complex(-2.0, 3.0)}) {
    const PointFlow flow = completion_flow({1.7, 1.7}, {{2.0, -3.0}, 0.8}, wrench, Complex(2.0, -3.0) + r);
    CHECK(std::abs(flow.pressure - dot(wrench.force, r) / (2.0 * pi * std::norm(r))) < 1e-15);
  }
  const PointFlow torque = completion_flow({1.7, 1.7}, {}, {0.0, wrench.torque}, {2.0, 1.0});
  CHECK(std::abs(torque.pressure) == 0.0);
  CHECK(std::abs(vorticity(torque)) < 1e-16);
}

TEST_CASE("the pressure decays like a Stokeslet's far from an ellipse and is continuous across its axes") {
  const Shape shape{1.5, 0.5};
  for (int k = 0; k < 7; ++k) {
    const Complex r = std::polar(1e3, 0.3 + 0.9 * k);
    const double pressure = completion_flow(shape, {0.0, 0.7}, {wrench.force, 0.0}, r).pressure;
    CHECK(std::abs(pressure - dot(wrench.force, r) / (2.0 * pi * std::norm(r))) < 1e-8);
  }
  for (double sign : {1.0, -1.0})
    for (Complex e : {Complex(sign, 0.0), Complex(0.0, sign)})
      for (double distance : {0.1, 1.0, 10.0}) {
        const Complex x = (distance + (e.imag() == 0.0 ? shape.a : shape.b)) * e;
        const PointFlow jump = completion_flow(shape, {}, wrench, x + 1e-12 * perp(e)) -
                               completion_flow(shape, {}, wrench, x - 1e-12 * perp(e));
        CHECK(std::abs(jump.pressure) + gradient_size(jump) < 1e-10);
      }
}
