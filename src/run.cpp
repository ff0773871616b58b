#include "run.hpp"

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <optional>

#include "checkpoint.hpp"
#include "fields.hpp"
#include "neighbours.hpp"
#include "output_folder.hpp"
#include "progress.hpp"
#include "recorder.hpp"
#include "threads.hpp"
#include "vtk.hpp"

namespace stokes {

namespace {

constexpr double resolved_tail = 1e-3;  // share of the density's energy in its top modes

void warn_of_small_gaps(const Case& c, const Suspension& bodies, double separation, Progress& progress) {
  const ClosestPair closest = smallest_gap(bodies);
  if (c.contact != ContactModel::none && closest.gap < separation)
    progress.message(concat("warning: ", pair_name(closest.a, closest.b), " start ", closest.gap,
                            " apart, below the minimum separation ", separation, "; the first step restores it"));
}

std::atomic<int> caught_signal = 0;
std::atomic<std::time_t> caught_at = 0;

// The first signal lets the run finish its step; one more, more than a second later, ends it at once.
extern "C" void catch_signal(int signal) {
  if (caught_signal == 0) {
    caught_at = std::time(nullptr);
    caught_signal = signal;
  } else if (std::time(nullptr) > caught_at + 1) {
    std::_Exit(128 + signal);
  }
}

void catch_signals() {
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction action {};
    sigaction(signal, nullptr, &action);
    if (action.sa_handler == SIG_IGN) continue;  // as in the background, where Ctrl-C is for others
    action = {};
    action.sa_handler = catch_signal;
    action.sa_flags = SA_RESTART;
    sigaction(signal, &action, nullptr);
  }
  std::signal(SIGXFSZ, SIG_IGN);  // a file at the limit of its size is then a write error like a full disk
}

// Writes the flow of the first state at or after each of the times asked for, where its file is missing.
class FieldTimes {
 public:
  FieldTimes(const Case& c, const StepperOptions& options) : case_(c), options_(options) {}

  void write(const StepRecord& record) {
    const double slack = 1e-9 * case_.time_step;
    for (; next_ < case_.fields_at.size() && record.time >= case_.fields_at[next_] - slack; ++next_) {
      if (std::filesystem::exists(path(case_.fields_at[next_]))) continue;
      const bool back = case_.reverse_at && record.time >= *case_.reverse_at - slack;
      write_fields(path(case_.fields_at[next_]), record.bodies, options_, back ? -1.0 : 1.0,
                   record.outcome ? record.outcome->contact_wrench : std::vector<Wrench>{}, case_.field_points);
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
  Checkpoints(const CheckpointFile& file, const Recorder& recorder, double interval)
      : file_(file), recorder_(recorder), interval_(interval), last_(Clock::now()) {}

  void observe(const RunState& state, RunStage stage) {
    latest_ = &state;
    latest_stage_ = stage;
    const int signal = caught_signal;
    const bool due = interval_ > 0.0 && std::chrono::duration<double>(Clock::now() - last_).count() >= interval_;
    if (stage == RunStage::under_way && !due && signal == 0) return;
    file_.write({state, stage, recorder_.position()});
    last_ = Clock::now();
    if (stage == RunStage::under_way && signal != 0) {
      throw Interruption{signal, concat("interrupted at step ", state.clock.step, ", time ", state.clock.time,
                                        "; the same command goes on from ", file_.path().string())};
    }
  }

  // Where a run that could not write its results goes on, as the end of a message: from the latest state, up to which
  // they reached to `position`, if there is room for its checkpoint, otherwise from the checkpoint before.
  std::string save_after_write_error(const Recorder::Position& position) const {
    std::string way = "the same command goes on from there";
    try {
      if (latest_) file_.write({*latest_, latest_stage_, position});
    } catch (const std::exception&) {
      way = "there is no room for a checkpoint, so that the same command goes on from an earlier one";
    }
    if (!std::filesystem::exists(file_.path())) way = "there is no checkpoint, so that the same command starts again";
    return concat("The results are complete up to here; ", way, ".");
  }

 private:
  using Clock = std::chrono::steady_clock;

  const CheckpointFile& file_;
  const Recorder& recorder_;
  double interval_;
  Clock::time_point last_;
  const RunState* latest_ = nullptr;  // alive while the run is
  RunStage latest_stage_ = RunStage::under_way;
};

}  // namespace

SimulationOptions options_of(const Case& c, const Suspension& bodies) {
  SimulationOptions options;
  options.stepper.flow = {c.flow, c.rate};
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
  options.time_step = c.time_step;
  options.end_time = c.end_time;
  options.reverse_at = c.reverse_at;
  options.time_counting = c.time_counting;
  options.adaptive = c.adaptive;
  return options;
}

RunSummary simulate_case(const Case& c, const std::string& label) {
  const Suspension bodies = read_suspension(c);
  SimulationOptions options = options_of(c, bodies);
  if (c.threads) set_thread_count(*c.threads);

  const FolderLock lock(c.output);
  const RunRecord ran(c, bodies);
  const CheckpointFile file(c, bodies);
  std::optional<Checkpoint> start = file.read();
  if (!std::filesystem::exists(file.path())) ran.check_overwriting();  // what failed may be replaced, too
  const StepsColumns columns = bodies.container ? StepsColumns::between_walls : StepsColumns::unbounded;
  const std::string misfit = start ? Recorder::why_not_continued(c.output, columns, start->recorder) : std::string();
  if (!misfit.empty()) start.reset();
  Progress progress(c.end_time, start ? start->run.clock.time : 0.0, label);
  if (!misfit.empty())
    progress.message(concat("warning: the results do not fit their checkpoint (", misfit, "): starting from the beginning"));
  if (!start) {
    file.remove();  // before the results that it belongs to
    ran.remove_results();
  }
  ran.write();
  catch_signals();
  std::optional<VtkWriter> vtk;
  if (c.vtk) vtk.emplace(std::filesystem::path(c.output) / "vtk", c.output_every);
  Recorder recorder = start ? Recorder(c.output, c.output_every, columns, start->recorder)
                            : Recorder(c.output, c.output_every, columns);
  if (start)
    progress.message(concat("going on from step ", start->run.clock.step, ", time ", start->run.clock.time));
  else
    warn_of_small_gaps(c, bodies, options.stepper.separation, progress);

  if (start) options.start = start->run;
  Checkpoints checkpoints(file, recorder, c.checkpoint_every);
  options.observe_state = [&](const RunState& state, RunStage stage) { checkpoints.observe(state, stage); };
  bool warned = false;
  FieldTimes fields(c, options.stepper);
  const auto write = [&](const StepRecord& record) {
    const Recorder::Position before = recorder.position();
    try {
      recorder.record(record);
      fields.write(record);
      if (vtk) vtk->write(record);
    } catch (const std::exception& error) {
      throw NumericalError(concat("step ", record.step, ", time ", record.time, ": ", error.what(), " ",
                                  checkpoints.save_after_write_error(before)));
    }
  };
  const RunSummary summary = simulate(bodies, options, [&](const StepRecord& record) {
    write(record);
    progress.show(record);
    if (!warned && record.outcome && record.outcome->density_tail > resolved_tail) {
      warned = true;
      progress.message(concat("warning: at time ", record.time, " the top third of the Fourier modes holds ",
                              record.outcome->density_tail, " of a density's energy (more than ", resolved_tail,
                              "); more points_per_body would resolve it"));
    }
  });
  recorder.close();
  file.remove();
  return summary;
}

}  // namespace stokes
