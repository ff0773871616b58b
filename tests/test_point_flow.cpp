// Pressure, gradient and stress at a point.
#include <doctest/doctest.h>

#include "flow.hpp"
#include "flow_checks.hpp"

using namespace stokes;

namespace {

// phi = (0.3 - 0.2i) z^3 + i z, psi = 0.5 z^2 - (1 + i) z
PointFlow polynomial_flow(Complex z) {
  const Complex c(0.3, -0.2), d(1.0, 1.0), i = imaginary_unit;
  return goursat_flow(z, {c * z * z * z + i * z, 3.0 * c * z * z + i, 6.0 * c * z, 0.5 * z * z - d * z, z - d});
}

}  // namespace

TEST_CASE("Goursat functions give a Stokes flow with its pressure and gradient") {
  for (Complex z : {Complex(0.3, -0.4), Complex(-1.2, 0.7)}) {
    const StokesResidual residual = stokes_residual(polynomial_flow, z, 1e-2);
    CHECK(residual.gradient < 1e-12);
    CHECK(residual.divergence < 1e-14);
    CHECK(residual.momentum < 1e-11);
    CHECK(std::abs(polynomial_flow(z).pressure) > 0.1);
  }
}

TEST_CASE("one node of a double layer is the point source of the direct sum, and its stress the published kernel") {
  const Complex y(0.4, -1.0), n = std::polar(1.0, 0.7), eta(0.8, -0.3);
  const double weight = 0.2;
  Curve node = Shape{}.curve(8);
  node.position = ComplexVector::Constant(1, y);
  node.tangent = ComplexVector::Constant(1, imaginary_unit * n);
  node.weight = Vector::Constant(1, weight);
  for (Complex x : {Complex(1.3, 0.2), Complex(0.41, -1.02), Complex(-30.0, 55.0)}) {
    const Complex r = x - y;
    const PointFlow flow = stresslet_flow(r, weight * n, eta);
    const PointFlow expected = direct_flow(node, Side::interior, ComplexVector::Constant(1, eta), {x})[0];
    const PointFlow error = flow - expected;
    const double size = gradient_size(expected);
    CHECK(std::abs(error.velocity) < 1e-14 * std::abs(expected.velocity));
    CHECK(std::abs(error.pressure) < 1e-14 * size);
    CHECK(gradient_size(error) < 1e-14 * size);
    // (1/pi) [ (n.eta/rho^2) I - 8 (r.n)(r.eta) r r/rho^6 + ((r.n)(r eta + eta r) + (r.eta)(r n + n r))/rho^4 ] w
    const double rr = std::norm(r), rn = dot(r, n), re = dot(r, eta);
    const auto entry = [&](double same, double ri, double rj, double ni, double nj, double ei, double ej) {
      return weight / pi * (same * dot(n, eta) / rr - 8.0 * rn * re * ri * rj / (rr * rr * rr) +
                            (rn * (ri * ej + ei * rj) + re * (ri * nj + ni * rj)) / (rr * rr));
    };
    const double rx = r.real(), ry = r.imag(), nx = n.real(), ny = n.imag(), ex = eta.real(), ey = eta.imag();
    const Stress sigma = stress(flow);
    CHECK(std::abs(sigma.xx - entry(1.0, rx, rx, nx, nx, ex, ex)) < 1e-13 * size);
    CHECK(std::abs(sigma.xy - entry(0.0, rx, ry, nx, ny, ex, ey)) < 1e-13 * size);
    CHECK(std::abs(sigma.yy - entry(1.0, ry, ry, ny, ny, ey, ey)) < 1e-13 * size);
  }
}

TEST_CASE("stress, traction, vorticity and rate of strain of elementary flows") {
  PointFlow shear;  // u = (3 y, 0), p = 2
  shear.pressure = 2.0, shear.velocity_y = 3.0;
  CHECK(stress(shear).xx == -2.0);
  CHECK(stress(shear).xy == 3.0);
  CHECK(stress(shear).yy == -2.0);
  CHECK(vorticity(shear) == -3.0);
  CHECK(strain_rate(shear) == Complex(0.0, 1.5));
  // The fluid above drags what is below its plane along and presses on it.
  CHECK(traction(stress(shear), imaginary_unit) == Complex(3.0, -2.0));
  CHECK(traction(stress(shear), 1.0) == Complex(-2.0, 3.0));

  PointFlow rotation;  // u = 2 perp(x)
  rotation.velocity_x = Complex(0.0, 2.0), rotation.velocity_y = -2.0;
  CHECK(vorticity(rotation) == 4.0);
  CHECK(std::abs(strain_rate(rotation)) == 0.0);
  CHECK(stress(rotation).xy == 0.0);

  PointFlow extension;  // u = (x, -y)
  extension.velocity_x = 1.0, extension.velocity_y = Complex(0.0, -1.0);
  CHECK(strain_rate(extension) == Complex(1.0, 0.0));
  CHECK(stress(extension).xx == 2.0);
  CHECK(stress(extension).yy == -2.0);

  const PointFlow sum = shear + 2.0 * extension - extension;
  CHECK(sum.pressure == 2.0);
  CHECK(strain_rate(sum) == Complex(1.0, 1.5));
}

TEST_CASE("a turned flow has the derivatives along the laboratory's axes, and its stress turns with it") {
  const Complex centre(2.0, -0.5), axis = std::polar(1.0, 0.9);
  const auto laboratory = [&](Complex x) { return turned(polynomial_flow(std::conj(axis) * (x - centre)), axis); };
  const Complex x(1.4, 0.2);
  const StokesResidual residual = stokes_residual(laboratory, x, 1e-2);
  CHECK(residual.gradient < 1e-11);
  CHECK(residual.divergence < 1e-13);
  CHECK(residual.momentum < 1e-10);
  const PointFlow body = polynomial_flow(std::conj(axis) * (x - centre)), flow = laboratory(x);
  const Complex n = std::polar(1.0, 2.2);
  CHECK(std::abs(traction(stress(flow), axis * n) - axis * traction(stress(body), n)) < 1e-13);
  CHECK(vorticity(flow) == doctest::Approx(vorticity(body)).epsilon(1e-14));
  CHECK(std::abs(strain_rate(flow) - axis * axis * strain_rate(body)) < 1e-13);
}

TEST_CASE("background flows have the gradient of their velocity") {
  for (FlowKind kind : {FlowKind::none, FlowKind::shear, FlowKind::extension, FlowKind::taylor_green}) {
    const BackgroundFlow background{kind, 1.7};
    const Complex x(0.6, -1.1);
    const StokesResidual residual = stokes_residual([&](Complex z) { return background.flow(z); }, x, 1e-2);
    CHECK(background.flow(x).velocity == background.velocity(x));
    CHECK(background.flow(x).pressure == 0.0);
    CHECK(residual.gradient < 1e-11);
    CHECK(residual.divergence < 1e-15);
    if (kind == FlowKind::taylor_green)
      CHECK(residual.momentum > 1.0);  // lap u = -2 u, which no pressure balances
    else
      CHECK(residual.momentum < 1e-12);
    CHECK((gradient_size(background.flow(x)) > 0.5) == (kind != FlowKind::none));
  }
}
