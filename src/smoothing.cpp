#include "smoothing.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace stokes {

namespace {

constexpr double half_width = 3.0;  // spacings
constexpr std::size_t least = 8;    // values of a level

// Local linear fit at x through values at 0, 1, 2, ...
double local_fit(const std::vector<double>& values, double x) {
  const auto last = static_cast<double>(values.size() - 1);
  const auto from = static_cast<std::size_t>(std::max(0.0, std::floor(x - half_width)));
  const auto to = static_cast<std::size_t>(std::min(last, std::ceil(x + half_width)));
  double w0 = 0.0, w1 = 0.0, w2 = 0.0, v0 = 0.0, v1 = 0.0;
  for (std::size_t k = from; k <= to; ++k) {
    const double d = static_cast<double>(k) - x, w = std::max(0.0, 1.0 - d * d / (half_width * half_width));
    w0 += w, w1 += w * d, w2 += w * d * d;
    v0 += w * values[k], v1 += w * d * values[k];
  }
  return (w2 * v0 - w1 * v1) / (w0 * w2 - w1 * w1);
}

std::vector<double> fit_at(const std::vector<double>& values, std::size_t count, double spacing) {
  std::vector<double> result;
  for (std::size_t k = 0; k < count; ++k) result.push_back(local_fit(values, spacing * static_cast<double>(k)));
  return result;
}

}  // namespace

MultiscaleFit multiscale_fit(const std::vector<double>& values, int levels) {
  if (std::any_of(values.begin(), values.end(), [](double v) { return !std::isfinite(v); }))
    throw std::invalid_argument("a value to be smoothed is not finite");
  MultiscaleFit fit{values, {}};
  for (int level = 0; level < levels && fit.coarse.size() / 2 >= least; ++level) {
    const std::size_t count = fit.coarse.size();
    const std::vector<double> next = fit_at(fit.coarse, (count + 1) / 2, 2.0);
    const std::vector<double> back = fit_at(next, count, 0.5);
    fit.details.emplace_back();
    for (std::size_t k = 0; k < count; ++k) fit.details.back().push_back(fit.coarse[k] - back[k]);
    fit.coarse = next;
  }
  return fit;
}

std::vector<double> multiscale_sum(const MultiscaleFit& fit, const std::vector<double>& thresholds) {
  std::vector<double> values = fit.coarse;
  for (std::size_t level = fit.details.size(); level-- > 0;) {
    const std::vector<double>& details = fit.details[level];
    values = fit_at(values, details.size(), 0.5);
    for (std::size_t k = 0; k < details.size(); ++k)
      values[k] += std::copysign(std::max(0.0, std::abs(details[k]) - thresholds[level]), details[k]);
  }
  return values;
}

std::vector<double> smoothed(const std::vector<double>& values, int levels) {
  const MultiscaleFit fit = multiscale_fit(values, levels);
  std::vector<double> thresholds;
  for (std::vector<double> sizes : fit.details) {
    for (double& d : sizes) d = std::abs(d);
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    thresholds.push_back(*middle / 0.6745 * std::sqrt(2.0 * std::log(static_cast<double>(values.size()))));
  }
  return multiscale_sum(fit, thresholds);
}

}  // namespace stokes
