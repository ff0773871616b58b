// Points to expansions and expansions to points (fmm_translations.hpp has the conventions).
//
// With d = (source - c)/h, g = w n eta/(4 pi h), e = -w (n conj(eta) + conj(n) eta)/(4 pi h) + iL/(4 pi h),
// f = F/(8 pi), a source has the expansions
//   multipole  a_0 = -f,  a_k = g d^{k-1} + f d^k/k,
//              b_0 = conj(f),  b_k = e d^{k-1} + (k-1) conj(d) g d^{k-2} - conj(f) d^k/k + conj(d) f d^{k-1}
//   local      A_0 = -f (2 log|h d| - 1) - g/d,  A_l = -g d^{-l-1} + f d^-l/l,
//              B_l = -e d^{-l-1} + (l+1) conj(d) g d^{-l-2} - conj(f) d^-l/l - conj(d) f d^{-l-1}
// (no term with 1/l at l = 0).
#pragma once

#include "fmm_translations.hpp"
#include "pair_kernels.hpp"
#include "quadtree.hpp"

namespace stokes {

// Centre and size of a box, and the length and the padding of its expansions.
struct ExpansionFrame {
  double x, y, size;
  int order, stride;
};

// Each function adds the expansion of the sources in a range (not empty) to `to`.
void add_to_multipole(const ExpansionFrame& frame, const StressletArrays& s, PointRange range, double* to);
void add_to_multipole(const ExpansionFrame& frame, const PointForceArrays& s, PointRange range, double* to);
void add_to_local(const ExpansionFrame& frame, const StressletArrays& s, PointRange range, double* to);
void add_to_local(const ExpansionFrame& frame, const PointForceArrays& s, PointRange range, double* to);

// Each function adds the flow of an expansion at a pack of points to `sum`. with_logarithm: a_0 is not zero.
void add_local_flow(const ExpansionFrame& frame, const double* from, Pack x, Pack y, VelocityPack& sum);
void add_local_flow(const ExpansionFrame& frame, const double* from, Pack x, Pack y, GradientPack& sum);
void add_multipole_flow(const ExpansionFrame& frame, const double* from, bool with_logarithm, Pack x, Pack y,
                        VelocityPack& sum);
void add_multipole_flow(const ExpansionFrame& frame, const double* from, bool with_logarithm, Pack x, Pack y,
                        GradientPack& sum);

}  // namespace stokes
