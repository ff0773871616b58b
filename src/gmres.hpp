// Flexible right-preconditioned GMRES for real linear operators.
#pragma once

#include <functional>

#include "base.hpp"

namespace stokes {

using LinearOperator = std::function<void(const Vector& in, Vector& out)>;

struct GmresOptions {
  double tolerance = 1e-8;   // of the true residual |b - A x| / s, where s is |b| or `scale`
  int max_iterations = 1000;
  int restart = 300;         // largest Krylov basis kept
  double scale = 0.0;        // if > 0: s, the size of the sum that A x is a part of; at least |b| / 1000
};

struct GmresResult {
  Vector x;
  int iterations = 0;     // operator applications inside the Krylov loop
  double residual = 0.0;  // |b - A x| / s, evaluated from x
  bool converged = false;
};

// Solves A x = b as A M (M^-1 x) = b from the initial guess `guess` (empty: zero). M is the approximate inverse
// `preconditioner`. Only the directions M v are used, so M may have low precision. The residual is always that of the
// unpreconditioned system, and convergence is declared only after it has been evaluated. If b = 0 then x = 0. The result
// does not depend on the number of threads. Throws an Interruption when a signal asks for it.
GmresResult gmres(const LinearOperator& A, const LinearOperator& preconditioner, const Vector& b,
                  const Vector& guess, const GmresOptions& options);

}  // namespace stokes
