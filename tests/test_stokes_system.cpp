// The completed double-layer system against closed forms.
#include <doctest/doctest.h>

#include <cmath>
#include <eigen3/Eigen/Eigenvalues>

#include "random_suspension.hpp"
#include "stokes_system.hpp"

using namespace stokes;

namespace {

Body ellipse(double a, double b, Complex centre, double angle) { return {{a, b}, {centre, angle}, {}, {}}; }

const BackgroundFlow shear{FlowKind::shear, 1.0};

// Two free unit discs on the x axis, gap eps; the right one's motion in u = (x, -y) and u = (y, x), and the
// force each takes when they approach at unit speed. Series in cosh(al) = 1 + eps/2.
struct TwoDiscs {
  double eps, U, w, V, F;
};
TwoDiscs two_discs(double eps) {
  const double al = std::acosh(1.0 + 0.5 * eps);
  double sum = 0.0;
  for (int n = 1; n < 200000; ++n) {
    const double term = n / (std::sinh(2.0 * n * al) + n * std::sinh(2.0 * al));
    sum += term;
    if (term < 1e-18 * sum) break;
  }
  const double w = -1.0 + 4.0 * std::pow(std::sinh(al), 2) * sum;
  return {eps, 2.0 * std::pow(std::sinh(al), 3) / std::cosh(2.0 * al), w, std::sinh(al) + w * std::cosh(al),
          4.0 * pi / (al - 0.5 * std::tanh(2.0 * al))};
}

double relative_error(double got, double expected) { return std::abs(got - expected) / std::abs(expected); }

// The mobility matrix of the suspension, 3M x 3M, on the forces and torques of unit size.
Matrix mobility_matrix(const Suspension& bodies, int points) {
  ShapeCache shapes;
  const StokesSystem system(bodies, points, shapes, {1e-13, 1000});
  const int m = static_cast<int>(bodies.size());
  Matrix result(3 * m, 3 * m);
  for (int k = 0; k < 3 * m; ++k) {
    std::vector<Wrench> wrenches(m);
    if (k % 3 == 2)
      wrenches[k / 3].torque = 1.0;
    else
      wrenches[k / 3].force = k % 3 == 0 ? 1.0 : imaginary_unit;
    const StokesSolution s = system.solve({}, wrenches);
    for (int j = 0; j < m; ++j) {
      result(3 * j, k) = s.velocity[j].velocity.real();
      result(3 * j + 1, k) = s.velocity[j].velocity.imag();
      result(3 * j + 2, k) = s.velocity[j].omega;
    }
  }
  return result;
}

}  // namespace

TEST_CASE("a disc in shear turns with half the vorticity wherever it is") {
  for (double rate : {1.0, -2.5})
    for (Complex centre : {Complex(0.0, 0.0), Complex(3.0, -700.0)}) {
      ShapeCache shapes;
      const StokesSystem system({ellipse(0.3, 0.3, centre, 0.4)}, 32, shapes, {});
      const StokesSolution s = system.solve({FlowKind::shear, rate}, {});
      CHECK(std::abs(s.velocity[0].omega + 0.5 * rate) < 1e-12);
      CHECK(std::abs(s.velocity[0].velocity - rate * centre.imag()) < 1e-12 * (1.0 + std::abs(centre)));
    }
}

TEST_CASE("an ellipse in shear has Jeffery's angular velocity and the closed-form stresslet") {
  for (const auto& [aspect, points] : {std::pair(2.0, 32), std::pair(3.0, 64), std::pair(6.0, 128)}) {
    const double a = 0.75, b = a / aspect;
    double worst_omega = 0.0, worst_stresslet = 0.0;
    ShapeCache shapes;
    for (int k = 0; k < 8; ++k) {
      const double angle = 0.1 + k * pi / 8.0;
      const StokesSystem system({ellipse(a, b, {1.0, 2.0}, angle)}, points, shapes, {1e-13, 1000});
      const StokesSolution s = system.solve(shear, {});
      const double omega = -(a * a * std::pow(std::sin(angle), 2) + b * b * std::pow(std::cos(angle), 2)) / (a * a + b * b);
      // In the body frame the strain i/2 e^{-2 i theta} makes S_11 = pi (a+b)^2 E_11 and S_12 = that times 2ab/(a^2+b^2).
      const Complex E = Complex(0.0, 0.5) * std::polar(1.0, -2.0 * angle);
      const Complex S = pi * (a + b) * (a + b) * Complex(E.real(), E.imag() * 2.0 * a * b / (a * a + b * b));
      worst_omega = std::max(worst_omega, std::abs(s.velocity[0].omega - omega));
      worst_stresslet = std::max(
          worst_stresslet, std::abs(system.stresslets(s.density, {})[0] - S * std::polar(1.0, 2.0 * angle)) / std::abs(S));
    }
    CHECK(worst_omega < 1e-10);
    CHECK(worst_stresslet < 1e-10);
    CHECK(shapes.factorisations() == 1);
  }
}

TEST_CASE("two close discs move in strain and resist squeezing as the bipolar solution says") {
  struct Row {
    double eps;
    int points;
    double tolerance;
  };
  for (const Row& row : {Row{1.0, 128, 1e-11}, Row{0.1, 128, 1e-11}, Row{1e-2, 320, 1e-9}, Row{1e-3, 1024, 1e-8}}) {
    const TwoDiscs exact = two_discs(row.eps);
    const double x = 1.0 + 0.5 * row.eps;
    ShapeCache shapes;
    const StokesSystem system({ellipse(1.0, 1.0, -x, 0.0), ellipse(1.0, 1.0, x, 0.0)}, row.points, shapes, {1e-14, 2000});
    // u = (x, -y); u = (y, x) is half of shear plus rotation: shear along both axes.
    const StokesSolution pull = system.solve({FlowKind::extension, 1.0}, {});
    const double U = pull.velocity[1].velocity.real();
    const StokesSolution turn = system.solve({FlowKind::shear, 2.0}, {});  // (2y, 0) = (y, x) + rotation by -1
    const double w = turn.velocity[1].omega + 1.0;
    const double V = turn.velocity[1].velocity.imag() + x;
    const StokesSolution squeeze = system.solve({}, {{1.0, 0.0}, {-1.0, 0.0}});
    const double F = 1.0 / squeeze.velocity[0].velocity.real();
    INFO("gap ", row.eps, " iterations ", pull.iterations, " errors U ", relative_error(U, exact.U), " w ",
         relative_error(w, exact.w), " V ", relative_error(V, exact.V), " F ", relative_error(F, exact.F));
    CHECK(relative_error(U, exact.U) < row.tolerance);
    CHECK(relative_error(w, exact.w) < row.tolerance);
    CHECK(relative_error(V, exact.V) < row.tolerance);
    CHECK(relative_error(F, exact.F) < row.tolerance);
    CHECK(std::abs(pull.velocity[0].velocity + U) < row.tolerance * U);
  }
}

TEST_CASE("the mobility matrix is symmetric, and positive definite on zero net force") {
  const Suspension bodies = six_ellipses();
  const Matrix M = mobility_matrix(bodies, 128);
  CHECK((M - M.transpose()).cwiseAbs().maxCoeff() < 1e-10 * M.cwiseAbs().maxCoeff());
  // Basis of forces without a resultant: differences of the last body's force, and all torques.
  const int m = static_cast<int>(bodies.size());
  Matrix Z = Matrix::Zero(3 * m, 3 * m - 2);
  int column = 0;
  for (int j = 0; j < m; ++j) {
    for (int k = 0; k < 2 && j + 1 < m; ++k) Z(3 * j + k, column) = 1.0, Z(3 * (m - 1) + k, column) = -1.0, ++column;
    Z(3 * j + 2, column++) = 1.0;
  }
  const Matrix reduced = Z.transpose() * M * Z;
  CHECK(Eigen::SelfAdjointEigenSolver<Matrix>(0.5 * (reduced + reduced.transpose())).eigenvalues()[0] > 1e-3);
}

TEST_CASE("rotating, translating and relabelling a suspension does the same to its velocities") {
  const Suspension bodies = six_ellipses();
  const int m = static_cast<int>(bodies.size());
  const double turn = 0.7;
  const Complex shift(3.0, -5.0), rotation = std::polar(1.0, turn);
  Suspension moved(m);
  for (int j = 0; j < m; ++j) {
    Body& target = moved[(j + 2) % m];
    target = bodies[j];
    target.pose = {rotation * bodies[j].pose.centre + shift, bodies[j].pose.angle + turn};
  }
  std::vector<Wrench> wrenches(m), moved_wrenches(m);
  for (int j = 0; j < m; ++j) {
    wrenches[j] = {std::polar(1.0, 2.0 * pi * j / m), 0.3 * j};  // zero net force
    moved_wrenches[(j + 2) % m] = {rotation * wrenches[j].force, wrenches[j].torque};
  }
  ShapeCache shapes;
  const StokesOptions options{1e-13, 1000};
  const StokesSolution here = StokesSystem(bodies, 128, shapes, options).solve({}, wrenches);
  const StokesSolution there = StokesSystem(moved, 128, shapes, options).solve({}, moved_wrenches);
  for (int j = 0; j < m; ++j) {
    CHECK(std::abs(there.velocity[(j + 2) % m].velocity - rotation * here.velocity[j].velocity) < 1e-10);
    CHECK(std::abs(there.velocity[(j + 2) % m].omega - here.velocity[j].omega) < 1e-10);
  }
  CHECK(shapes.factorisations() == 3);
}

TEST_CASE("the fluid moves with the bodies on their boundaries") {
  const Suspension bodies = six_ellipses();
  ShapeCache shapes;
  const StokesSystem system(bodies, 128, shapes, {1e-12, 1000});
  std::vector<Wrench> wrenches(bodies.size());
  wrenches[0] = {Complex(1.0, 0.5), -0.4}, wrenches[3] = {Complex(-1.0, -0.5), 0.2};
  const StokesSolution s = system.solve(shear, wrenches);
  for (std::size_t j = 0; j < bodies.size(); ++j) {
    // Just off the boundary, between the nodes; a Lipschitz constant of 20 covers the velocity gradient.
    const double distance = 1e-9;
    std::vector<Complex> points, expected;
    for (int k = 0; k < 37; ++k) {
      const double alpha = 0.05 + 2.0 * pi * k / 37.0;
      const Shape& shape = bodies[j].shape;
      const Complex local(shape.a * std::cos(alpha), shape.b * std::sin(alpha));
      const Complex normal(shape.b * std::cos(alpha), shape.a * std::sin(alpha));
      const Complex offset = bodies[j].pose.axis() * (local + distance * normal / std::abs(normal));
      points.push_back(bodies[j].pose.centre + offset);
      expected.push_back(s.velocity[j].velocity + s.velocity[j].omega * perp(offset));
    }
    const std::vector<PointFlow> u = system.flow(points, s.density, shear, wrenches);
    double worst = 0.0;
    for (int k = 0; k < 37; ++k) worst = std::max(worst, std::abs(u[k].velocity - expected[k]));
    CHECK(worst < 1e-7);
  }
}
