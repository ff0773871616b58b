// Progress of a long run on stderr: one rewritten line on a terminal, otherwise a line every 5 %.
#pragma once

#include <chrono>
#include <string>

#include "simulation.hpp"

namespace stokes {

class Progress {
 public:
  // For a run from start_time to end_time. Every line begins with `label`.
  explicit Progress(double end_time, double start_time = 0.0, const std::string& label = {});
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  // Time, step, contacts, iterations and the estimated end, at most ten times a second.
  void show(const StepRecord& record);

  // Prints a separate line, after the progress line if there is one.
  void message(const std::string& text);

 private:
  using Clock = std::chrono::steady_clock;

  void clear_line();

  std::string label_;
  double start_time_, end_time_;
  bool terminal_, line_open_ = false;
  Clock::time_point start_, last_;
  int next_percent_ = 5;
};

}  // namespace stokes
