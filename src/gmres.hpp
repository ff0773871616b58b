// Flexible right-preconditioned GMRES for real linear operators.
#pragma once

#include <functional>

#include "base.hpp"

namespace stokes {

using LinearOperator = std::function<void(const Vector& in, Vector& out)>;

struct GmresOptions {
  double tolerance = 1e-8;   // on the true residual |b - A x| / s, s = |b| or `scale`
  int max_iterations = 1000;
  int restart = 300;         // largest Krylov basis kept
  double scale = 0.0;        // if > 0: s, of a sum that A x is a part of; |b| / 1000 at least
};

struct GmresResult {
  Vector x;
  int iterations = 0;     // operator applications inside the Krylov loop
  double residual = 0.0;  // |b - A x| / s, evaluated from x
  bool converged = false;
};

// Solves A x = b from the initial guess `guess` (empty: zero) with A M (M^-1 x) = b, M the approximate
// inverse `preconditioner`, of which only the directions M v are used, so that it may be of low precision. The residual
// is always that of the unpreconditioned system, and convergence is declared only after it has been evaluated; b = 0
// answers x = 0. Deterministic for any number of threads. Ends with an Interruption when a signal asks for it.
GmresResult gmres(const LinearOperator& A, const LinearOperator& preconditioner, const Vector& b,
                  const Vector& guess, const GmresOptions& options);

}  // namespace stokes
