#include "recorder.hpp"

#include <cmath>

namespace stokes {

namespace {

const std::filesystem::path& existing_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder))
    throw InputError(concat("the output folder ", quote(folder.string()), " cannot be made",
                            error ? concat(" (", error.message(), ")") : std::string(), "; choose another one: output = FOLDER"));
  return folder;
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

Recorder::Recorder(const std::filesystem::path& folder, int output_every)
    : output_every_(output_every),
      trajectory_(existing_folder(folder) / "trajectory.csv",
                  {"step", "time", "body", "x", "y", "theta", "ux", "uy", "omega", "fx", "fy", "torque"}),
      steps_(folder / "steps.csv",
             {"step", "time", "dt", "gmres_iterations", "ncp_iterations", "contacts", "min_gap", "density_tail"}) {}

void Recorder::record(const StepRecord& record) {
  const double nan = std::nan(""), step = static_cast<double>(record.step);
  const StepOutcome* outcome = record.outcome;
  std::vector<Row> rows;
  for (std::size_t i = 0; i < record.bodies.size(); ++i) {
    const Pose& pose = record.bodies[i].pose;
    Row row = {step, record.time, static_cast<double>(i), pose.centre.real(), pose.centre.imag(), pose.angle};
    if (outcome) {
      const RigidVelocity& u = outcome->velocity[i];
      const Wrench& f = outcome->contact_wrench[i];
      for (double value : {u.velocity.real(), u.velocity.imag(), u.omega, f.force.real(), f.force.imag(), f.torque})
        row.push_back(value);
    } else {
      row.resize(12, nan);
    }
    rows.push_back(std::move(row));
  }
  if (outcome)
    steps_.row(std::vector<double>{step, record.time, outcome->dt, static_cast<double>(outcome->gmres_iterations),
                                   static_cast<double>(outcome->ncp_iterations), contact_count(*outcome), record.min_gap,
                                   outcome->density_tail});
  else
    steps_.row(std::vector<double>{step, record.time, nan, nan, nan, nan, record.min_gap, nan});

  if (outcome && record.step % output_every_ != 0) {
    skipped_ = std::move(rows);
  } else {
    if (!outcome)
      for (const Row& row : skipped_) trajectory_.row(row);
    skipped_.clear();
    for (const Row& row : rows) trajectory_.row(row);
  }
  trajectory_.flush();
  steps_.flush();
}

}  // namespace stokes
