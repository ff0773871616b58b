// Writes a run as it goes: trajectory.csv and steps.csv in one folder, every field a number.
#pragma once

#include <filesystem>
#include <vector>

#include "csv.hpp"
#include "simulation.hpp"

namespace stokes {

// trajectory.csv  step,time,body,x,y,theta,ux,uy,omega,fx,fy,torque
//   The configuration at the start of a step, the velocities and the contact forces and torques that moved
//   it; every `output_every`-th step, the first and the last; the final configuration is one more step
//   whose other fields are nan.
// steps.csv  step,time,dt,gmres_iterations,ncp_iterations,contacts,min_gap,density_tail
//   A row for every step and one for the final configuration.
class Recorder {
 public:
  // Creates the folder where it is missing. InputError when it cannot be written.
  Recorder(const std::filesystem::path& folder, int output_every);

  // Rows are on disk when this returns. NumericalError on a write error.
  void record(const StepRecord& record);

 private:
  using Row = std::vector<double>;

  int output_every_;
  CsvWriter trajectory_, steps_;
  std::vector<Row> skipped_;  // rows of the latest step that was left out; written if it is the last
};

}  // namespace stokes
