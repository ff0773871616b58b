// GMRES on systems whose solution and spectrum are known.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <eigen3/Eigen/LU>
#include <limits>

#include "gmres.hpp"
#include "random_suspension.hpp"
#include "threads.hpp"

using namespace stokes;

namespace {

// Nonsymmetric, eigenvalues in a disc of radius about 0.6 around 1.
Matrix nonsymmetric(int n, unsigned seed) {
  return Matrix::Identity(n, n) + 0.6 * std::sqrt(3.0 / n) * random_matrix(n, n, seed);
}

LinearOperator times(const Matrix& m) {
  return [m](const Vector& in, Vector& out) { out.noalias() = m * in; };
}
const LinearOperator identity = [](const Vector& in, Vector& out) { out = in; };

double true_residual(const Matrix& A, const Vector& x, const Vector& b) {
  return (b - A * x).norm() / b.norm();
}

}  // namespace

TEST_CASE("nonsymmetric systems are solved to the tolerance, and the residual reported is the true one") {
  for (int n : {1, 2, 10, 60, 200})
    for (double tolerance : {1e-3, 1e-8, 1e-13}) {
      const Matrix A = nonsymmetric(n, 10 + n);
      const Vector b = random_matrix(n, 1, 20 + n), exact = A.partialPivLu().solve(b);
      const GmresResult result = gmres(times(A), identity, b, {}, {tolerance, 1000, 300});
      INFO("n ", n, " iterations ", result.iterations, " residual ", result.residual);
      CHECK(result.converged);
      CHECK(result.residual <= tolerance);
      CHECK(std::abs(result.residual - true_residual(A, result.x, b)) < 1e-14);
      CHECK((result.x - exact).norm() < 20.0 * tolerance * exact.norm());
      CHECK(result.iterations <= std::min(n, 80));
      if (n >= 60) CHECK(result.residual > 1e-3 * tolerance);  // no more work than asked for
    }
}

TEST_CASE("a looser tolerance takes fewer iterations") {
  const Matrix A = nonsymmetric(200, 1);
  const Vector b = random_matrix(200, 1, 2);
  int previous = 0;
  for (double tolerance : {1e-2, 1e-5, 1e-8, 1e-11}) {
    const int iterations = gmres(times(A), identity, b, {}, {tolerance, 1000, 300}).iterations;
    CHECK(iterations > previous);
    previous = iterations;
  }
}

TEST_CASE("k distinct eigenvalues take k iterations") {
  Vector spectrum(120);
  for (int i = 0; i < 120; ++i) spectrum[i] = 1.0 + i % 4;
  const Matrix V = nonsymmetric(120, 3);
  const Matrix A = V * spectrum.asDiagonal() * V.inverse();
  const GmresResult result = gmres(times(A), identity, random_matrix(120, 1, 4), {}, {1e-10, 1000, 300});
  CHECK(result.converged);
  CHECK(result.iterations == 4);
}

TEST_CASE("the preconditioner acts on the right: it changes the iterations, not the residual reported") {
  // Badly scaled columns: x spans eight decades.
  const int n = 80;
  Vector scale(n);
  for (int i = 0; i < n; ++i) scale[i] = std::pow(10.0, -4.0 + 8.0 * i / (n - 1));
  const Matrix A = nonsymmetric(n, 5) * scale.asDiagonal();
  const Matrix inverse = A.inverse(), scaling = scale.cwiseInverse().asDiagonal();
  const Vector b = random_matrix(n, 1, 6);
  const GmresResult scaled = gmres(times(A), times(scaling), b, {}, {1e-9, 1000, 300});
  const GmresResult exact = gmres(times(A), times(inverse), b, {}, {1e-9, 1000, 300});
  const GmresResult magnified = gmres(times(A), times(1e12 * scaling), b, {}, {1e-9, 1000, 300});
  CHECK(exact.iterations == 1);
  CHECK(scaled.iterations > 5);
  CHECK(scaled.iterations < 60);
  CHECK(magnified.iterations == scaled.iterations);
  for (const GmresResult* result : {&scaled, &exact, &magnified}) {
    CHECK(result->converged);
    CHECK(std::abs(result->residual - true_residual(A, result->x, b)) < 1e-13);
    CHECK(true_residual(A, result->x, b) <= 1e-9);
  }
}

TEST_CASE("a zero right-hand side has the solution zero, whatever the guess") {
  const Matrix A = nonsymmetric(20, 7);
  for (const Vector& guess : {Vector(), Vector(Vector::Ones(20))}) {
    const GmresResult result = gmres(times(A), identity, Vector::Zero(20), guess, {});
    CHECK(result.converged);
    CHECK(result.x == Vector::Zero(20));
    CHECK(result.iterations == 0);
    CHECK(result.residual == 0.0);
  }
}

TEST_CASE("an exact guess is returned as it is, a near one saves iterations") {
  const Matrix A = nonsymmetric(100, 8);
  const Vector exact = random_matrix(100, 1, 9), b = A * exact;
  const GmresResult same = gmres(times(A), identity, b, exact, {1e-12, 1000, 300});
  CHECK(same.converged);
  CHECK(same.iterations == 0);
  CHECK(same.x == exact);
  const GmresResult cold = gmres(times(A), identity, b, {}, {1e-10, 1000, 300});
  const Vector near = exact + 1e-6 * random_matrix(100, 1, 10);
  const GmresResult warm = gmres(times(A), identity, b, near, {1e-10, 1000, 300});
  CHECK(warm.converged);
  CHECK(warm.residual <= 1e-10);
  CHECK(warm.iterations < 0.7 * cold.iterations);  // 4 decades of 10 remain
}

TEST_CASE("a guess worse than none is dropped: the result is that of no guess") {
  const Matrix A = nonsymmetric(100, 11);
  const Vector b = random_matrix(100, 1, 12);
  const GmresResult cold = gmres(times(A), identity, b, {}, {1e-10, 1000, 300});
  const Vector absurd = 1e6 * random_matrix(100, 1, 13);
  const Vector nan = Vector::Constant(100, std::numeric_limits<double>::quiet_NaN());
  for (const Vector& guess : {absurd, nan}) {
    const GmresResult result = gmres(times(A), identity, b, guess, {1e-10, 1000, 300});
    CHECK(result.converged);
    CHECK(result.iterations == cold.iterations);
    CHECK(result.x == cold.x);
  }
}

TEST_CASE("a singular system with a solution is solved") {
  const int n = 40;
  Matrix A = nonsymmetric(n, 14);
  const Vector null = random_matrix(n, 1, 15).normalized();
  A -= A * null * null.transpose();  // A null = 0
  const Vector b = A * random_matrix(n, 1, 16);
  const GmresResult result = gmres(times(A), identity, b, {}, {1e-9, 1000, 300});
  CHECK(result.converged);
  CHECK(true_residual(A, result.x, b) <= 1e-9);
  CHECK(result.x.norm() < 1e3 * b.norm());
  // A projection: the Krylov space is exhausted by its first vector.
  const Matrix P = Matrix::Identity(n, n) - null * null.transpose();
  const GmresResult projection = gmres(times(P), identity, P * b, {}, {1e-12, 1000, 300});
  CHECK(projection.converged);
  CHECK(projection.iterations <= 2);
}

TEST_CASE("a system without a solution is reported as not converged, with its true residual") {
  const int n = 40;
  Matrix A = nonsymmetric(n, 17);
  A.row(7).setZero();
  const Vector b = random_matrix(n, 1, 18);
  const GmresResult result = gmres(times(A), identity, b, {}, {1e-8, 1000, 300});
  CHECK_FALSE(result.converged);
  CHECK(std::abs(result.residual - true_residual(A, result.x, b)) < 1e-12);
  CHECK(result.residual >= std::abs(b[7]) / b.norm() * (1.0 - 1e-12));
  CHECK(result.iterations < 1000);
}

TEST_CASE("a tolerance below round-off is reported as not converged, with the residual reached") {
  const Matrix A = nonsymmetric(100, 19);
  const Vector b = random_matrix(100, 1, 20);
  const GmresResult result = gmres(times(A), identity, b, {}, {1e-18, 1000, 300});
  CHECK_FALSE(result.converged);
  CHECK(result.residual < 1e-14);
  CHECK(result.residual > 1e-18);
  CHECK(result.iterations < 1000);
}

TEST_CASE("too few iterations are reported as not converged, and the best of their space is returned") {
  const Matrix A = nonsymmetric(100, 21);
  const Vector b = random_matrix(100, 1, 22);
  double previous = 1.0;
  for (int limit : {0, 1, 3, 6}) {
    const GmresResult result = gmres(times(A), identity, b, {}, {1e-10, limit, 300});
    CHECK_FALSE(result.converged);
    CHECK(result.iterations == limit);
    CHECK(std::abs(result.residual - true_residual(A, result.x, b)) < 1e-14);
    if (limit == 0) CHECK(result.x == Vector::Zero(100));
    if (limit > 0) CHECK(result.residual < previous);
    previous = result.residual;
  }
  // One iteration minimises |b - c A b| over c.
  const Vector Ab = A * b, best = Ab.dot(b) / Ab.squaredNorm() * b;
  CHECK((gmres(times(A), identity, b, {}, {1e-10, 1, 300}).x - best).norm() < 1e-14 * b.norm());
}

TEST_CASE("restarted cycles converge too, with more iterations than one long cycle") {
  const Matrix A = nonsymmetric(150, 23);
  const Vector b = random_matrix(150, 1, 24);
  const GmresResult full = gmres(times(A), identity, b, {}, {1e-11, 1000, 300});
  for (int restart : {5, 10, 20}) {
    const GmresResult result = gmres(times(A), identity, b, {}, {1e-11, 1000, restart});
    INFO("restart ", restart, " iterations ", result.iterations, " residual ", result.residual);
    CHECK(result.converged);
    CHECK(true_residual(A, result.x, b) <= 1e-11);
    CHECK(result.iterations >= full.iterations);
    CHECK(result.iterations <= 4 * full.iterations);
  }
}

TEST_CASE("not-a-number from the operator ends the solve as not converged") {
  const LinearOperator broken = [](const Vector& in, Vector& out) { out = in * std::nan(""); };
  const GmresResult result = gmres(broken, identity, Vector::Ones(10), {}, {1e-8, 1000, 300});
  CHECK_FALSE(result.converged);
  CHECK(result.iterations < 1000);
}

TEST_CASE("the result has the same bits each time and for any number of threads") {
  const int threads = thread_count();
  const Matrix A = nonsymmetric(300, 25);
  const Vector b = random_matrix(300, 1, 26);
  const Vector first = gmres(times(A), identity, b, {}, {1e-10, 1000, 300}).x;
  for (int count : {1, 2, 4}) {
    set_thread_count(count);
    CHECK(gmres(times(A), identity, b, {}, {1e-10, 1000, 300}).x == first);
  }
  set_thread_count(threads);
}
