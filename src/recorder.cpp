#include "recorder.hpp"

#include <unistd.h>

#include <cmath>
#include <fstream>
#include <span>

namespace stokes {

namespace {

constexpr const char *trajectory_name = "trajectory.csv", *steps_name = "steps.csv";

struct Column {
  const char *name, *meaning;
};

constexpr Column trajectory_table[] = {
    {"step", "number of the step, from 0"},
    {"time", "at its start"},
    {"body", "row of the bodies' file, from 0"},
    {"x", "centre, length"},
    {"y", "centre, length"},
    {"theta", "angle of the semi-axis a, radians, whole turns counted"},
    {"ux", "velocity during the step, length/time"},
    {"uy", "velocity during the step, length/time"},
    {"omega", "angular velocity during the step, 1/time"},
    {"fx", "sum of the contact forces on the body"},
    {"fy", "sum of the contact forces on the body"},
    {"torque", "of these forces about the centre"},
    {"stresslet_11", "of the body about its centre, the part without trace: S_11 = -S_22"},
    {"stresslet_12", "the same: S_12 = S_21"},
};
constexpr Column steps_table[] = {
    {"step", "number of the step, from 0"},
    {"time", "at its start"},
    {"dt", "length of the step, time"},
    {"gmres_iterations", "in all Stokes solves of the step, rejected attempts included"},
    {"ncp_iterations", "linear complementarity problems solved, rejected attempts included"},
    {"contacts", "pairs in contact"},
    {"min_gap", "smallest distance of two bodies at the start of the step, negative if they overlap, inf for one body"},
    {"density_tail", "largest share of a density's energy in the top third of its Fourier modes: resolved far below 1e-3"},
    {"stokes_solves", "Stokes problems solved"},
    {"smallest_multiplier", "of the contacts: a force, or with contact = stiv the factor of a volume's gradient"},
    {"largest_multiplier", "of the contacts"},
    {"estimated_error", "of the velocities, in units of the rate and size of what drives them, with an accuracy"},
    {"nodes", "of all boundaries"},
    {"clusters", "points of boundaries around which nodes are concentrated"},
    {"most_nodes", "of one boundary"},
    {"unresolved", "boundaries that miss the accuracy; with fixed nodes, pairs and bodies that these do not resolve"},
    {"local_error", "estimated error of the step with a tolerance: of positions in largest semi-axes, of angles in radians"},
    {"rejected_by_error", "attempts at the step whose error was above the tolerance"},
    {"rejected_by_failure", "attempts at the step that failed"},
};
constexpr Column unbounded_table[] = {
    {"stresslet_sum_11", "sum of the bodies' stresslets"},
    {"stresslet_sum_12", "sum of the bodies' stresslets"},
    {"contact_sum_11", "sum of F d over contacts, symmetric without trace: F on one body, d from its centre to the other"},
    {"contact_sum_12", "the same: 12"},
    {"bulk_stress_11", "stress without trace: twice the flow's rate of strain, and the sums above over sample_area"},
    {"bulk_stress_12", "the same: 12"},
    {"effective_viscosity", "bulk stress along the rate of strain over twice the rate of strain; with sample_area"},
};
constexpr Column disc_table[] = {
    {"outer_torque", "of the wall on the fluid about its centre"},
};
constexpr Column walls_table[] = {
    {"inner_torque", "of the inner wall on the fluid about its centre"},
    {"outer_torque", "of the outer wall on the fluid about its centre"},
    {"order_parameter", "mean of cos 2 (theta - phi - pi/2), phi the polar angle of the centre: 1 along circles, -1 across"},
    {"effective_viscosity", "torque of the inner wall over that without bodies"},
    {"stresslet_shear", "the bodies' stresslets per area between the walls: stress r theta"},
    {"stresslet_normal_difference", "the same: stress theta theta less stress r r"},
    {"contact_shear", "the contact forces' part of the stress r theta"},
    {"contact_normal_difference", "the same: stress theta theta less stress r r"},
};

std::vector<std::string> names_of(std::span<const Column> columns) {
  std::vector<std::string> names;
  for (const Column& column : columns) names.push_back(column.name);
  return names;
}

const std::vector<std::string> trajectory_columns = names_of(trajectory_table);

std::span<const Column> columns_of(StepsColumns columns) {
  switch (columns) {
    case StepsColumns::unbounded: return unbounded_table;
    case StepsColumns::in_disc: return disc_table;
    case StepsColumns::between_walls: return walls_table;
  }
  return {};
}

std::vector<std::string> steps_columns(StepsColumns columns) {
  std::vector<std::string> names = names_of(steps_table);
  for (const Column& column : columns_of(columns)) names.push_back(column.name);
  return names;
}

std::string help_of(std::span<const Column> columns) {
  std::string text;
  for (const Column& column : columns) text += concat("  ", padded(column.name, 29), column.meaning, "\n");
  return text;
}

// Says why a table with these columns cannot be cut to so many bytes and continued; empty if it can.
std::string why_not_continued(const std::filesystem::path& file, const std::vector<std::string>& columns,
                              std::uintmax_t bytes) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) return concat(file.string(), ": ", error.message());
  if (size < bytes) return concat(file.string(), " has ", size, " bytes, but the checkpoint belongs to ", bytes);
  std::ifstream table(file, std::ios::binary);
  std::string header;
  std::getline(table, header);
  if (header != join(columns, ",")) return concat(file.string(), " has other columns");
  table.seekg(static_cast<std::streamoff>(bytes) - 1);
  if (table.get() != '\n') return concat(file.string(), " has no row that ends where the checkpoint was made");
  return {};
}

// Contacts are pairs: two regions of one pair count once.
double contact_count(const StepOutcome& step) {
  long count = 0;
  for (std::size_t k = 0; k < step.contacts.size(); ++k) {
    const ContactConstraint &c = step.contacts[k].constraint, &p = step.contacts[k ? k - 1 : 0].constraint;
    count += k == 0 || c.a != p.a || c.b != p.b;
  }
  return static_cast<double>(count);
}

}  // namespace

std::string why_not_writable(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  const auto because = [](const fs::path& place, std::string_view why) { return concat(quote(place.string()), " ", why); };
  std::error_code error;
  fs::path existing = fs::absolute(folder, error);
  if (error) return because(folder, error.message());
  fs::file_status status;
  while ((status = fs::symlink_status(existing, error)).type() == fs::file_type::not_found && existing.has_relative_path())
    existing = existing.parent_path();
  if (status.type() == fs::file_type::none) return because(existing, concat("cannot be used: ", error.message()));
  if (!fs::is_directory(existing, error)) return because(existing, "is not a folder");
  if (access(existing.c_str(), W_OK | X_OK) != 0) return because(existing, "is not writable");
  for (const char* name : {trajectory_name, steps_name, "checkpoint", "run.txt", "case.txt", "bodies.csv"}) {
    const fs::path file = folder / name;
    const fs::file_type type = fs::status(file, error).type();
    if (type == fs::file_type::not_found) continue;
    if (type == fs::file_type::none) return because(file, concat("cannot be used: ", error.message()));
    if (type != fs::file_type::regular) return because(file, "is in the way of a file to be written");
    if (access(file.c_str(), W_OK) != 0) return because(file, "is not writable");
  }
  return {};
}

const std::filesystem::path& made_folder(const std::filesystem::path& folder) {
  std::string why = why_not_writable(folder);
  std::error_code error;
  if (why.empty()) std::filesystem::create_directories(folder, error);
  if (error) why = error.message();
  if (!why.empty()) throw InputError(concat("the output folder ", quote(folder.string()), " cannot be used: ", why));
  return folder;
}

Recorder::Recorder(const std::filesystem::path& folder, int output_every, StepsColumns columns, const Sample& sample)
    : output_every_(output_every),
      columns_(columns),
      sample_(sample),
      trajectory_(made_folder(folder) / trajectory_name, trajectory_columns),
      steps_(folder / steps_name, steps_columns(columns)) {
  trajectory_.flush();
  steps_.flush();
  position_ = {trajectory_.bytes(), steps_.bytes(), {}};
}

Recorder::Recorder(const std::filesystem::path& folder, int output_every, StepsColumns columns, const Sample& sample,
                   const Position& position)
    : output_every_(output_every),
      columns_(columns),
      sample_(sample),
      trajectory_(CsvWriter::continued(folder / trajectory_name, trajectory_columns.size(),
                                       position.trajectory_bytes)),
      steps_(CsvWriter::continued(folder / steps_name, steps_columns(columns).size(), position.steps_bytes)),
      skipped_(position.skipped),
      position_(position) {}

std::string Recorder::why_not_continued(const std::filesystem::path& folder, StepsColumns columns,
                                        const Position& position) {
  std::string why = stokes::why_not_continued(folder / trajectory_name, trajectory_columns, position.trajectory_bytes);
  if (why.empty()) why = stokes::why_not_continued(folder / steps_name, steps_columns(columns), position.steps_bytes);
  return why;
}

void Recorder::record(const StepRecord& record) {
  try {
    write(record);
  } catch (const NumericalError&) {
    trajectory_.close_after(position_.trajectory_bytes);
    steps_.close_after(position_.steps_bytes);
    throw;
  }
  position_ = {trajectory_.bytes(), steps_.bytes(), skipped_};
}

void Recorder::write(const StepRecord& record) {
  const double nan = std::nan("");
  const StepOutcome* outcome = record.outcome;
  Row summary = {static_cast<double>(record.step), record.time};
  if (outcome) {
    double smallest = nan, largest = nan;
    for (const ActiveContact& c : outcome->contacts)
      smallest = std::fmin(smallest, c.multiplier), largest = std::fmax(largest, c.multiplier);
    for (double value : {outcome->dt, static_cast<double>(outcome->gmres_iterations),
                         static_cast<double>(outcome->ncp_iterations), contact_count(*outcome), record.min_gap,
                         outcome->density_tail, static_cast<double>(outcome->stokes_solves), smallest, largest,
                         outcome->estimated_error, static_cast<double>(outcome->nodes),
                         static_cast<double>(outcome->clusters), static_cast<double>(outcome->most_nodes),
                         static_cast<double>(outcome->unresolved), outcome->error.value_or(nan),
                         static_cast<double>(outcome->rejected_by_error), static_cast<double>(outcome->rejected_by_failure)})
      summary.push_back(value);
    append_geometry(record, summary);
  } else {
    summary.resize(steps_columns(columns_).size(), nan);
    summary[6] = record.min_gap;
  }
  steps_.row(summary);
  write_bodies(record);
  trajectory_.flush();
  steps_.flush();
}

// The columns of one geometry.
void Recorder::append_geometry(const StepRecord& record, Row& row) const {
  const StepOutcome& step = *record.outcome;
  const auto append = [&row](std::initializer_list<double> values) { row.insert(row.end(), values); };
  switch (columns_) {
    case StepsColumns::unbounded: {
      const StressSum sum = stress_sum(record.bodies, step);
      append({sum.stresslets.real(), sum.stresslets.imag(), sum.contacts.real(), sum.contacts.imag()});
      const double nan = std::nan("");
      if (sample_.area == 0.0) return append({nan, nan, nan});
      const Complex stress = sample_.stress(sum, step.driving);
      return append({stress.real(), stress.imag(), sample_.viscosity(sum, step.driving)});
    }
    case StepsColumns::in_disc: return append({step.container.torque});
    case StepsColumns::between_walls: {
      const ParticleStress stress = particle_stress(record.bodies, step);
      return append({step.reaction.back().torque, step.container.torque, order_parameter(record.bodies),
                     effective_viscosity(record.bodies, step), stress.stresslets.shear, stress.stresslets.normal_difference,
                     stress.contacts.shear, stress.contacts.normal_difference});
    }
  }
}

// The rows of a step that is not written are kept until it is known whether it is the last.
void Recorder::write_bodies(const StepRecord& record) {
  const StepOutcome* outcome = record.outcome;
  std::vector<Row> rows;
  for (std::size_t i = 0; i < record.bodies.size(); ++i) {
    if (record.bodies[i].points > 0) continue;  // a wall
    const Pose& pose = record.bodies[i].pose;
    Row row = {static_cast<double>(record.step), record.time, static_cast<double>(i), pose.centre.real(), pose.centre.imag(),
               pose.angle};
    if (outcome) {
      const RigidVelocity& u = outcome->velocity[i];
      const Wrench& f = outcome->contact_wrench[i];
      const Complex s = outcome->stresslets[i];
      row.insert(row.end(), {u.velocity.real(), u.velocity.imag(), u.omega, f.force.real(), f.force.imag(), f.torque,
                             s.real(), s.imag()});
    } else {
      row.resize(trajectory_columns.size(), std::nan(""));
    }
    rows.push_back(std::move(row));
  }
  if (outcome && record.step % output_every_ != 0) {
    skipped_ = std::move(rows);
    return;
  }
  if (!outcome)
    for (const Row& row : skipped_) trajectory_.row(row);
  skipped_.clear();
  for (const Row& row : rows) trajectory_.row(row);
}

void Recorder::sync() {
  trajectory_.sync();
  steps_.sync();
}

void Recorder::close() {
  trajectory_.close();
  steps_.close();
}

std::string columns_help() {
  return concat("trajectory.csv has a row for every body and every output_every-th step, the first and the last, and\n"
                "for the final configuration. Walls have none.\n\n",
                help_of(trajectory_table),
                "\nsteps.csv has a row for every step and one for the final configuration.\n\n", help_of(steps_table),
                "\nin unbounded fluid also\n\n", help_of(unbounded_table), "\nin a disc\n\n", help_of(disc_table),
                "\nand in an annulus\n\n", help_of(walls_table),
                "\nA field is empty where there is nothing to tell: of the step from the final configuration, which is not\n"
                "made, of multipliers without contacts, of bulk stress and viscosity without sample_area. Units are those\n"
                "of the case, with viscosity 1.\n");
}

}  // namespace stokes
