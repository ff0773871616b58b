#include "fmm_points.hpp"

#include <algorithm>

namespace stokes {

namespace {

// Sums of the coefficients over the sources, lane by lane.
struct LaneSums {
  alignas(64) double value[4 * (largest_order + 1) * lanes];
  const int stride;

  explicit LaneSums(const ExpansionFrame& frame) : stride(frame.stride) {
    std::fill_n(value, 4 * stride * lanes, 0.0);
  }

  void add(int series, int k, ComplexPack term) {
    double* const re = value + (2 * series * stride + k) * lanes;
    double* const im = re + stride * lanes;
    store(re, load(re) + term.re), store(im, load(im) + term.im);
  }

  void add_to(double* to) const {
    for (int k = 0; k < 4 * stride; k += lanes) store(to + k, load(to + k) + sum_of_lanes(value + k * lanes));
  }
};

// p[j], p[j + 1], ...; beyond `end` the last one, or zero.
Pack load_up_to(const double* p, int j, int end) {
  if (j + lanes <= end) return load(p + j);
  double values[lanes];
  for (int i = 0; i < lanes; ++i) values[i] = p[std::min(j + i, end - 1)];
  return load(values);
}

Pack load_or_zero(const double* p, int j, int end) {
  if (j + lanes <= end) return load(p + j);
  double values[lanes] = {};
  for (int i = 0; j + i < end; ++i) values[i] = p[j + i];
  return load(values);
}

ComplexPack relative(const ExpansionFrame& frame, Pack x, Pack y) {
  const double factor = 1.0 / frame.size;
  return {(x - frame.x) * factor, (y - frame.y) * factor};
}

// g and -e of stresslets. (The arrays hold eta/pi.)
struct StressletTerms {
  ComplexPack g;
  Pack h;

  StressletTerms(const ExpansionFrame& frame, const StressletArrays& s, int j, int end) {
    const Pack nx = load_or_zero(s.nx, j, end), ny = load_or_zero(s.ny, j, end);
    const Pack ex = load_or_zero(s.ex, j, end), ey = load_or_zero(s.ey, j, end);
    const double factor = 0.25 / frame.size;
    g = {(nx * ex - ny * ey) * factor, (nx * ey + ny * ex) * factor};
    h = (nx * ex + ny * ey) * (2.0 * factor);
  }
};

// f and the imaginary part of e. (The arrays hold F/4 pi and L/4 pi.)
struct ForceTerms {
  ComplexPack f;
  Pack torque;

  ForceTerms(const ExpansionFrame& frame, const PointForceArrays& s, int j, int end)
      : f{0.5 * load_or_zero(s.fx, j, end), 0.5 * load_or_zero(s.fy, j, end)},
        torque(load_or_zero(s.torque, j, end) * (1.0 / frame.size)) {}
};

// Values at Z of phi, its derivatives with respect to Z, psi and its derivative; and the flow of these.
struct Goursat {
  ComplexPack phi, phi1, psi, phi2{}, psi1{};

  void add_to(ComplexPack z, double, VelocityPack& sum) const {
    const ComplexPack shear = z * conj(phi1);
    sum.x += phi.re - shear.re - psi.re, sum.y += phi.im - shear.im + psi.im;
  }

  // du/dx = 2i Im phi' - W, du/dy = -2 Im phi' + iW, W = Z conj(phi'') + conj(psi').
  void add_to(ComplexPack z, double size, GradientPack& sum) const {
    const double factor = 1.0 / size;
    const ComplexPack shear = z * conj(phi1), bend = z * conj(phi2);
    sum.x += phi.re - shear.re - psi.re, sum.y += phi.im - shear.im + psi.im;
    sum.pressure -= 4.0 * factor * phi1.re;
    const Pack w_re = factor * (bend.re + psi1.re), w_im = factor * (bend.im - psi1.im);
    const Pack spin = 2.0 * factor * phi1.im;
    sum.x_x -= w_re, sum.y_x += spin - w_im, sum.x_y -= spin + w_im;
  }
};

template <bool derivatives>
Goursat horner(const ExpansionFrame& frame, const double* from, ComplexPack z) {
  const double* const a_re = from;
  const double* const a_im = from + frame.stride;
  const double* const b_re = from + 2 * frame.stride;
  const double* const b_im = from + 3 * frame.stride;
  Goursat f{};
  for (int l = frame.order; l >= 0; --l) {
    if constexpr (derivatives) {
      f.phi2 = f.phi2 * z + f.phi1;
      f.psi1 = f.psi1 * z + f.psi;
    }
    f.phi1 = f.phi1 * z + f.phi;
    const ComplexPack phi = f.phi * z, psi = f.psi * z;
    f.phi = {phi.re + a_re[l], phi.im + a_im[l]};
    f.psi = {psi.re + b_re[l], psi.im + b_im[l]};
  }
  f.phi2 = 2.0 * f.phi2;
  return f;
}

template <class FlowPack>
void local_flow(const ExpansionFrame& frame, const double* from, Pack x, Pack y, FlowPack& sum) {
  const ComplexPack z = relative(frame, x, y);
  horner<std::is_same_v<FlowPack, GradientPack>>(frame, from, z).add_to(z, frame.size, sum);
}

template <class FlowPack>
void multipole_flow(const ExpansionFrame& frame, const double* from, bool with_logarithm, Pack x, Pack y,
                    FlowPack& total) {
  constexpr bool derivatives = std::is_same_v<FlowPack, GradientPack>;
  const ComplexPack z = relative(frame, x, y), v = inverse(z), vv = v * v;
  const ComplexPack a0{broadcast(from[0]), broadcast(from[frame.stride])};
  const ComplexPack b0{broadcast(from[2 * frame.stride]), broadcast(from[3 * frame.stride])};
  // As functions of v = 1/Z: d/dZ = -v^2 d/dv, d2/dZ2 = v^4 d2/dv2 + 2 v^3 d/dv.
  Goursat f = horner<derivatives>(frame, from, v);
  if constexpr (derivatives) {
    f.phi2 = vv * vv * f.phi2 + 2.0 * (vv * v * f.phi1);
    f.psi1 = -1.0 * (vv * f.psi1);
  }
  f.phi1 = -1.0 * (vv * f.phi1);
  // The series above took a_0 and b_0 for constant terms.
  f.phi = f.phi - a0, f.psi = f.psi - b0;
  if (with_logarithm) {
    const Pack rx = x - frame.x, ry = y - frame.y;
    f.phi = f.phi + (log(rx * rx + ry * ry) - 1.0) * a0;
    f.phi1 = f.phi1 + a0 * v;
    if constexpr (derivatives) {
      f.phi2 = f.phi2 - a0 * vv;
      f.psi1 = f.psi1 + b0 * v;
    }
  }
  f.add_to(z, frame.size, total);
}

}  // namespace

void add_to_multipole(const ExpansionFrame& frame, const StressletArrays& s, PointRange range, double* to) {
  LaneSums sums(frame);
  for (int j = range.begin; j < range.end; j += lanes) {
    const ComplexPack d = relative(frame, load_up_to(s.x, j, range.end), load_up_to(s.y, j, range.end));
    const StressletTerms terms(frame, s, j, range.end);
    ComplexPack g = terms.g, h{terms.h, Pack{}};  // g d^{k-1}, h d^{k-1}
    ComplexPack q{};                              // conj(d) g d^{k-2}
    for (int k = 1; k <= frame.order; ++k) {
      sums.add(0, k, g);
      sums.add(1, k, (k - 1.0) * q - h);
      q = k == 1 ? conj(d) * g : q * d;
      g = g * d, h = h * d;
    }
  }
  sums.add_to(to);
}

void add_to_multipole(const ExpansionFrame& frame, const PointForceArrays& s, PointRange range, double* to) {
  LaneSums sums(frame);
  for (int j = range.begin; j < range.end; j += lanes) {
    const ComplexPack d = relative(frame, load_up_to(s.x, j, range.end), load_up_to(s.y, j, range.end));
    const ForceTerms terms(frame, s, j, range.end);
    const ComplexPack f = terms.f, e = conj(d) * f + ComplexPack{Pack{}, terms.torque};
    sums.add(0, 0, -1.0 * f);
    sums.add(1, 0, conj(f));
    ComplexPack power{broadcast(1.0), Pack{}};  // d^{k-1}
    for (int k = 1; k <= frame.order; ++k) {
      const ComplexPack lower = power;
      power = power * d;
      const ComplexPack part = 1.0 / k * power;
      sums.add(0, k, f * part);
      sums.add(1, k, e * lower - conj(f) * part);
    }
  }
  sums.add_to(to);
}

void add_to_local(const ExpansionFrame& frame, const StressletArrays& s, PointRange range, double* to) {
  LaneSums sums(frame);
  for (int j = range.begin; j < range.end; j += lanes) {
    const ComplexPack d = relative(frame, load_up_to(s.x, j, range.end), load_up_to(s.y, j, range.end));
    const ComplexPack v = inverse(d);
    const StressletTerms terms(frame, s, j, range.end);
    ComplexPack g = terms.g * v, h = terms.h * v;  // g v^{l+1}, h v^{l+1}
    ComplexPack q = conj(d) * g * v;               // conj(d) g v^{l+2}
    for (int l = 0; l <= frame.order; ++l) {
      sums.add(0, l, -1.0 * g);
      sums.add(1, l, h + (l + 1.0) * q);
      g = g * v, h = h * v, q = q * v;
    }
  }
  sums.add_to(to);
}

void add_to_local(const ExpansionFrame& frame, const PointForceArrays& s, PointRange range, double* to) {
  LaneSums sums(frame);
  for (int j = range.begin; j < range.end; j += lanes) {
    const ComplexPack d = relative(frame, load_up_to(s.x, j, range.end), load_up_to(s.y, j, range.end));
    const ComplexPack v = inverse(d);
    const ForceTerms terms(frame, s, j, range.end);
    const ComplexPack f = terms.f, e = conj(d) * f + ComplexPack{Pack{}, terms.torque};
    const Pack logarithm = log(squared(d) * (frame.size * frame.size));
    sums.add(0, 0, (1.0 - logarithm) * f);
    ComplexPack power{broadcast(1.0), Pack{}};  // v^l
    for (int l = 0; l <= frame.order; ++l) {
      const ComplexPack higher = power * v;
      const ComplexPack part = (l == 0 ? 0.0 : 1.0 / l) * power;
      sums.add(0, l, f * part);
      sums.add(1, l, -1.0 * (e * higher + conj(f) * part));
      power = higher;
    }
  }
  sums.add_to(to);
}

void add_local_flow(const ExpansionFrame& frame, const double* from, Pack x, Pack y, VelocityPack& sum) {
  local_flow(frame, from, x, y, sum);
}

void add_local_flow(const ExpansionFrame& frame, const double* from, Pack x, Pack y, GradientPack& sum) {
  local_flow(frame, from, x, y, sum);
}

void add_multipole_flow(const ExpansionFrame& frame, const double* from, bool with_logarithm, Pack x, Pack y,
                        VelocityPack& sum) {
  multipole_flow(frame, from, with_logarithm, x, y, sum);
}

void add_multipole_flow(const ExpansionFrame& frame, const double* from, bool with_logarithm, Pack x, Pack y,
                        GradientPack& sum) {
  multipole_flow(frame, from, with_logarithm, x, y, sum);
}

}  // namespace stokes
