// Smoothing of a time series with spikes by a multiscale local polynomial transform.
//
// A pyramid of local linear fits starts from the values s_0. s_{j+1} is the fit through s_j, with the kernel 1 - (x/w)^2 of
// half-width w = 3 spacings of s_j, at every second of its places. The detail d_j = s_j - (fit through s_{j+1} at the
// places of s_j) is kept at all places, so that values and transform are equivalent. Smoothing applies a soft threshold
// to the details and adds everything up again. (After Jansen and Amghar, Multiscale local polynomial decompositions using
// bandwidths as scales.)
#pragma once

#include <vector>

namespace stokes {

struct MultiscaleFit {
  std::vector<double> coarse;                // the last s_j
  std::vector<std::vector<double>> details;  // d_0 (as many as values), d_1, ...
};

// Values at equal steps. `levels` >= 0; the pyramid has fewer if less than 8 values are left for the next. Cost O(n).
MultiscaleFit multiscale_fit(const std::vector<double>& values, int levels);

// The values from the details after soft thresholding; `thresholds`: one for each level of details.
std::vector<double> multiscale_sum(const MultiscaleFit& fit, const std::vector<double>& thresholds);

// The values smoothed over `levels` levels with the universal threshold sigma sqrt(2 ln n), where sigma is the median
// modulus of the details of a level over 0.6745. Features narrower than about ten times the widest fit (3 2^levels values
// to either side) are smoothed, too. NaN values are refused (std::invalid_argument).
std::vector<double> smoothed(const std::vector<double>& values, int levels);

}  // namespace stokes
