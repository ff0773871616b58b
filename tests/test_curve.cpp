// Curves sampled at equal steps of their parameter, and the Fourier interpolation behind them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "curve.hpp"
#include "fourier.hpp"
#include "shape.hpp"
#include "threads.hpp"

using namespace stokes;

namespace {

double largest(const ComplexVector& v) { return v.cwiseAbs().maxCoeff(); }

// f(alpha_k) at N equal steps.
template <class Function>
ComplexVector sampled(int points, const Function& f) {
  ComplexVector v(points);
  for (int k = 0; k < points; ++k) v[k] = f(2.0 * pi * k / points);
  return v;
}

ComplexVector wave(int points, int mode) {
  return sampled(points, [mode](double alpha) { return std::polar(1.0, mode * alpha); });
}

Complex bump(double alpha) { return std::exp(Complex(std::cos(alpha), std::sin(2.0 * alpha))); }
Complex bump_derivative(double alpha) {
  return bump(alpha) * Complex(-std::sin(alpha), 2.0 * std::cos(2.0 * alpha));
}

// Int |zeta'| d alpha by the midpoint rule, which shares no node with the trapezoid rule of a curve.
double arclength(const Shape& shape, int points) {
  double sum = 0.0;
  for (int k = 0; k < points; ++k) {
    const double alpha = 2.0 * pi * (k + 0.5) / points;
    sum += std::sqrt(std::pow(shape.a * std::sin(alpha), 2) + std::pow(shape.b * std::cos(alpha), 2));
  }
  return sum * 2.0 * pi / points;
}

// The message of the InputError that `nodes` provoke; empty if none.
std::string refusal(const ComplexVector& nodes) {
  try {
    Curve::through(nodes);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("an ellipse's curve has its area, tangents, curvatures and centroid at any number of nodes") {
  for (const Shape& shape : {Shape{1.0, 1.0}, Shape{2.0, 0.5}, Shape{0.3, 1.2}})
    for (int points : {8, 32, 66}) {
      const Curve curve = shape.curve(points);
      const double a = shape.a, b = shape.b;
      REQUIRE(curve.size() == points);
      CHECK(std::abs(curve.area() - pi * a * b) < 1e-14 * pi * a * b);
      CHECK(std::abs(curve.centroid()) < 1e-15 * (a + b));
      for (int k = 0; k < points; ++k) {
        const double alpha = 2.0 * pi * k / points;
        const Complex derivative(-a * std::sin(alpha), b * std::cos(alpha));
        const double speed = std::abs(derivative);
        const Complex position(a * std::cos(alpha), b * std::sin(alpha));
        CHECK(std::abs(curve.position[k] - position) < 1e-15 * (a + b));
        CHECK(std::abs(curve.tangent[k] - derivative / speed) < 1e-14);
        CHECK(std::abs(curve.weight[k] - speed * 2.0 * pi / points) < 1e-15 * (a + b));
        CHECK(std::abs(curve.curvature[k] * std::pow(speed, 3) / (a * b) - 1.0) < 1e-14);
      }
      CHECK(curve.max_spacing() <= 2.0 * pi * shape.circumradius() / points * (1.0 + 1e-14));
      CHECK(curve.max_spacing() >= curve.length() / points * (1.0 - 1e-14));
    }
}

TEST_CASE("the length of a curve converges to the perimeter like exp(-N atanh(b/a))") {
  const Shape shape{1.0, 0.25};
  double previous = 1.0;
  for (int points : {16, 32, 64}) {
    const double error = std::abs(shape.curve(points).length() / shape.perimeter() - 1.0);
    CHECK(error < 10.0 * std::exp(-points * std::atanh(0.25)));
    CHECK(error < 0.1 * previous);
    previous = error;
  }
  CHECK(std::abs(shape.curve(256).length() / shape.perimeter() - 1.0) < 1e-14);
}

TEST_CASE("the perimeter of a shape is the arclength integral to round-off, whichever axis is longer") {
  for (double aspect : {1.0, 1.0 + 1e-9, 1.001, 1.5, 3.0, 6.0, 20.0}) {
    const Shape shape{0.7, 0.7 / aspect};
    const double expected = arclength(shape, 4000);
    CHECK(std::abs(shape.perimeter() - expected) < 1e-13 * expected);
    CHECK(std::abs(Shape{shape.b, shape.a}.perimeter() - shape.perimeter()) < 1e-15 * expected);
  }
  CHECK(std::abs(Shape{2.0, 2.0}.perimeter() - 4.0 * pi) < 1e-14);
  // A needle: 4 a (1 + (b/a)^2 (ln(4a/b)/2 - 1/4) + ...).
  const double ratio = 1e-4;
  const double needle = 4.0 * (1.0 + ratio * ratio * (0.5 * std::log(4.0 / ratio) - 0.25));
  CHECK(std::abs(Shape{1.0, ratio}.perimeter() - needle) < 1e-13);
}

TEST_CASE("a curve through an ellipse's nodes is the ellipse's curve") {
  for (int points : {8, 64, 256}) {
    const Curve exact = Shape{1.3, 0.4}.curve(points), curve = Curve::through(exact.position);
    const double tolerance = 1e-15 * points;  // each derivative amplifies round-off by up to N/2
    CHECK(largest(curve.position - exact.position) == 0.0);
    CHECK(largest(curve.derivative - exact.derivative) < tolerance);
    CHECK(largest(curve.tangent - exact.tangent) < 10.0 * tolerance);
    CHECK((curve.weight - exact.weight).cwiseAbs().maxCoeff() < tolerance);
    CHECK((curve.curvature - exact.curvature).cwiseAbs().maxCoeff() < 100.0 * points * tolerance);
  }
}

TEST_CASE("a curve off the origin and not convex has its area, centroid and signed curvature") {
  // r = 1 + e cos 3 alpha about c: area pi (1 + e^2/2); at the middle of a dent, alpha = pi/3, r = 1 - e,
  // r'' = 9 e, curvature (r - r'')/r^2.
  const double e = 0.3;
  const Complex centre(5.0, -2.0);
  const Curve curve = Curve::through(sampled(180, [&](double alpha) {
    return centre + std::polar(1.0 + e * std::cos(3.0 * alpha), alpha);
  }));
  CHECK(std::abs(curve.area() - pi * (1.0 + 0.5 * e * e)) < 1e-13);
  CHECK(std::abs(curve.centroid() - centre) < 1e-13);  // by its threefold symmetry
  CHECK(std::abs(curve.curvature[30] - (1.0 - 10.0 * e) / ((1.0 - e) * (1.0 - e))) < 1e-9);
  CHECK(std::abs(curve.curvature[0] - (1.0 + 10.0 * e) / ((1.0 + e) * (1.0 + e))) < 1e-9);
}

TEST_CASE("the centroid weighs by arclength") {
  // An eccentric parametrisation of the unit circle about c, e^{i (alpha + 0.4 sin alpha)}: nodes crowd on
  // one side, the centroid stays.
  const Complex centre(0.5, 3.0);
  const Curve curve = Curve::through(sampled(64, [&](double alpha) {
    return centre + std::polar(1.0, alpha + 0.4 * std::sin(alpha));
  }));
  CHECK(std::abs(curve.position.mean() - centre) > 0.1);
  CHECK(std::abs(curve.centroid() - centre) < 1e-14);
}

TEST_CASE("nodes that make no curve are refused with the reason") {
  const auto circle = [](int points) { return wave(points, 1); };
  CHECK(refusal(circle(8)).empty());
  CHECK(refusal(circle(9)).find("even number of nodes, at least 8; got 9") != std::string::npos);
  CHECK(refusal(circle(6)).find("got 6") != std::string::npos);
  CHECK(refusal(ComplexVector()).find("got 0") != std::string::npos);
  CHECK(refusal(wave(16, -1)).find("counter-clockwise") != std::string::npos);
  CHECK(refusal(ComplexVector::Zero(16)).find("counter-clockwise") != std::string::npos);
  ComplexVector broken = circle(16);
  broken[3] = std::nan("");
  CHECK_FALSE(refusal(broken).empty());
}

TEST_CASE("coefficients are those of their waves, and values invert them") {
  const int points = 12;
  for (int mode = -5; mode <= 5; ++mode) {
    const ComplexVector c = fourier_coefficients(Complex(2.0, -1.0) * wave(points, mode));
    ComplexVector expected = ComplexVector::Zero(points);
    expected[(mode + points) % points] = Complex(2.0, -1.0);
    CHECK(largest(c - expected) < 1e-14);
  }
  for (int length : {2, 8, 30, 64, 250, 1024}) {
    const ComplexVector f = sampled(length, [](double alpha) { return bump(3.0 * alpha) + alpha; });
    CHECK(largest(fourier_values(fourier_coefficients(f)) - f) < 2e-14);
  }
}

TEST_CASE("the derivative of every resolved wave is exact, and that of the Nyquist mode is dropped") {
  const int points = 16;
  for (int mode = -7; mode <= 7; ++mode) {
    const ComplexVector derivative = fourier_derivative(wave(points, mode));
    CHECK(largest(derivative - Complex(0.0, mode) * wave(points, mode)) < 2e-13);
  }
  CHECK(largest(fourier_derivative(wave(points, 8))) < 1e-13);
}

TEST_CASE("the derivative of an analytic function converges faster than any power of N") {
  double previous = 1.0;
  for (const auto& [points, bound] : {std::pair(16, 1.0), std::pair(32, 1e-3), std::pair(64, 1e-12)}) {
    const ComplexVector derivative = fourier_derivative(sampled(points, bump));
    const double error = largest(derivative - sampled(points, bump_derivative));
    INFO("N = ", derivative.size(), " error ", error);
    CHECK(error < bound);
    CHECK(error < 1e-2 * previous + 1e-12 + (points == 16 ? 1.0 : 0.0));
    previous = error;
  }
}

TEST_CASE("upsampling reproduces resolved waves at any larger number of points") {
  for (int fine : {16, 17, 18, 31, 32, 100})
    for (int mode = -7; mode <= 7; ++mode)
      CHECK(largest(fourier_upsample(wave(16, mode), fine) - wave(fine, mode)) < 1e-13);
  const ComplexVector f = sampled(64, bump);
  CHECK(largest(fourier_upsample(f, 192) - sampled(192, bump)) < 1e-13);
  CHECK(fourier_upsample(f, 64) == f);
}

TEST_CASE("upsampling takes the Nyquist mode for a cosine, so that real values stay real") {
  for (int fine : {17, 18, 31, 32, 100}) {
    const ComplexVector expected = sampled(fine, [](double alpha) { return Complex(std::cos(8.0 * alpha)); });
    CHECK(largest(fourier_upsample(wave(16, 8), fine) - expected) < 1e-13);
  }
  const ComplexVector real = sampled(16, [](double alpha) { return Complex(std::abs(alpha - 2.0)); });
  CHECK(fourier_upsample(real, 48).imag().cwiseAbs().maxCoeff() < 1e-15);
}

TEST_CASE("transforms from several threads, planned side by side, have the bits of one thread") {
  const int threads = thread_count(), count = 60;
  const auto transform = [](long i) {
    return fourier_coefficients(sampled(1500 + 2 * static_cast<int>(i % 30), bump));
  };
  std::vector<ComplexVector> together(count), alone(count);
  set_thread_count(4);
  parallel_for(count, [&](long i) { together[i] = transform(i); });
  set_thread_count(1);
  for (int i = 0; i < count; ++i) alone[i] = transform(i);
  set_thread_count(threads);
  for (int i = 0; i < count; ++i) CHECK(together[i] == alone[i]);
}
