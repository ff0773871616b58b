// A case of an experiment that is a run of simulate_case(), with its files in <experiment>/<case>/.
// If it is killed or interrupted, the same command continues it from its checkpoint there.
#pragma once

#include "experiment.hpp"
#include "run.hpp"

namespace stokes {

// A case between two walls, both with the same source.
inline Case case_between(const Annulus& annulus) {
  Case c;
  c.geometry = Geometry::annulus;
  c.inner_radius = annulus.inner_radius, c.outer_radius = annulus.outer_radius;
  c.wall_points = annulus.wall_points;
  c.inner_angular_velocity = annulus.inner_surface.angular_velocity;
  c.outer_angular_velocity = annulus.outer_surface.angular_velocity;
  c.injection_rate = annulus.outer_surface.source;
  return c;
}

// Writes case.txt and bodies.csv, which `simulate` can read, too, and returns the case that they describe. It replaces a
// run of another case there, left by an earlier version of the experiment.
inline Case write_case(const std::string& name, Case c, const Suspension& bodies, const Results& results) {
  const std::filesystem::path folder = results.folder() / name, file = folder / "case.txt";
  c.bodies = "bodies.csv";
  c.output = folder.string();
  std::vector<std::string> settings = results.settings();
  settings.insert(settings.end(), {concat("threads=", thread_count()), "overwrite=yes"});
  const std::string text = format_case(c);
  Case checked = parse_case(text, file, settings);
  checked.command = results.command();
  std::filesystem::create_directories(folder);
  write_file_atomically(file, text);
  write_file_atomically(checked.bodies_path(), format_bodies(bodies));
  return checked;
}

struct RecordedBody {
  Pose pose;
  Wrench contact;  // on the body in the step from here
};

// The output of a run with output_every = 1: its states. No step starts from the last one.
class RecordedRun {
 public:
  // InputError where rows are missing.
  explicit RecordedRun(const std::filesystem::path& folder) : steps_(read_csv(folder / "steps.csv")) {
    const Table rows = read_csv(folder / "trajectory.csv");
    const auto column = [&](const char* name) { return rows.numbers(name); };
    const std::vector<double> step = column("step"), x = column("x"), y = column("y"), theta = column("theta");
    const std::vector<double> fx = column("fx"), fy = column("fy"), torque = column("torque");
    bodies_.resize(steps_.rows.size());
    for (std::size_t row = 0; row < step.size(); ++row) {
      const Wrench contact = std::isnan(fx[row]) ? Wrench{} : Wrench{{fx[row], fy[row]}, torque[row]};
      bodies_.at(static_cast<std::size_t>(step[row])).push_back({{{x[row], y[row]}, theta[row]}, contact});
    }
    for (const auto& state : bodies_)
      if (state.empty() || state.size() != bodies_[0].size())
        throw InputError(concat(rows.file, ": not every step has a row for every body"));
  }

  // True if the last state, in which a run ends or fails, has been written.
  bool has_ended() const { return !bodies_.empty() && std::isnan(states("dt").back()); }

  // The bodies in each state.
  const std::vector<std::vector<RecordedBody>>& bodies() const { return bodies_; }
  // A column of steps.csv with a value for each state.
  std::vector<double> states(const char* column) const { return steps_.numbers(column); }
  // A column with a value for the step from each state; 0 for the last state.
  std::vector<double> steps(const char* column) const {
    std::vector<double> values = steps_.numbers(column);
    values.back() = 0.0;
    return values;
  }

  // The first states at or after each of some times, as far as they exist.
  std::vector<std::size_t> states_at(const std::vector<double>& times) const {
    const std::vector<double> time = states("time");
    std::vector<std::size_t> found;
    for (const double t : times)
      if (t - 1e-9 < time.back()) found.push_back(std::upper_bound(time.begin(), time.end(), t - 1e-9) - time.begin());
    return found;
  }

  // True in the step from a state.
  bool in_contact(std::size_t state, std::size_t body) const {
    const Wrench& w = bodies_[state][body].contact;
    return w.force != 0.0 || w.torque != 0.0;
  }
  // True in the step that led to a state; for the start, in the first step.
  bool was_in_contact(std::size_t state, std::size_t body) const {
    return in_contact(state > 0 ? state - 1 : 0, body);
  }

 private:
  Table steps_;
  std::vector<std::vector<RecordedBody>> bodies_;
};

}  // namespace stokes
