// Expansions of the two analytic functions of Stokes flow about box centres, and their translations.
//
// With c the centre and h the size of a box, Z = (z - c)/h, the velocity is
//   u = phi - Z conj(d phi/dZ) - conj(psi)
// (psi relative to c), and the expansions, all coefficients in units of phi,
//   multipole  phi = a_0 log Z + Sum_{k=1}^P a_k Z^-k,  psi likewise with b and b_0 = -conj(a_0),
//   local      phi = Sum_{l=0}^P A_l Z^l,               psi likewise with B.
// Of the logarithms only 2 a_0 log|z - c| acts on u. It is added to A_0, together with the constant -a_0 that belongs to
// every Stokeslet, so that no branch has to be chosen.
//
// A translation by s (in units of h of the larger box) first moves the centre of psi, with r = 2s, the shift in units of
// the child, from child to parent, and r = s between boxes of one size:
//   b_k += conj(r) c_k,  c_1 = -a_0, c_k = (k - 1) a_{k-1}   (multipole; s = old centre - new centre)
//   B_l += conj(s) (l + 1) A_{l+1}                           (local; s = new centre - old centre)
// It then acts on both series alike, as a real matrix between two complex diagonals of powers of the shift:
//   multipole to multipole  a'_l = s^l  [-a_0/l + Sum_{k=1}^l C(l-1, k-1) (2s)^-k a_k]
//   multipole to local      A_l  = s^-l [-a_0/l + Sum_{k=1}^P (-1)^k C(l+k-1, k-1) s^-k a_k]
//   local to local          A'_l = (2s)^-l Sum_{k=l}^P C(k, l) s^k A_k
// One matrix serves all boxes; the diagonals depend only on the relative position of the two boxes.
#pragma once

#include <array>
#include <vector>

#include "base.hpp"
#include "interaction_lists.hpp"
#include "simd.hpp"

namespace stokes {

inline constexpr int largest_order = 47;

// Coefficients 0 ... order of phi and psi of all boxes: for each box the real and imaginary parts of phi,
// then of psi, each padded with zeros to a multiple of eight. Each box is preceded by zeros that are never written. Shifted
// loads of its first coefficients read them, with weight zero.
class Expansions {
 public:
  static int padded(int order) { return (order + 8) / 8 * 8; }

  // All coefficients zero.
  void resize(int box_count, int order);
  int stride() const { return stride_; }
  double* operator[](int box) { return data_.data() + lead + static_cast<std::size_t>(box) * (4 * stride_ + lead); }
  const double* operator[](int box) const { return const_cast<Expansions&>(*this)[box]; }

 private:
  static constexpr int lead = 8;
  int stride_ = 0;
  AlignedVector data_;
};

class Translations {
 public:
  // Tables for expansions of `order` terms, at most largest_order. Cost O(order^2).
  explicit Translations(int order);

  int order() const { return order_; }

  // Each function adds the translated expansion `from` to `to` (both with padded(order) coefficients a part).
  // `child` is the quadrant, 0 to 3, of the smaller box. with_logarithm: a_0 is not zero.
  void multipole_to_multipole(const double* from, int child, double* to) const;
  void multipole_to_local(const double* from, int offset, bool with_logarithm, double* to) const;
  void local_to_local(const double* from, int child, double* to) const;

 private:
  // Powers of one offset s, real and imaginary parts; zero beyond the order.
  struct Diagonals {
    Complex offset;
    int terms;
    AlignedVector in_re, in_im, out_re, out_im;
  };
  Diagonals powers(Complex offset, Complex in, Complex out, int terms) const;

  template <bool downward>
  void translate(const AlignedVector& matrix, const Diagonals& d, int first, const double* from,
                 double* to) const;

  int order_, stride_;
  AlignedVector up_, across_, down_;           // matrices, column by column
  AlignedVector multipole_weight_, local_weight_;  // of a_{k-1} in c_k; of A_{l+1}
  std::array<Diagonals, 4> up_powers_, down_powers_;
  std::array<Diagonals, offset_count> across_powers_;
};

}  // namespace stokes
