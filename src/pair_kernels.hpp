// Flow of point sources at a pack of targets: the innermost loops of the direct sums and of the near
// field of the fast multipole method.
//
// All kernels add the sum over the sources [begin, end) to `sum`. Sources that coincide with a target are
// left out; for ranges that are known to hold none, Coincident::absent saves the test. With r = target -
// source, rho = |r|, normal n including the quadrature weight, and the strengths scaled beforehand as
// stated at each structure:
//   stresslet  u = (r.n)(r.eta) r/rho^4,               p = 2 (r.n)(r.eta)/rho^4 - n.eta/rho^2
//   Stokeslet  u = -log(rho) F + (r.F) r/rho^2,        p = 2 F.r/rho^2
//   rotlet     u = L perp(r)/rho^2,                    p = 0
// Distances must lie between 1e-37 and 1e37, because products of their powers are formed.
#pragma once

#include "simd.hpp"

namespace stokes {

enum class Coincident { possible, absent };

// eta includes the factor 1/pi.
struct StressletArrays {
  const double *x, *y, *nx, *ny, *ex, *ey;
};

// F and L include the factor 1/(4 pi).
struct PointForceArrays {
  const double *x, *y, *fx, *fy, *torque;
};

struct VelocityPack {
  Pack x{}, y{};
};

// Derivatives: x_x = d u_1/dx, x_y = d u_1/dy, y_x = d u_2/dx; d u_2/dy = -x_x.
struct GradientPack {
  Pack x{}, y{}, pressure{}, x_x{}, x_y{}, y_x{};
};

namespace detail {

// v with zeros replaced by one; the numerators vanish there.
template <Coincident coincident>
inline Pack nonzero(Pack v) {
  if constexpr (coincident == Coincident::absent) {
    return v;
  } else {
    return v == 0.0 ? broadcast(1.0) : v;
  }
}

}  // namespace detail

template <Coincident coincident>
inline void add_stresslets(Pack x, Pack y, const StressletArrays& s, int begin, int end, VelocityPack& sum) {
  Pack ux = sum.x, uy = sum.y;
  int j = begin;
  for (; j + 1 < end; j += 2) {  // two sources share one division
    const Pack rx0 = x - s.x[j], ry0 = y - s.y[j], rx1 = x - s.x[j + 1], ry1 = y - s.y[j + 1];
    const Pack rr0 = rx0 * rx0 + ry0 * ry0, rr1 = rx1 * rx1 + ry1 * ry1;
    const Pack q0 = detail::nonzero<coincident>(rr0 * rr0), q1 = detail::nonzero<coincident>(rr1 * rr1);
    const Pack both = 1.0 / (q0 * q1);
    const Pack n0 = rx0 * s.nx[j] + ry0 * s.ny[j], e0 = rx0 * s.ex[j] + ry0 * s.ey[j];
    const Pack f0 = n0 * e0 * (both * q1);
    const Pack n1 = rx1 * s.nx[j + 1] + ry1 * s.ny[j + 1], e1 = rx1 * s.ex[j + 1] + ry1 * s.ey[j + 1];
    const Pack f1 = n1 * e1 * (both * q0);
    ux += f0 * rx0, uy += f0 * ry0;
    ux += f1 * rx1, uy += f1 * ry1;
  }
  if (j < end) {
    const Pack rx = x - s.x[j], ry = y - s.y[j], rr = rx * rx + ry * ry;
    const Pack f = (rx * s.nx[j] + ry * s.ny[j]) * (rx * s.ex[j] + ry * s.ey[j]) /
                   detail::nonzero<coincident>(rr * rr);
    ux += f * rx, uy += f * ry;
  }
  sum.x = ux, sum.y = uy;
}

template <Coincident coincident>
inline void add_stresslets(Pack x, Pack y, const StressletArrays& s, int begin, int end, GradientPack& sum) {
  GradientPack total = sum;
  for (int j = begin; j < end; ++j) {
    const Pack rx = x - s.x[j], ry = y - s.y[j], rr = rx * rx + ry * ry;
    const Pack rn = rx * s.nx[j] + ry * s.ny[j], re = rx * s.ex[j] + ry * s.ey[j];
    Pack i2 = 1.0 / detail::nonzero<coincident>(rr);
    if constexpr (coincident == Coincident::possible) i2 = rr == 0.0 ? Pack{} : i2;
    const Pack i4 = i2 * i2, f = rn * re * i4;
    // d_j u_i = (n_j re + eta_j rn) r_i/rho^4 + delta_ij f - 4 f r_i r_j/rho^2
    const Pack four = 4.0 * f * i2, an = re * i4, ae = rn * i4;
    const Pack tx = an * s.nx[j] + ae * s.ex[j] - four * rx, ty = an * s.ny[j] + ae * s.ey[j] - four * ry;
    total.x += f * rx, total.y += f * ry;
    total.pressure += 2.0 * f - (s.nx[j] * s.ex[j] + s.ny[j] * s.ey[j]) * i2;
    total.x_x += tx * rx + f, total.x_y += ty * rx, total.y_x += tx * ry;
  }
  sum = total;
}

template <Coincident coincident>
inline void add_point_forces(Pack x, Pack y, const PointForceArrays& s, int begin, int end,
                             VelocityPack& sum) {
  Pack ux = sum.x, uy = sum.y;
  for (int j = begin; j < end; ++j) {
    const Pack rx = x - s.x[j], ry = y - s.y[j];
    // For rho = 0 every term vanishes, log(1) included.
    const Pack rr = detail::nonzero<coincident>(rx * rx + ry * ry);
    const Pack i2 = 1.0 / rr, logarithm = -0.5 * log(rr);
    const Pack radial = (rx * s.fx[j] + ry * s.fy[j]) * i2, around = i2 * s.torque[j];
    ux += logarithm * s.fx[j] + radial * rx - around * ry;
    uy += logarithm * s.fy[j] + radial * ry + around * rx;
  }
  sum.x = ux, sum.y = uy;
}

template <Coincident coincident>
inline void add_point_forces(Pack x, Pack y, const PointForceArrays& s, int begin, int end,
                             GradientPack& sum) {
  GradientPack total = sum;
  for (int j = begin; j < end; ++j) {
    const Pack rx = x - s.x[j], ry = y - s.y[j], square = rx * rx + ry * ry;
    const Pack rr = detail::nonzero<coincident>(square);
    Pack i2 = 1.0 / rr;
    if constexpr (coincident == Coincident::possible) i2 = square == 0.0 ? Pack{} : i2;
    const Pack logarithm = -0.5 * log(rr);
    const Pack radial = (rx * s.fx[j] + ry * s.fy[j]) * i2, around = i2 * s.torque[j];
    total.x += logarithm * s.fx[j] + radial * rx - around * ry;
    total.y += logarithm * s.fy[j] + radial * ry + around * rx;
    total.pressure += 2.0 * radial;
    // d_j u_i = (r_i F_j - F_i r_j + delta_ij r.F)/rho^2 - 2 (r.F) r_i r_j/rho^4
    //           + L (d_j perp(r)_i/rho^2 - 2 perp(r)_i r_j/rho^4)
    const Pack px = rx * i2, py = ry * i2, curl = py * s.fx[j] - px * s.fy[j];
    const Pack two = 2.0 * radial, twist = 2.0 * s.torque[j] * px * py;
    total.x_x += radial - two * rx * px + twist;
    total.x_y += -curl - two * rx * py + around * (2.0 * ry * py - 1.0);
    total.y_x += curl - two * ry * px - around * (2.0 * rx * px - 1.0);
  }
  sum = total;
}

}  // namespace stokes
