// The matrix that learns from answers, and combinations of known answers.
#include <doctest/doctest.h>

#include "known_contacts.hpp"
#include "random_suspension.hpp"

using namespace stokes;

namespace {

// Symmetric, with eigenvalues from about 0.1 on.
Matrix mobility(int n, unsigned seed) {
  const Matrix A = random_matrix(n, n, seed);
  return A * A.transpose() / n + 0.1 * Matrix::Identity(n, n);
}

}  // namespace

TEST_CASE("the matrix gives the latest answer, stays symmetric, comes no farther from the mobility, in the end to it") {
  const int n = 6, answers = 400;
  const Matrix exact = mobility(n, 1), directions = random_matrix(n, answers, 2);
  Matrix learnt = Matrix::Identity(n, n);
  for (int k = 0; k < answers; ++k) {
    const Vector s = directions.col(k), unit = learnt.diagonal().cwiseSqrt().cwiseInverse();
    const auto distance = [&](const Matrix& M) { return (unit.asDiagonal() * (M - exact) * unit.asDiagonal()).norm(); };
    const double before = distance(learnt);
    learn(learnt, s, exact * s, s);
    CHECK((learnt * s - exact * s).norm() < 1e-12);
    CHECK((learnt - learnt.transpose()).norm() < 1e-12);
    CHECK(distance(learnt) < before + 1e-12);
    REQUIRE(learnt.diagonal().minCoeff() > 0.0);
  }
  CHECK((learnt - exact).norm() < 1e-6);
}

TEST_CASE("the matrix learns also where what it misses is orthogonal to the forces; it is changed as little as can be") {
  const Vector s = Vector::Ones(4), across = Vector::Unit(4, 0) - Vector::Unit(4, 1);
  Matrix learnt = Matrix::Identity(4, 4);
  learn(learnt, s, s + across, s);
  CHECK((learnt * s - s - across).norm() < 1e-12);
  const Matrix change = learnt - Matrix::Identity(4, 4);
  // Any other symmetric change with that result differs by a matrix that maps s to zero, to which it is orthogonal.
  const Matrix onto = Matrix::Identity(4, 4) - s * s.transpose() / 4.0, other = onto * mobility(4, 3) * onto;
  CHECK(std::abs(change.cwiseProduct(other).sum()) < 1e-12);
}

TEST_CASE("changes as small as the errors of answers teach nothing, nor does a matrix learn that is no mobility") {
  const Matrix start = Matrix::Identity(4, 4);
  Matrix learnt = start;
  learn(learnt, 0.002 * random_matrix(4, 1, 5), random_matrix(4, 1, 6), Vector::Ones(4));
  CHECK(learnt == start);
  learn(learnt, Vector::Ones(4), Vector::Ones(4), Vector::Ones(4));  // nothing missed
  CHECK(learnt == start);
  Matrix negative = start;
  negative(2, 2) = -1.0;
  learnt = negative;
  learn(learnt, Vector::Ones(4), 2.0 * Vector::Ones(4), Vector::Ones(4));
  CHECK(learnt == negative);
}

TEST_CASE("a combination of known answers: exact where there is one, nearest in the given scale where there is none") {
  const Matrix known = random_matrix(8, 3, 7);
  const Vector part = random_matrix(3, 1, 8), scale = random_matrix(8, 1, 9).cwiseAbs().array() + 0.5;
  CHECK((nearest_combination(known, known * part, scale) - part).norm() < 1e-4);

  const Vector wanted = random_matrix(8, 1, 10);
  const Vector nearest = nearest_combination(known, wanted, scale);
  const Vector rest = scale.cwiseProduct(wanted - known * nearest);
  CHECK((known.transpose() * scale.asDiagonal() * rest).norm() < 1e-4 * scale.cwiseProduct(wanted).norm());

  // Two equal answers share the coefficient; none give none.
  Matrix equal(8, 2);
  equal << known.col(0), known.col(0);
  const Vector half = nearest_combination(equal, known.col(0), scale);
  CHECK((half - Vector::Constant(2, 0.5)).norm() < 1e-5);
  CHECK(nearest_combination(Matrix(8, 0), wanted, scale).size() == 0);
  CHECK(nearest_combination(Matrix::Zero(8, 2), wanted, scale) == Vector::Zero(2));
}
