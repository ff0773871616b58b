// Writes trajectory.csv and steps.csv during a run. Every field is a number or empty.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "csv.hpp"
#include "rheology.hpp"
#include "simulation.hpp"

namespace stokes {

// Says why the files of a run cannot be written to `folder`; empty if they can. Nothing is created or changed. The nearest
// existing parent folder must be writable, and existing files of these names must be writable files.
std::string why_not_writable(const std::filesystem::path& folder);

// Creates the folder if it is missing. InputError if it cannot be created or written.
const std::filesystem::path& made_folder(const std::filesystem::path& folder);

// trajectory.csv  step,time,body,x,y,theta,ux,uy,omega,fx,fy,torque,stresslet_11,stresslet_12
//   The configuration at the start of a step, the velocities, contact forces and torques of that step, and the stresslets.
//   Steps written: every `output_every`-th, the first and the last. The final configuration is one more step whose other
//   fields are empty. Walls have no rows.
// steps.csv  step,time,dt,gmres_iterations,ncp_iterations,contacts,min_gap,density_tail,stokes_solves,
//            smallest_multiplier,largest_multiplier,estimated_error,nodes,clusters,most_nodes,unresolved
//   A row for every step and one for the final configuration. With an accuracy the estimated error is that of the
//   velocities (resolution.hpp), and `unresolved` boundaries miss the accuracy. nodes and clusters are those of all
//   boundaries, most_nodes those of one. The multipliers are those of the step's contacts, empty without contacts: forces
//   or, with interference volumes, factors of the volumes' gradients. There are more columns (rheology.hpp):
//   * in unbounded fluid: stresslet_sum_11, stresslet_sum_12, contact_sum_11, contact_sum_12 and, with the area of a sample,
//     bulk_stress_11, bulk_stress_12, effective_viscosity;
//   * in a disc: outer_torque, of the container on the fluid about its centre;
//   * between two walls: inner_torque, outer_torque, order_parameter, effective_viscosity, stresslet_shear,
//     stresslet_normal_difference, contact_shear, contact_normal_difference.
enum class StepsColumns { unbounded, in_disc, between_walls };

class Recorder {
 public:
  using Row = std::vector<double>;

  // Where the files of an unfinished run end.
  struct Position {
    std::uintmax_t trajectory_bytes = 0, steps_bytes = 0;
    std::vector<Row> skipped;  // rows of the latest step between two outputs
  };

  // Creates the folder if it is missing. InputError if it cannot be written.
  Recorder(const std::filesystem::path& folder, int output_every, StepsColumns columns = StepsColumns::unbounded,
           const Sample& sample = {});
  // Says why the files in a folder do not belong to a run that was at `position`; empty if they do.
  static std::string why_not_continued(const std::filesystem::path& folder, StepsColumns columns,
                                       const Position& position);
  // Continues the files of a run that was at `position`. Everything behind that position is cut off.
  Recorder(const std::filesystem::path& folder, int output_every, StepsColumns columns, const Sample& sample,
           const Position& position);

  const Position& position() const { return position_; }

  // Other processes see the rows when this returns. On a write error it throws NumericalError. Both files and position()
  // are then those of the previous record, and nothing more can be recorded.
  void record(const StepRecord& record);

  // Returns when all rows are on disk. NumericalError on a write error.
  void sync();

  // Called at the end of the run. NumericalError on a write error.
  void close();

 private:
  void write(const StepRecord& record);
  void write_bodies(const StepRecord& record);
  void append_geometry(const StepRecord& record, Row& row) const;

  int output_every_;
  StepsColumns columns_;
  Sample sample_;
  CsvWriter trajectory_, steps_;
  std::vector<Row> skipped_;  // rows of the latest step between two outputs; written if it is the last step
  Position position_;         // after the latest record
};

// The meaning of every column of the two tables, for users.
std::string columns_help();

}  // namespace stokes
