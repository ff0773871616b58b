// Dense linear complementarity problem (LCP): find z with
//     0 <= w = B z + b   perp   z >= 0        (z_i >= 0, w_i >= 0, z_i w_i = 0 for every i),
// B of shape m x m, b of length m, m from 0 to a few hundred. For contacts z holds the multipliers, w
// the gaps after the step, b the gaps without contact forces and B the nearly symmetric mobility of
// the contacts. With B symmetric positive semidefinite (PSD) the problem is solvable exactly if some
// z >= 0 gives w >= 0, and then w is unique; z is unique if B is positive definite. Redundant contacts
// make B singular and z one of many. (Cottle, Pang and Stone, The Linear Complementarity Problem,
// sections 3.1 and 4.4.)
#pragma once

#include "base.hpp"

#include <string>

namespace stokes {

enum class LcpMethod {
  automatic,               // the four below in this order until one has a residual of 1e-13; the best counts
  minimum_map_newton,      // active-set Newton on min(z, w): a few steps when B is definite
  fischer_newton,          // Newton on sqrt(z^2 + w^2) - z - w with an Armijo line search (Fischer 1992)
  projected_gauss_seidel,  // sweeps, each followed now and then by minimum-map steps; needs B_ii > 0
  lemke                    // complementary pivoting with the lexicographic ratio test
};

std::string to_string(LcpMethod method);

// A result is `solved` when lcp_residual(B, b, z) <= lcp_tolerance; 1e-15 to 1e-13 is usual.
inline constexpr double lcp_tolerance = 1e-10;

struct LcpResult {
  Vector z;              // length of b, finite, z >= 0; the best iterate, for diagnosis only, if not solved
  bool solved = false;
  LcpMethod method = LcpMethod::automatic;  // the one that produced z; the one asked for if z = 0 stands
  int iterations = 0;    // of that method: Newton steps, sweeps or pivots
  double residual = 0.0;                    // lcp_residual of z on the problem as given
  std::string message;   // empty when solved, else one sentence: what failed, by how much, what it means
};

// Solves the LCP. b >= 0 is answered by z = 0 without looking further. Every method works on
//     B'_ij = B_ij / (s_i s_j),   b'_i = b_i / (s_i beta),   z = beta z' / s,   s_i ~ sqrt(B_ii),
// with beta ~ max_i(-b_i / s_i) and all factors powers of two, so that nothing is rounded and only
// ratios within B and within b matter. Where B_ii <= 0, s_i follows from the other entries of row and
// column i.
// No answer is an exception: a jammed (infeasible) problem, one on which the methods fail and input of
// wrong shape or with a non-finite number give solved = false and a message. Lemke's method solves every
// PSD and every P-matrix problem that has a solution, up to rounding; its ray is a proof of
// infeasibility for PSD, and the message says "infeasible" only if that proof was checked.
// Cost: O(m^3) per Newton step, O(m^2) per sweep and pivot; all loops are bounded. Deterministic.
LcpResult solve_lcp(const Matrix& B, const Vector& b, LcpMethod method = LcpMethod::automatic);

// Scaled natural residual  max_i |min(s_i z_i, w_i / s_i)| / beta,  beta = max_i(-b_i / s_i),  with
// s_i = sqrt(B_ii) as above (not rounded): z and w are measured in the same unit and against the worst
// violation without forces, not against large irrelevant gaps. It does not change if B, b or both are
// multiplied by positive numbers nor, where B_ii > 0, if the unknowns are scaled one by one. If all
// B_ii are equal it is |min(B_ii z, w)|_inf / max(-b); in general |min(B_ii z, w)|_inf is at most
// residual * sqrt(max B_ii / min B_ii) * max(-b). If b >= 0, beta is max(|b_i| / s_i, s_i |z_i|).
// w is summed in doubled precision, so cancellation cannot hide a wrong z. Infinite if B, b or z has a
// non-finite entry or their sizes differ.
double lcp_residual(const Matrix& B, const Vector& b, const Vector& z);

// The largest multiplier over the worst violation, both in units of sqrt(B_ll), which makes the ratio independent of the
// scales of single contacts. A jam that only rounding makes solvable has a ratio as large as the inverse of that rounding.
inline double amplification(const Matrix& B, const Vector& b, const Vector& z) {
  const Vector scale = B.diagonal().cwiseSqrt();
  const double violation = -b.cwiseQuotient(scale).minCoeff();
  return violation > 0.0 ? z.cwiseProduct(scale).maxCoeff() / violation : 0.0;
}

}  // namespace stokes
