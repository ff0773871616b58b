// A user's problem: the case file `key = value` and the CSV of its bodies.
//
// Every error in either is an InputError of one paragraph: file and line (or the argument), the value
// against its limit, what to try. A new key needs a member of Case and a line in case_keys.cpp. A new
// value needs an enumerator and its word in case_keys.cpp. Limits, if there are any, belong in check_case().
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bodies.hpp"
#include "csv.hpp"
#include "simulation.hpp"
#include "start_from.hpp"

namespace stokes {

enum class Geometry {
  unbounded,
  disc,     // one circular wall around the fluid, centred at 0
  annulus,  // two concentric circular walls, centred at 0
};

struct Case {
  std::filesystem::path file;  // the case file; not a key
  std::string command;         // the command that runs the case, for its record; not a key
  std::vector<std::string> warnings;  // about the values given; not a key
  std::optional<EarlierState> earlier;  // the state that start_from names, once it is read; not a key

  // Required.
  std::string bodies;             // CSV of the bodies, as written: see bodies_path(); not with start_from
  FlowKind flow = FlowKind::none;  // between walls not required, and none
  int points_per_body = 0;        // even, at least 8; 0: none, with an accuracy
  double time_step = 0.0;         // time
  double end_time = 0.0;          // time
  std::string output;             // folder, relative to the working directory

  // Required in an annulus, the outer radius also in a disc, and only possible there.
  double inner_radius = 0.0;  // length
  double outer_radius = 0.0;  // length

  // With defaults, only possible in an annulus, those of the outer wall also in a disc.
  int wall_points = 256;                // even, at least 16
  double outer_angular_velocity = 0.0;  // 1 / time
  double inner_angular_velocity = 0.0;  // 1 / time
  double injection_rate = 0.0;          // area / time, outwards through both walls

  // Of unbounded fluid.
  double rate = 1.0;                  // 1 / time, in Poiseuille flow 1 / (length time); may be negative
  std::vector<double> gradient;       // of flow = linear, required there: du/dx, du/dy, dv/dx, dv/dy
  std::optional<double> sample_area;  // area, over which stresses are averaged

  // With defaults.
  Geometry geometry = Geometry::unbounded;
  double start_time = 0.0;                      // time
  std::string start_from;                       // folder of an earlier run and, behind a space, a time; empty: none
  std::optional<double> reverse_at;             // time; the flow and the walls' velocities change sign once
  double min_separation = 0.0;                  // in units of h = longest perimeter / points_per_body
  std::optional<double> min_separation_length;  // length; instead of min_separation
  ContactModel contact = ContactModel::gap;
  Coupling coupling = Coupling::global;
  LcpMatrix lcp_matrix = LcpMatrix::full;
  int stiv_vertices = 0;                        // 0: 4 points_per_body
  StivGradient stiv_gradient = StivGradient::full;
  NearSingular near_singular = NearSingular::cauchy;
  std::optional<double> accuracy;               // of velocities, in units of rate and size; chooses nodes and tolerances
  double gmres_tolerance = 1e-8;                // relative true residual
  Refine refine = Refine::none;
  Summation summation = Summation::automatic;
  IntegratorKind integrator = IntegratorKind::euler;
  bool adaptive = false;                        // reject and halve time steps
  std::optional<double> tolerance;              // of the local error of a step, which then chooses the steps
  int output_every = 1;                         // steps
  std::vector<double> fields_at;                // times, increasing
  int field_points = 200;                       // on each side of the grid
  bool overwrite = false;                       // results of another run in the output folder
  bool vtk = false;                             // a picture of every output step in OUTPUT/vtk
  double checkpoint_every = 60.0;               // seconds of wall time; 0: none at intervals
  std::optional<int> threads;                   // all cores if not given
  TimeCounting time_counting = TimeCounting::exact;

  BackgroundFlow background() const;

  // The bodies' file; a relative name starts from the case file's folder.
  std::filesystem::path bodies_path() const { return file.parent_path() / bodies; }
};

// Reads and checks a case file. Each override `key=value` replaces the value that is written in the file, whether that
// is valid or not.
Case read_case(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});
// The same for the content of a case file of that name.
Case parse_case(std::string_view content, const std::filesystem::path& file,
                const std::vector<std::string>& overrides = {});

// The bodies of a case's file and its walls (annulus.hpp). InputError as read_bodies().
Suspension read_suspension(const Case& parameters);
// The same for the content of the bodies' file.
Suspension parse_suspension(const Case& parameters, std::string_view content);

// The smallest allowed distance between two bodies, as a length. Its unit h is the largest of the bodies, not of the walls.
double separation_length(const Case& parameters, const Suspension& bodies);

// Every key that has an effect in the case, with its value, defaults included. `threads`, `output`, `overwrite` and
// `checkpoint_every` are left out, because they do not change the bytes of the results.
Comments describe(const Case& parameters);

// The content of a case file for the same case, without `threads`, `overwrite` and `checkpoint_every`.
std::string format_case(const Case& parameters);

// Help for users: every key with its default and values, and the columns of the bodies' file.
std::string case_help();

}  // namespace stokes
