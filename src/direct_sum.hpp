// Direct evaluation of the double-layer sum: O(targets x sources), the oracle for every fast path.
#pragma once

#include <vector>

#include "base.hpp"

namespace stokes {

// Points as a structure of arrays.
struct PointArray {
  std::vector<double> x, y;

  int size() const { return static_cast<int>(x.size()); }
  void resize(int count) { x.resize(count), y.resize(count); }
  void set(int k, Complex z) { x[k] = z.real(), y[k] = z.imag(); }
  Complex operator[](int k) const { return {x[k], y[k]}; }
};

// velocity[i] = (1/pi) Sum_j (r . n_j)(r . eta_j) r / |r|^4 w_j,  r = target_i - source_j,
// where weighted_normal_j = w_j n_j. Sources that coincide with the target are left out (the diagonal
// limit of the trapezoid rule is the caller's). Vectorised over targets and threaded; the result does
// not depend on the number of threads.
// `softening` >= 0: |r| in the denominator is replaced by this length where it is smaller. The caller corrects such close
// pairs if it knows their difference more accurately than the coordinates do.
void double_layer_velocity(const PointArray& targets, const PointArray& sources,
                           const PointArray& weighted_normal, const ComplexVector& density,
                           ComplexVector& velocity, double softening = 0.0);

}  // namespace stokes
