// The flow of a suspension on a grid of points, and as CSV.
#pragma once

#include <filesystem>

#include "simulation.hpp"

namespace stokes {

struct Square {
  Complex corner;  // lower left
  double side;
};

struct GridPoint {
  Complex x;
  bool inside;     // in a body or beyond the container, where there is no flow
  PointFlow flow;
};

struct GridFlow {
  std::vector<GridPoint> points;  // row by row from below
  std::vector<Wrench> wrenches;   // of each body on the fluid: those given for free bodies, reactions of fixed ones
};

// Solves for the flow at the poses of `bodies`, with the background flow and the walls' velocities multiplied by `driving`
// and with `contact` forces and torques on the bodies (one each; empty: none). Evaluates it at points x points points of
// the square, its sides included. The pressure of a bounded flow has a free constant.
// NumericalError when GMRES fails.
GridFlow flow_on_grid(const Suspension& bodies, const StepperOptions& options, double driving,
                      const std::vector<Wrench>& contact, const Square& square, int points);

// The flow of a step, contact forces included: that of the densities that moved the bodies. The flow of the final
// configuration is solved for as above, without contact forces.
GridFlow flow_on_grid(const StepRecord& record, const StepperOptions& options, const Square& square, int points);

// Writes the flow of a record on the square around the container or on the smallest square around the bodies with a
// body's length to spare:
//   x,y,u,v,p,sigma_xx,sigma_xy,sigma_yy,inside
// inside is 1 or 0; where it is 1, all columns but x and y are nan. The file depends only on the arguments. Errors as
// above, and NumericalError on a write error.
void write_fields(const std::filesystem::path& path, const StepRecord& record, const StepperOptions& options, int points);

}  // namespace stokes
