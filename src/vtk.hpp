// Pictures of a run for ParaView: one file per state, with the bodies' outlines as polygons and the numbers of each body.
#pragma once

#include <filesystem>
#include <string>

#include "simulation.hpp"

namespace stokes {

// A state as a legacy VTK file (version 3.0, binary, big-endian): the container, if there is one, as a closed line, each
// body as a polygon of `outline_points` corners on its boundary. Every cell has body (its index, -1 for the
// container), fixed (0 or 1), velocity, omega (of a fixed body and of the container that of the surface), contact_force and
// contact_torque, the last four nan in a final configuration. TIME holds the time.
std::string vtk_file(const StepRecord& record, int outline_points = 96);

// Writes FOLDER/step_<number of the step, at least six digits>.vtk at the start of every `output_every`-th step and for
// the final configuration. Beside FOLDER, run.vtk.series names all of them with their times, for ParaView.
class VtkWriter {
 public:
  // Creates the folder. InputError if it cannot be written.
  VtkWriter(const std::filesystem::path& folder, int output_every);
  VtkWriter(const VtkWriter&) = delete;
  VtkWriter& operator=(const VtkWriter&) = delete;
  // Writes the series if that has not been done. An error is not reported: a run that ends early has other messages.
  ~VtkWriter();

  // Replaces each file as a whole. NumericalError on a write error.
  void write(const StepRecord& record);

  // The same for the series of the files in the folder, those of a run before an interruption included.
  void write_series();

 private:
  std::filesystem::path folder_;
  int output_every_;
  bool is_series_written_ = false;
};

}  // namespace stokes
