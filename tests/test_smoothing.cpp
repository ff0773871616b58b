// The multiscale local polynomial transform that smooths Figure 10.
#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "smoothing.hpp"

namespace stokes {
namespace {

double largest_difference(const std::vector<double>& u, const std::vector<double>& v) {
  double largest = 0.0;
  for (std::size_t k = 0; k < u.size(); ++k) largest = std::max(largest, std::abs(u[k] - v[k]));
  return largest;
}

TEST_CASE("without thresholds the transform gives the values back, for any number of them") {
  std::mt19937_64 generator(3);
  for (const std::size_t count : {1u, 7u, 16u, 17u, 100u, 2001u}) {
    std::vector<double> values;
    for (std::size_t k = 0; k < count; ++k) values.push_back(static_cast<double>(generator() >> 11) * 0x1p-53);
    const MultiscaleFit fit = multiscale_fit(values, 6);
    CHECK(largest_difference(multiscale_sum(fit, std::vector<double>(fit.details.size(), 0.0)), values) < 1e-14);
  }
}

TEST_CASE("straight lines have no details, and smoothing keeps them to the ends") {
  std::vector<double> values;
  for (int k = 0; k < 333; ++k) values.push_back(2.0 - 0.01 * k);
  for (const std::vector<double>& details : multiscale_fit(values, 5).details)
    for (const double d : details) CHECK(std::abs(d) < 1e-12);
  CHECK(largest_difference(smoothed(values, 5), values) < 1e-12);
}

TEST_CASE("noise on a slow wave is reduced to a third at least, in the mean square") {
  std::mt19937_64 generator(5);
  std::vector<double> wave, noisy;
  for (int k = 0; k < 2000; ++k) {
    wave.push_back(std::sin(2.0 * 3.141592653589793 * k / 1000.0));
    double noise = -6.0;  // of variance 1
    for (int i = 0; i < 12; ++i) noise += static_cast<double>(generator() >> 11) * 0x1p-53;
    noisy.push_back(wave.back() + 0.1 * noise);
  }
  const std::vector<double> smooth = smoothed(noisy, 4);
  double before = 0.0, after = 0.0;
  for (std::size_t k = 0; k < wave.size(); ++k) {
    before += std::pow(noisy[k] - wave[k], 2);
    after += std::pow(smooth[k] - wave[k], 2);
  }
  CHECK(after < before / 9.0);
  CHECK_THROWS_AS(smoothed({1.0, std::nan("")}, 3), std::invalid_argument);
}

}  // namespace
}  // namespace stokes
