// Signals that ask the program to end, and how long computations notice them.
#pragma once

#include <atomic>
#include <csignal>
#include <iterator>
#include <string>

namespace stokes {

// A signal ended a run.
struct Interruption {
  int signal;
  std::string message{};
};

namespace detail {
inline std::atomic<int> caught_signal = 0;  // global, because a signal handler can reach nothing else
}

// Throws an Interruption if a signal was caught. Long loops call it where they can be left. The work under way is
// abandoned.
inline void end_if_interrupted() {
  if (const int signal = detail::caught_signal) throw Interruption{signal};
}

// While it lives, catches SIGINT, SIGTERM, SIGHUP (closed terminal) and SIGPIPE (output that nobody reads), except those
// that were ignored before. A second signal, more than a second later, ends the program at once. SIGXFSZ is ignored: a
// file that reaches its size limit is then a write error, like a full disk.
class SignalGuard {
 public:
  SignalGuard();
  SignalGuard(const SignalGuard&) = delete;
  SignalGuard& operator=(const SignalGuard&) = delete;
  ~SignalGuard();  // restores the former handlers

 private:
  static constexpr int signals_[] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ};
  struct sigaction before_[std::size(signals_)];
};

}  // namespace stokes
