#include "progress.hpp"

#include <unistd.h>

#include <cstdio>

namespace stokes {

Progress::Progress(double end_time, double start_time, const std::string& label)
    : label_(label.empty() ? label : label + ": "),
      start_time_(start_time),
      end_time_(end_time),
      terminal_(isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      last_(start_) {
  while (100.0 * start_time_ >= end_time_ * next_percent_) next_percent_ += 5;
}

Progress::~Progress() { clear_line(); }

void Progress::clear_line() {
  if (line_open_) std::fprintf(stderr, "\r\033[K");
  line_open_ = false;
}

void Progress::message(const std::string& text) {
  clear_line();
  std::fprintf(stderr, "%s%s\n", label_.c_str(), text.c_str());
}

void Progress::show(const StepRecord& record) {
  if (!record.outcome) return clear_line();
  const double done = end_time_ > 0.0 ? record.time / end_time_ : 1.0;
  const Clock::time_point now = Clock::now();
  if (terminal_ ? now - last_ < std::chrono::milliseconds(100) : 100.0 * done < next_percent_) return;
  last_ = now;
  while (100.0 * done >= next_percent_) next_percent_ += 5;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double way = record.time - start_time_;
  const double left = way > 0.0 ? elapsed * (end_time_ - record.time) / way : 0.0;
  clear_line();
  std::fprintf(stderr, "%s%3.0f %%  time %.6g of %.6g  step %ld  contacts %zu  iterations %d gmres, %d ncp  %.0f s left%s",
               label_.c_str(), 100.0 * done, record.time, end_time_, record.step, record.outcome->contacts.size(),
               record.outcome->gmres_iterations, record.outcome->ncp_iterations, left, terminal_ ? "" : "\n");
  line_open_ = terminal_;
}

}  // namespace stokes
