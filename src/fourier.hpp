// Trigonometric interpolation of periodic functions sampled at N equal steps of [0, 2 pi), N even.
#pragma once

#include "base.hpp"

namespace stokes {

// Coefficients c_k of f(alpha) = Sum_k c_k e^{i k alpha}, ordered k = 0, 1, ..., N/2-1, -N/2, ..., -1.
// O(N log N); thread-safe.
ComplexVector fourier_coefficients(const ComplexVector& values);

// Values at N equal steps from coefficients in the same order.
ComplexVector fourier_values(const ComplexVector& coefficients);

// d f / d alpha at the nodes; the Nyquist mode, whose derivative the nodes do not determine, is dropped.
ComplexVector fourier_derivative(const ComplexVector& values);

// f at `points` >= N equal steps; the Nyquist coefficient is split between +N/2 and -N/2.
ComplexVector fourier_upsample(const ComplexVector& values, int points);

}  // namespace stokes
