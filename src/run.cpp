#include "run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "annulus.hpp"
#include "checkpoint.hpp"
#include "fields.hpp"
#include "neighbours.hpp"
#include "output_folder.hpp"
#include "progress.hpp"
#include "recorder.hpp"
#include "rheology.hpp"
#include "threads.hpp"
#include "version.hpp"
#include "vtk.hpp"

namespace stokes {

namespace {

constexpr double resolved_tail = 1e-3;  // share of the density's energy in its top modes

void warn_of_small_gaps(const Case& c, const Suspension& bodies, double separation, Progress& progress) {
  const ClosestPair closest = smallest_gap(bodies);
  if (c.contact != ContactModel::none && closest.gap < separation)
    progress.message(concat("warning: ", pair_name(closest.a, closest.b), " start ", brief(closest.gap),
                            " apart, below the minimum separation ", separation, "; the first step restores it"));
}

StepsColumns columns_of(const Suspension& bodies) {
  if (!bodies.container) return StepsColumns::unbounded;
  return inner_wall_of(bodies) ? StepsColumns::between_walls : StepsColumns::in_disc;
}

Sample sample_of(const Case& c) { return {c.sample_area.value_or(0.0), strain_rate(c.background().flow(0.0))}; }

// The largest rate of strain or rotation of the flow without bodies, at the initial positions of the bodies.
double largest_rate(const Case& c, const Suspension& bodies) {
  if (!bodies.container) {
    double height = 0.0;  // in Poiseuille flow the rate grows with it
    for (const Body& body : bodies) height = std::max(height, std::abs(body.pose.centre.imag()) + body.shape.circumradius());
    switch (c.flow) {
      case FlowKind::none: return 0.0;
      case FlowKind::linear: return std::abs(c.rate) * c.background().gradient.largest();
      case FlowKind::poiseuille: return 2.0 * std::abs(c.rate) * height;
      default: return std::abs(c.rate);
    }
  }
  if (!inner_wall_of(bodies)) return std::abs(bodies.container->surface.angular_velocity);
  const CouetteFlow flow = couette_flow(bodies);
  return std::abs(flow.shear_rate(flow.inner_radius));
}

// Warns of values that are possible but probably not intended.
void warn_of_values(const Case& c, const Suspension& bodies, Progress& progress) {
  for (const std::string& warning : c.warnings) progress.message(concat("warning: ", warning));
  constexpr double large_step = 0.5;
  if (const double strain = largest_rate(c, bodies) * c.time_step; !c.adaptive && strain > large_step)
    progress.message(concat("warning: in a step of ", c.time_step, " the flow deforms by ", brief(strain),
                            " (more than ", large_step, "), too much for forward Euler steps; try time_step = ",
                            brief(0.1 * c.time_step / strain)));
  const auto turned = [](const Body& body) { return std::abs(body.pose.angle) > 2.0 * pi; };
  if (const auto first = std::find_if(bodies.begin(), bodies.end(), turned); first != bodies.end())
    progress.message(concat("warning: theta = ", first->pose.angle, " of body ", first - bodies.begin(),
                            " is more than a turn; angles are in radians, a right angle is ", brief(0.5 * pi)));
}

// Writes the flow of the first state at or after each of the times asked for, where its file is missing.
class FieldTimes {
 public:
  FieldTimes(const Case& c, const StepperOptions& options) : case_(c), options_(options) {}

  void write(const StepRecord& record) {
    const double slack = 1e-9 * case_.time_step;
    for (; next_ < case_.fields_at.size() && record.time >= case_.fields_at[next_] - slack; ++next_) {
      if (std::filesystem::exists(path(case_.fields_at[next_]))) continue;
      write_fields(path(case_.fields_at[next_]), record, options_, case_.field_points);
    }
  }

 private:
  std::filesystem::path path(double time) const {
    return std::filesystem::path(case_.output) / concat("fields_", time, ".csv");
  }

  const Case& case_;
  const StepperOptions& options_;
  std::size_t next_ = 0;
};

// Writes checkpoints at intervals of wall time, and where the run ends early.
class Checkpoints {
 public:
  Checkpoints(const CheckpointFile& file, Recorder& recorder, double interval, Progress& progress)
      : file_(file), recorder_(recorder), progress_(progress), interval_(interval), last_(Clock::now()),
        position_(recorder.position()) {}

  void observe(const RunState& state, RunStage stage) {
    latest_ = &state;
    latest_stage_ = stage;
    // The rows of a step that was abandoned while its fields were written do not belong to the state before it.
    if (stage != RunStage::interrupted) position_ = recorder_.position();
    if (stage == RunStage::under_way) {
      const bool due = interval_ > 0.0 && std::chrono::duration<double>(Clock::now() - last_).count() >= interval_;
      if (due) write();
      end_if_interrupted();
    } else {
      write();
    }
    if (stage == RunStage::interrupted)
      interruption_ = concat("interrupted at step ", state.step(), ", time ", state.time(), "; ", way_on());
  }

  const std::string& interruption() const { return interruption_; }

  // Says, as the end of a message, from where a run that could not write its results continues: from the latest state, if
  // there is room for its checkpoint, otherwise from the checkpoint before.
  std::string save_after_write_error() {
    if (latest_) write();
    return concat("The results are complete up to here; ", way_on(), ".");
  }

 private:
  using Clock = std::chrono::steady_clock;

  void write() {
    why_not_written_.clear();
    try {
      recorder_.sync();  // before the checkpoint that belongs to these rows
      file_.write({latest_->save(), latest_stage_, position_});
    } catch (const std::exception& error) {
      why_not_written_ = error.what();
      progress_.message(concat("warning: there is no checkpoint of step ", latest_->step(), ": ", error.what()));
    }
    last_ = Clock::now();
  }

  std::string way_on() const {
    if (!std::filesystem::exists(file_.path())) return "there is no checkpoint, so that the same command starts again";
    return concat("the same command goes on from ", why_not_written_.empty() ? "" : "an earlier step, ",
                  file_.path().string());
  }

  const CheckpointFile& file_;
  Recorder& recorder_;
  Progress& progress_;
  double interval_;
  Clock::time_point last_;
  const RunState* latest_ = nullptr;  // alive while the run is
  RunStage latest_stage_ = RunStage::under_way;
  Recorder::Position position_;  // where the results of the latest state end
  std::string why_not_written_, interruption_;
};

// The checkpoint from which a run continues, or none for a run that begins anew, with warnings.
struct Beginning {
  std::optional<Checkpoint> checkpoint;
  std::vector<std::string> warnings;
};

// Prepares the folder for either: keeps or removes the results in it, and records the run.
Beginning beginning(const Case& c, const Suspension& bodies, const CheckpointFile& file, StepsColumns columns) {
  const RunRecord record(c, bodies);
  Beginning result{file.read(), {}};
  std::optional<Checkpoint>& start = result.checkpoint;
  if (!std::filesystem::exists(file.path())) record.check_overwriting();  // results of a failed run may be replaced, too
  if (start && start->build != build_description())
    result.warnings.push_back(concat("the checkpoint is of another build of the program (", start->build, "; this is ",
                                     build_description(), "): from here on the last digits may be others"));
  const std::string misfit = start ? Recorder::why_not_continued(c.output, columns, start->recorder) : std::string();
  if (!misfit.empty()) {
    start.reset();
    result.warnings = {concat("the results do not fit their checkpoint (", misfit, "): starting from the beginning")};
  }
  if (!start) {
    file.remove();  // before the results that it belongs to
    record.remove_results();
  }
  record.write();
  return result;
}

// Warns of what the nodes do not resolve: the first time, and at the end.
class ResolutionWarnings {
 public:
  ResolutionWarnings(bool by_accuracy, Progress& progress) : by_accuracy_(by_accuracy), progress_(progress) {}

  void observe(const StepRecord& record) {
    if (!record.outcome) return;
    const StepOutcome& step = *record.outcome;
    const auto warn = [&](const auto&... parts) {
      progress_.message(concat("warning: at time ", record.time, " ", parts...));
    };
    if (step.unresolved > 0 && unresolved_steps_++ == 0 && by_accuracy_)
      warn(step.unresolved, " boundaries do not keep the accuracy; the estimated error is ", brief(step.estimated_error));
    if (!step.shortfalls.empty()) {
      const Shortfall& largest = step.shortfalls[0];
      if (!worst_) warn(describe(largest));
      if (!worst_ || largest.error > worst_->error) worst_ = largest;
    }
    if (!warned_of_tail_ && step.density_tail > resolved_tail) {
      warned_of_tail_ = true;
      warn("the top third of the Fourier modes holds ", brief(step.density_tail), " of a density's energy (more than ",
           resolved_tail, "); more points_per_body would resolve it");
    }
  }

  void conclude() const {
    if (unresolved_steps_ == 0) return;
    progress_.message(concat("warning: ", unresolved_steps_, " steps were not resolved",
                             worst_ ? concat("; in the worst of them ", describe(*worst_)) : std::string()));
  }

 private:
  bool by_accuracy_;
  Progress& progress_;
  bool warned_of_tail_ = false;
  long unresolved_steps_ = 0;
  std::optional<Shortfall> worst_;
};

// As a fraction of the separation. With 1e-4 the error of contacts would limit the accuracy of orders above the first.
double contact_tolerance_for(const Case& c, const Suspension& bodies, double separation) {
  if (c.integrator == IntegratorKind::euler) return contact_tolerance;
  constexpr double of_higher_order = 1e-6, of_tolerance = 0.1, least_length = 1e-11;  // the last in semi-axes
  double smallest = bodies.front().shape.inradius();
  for (const Body& body : bodies) smallest = std::min(smallest, body.shape.inradius());
  if (separation < 1e-6 * smallest) return contact_tolerance;
  const double wanted = std::min(of_higher_order, c.tolerance ? of_tolerance * *c.tolerance * smallest / separation : 1.0);
  return std::max(wanted, least_length * smallest / separation);
}

}  // namespace

SimulationOptions options_of(const Case& c, const Suspension& bodies) {
  SimulationOptions options;
  options.stepper.flow = c.background();
  options.stepper.accuracy = c.accuracy.value_or(0.0);
  options.stepper.points_per_body = c.points_per_body;
  options.stepper.refine = c.refine;
  options.stepper.stokes.gmres_tolerance = c.gmres_tolerance;
  options.stepper.stokes.summation = c.summation;
  options.stepper.near_singular = c.near_singular;
  options.stepper.contact = c.contact;
  options.stepper.separation = separation_length(c, bodies);
  options.stepper.coupling = c.coupling;
  options.stepper.lcp_matrix = c.lcp_matrix;
  options.stepper.stiv_vertices = c.stiv_vertices;
  options.stepper.stiv_gradient = c.stiv_gradient;
  options.start_time = c.start_time;
  options.time_step = c.time_step;
  options.end_time = c.end_time;
  options.reverse_at = c.reverse_at;
  options.time_counting = c.time_counting;
  options.adaptive = c.adaptive;
  options.tolerance = options.stepper.tolerance = c.tolerance.value_or(0.0);
  options.stepper.integrator = c.integrator;
  options.stepper.contact_tolerance = contact_tolerance_for(c, bodies, options.stepper.separation);
  return options;
}

RunSummary simulate_case(const Case& c, const std::string& label) {
  const Suspension bodies = read_suspension(c);
  SimulationOptions options = options_of(c, bodies);
  if (c.threads) set_thread_count(*c.threads);
  const SignalGuard signals;

  const FolderLock lock(c.output);
  const CheckpointFile file(c, bodies);
  const StepsColumns columns = columns_of(bodies);
  const auto [start, warnings] = beginning(c, bodies, file, columns);
  Progress progress(c.end_time, start ? start->run.time : c.start_time, label);
  for (const std::string& warning : warnings) progress.message(concat("warning: ", warning));
  std::optional<VtkWriter> vtk;
  if (c.vtk) vtk.emplace(std::filesystem::path(c.output) / "vtk", c.output_every);
  Recorder recorder = start ? Recorder(c.output, c.output_every, columns, sample_of(c), start->recorder)
                            : Recorder(c.output, c.output_every, columns, sample_of(c));
  if (start) {
    options.start = start->run;
    progress.message(concat("going on from step ", start->run.step, ", time ", start->run.time));
  } else {
    warn_of_values(c, bodies, progress);
    warn_of_small_gaps(c, bodies, options.stepper.separation, progress);
  }

  Checkpoints checkpoints(file, recorder, c.checkpoint_every, progress);
  options.observe_state = [&](const RunState& state, RunStage stage) { checkpoints.observe(state, stage); };
  FieldTimes fields(c, options.stepper);
  const auto write = [&](const StepRecord& record) {
    try {
      recorder.record(record);
      fields.write(record);
      if (vtk) vtk->write(record);
    } catch (const std::exception& error) {
      throw NumericalError(concat("step ", record.step, ", time ", record.time, ": ", error.what(), " ",
                                  checkpoints.save_after_write_error()));
    }
  };
  ResolutionWarnings resolution(c.accuracy.has_value(), progress);
  RunSummary summary;
  try {
    summary = simulate(bodies, options, [&](const StepRecord& record) {
      write(record);
      progress.show(record);
      resolution.observe(record);
    });
  } catch (const Interruption& end) {
    throw Interruption{end.signal, checkpoints.interruption()};
  }
  if (vtk) vtk->write_series();
  recorder.close();
  file.remove();
  resolution.conclude();
  return summary;
}

}  // namespace stokes
