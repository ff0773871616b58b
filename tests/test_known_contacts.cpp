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

TEST_CASE("the matrix gives the latest answer, keeps earlier ones, and after as many as contacts is exact") {
  const int n = 6;
  const Matrix exact = mobility(n, 1), directions = random_matrix(n, n, 2);
  Matrix learnt = Matrix::Identity(n, n);
  for (int k = 0; k < n; ++k) {
    const Vector s = directions.col(k);
    learn(learnt, s, exact * s, s);
    for (int j = 0; j <= k; ++j) CHECK((learnt * directions.col(j) - exact * directions.col(j)).norm() < 1e-9);
    CHECK((learnt - learnt.transpose()).norm() < 1e-12);
  }
  CHECK((learnt - exact).norm() < 1e-8);
}

TEST_CASE("changes as small as the errors of answers, and updates much larger than what they mend, teach nothing") {
  const Matrix exact = mobility(4, 3), start = Matrix::Identity(4, 4);
  const Vector present = Vector::Ones(4);
  Matrix learnt = start;
  learn(learnt, 0.01 * random_matrix(4, 1, 5), random_matrix(4, 1, 6), present);
  CHECK(learnt == start);
  learn(learnt, present, start * present, present);  // nothing missed
  CHECK(learnt == start);
  const Vector across = Vector::Unit(4, 0) - Vector::Unit(4, 1);  // orthogonal to `present`
  learn(learnt, present, start * present + across, present);
  CHECK(learnt == start);
  learn(learnt, present, exact * present, present);
  CHECK((learnt * present - exact * present).norm() < 1e-12);
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
