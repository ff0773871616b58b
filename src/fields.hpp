// The flow of a suspension on a grid of points, as CSV.
#pragma once

#include <filesystem>

#include "stepper.hpp"

namespace stokes {

// Solves for the flow at the poses of `bodies`, everything that drives it multiplied by `driving` and `contact`
// forces and torques on the bodies (one each; empty: none), and writes it at points x points points of the square
// around the container or of the smallest square around the bodies with a body's length to spare:
//   x,y,u,v,p,sigma_xx,sigma_xy,sigma_yy,inside
// row by row from below; inside = 1 in a body and beyond the container, where the rest is nan. The pressure of a
// bounded flow has a free constant. A function of its arguments alone. NumericalError when GMRES fails or on a
// write error.
void write_fields(const std::filesystem::path& path, const Suspension& bodies, const StepperOptions& options,
                  double driving, const std::vector<Wrench>& contact, int points);

}  // namespace stokes
