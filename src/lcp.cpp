#include "lcp.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include <eigen3/Eigen/LU>

namespace stokes {
namespace {

using Index = Eigen::Index;
constexpr double infinity = std::numeric_limits<double>::infinity();
// Residuals of the scaled problem: at the first the search for a better result ends, the second is that of rounding.
constexpr double sufficient = 1e-13;
constexpr double finished = 1e-15;

// s_i = sqrt(B_ii). A row without a positive diagonal takes the smallest s_i that is compatible with
// |B_ij| <= s_i s_j, the bound a semidefinite matrix obeys; a zero row takes the largest of the others.
Vector diagonal_scales(const Matrix& B) {
  Vector s = B.diagonal().cwiseAbs().cwiseSqrt();
  for (Index i = 0; i < s.size(); ++i) {
    if (B(i, i) > 0.0) continue;
    const Vector entries = B.row(i).transpose().cwiseAbs().cwiseMax(B.col(i).cwiseAbs());
    for (Index j = 0; j < s.size(); ++j)
      if (B(j, j) > 0.0) s(i) = std::max(s(i), entries(j) / s(j));
    if (s(i) == 0.0) s(i) = std::sqrt(entries.maxCoeff());
  }
  const double largest = s.maxCoeff() > 0.0 ? s.maxCoeff() : 1.0;
  s = (s.array() > 0.0).select(s, largest);
  return s.cwiseMax(1e-150).cwiseMin(1e150);  // products and quotients of two stay finite
}

// B z + b in doubled precision (Ogita, Rump and Oishi 2005, Dot2). The product is an fma because a compiler
// may contract a plain product with the sum that follows, which breaks the sum's error term.
Vector slack(const Matrix& B, const Vector& b, const Vector& z) {
  Vector sum = b;
  Vector error = Vector::Zero(b.size());
  for (Index j = 0; j < z.size(); ++j) {
    if (z(j) == 0.0) continue;
    for (Index i = 0; i < b.size(); ++i) {
      const double product = std::fma(B(i, j), z(j), 0.0);
      const double total = sum(i) + product;
      const double part = total - sum(i);
      error(i) += ((sum(i) - (total - part)) + (product - part)) + std::fma(B(i, j), z(j), -product);
      sum(i) = total;
    }
  }
  return sum + error;
}

double natural_residual(const Vector& z, const Vector& w) {
  return z.allFinite() && w.allFinite() ? z.cwiseMin(w).lpNorm<Eigen::Infinity>() : infinity;
}

// The problem in units in which B' has a diagonal near 1 and the most negative b' is near -1, so that
// plain numbers can serve as tolerances below.
struct ScaledProblem {
  Matrix B;
  Vector b;
  Vector unit;  // z = unit * z'

  Vector slack_of(const Vector& z) const { return slack(B, b, z); }
};

double power_of_two_near(double x) { return std::ldexp(1.0, std::ilogb(x * std::numbers::sqrt2)); }

ScaledProblem scale_problem(const Matrix& B, const Vector& b) {
  const Vector s = diagonal_scales(B).unaryExpr(&power_of_two_near);
  const double beta = power_of_two_near(-b.cwiseQuotient(s).minCoeff());
  const Vector inverse = s.cwiseInverse();
  return {inverse.asDiagonal() * B * inverse.asDiagonal(), b.cwiseQuotient(s) / beta, beta * inverse};
}

// The result of a method: the best z' found, z' = 0 at first.
struct Attempt {
  explicit Attempt(const ScaledProblem& p)
      : z(Vector::Zero(p.b.size())), residual(natural_residual(z, p.b)) {}

  void offer(const Vector& candidate, double its_residual) {
    if (!(its_residual < residual)) return;
    z = candidate;
    residual = its_residual;
  }
  void offer(const Attempt& other) { offer(other.z, other.residual); }

  Vector z;
  double residual;
  int iterations = 0;
  bool ray = false;         // Lemke's method found no row that blocks
  bool infeasible = false;  // and the ray is a checked proof that no z >= 0 gives w >= 0
};

// Solves A x = r. Redundant contacts make A singular: then (A + 1e-10) x = r, whose error is repaired
// by the next Newton step. 1e-10 lies between rounding of A and the smallest honest eigenvalues.
Vector solve_active(Matrix A, const Vector& r) {
  constexpr double shift = 1e-10;
  const Eigen::PartialPivLU<Matrix> lu(A);
  if (lu.rcond() > shift) return lu.solve(r);
  A.diagonal().array() += shift;
  return A.partialPivLu().solve(r);
}

// Newton step for H(z) = min(z, w): dz_I = -z_I and B_AA dz_A = -w_A + B_AI z_I with the active set
// A = {i : w_i < z_i} and I the rest.
Vector minimum_map_step(const ScaledProblem& p, const Vector& z, const Vector& w) {
  std::vector<Index> active;
  Vector step = -z;
  for (Index i = 0; i < z.size(); ++i) {
    if (w(i) >= z(i)) continue;
    active.push_back(i);
    step(i) = 0.0;
  }
  const Vector right = -w - p.B * step;  // step holds -z_I here
  if (!active.empty()) step(active) = solve_active(p.B(active, active), right(active));
  return step;
}

// Full steps solve most contact problems. Since the step need not be a direction of descent where
// active sets change, the shortest trial is taken even if |H| grows.
Attempt minimum_map_newton(const ScaledProblem& p, Vector z, int limit) {
  constexpr int patience = 12;  // steps without halving the residual
  Attempt best(p);
  Vector w = p.slack_of(z);
  best.offer(z, natural_residual(z, w));
  for (int stalled = 0; best.iterations < limit && best.residual > finished;) {
    const Vector step = minimum_map_step(p, z, w);
    if (!step.allFinite()) break;
    const Vector start = z;
    const double merit = z.cwiseMin(w).norm();
    for (double t = 1.0; t > 1e-3; t /= 2.0) {
      z = start + t * step;
      w = p.slack_of(z);
      if (z.cwiseMin(w).norm() < (1.0 - 1e-4 * t) * merit) break;
    }
    ++best.iterations;
    const double residual = natural_residual(z, w);
    stalled = residual < 0.5 * best.residual ? 0 : stalled + 1;
    best.offer(z, residual);
    if (residual == infinity || stalled > (best.residual < sufficient ? 0 : patience)) break;
  }
  return best;
}

// phi(z, w) = sqrt(z^2 + w^2) - z - w without cancellation where z + w > 0.
double fischer_burmeister(double z, double w) {
  const double rho = std::hypot(z, w);
  return z + w > 0.0 ? -2.0 * z * (w / (rho + z + w)) : rho - z - w;
}

// An element diag(z/rho - 1) + diag(w/rho - 1) B of the generalised Jacobian of phi; at the kink
// z = w = 0 the pair is replaced by (eps, eps), which selects z/rho = w/rho = 1/sqrt 2.
Matrix fischer_jacobian(const Matrix& B, const Vector& z, const Vector& w) {
  constexpr double kink = 1e-14;
  Matrix jacobian = B;
  for (Index i = 0; i < z.size(); ++i) {
    const double rho = std::hypot(z(i), w(i));
    jacobian.row(i) *= (rho > kink ? w(i) / rho : std::numbers::sqrt2 / 2.0) - 1.0;
    jacobian(i, i) += (rho > kink ? z(i) / rho : std::numbers::sqrt2 / 2.0) - 1.0;
  }
  return jacobian;
}

// Damped Newton for phi(z, w) = 0 with theta = |phi|^2 / 2, gradient steps where Newton's is no descent
// (De Luca, Facchinei and Kanzow 1996). Near the solution minimum-map steps give the last digits, of
// which the kink leaves only half where z_i = w_i = 0.
Attempt fischer_newton(const ScaledProblem& p) {
  constexpr int limit = 60;
  Attempt best(p);
  Vector z = best.z;
  Vector w = p.slack_of(z);
  Vector phi = z.binaryExpr(w, &fischer_burmeister);
  while (best.iterations < limit) {
    const Matrix jacobian = fischer_jacobian(p.B, z, w);
    const Vector gradient = jacobian.transpose() * phi;
    Vector step = jacobian.partialPivLu().solve(-phi);
    if (!step.allFinite() || gradient.dot(step) > -1e-8 * gradient.norm() * step.norm()) step = -gradient;
    const double theta = phi.squaredNorm() / 2.0;
    const Vector start = z;
    double t = 2.0;
    do {
      t /= 2.0;
      z = start + t * step;
      w = p.slack_of(z);
      phi = z.binaryExpr(w, &fischer_burmeister);
    } while (!(phi.squaredNorm() / 2.0 <= theta + 1e-4 * t * gradient.dot(step)) && t > 1e-12);
    ++best.iterations;
    best.offer(z, natural_residual(z, w));
    if (best.residual < 1e-6) best.offer(minimum_map_newton(p, best.z, limit));
    if (best.residual < sufficient || t <= 1e-12) break;
  }
  return best;
}

// Sweeps z_i <- max(0, z_i - w_i / B_ii) find the active set only linearly, so minimum-map steps are
// tried from the iterate after 10, 20, 40, ... sweeps.
Attempt projected_gauss_seidel(const ScaledProblem& p) {
  constexpr int limit = 2560;
  Attempt best(p);
  Vector z = best.z;
  for (int next_polish = 10; best.iterations < limit && best.residual >= sufficient;) {
    Vector w = p.B * z + p.b;
    for (Index i = 0; i < z.size(); ++i) {
      if (!(p.B(i, i) > 0.0)) continue;
      const double moved = std::max(0.0, z(i) - w(i) / p.B(i, i));
      w += p.B.col(i) * (moved - z(i));
      z(i) = moved;
    }
    if (++best.iterations < next_polish) continue;
    next_polish *= 2;
    best.offer(minimum_map_newton(p, z, 20));
  }
  return best;
}

// Tableau of Lemke's method: w - B z - 1 z_0 = b; columns b, w (m), z (m), z_0. The columns of w hold the
// inverse of the basis matrix, which the lexicographic rule needs.
struct LemkeTableau {
  explicit LemkeTableau(const ScaledProblem& p) : m(p.b.size()), table(m, 2 * m + 2), basis(m) {
    table << p.b, Matrix::Identity(m, m), -p.B, -Vector::Ones(m);
    std::iota(basis.begin(), basis.end(), Index{1});
  }

  // Lexicographic order of the rows (b, inverse basis) / entry. Of equal b / entry the row of z_0 comes
  // first: the problem is solved when z_0 leaves.
  bool precedes(Index i, Index j, Index entering) const {
    for (Index k = 0; k <= m; ++k) {
      const double ratio_i = table(i, k) / table(i, entering);
      const double ratio_j = table(j, k) / table(j, entering);
      if (std::abs(ratio_i - ratio_j) > 1e-12 * std::max(1.0, std::abs(ratio_j))) return ratio_i < ratio_j;
      if (basis[i] > 2 * m || basis[j] > 2 * m) return basis[i] > 2 * m;
    }
    return false;
  }

  // The first of the rows that block the entering variable, or -1 on a ray.
  Index blocking_row(Index entering) const {
    const double zero = 1e-11 * std::max(1.0, table.col(entering).lpNorm<Eigen::Infinity>());
    Index row = -1;
    for (Index i = 0; i < m; ++i)
      if (table(i, entering) > zero && (row < 0 || precedes(i, row, entering))) row = i;
    return row;
  }

  // Exchanges the basic variable of the row for the entering one and returns the one that left.
  Index pivot(Index row, Index entering) {
    const Eigen::RowVectorXd pivot_row = table.row(row) / table(row, entering);
    Vector column = table.col(entering);
    column(row) = 0.0;
    table.noalias() -= column * pivot_row;
    table.row(row) = pivot_row;
    return std::exchange(basis[row], entering);
  }

  // The z among basic values, one per row.
  Vector part_in_z(const Vector& basic) const {
    Vector z = Vector::Zero(m);
    for (Index i = 0; i < m; ++i)
      if (basis[i] > m && basis[i] <= 2 * m) z(basis[i] - m - 1) = std::max(0.0, basic(i));
    return z;
  }

  Index m;
  Matrix table;
  std::vector<Index> basis;  // column of the basic variable of each row
};

// Cottle, Pang and Stone, algorithm 4.4.5, with section 4.9 on degeneracy. z_0 first replaces the most
// negative b, of equal ones the last, which makes every row lexicographically positive. Rounding can
// upset that order, hence the bound on the pivots.
Attempt lemke(const ScaledProblem& p) {
  const Index m = p.b.size();
  Attempt best(p);
  LemkeTableau tableau(p);
  Index row = 0;
  for (Index i = 1; i < m; ++i)
    if (p.b(i) <= p.b(row)) row = i;
  for (Index entering = 2 * m + 1; best.iterations < 100 + 20 * m;) {
    const Index left = tableau.pivot(row, entering);
    ++best.iterations;
    if (left > 2 * m) break;
    entering = left > m ? left - m : left + m;
    row = tableau.blocking_row(entering);
    best.ray = row < 0;
    if (!best.ray) continue;
    // y >= 0 with B^T y <= 0 and b^T y < 0 proves that no z >= 0 has w >= 0 (Farkas). With the rounding
    // allowed here z' would have to exceed 1e6.
    Vector y = tableau.part_in_z(-tableau.table.col(entering));
    if (entering > m) y(entering - m - 1) = 1.0;
    const double size = y.lpNorm<1>();
    best.infeasible = (p.B.transpose() * y).maxCoeff() <= 1e-12 * size && p.b.dot(y) < -1e-6 * size;
    return best;
  }
  best.offer(minimum_map_newton(p, tableau.part_in_z(tableau.table.col(0)), 20));
  return best;
}

Attempt run(const ScaledProblem& p, LcpMethod method) {
  if (method == LcpMethod::fischer_newton) return fischer_newton(p);
  if (method == LcpMethod::projected_gauss_seidel) return projected_gauss_seidel(p);
  if (method == LcpMethod::lemke) return lemke(p);
  return minimum_map_newton(p, Vector::Zero(p.b.size()), 100);
}

template <class... Values>
std::string text(const char* format, Values... values) {
  char buffer[400];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

// Says why no method need be tried; otherwise empty.
std::string fault(const Matrix& B, const Vector& b) {
  const Index m = b.size();
  if (B.rows() != m || B.cols() != m)
    return text("the LCP has a matrix of %td x %td but a vector of %td entries", B.rows(), B.cols(), m);
  if (!B.allFinite() || !b.allFinite())
    return text("the LCP of size %td has a non-finite %s", m, b.allFinite() ? "matrix" : "vector");
  for (Index i = 0; i < m; ++i)
    if (b(i) < 0.0 && B.row(i).maxCoeff() <= 0.0)
      return text("the LCP of size %td is infeasible (jammed): row %td has b = %.3g < 0 but no positive "
                  "entry in B, so that no non-negative force opens it", m, i, b(i));
  return {};
}

std::string failure(Index m, const Attempt& last, LcpMethod method, double residual) {
  std::string reason = "was not solved by " + to_string(method);
  reason += text(" in %d iterations: ", last.iterations);
  reason += method == LcpMethod::lemke ? "B is too ill-conditioned" : "try the method automatic";
  if (last.ray) reason = "was left by Lemke's method on a ray: none found, B not positive semidefinite";
  if (last.infeasible) reason = "is infeasible (jammed): no non-negative forces open all constraints at once";
  return text("the LCP of size %td %s (best residual %.2g, limit %.0e of the worst violation)", m,
              reason.c_str(), residual, lcp_tolerance);
}

}  // namespace

std::string to_string(LcpMethod method) {
  static constexpr const char* names[] = {"automatic", "minimum-map Newton", "Fischer-Newton",
                                          "projected Gauss-Seidel", "Lemke's method"};
  return names[static_cast<int>(method)];
}

double lcp_residual(const Matrix& B, const Vector& b, const Vector& z) {
  if (B.rows() != b.size() || B.cols() != b.size() || z.size() != b.size()) return infinity;
  if (!B.allFinite() || !b.allFinite() || !z.allFinite()) return infinity;
  if (b.size() == 0) return 0.0;
  const Vector s = diagonal_scales(B);
  const Vector scaled_b = b.cwiseQuotient(s);
  const Vector scaled_z = z.cwiseProduct(s);
  const double error = natural_residual(scaled_z, slack(B, b, z).cwiseQuotient(s));
  double beta = -scaled_b.minCoeff();
  if (beta <= 0.0) beta = std::max(scaled_b.maxCoeff(), scaled_z.lpNorm<Eigen::Infinity>());
  if (error == 0.0) return 0.0;
  return std::isfinite(error / beta) ? error / beta : infinity;
}

LcpResult solve_lcp(const Matrix& B, const Vector& b, LcpMethod method) {
  const Vector zero = Vector::Zero(b.size());
  LcpResult result{zero, false, method, 0, lcp_residual(B, b, zero), fault(B, b)};
  result.solved = result.residual == 0.0;
  if (result.solved || !result.message.empty()) return result;

  const ScaledProblem problem = scale_problem(B, b);
  if (!problem.B.allFinite() || !problem.b.allFinite() || !problem.unit.allFinite()) {
    result.message = text("the LCP of size %td has entries too far apart to be scaled", b.size());
    return result;
  }
  std::vector<LcpMethod> methods{method};
  if (method == LcpMethod::automatic)
    methods = {LcpMethod::minimum_map_newton, LcpMethod::fischer_newton, LcpMethod::projected_gauss_seidel,
               LcpMethod::lemke};
  for (const LcpMethod candidate : methods) {
    const Attempt attempt = run(problem, candidate);
    const Vector z = attempt.z.cwiseMax(0.0).cwiseProduct(problem.unit);
    const double residual = lcp_residual(B, b, z);
    if (residual < result.residual) result = {z, false, candidate, attempt.iterations, residual, {}};
    result.message = failure(b.size(), attempt, candidate, result.residual);
    if (result.residual <= sufficient) break;
  }
  result.solved = result.residual <= lcp_tolerance;
  if (result.solved) result.message.clear();
  return result;
}

}  // namespace stokes
