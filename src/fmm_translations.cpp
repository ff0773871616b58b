#include "fmm_translations.hpp"

#include <algorithm>
#include <cmath>

#include "simd.hpp"
#include "threads.hpp"

namespace stokes {

namespace {

// Accumulators of 4 right-hand sides that fit the registers beside a column of the matrix.
constexpr int block_packs = lanes == 8 ? 6 : 3;

// Rows [0, packs) of: to += out * (matrix y), for the four real right-hand sides y.
template <int packs>
void multiply_rows(const double* matrix, int stride, int first, int last, const double* y,
                   const double* out_re, const double* out_im, double* to) {
  Pack phi_re[packs]{}, phi_im[packs]{}, psi_re[packs]{}, psi_im[packs]{};
  for (int k = first; k <= last; ++k) {
    const double* const column = matrix + k * stride;
    const Pack y0 = broadcast(y[k]), y1 = broadcast(y[stride + k]);
    const Pack y2 = broadcast(y[2 * stride + k]), y3 = broadcast(y[3 * stride + k]);
    unrolled<packs>([&](auto p) {
      Pack c = load(column + p * lanes);
      keep_in_register(c);
      phi_re[p] += c * y0, phi_im[p] += c * y1, psi_re[p] += c * y2, psi_im[p] += c * y3;
    });
  }
  unrolled<packs>([&](auto p) {
    const Pack re = load(out_re + p * lanes), im = load(out_im + p * lanes);
    double* const target = to + p * lanes;
    store(target, load(target) + (re * phi_re[p] - im * phi_im[p]));
    store(target + stride, load(target + stride) + (re * phi_im[p] + im * phi_re[p]));
    store(target + 2 * stride, load(target + 2 * stride) + (re * psi_re[p] - im * psi_im[p]));
    store(target + 3 * stride, load(target + 3 * stride) + (re * psi_im[p] + im * psi_re[p]));
  });
}

// Terms with which a multipole-to-local translation is as accurate as with `order` terms between boxes at
// the least distance. The error of the velocity of a stresslet falls by these factors a term (worst places
// in the boxes, measured; the prefactors are all about 5).
int terms_across(int columns, int rows, int order) {
  constexpr double factor[4][4] = {{}, {}, {0.487, 0.460, 0.345}, {0.290, 0.287, 0.257, 0.212}};
  const int far = std::max(std::abs(columns), std::abs(rows));
  const int near = std::min(std::abs(columns), std::abs(rows));
  return static_cast<int>(std::ceil(order * std::log(factor[2][0]) / std::log(factor[far][near])));
}

// C(n, k) for n below `count`, by rows.
std::vector<std::vector<double>> binomials(int count) {
  std::vector<std::vector<double>> c(count);
  for (int n = 0; n < count; ++n) {
    c[n].assign(n + 1, 1.0);
    for (int k = 1; k < n; ++k) c[n][k] = c[n - 1][k - 1] + c[n - 1][k];
  }
  return c;
}

}  // namespace

void Expansions::resize(int box_count, int order) {
  stride_ = padded(order);
  data_.resize(lead + static_cast<std::size_t>(box_count) * (4 * stride_ + lead));
  const long size = static_cast<long>(data_.size());
  constexpr long piece = 1 << 17;
  parallel_for((size + piece - 1) / piece, [&](long c) {
    std::fill(data_.begin() + c * piece, data_.begin() + std::min(size, (c + 1) * piece), 0.0);
  });
}

Translations::Translations(int order) : order_(order), stride_(Expansions::padded(order)) {
  const std::size_t size = static_cast<std::size_t>(stride_) * stride_;
  up_.assign(size, 0.0), across_.assign(size, 0.0), down_.assign(size, 0.0);
  multipole_weight_.assign(stride_, 0.0), local_weight_.assign(stride_, 0.0);
  const auto c = binomials(2 * order + 1);
  up_[0] = 1.0;
  for (int l = 1; l <= order; ++l) {
    up_[l] = across_[l] = -1.0 / l;
    for (int k = 1; k <= l; ++k) up_[k * stride_ + l] = c[l - 1][k - 1];
  }
  for (int k = 1; k <= order; ++k) {
    for (int l = 0; l <= order; ++l) across_[k * stride_ + l] = (k % 2 ? -1.0 : 1.0) * c[l + k - 1][k - 1];
  }
  for (int k = 0; k <= order; ++k) {
    for (int l = 0; l <= k; ++l) down_[k * stride_ + l] = c[k][l];
    multipole_weight_[k] = k == 0 ? 0.0 : k == 1 ? -1.0 : k - 1.0;
    if (k < order) local_weight_[k] = k + 1.0;
  }
  for (int q = 0; q < 4; ++q) {
    // Centre of the child relative to the parent's; coefficients of the child are in units of half the size.
    const Complex s{q % 2 ? 0.25 : -0.25, q / 2 ? 0.25 : -0.25};
    up_powers_[q] = powers(2.0 * s, 0.5 / s, s, order);
    down_powers_[q] = powers(s, s, 0.5 / s, order);
  }
  for (int columns = -3; columns <= 3; ++columns) {
    for (int rows = -3; rows <= 3; ++rows) {
      if (std::max(std::abs(columns), std::abs(rows)) < 2) continue;
      const Complex s(columns, rows);
      const int terms = terms_across(columns, rows, order);
      across_powers_[offset_number(columns, rows)] = powers(s, 1.0 / s, 1.0 / s, terms);
    }
  }
}

Translations::Diagonals Translations::powers(Complex offset, Complex in, Complex out, int terms) const {
  Diagonals d{offset, terms, {}, {}, {}, {}};
  d.in_re.assign(stride_, 0.0), d.in_im.assign(stride_, 0.0);
  d.out_re.assign(stride_, 0.0), d.out_im.assign(stride_, 0.0);
  Complex in_power = 1.0, out_power = 1.0;
  for (int k = 0; k <= order_; ++k) {
    d.in_re[k] = in_power.real(), d.in_im[k] = in_power.imag();
    d.out_re[k] = out_power.real(), d.out_im[k] = out_power.imag();
    in_power *= in, out_power *= out;
  }
  return d;
}

template <bool downward>
void Translations::translate(const AlignedVector& matrix, const Diagonals& d, int first, const double* from,
                             double* to) const {
  constexpr int shift = downward ? 1 : -1;
  const double* const weight = downward ? local_weight_.data() : multipole_weight_.data();
  const Pack s_re = broadcast(d.offset.real()), s_im = broadcast(d.offset.imag());
  alignas(64) double y[4 * (largest_order + 1)];
  const int packs = d.terms / lanes + 1;
  for (int k = 0; k < packs * lanes; k += lanes) {
    const Pack w = load(weight + k), in_re = load(d.in_re.data() + k), in_im = load(d.in_im.data() + k);
    const Pack a_re = load(from + k), a_im = load(from + stride_ + k);
    const Pack c_re = w * load(from + k + shift), c_im = w * load(from + stride_ + k + shift);
    const Pack b_re = load(from + 2 * stride_ + k) + (s_re * c_re + s_im * c_im);
    const Pack b_im = load(from + 3 * stride_ + k) + (s_re * c_im - s_im * c_re);
    store(y + k, in_re * a_re - in_im * a_im);
    store(y + stride_ + k, in_re * a_im + in_im * a_re);
    store(y + 2 * stride_ + k, in_re * b_re - in_im * b_im);
    store(y + 3 * stride_ + k, in_re * b_im + in_im * b_re);
  }
  for (int p = 0; p < packs; p += block_packs) {
    const int row = p * lanes;
    const double* const rows = matrix.data() + row;
    const double* const out_re = d.out_re.data() + row;
    const double* const out_im = d.out_im.data() + row;
    const auto run = [&]<int count>() {
      multiply_rows<count>(rows, stride_, first, d.terms, y, out_re, out_im, to + row);
    };
    switch (std::min(block_packs, packs - p)) {
      case 1: run.template operator()<1>(); break;
      case 2: run.template operator()<2>(); break;
      case 3: run.template operator()<3>(); break;
      case 4: run.template operator()<4>(); break;
      case 5: run.template operator()<5>(); break;
      case 6: run.template operator()<6>(); break;
    }
  }
}

void Translations::multipole_to_multipole(const double* from, int child, double* to) const {
  translate<false>(up_, up_powers_[child], 0, from, to);
}

void Translations::multipole_to_local(const double* from, int offset, bool with_logarithm, double* to) const {
  translate<false>(across_, across_powers_[offset], with_logarithm ? 0 : 1, from, to);
}

void Translations::local_to_local(const double* from, int child, double* to) const {
  translate<true>(down_, down_powers_[child], 0, from, to);
}

}  // namespace stokes
