// Types, conventions and errors shared by every file.
//
// Conventions, stated once and used everywhere:
//   * A vector (v1, v2) is the complex number v1 + i v2; <u, v> = Re(u conj(v)); perp(v) = i v.
//   * The viscosity is 1. Angles are radians, counter-clockwise, never wrapped.
//   * Every closed curve is traversed counter-clockwise, zeta(alpha), alpha in [0, 2 pi); t = zeta'/|zeta'|.
//   * The normal n = -i s t points OUT OF THE FLUID: side s = +1 for an outer wall, s = -1 for an inner
//     wall or a body (n points into the body).
//   * Forces and torques are those exerted BY a body ON the fluid, which for a free body is the
//     external (or contact) force on the body.
//   * A density is a complex vector over the nodes. The boundary operators are only real-linear, so
//     solvers see it as 2N reals (real and imaginary parts interleaved) with the real inner product.
#pragma once

#include <complex>
#include <numbers>
#include <stdexcept>
#include <string>

#include <eigen3/Eigen/Core>

// Eigen's own threads would make its sums depend on their number. The definition belongs to the compiler's flags: set in a
// header it would miss files that include Eigen first, and the linker would mix both kinds of products.
#ifndef EIGEN_DONT_PARALLELIZE
#error "compile every file with -DEIGEN_DONT_PARALLELIZE, as the makefile does"
#endif

namespace stokes {

using Complex = std::complex<double>;
using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;
using ComplexVector = Eigen::VectorXcd;
using ComplexMatrix = Eigen::MatrixXcd;

inline constexpr double pi = std::numbers::pi;
inline constexpr Complex imaginary_unit{0.0, 1.0};

inline double dot(Complex u, Complex v) { return u.real() * v.real() + u.imag() * v.imag(); }
inline double cross(Complex u, Complex v) { return u.real() * v.imag() - u.imag() * v.real(); }
inline Complex perp(Complex v) { return {-v.imag(), v.real()}; }

// 1/z and u/z without the checks for overflow, which make the built-in division several times slower.
inline Complex reciprocal(Complex z) { return std::conj(z) / std::norm(z); }
inline Complex quotient(Complex u, Complex z) {
  const double over = 1.0 / std::norm(z);
  return {dot(u, z) * over, -cross(u, z) * over};
}

// The input is wrong. The message is one paragraph: what, where, value against limit, what to try.
// Nothing has been written. Programs exit with status 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The computation cannot go on. Everything computed before has been written. Programs exit with status 3.
struct NumericalError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace stokes
