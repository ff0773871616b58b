#include "fourier.hpp"

#include <fftw3.h>

#include <map>
#include <mutex>

namespace stokes {

namespace {

struct PlanCache {
  std::mutex mutex;
  std::map<std::pair<int, int>, fftw_plan> plans;

  ~PlanCache() {
    for (const auto& entry : plans) fftw_destroy_plan(entry.second);
  }
};

// One plan per length and direction. FFTW_ESTIMATE, because measured plans differ from run to run and
// with them the last bits of every result. Planning is not thread-safe, executing is.
fftw_plan plan_of_length(int n, int direction) {
  static PlanCache cache;
  const std::lock_guard lock(cache.mutex);
  fftw_plan& plan = cache.plans[{n, direction}];
  if (!plan) {
    ComplexVector in(n), out(n);
    plan = fftw_plan_dft_1d(n, reinterpret_cast<fftw_complex*>(in.data()),
                            reinterpret_cast<fftw_complex*>(out.data()), direction,
                            FFTW_ESTIMATE | FFTW_UNALIGNED);
  }
  return plan;
}

ComplexVector transform(const ComplexVector& in, int direction) {
  const int n = static_cast<int>(in.size());
  ComplexVector source = in, out(n);
  fftw_execute_dft(plan_of_length(n, direction), reinterpret_cast<fftw_complex*>(source.data()),
                   reinterpret_cast<fftw_complex*>(out.data()));
  return out;
}

}  // namespace

ComplexVector fourier_coefficients(const ComplexVector& values) {
  return transform(values, FFTW_FORWARD) / static_cast<double>(values.size());
}

ComplexVector fourier_values(const ComplexVector& coefficients) {
  return transform(coefficients, FFTW_BACKWARD);
}

ComplexVector fourier_derivative(const ComplexVector& values) {
  const Eigen::Index n = values.size();
  ComplexVector c = fourier_coefficients(values);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Index mode = k < n / 2 ? k : k - n;
    c[k] *= 2 * k == n ? Complex(0.0) : Complex(0.0, static_cast<double>(mode));
  }
  return fourier_values(c);
}

ComplexVector fourier_upsample(const ComplexVector& values, int points) {
  const Eigen::Index n = values.size();
  if (points == n) return values;
  const ComplexVector c = fourier_coefficients(values);
  ComplexVector fine = ComplexVector::Zero(points);
  fine.head(n / 2) = c.head(n / 2);
  fine.tail(n / 2 - 1) = c.tail(n / 2 - 1);
  fine[n / 2] = 0.5 * c[n / 2];
  fine[points - n / 2] += 0.5 * c[n / 2];
  return fourier_values(fine);
}

}  // namespace stokes
