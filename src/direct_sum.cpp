#include "direct_sum.hpp"

#include <algorithm>
#include <cmath>

#include "simd.hpp"
#include "threads.hpp"

namespace stokes {

namespace {

constexpr int block = 2 * lanes;  // targets that share one division

struct SourceArrays {
  const double *x, *y, *nx, *ny, *ex, *ey;  // ex, ey: density / pi
  int count;
  double least;  // of |r|^4, positive
};

// Adds the sum over all sources to two packs of targets.
void sum_block(const double* tx, const double* ty, const SourceArrays& s, double* ux, double* uy) {
  const Pack x0 = load(tx), x1 = load(tx + lanes), y0 = load(ty), y1 = load(ty + lanes);
  const Pack least = x0 * 0.0 + s.least;
  Pack ux0{}, ux1{}, uy0{}, uy1{};
  for (int j = 0; j < s.count; ++j) {
    const Pack rx0 = x0 - s.x[j], rx1 = x1 - s.x[j], ry0 = y0 - s.y[j], ry1 = y1 - s.y[j];
    const Pack rr0 = rx0 * rx0 + ry0 * ry0, rr1 = rx1 * rx1 + ry1 * ry1;
    // A coincident source has r = 0, so any finite factor removes it.
    const Pack p0 = rr0 * rr0, p1 = rr1 * rr1, q0 = p0 < least ? least : p0, q1 = p1 < least ? least : p1;
    const Pack both = 1.0 / (q0 * q1);
    const Pack f0 = (rx0 * s.nx[j] + ry0 * s.ny[j]) * (rx0 * s.ex[j] + ry0 * s.ey[j]) * (both * q1);
    const Pack f1 = (rx1 * s.nx[j] + ry1 * s.ny[j]) * (rx1 * s.ex[j] + ry1 * s.ey[j]) * (both * q0);
    ux0 += f0 * rx0, uy0 += f0 * ry0;
    ux1 += f1 * rx1, uy1 += f1 * ry1;
  }
  store(ux, ux0), store(ux + lanes, ux1);
  store(uy, uy0), store(uy + lanes, uy1);
}

}  // namespace

void double_layer_velocity(const PointArray& targets, const PointArray& sources,
                           const PointArray& weighted_normal, const ComplexVector& density,
                           ComplexVector& velocity, double softening) {
  const int count = targets.size(), source_count = sources.size();
  std::vector<double> ex(source_count), ey(source_count);
  for (int j = 0; j < source_count; ++j) ex[j] = density[j].real() / pi, ey[j] = density[j].imag() / pi;
  const SourceArrays arrays{sources.x.data(), sources.y.data(), weighted_normal.x.data(),
                            weighted_normal.y.data(), ex.data(), ey.data(), source_count,
                            std::max(std::pow(softening, 4), 1e-148)};
  velocity.resize(count);

  const auto sum_targets = [&](int first, int last) {
    for (int i = first; i < last; i += block) {
      const int n = std::min(block, last - i);
      double tx[block], ty[block], ux[block], uy[block];
      for (int k = 0; k < block; ++k) tx[k] = targets.x[i + std::min(k, n - 1)], ty[k] = targets.y[i + std::min(k, n - 1)];
      sum_block(tx, ty, arrays, ux, uy);
      for (int k = 0; k < n; ++k) velocity[i + k] = {ux[k], uy[k]};
    }
  };
  // Below about 1e5 pairs starting the threads costs more than the sum.
  constexpr long pairs_per_task = 100000;
  const long pairs = static_cast<long>(count) * source_count;
  if (pairs < 2 * pairs_per_task) return sum_targets(0, count);
  const int chunk = block * std::max(1, static_cast<int>(pairs_per_task / source_count / block));
  parallel_for((count + chunk - 1) / chunk, [&](long c) {
    sum_targets(static_cast<int>(c) * chunk, std::min(count, static_cast<int>(c + 1) * chunk));
  });
}

}  // namespace stokes
