// Signals that ask the program to end, and the work that ends early for them.
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
inline std::atomic<int> caught_signal = 0;  // a handler reaches nothing but what is global
}

// Throws an Interruption if a signal was caught. Called by loops that may be long, at a place where they can be left:
// whatever is under way is given up.
inline void end_if_interrupted() {
  if (const int signal = detail::caught_signal) throw Interruption{signal};
}

// Catches SIGINT, SIGTERM, SIGHUP (a terminal that is closed) and SIGPIPE (an output that nobody reads) while it lives,
// unless they were ignored before; a second one, more than a second later, ends the program at once. SIGXFSZ is ignored:
// a file at the limit of its size is a write error like a full disk.
class SignalGuard {
 public:
  SignalGuard();
  SignalGuard(const SignalGuard&) = delete;
  SignalGuard& operator=(const SignalGuard&) = delete;
  ~SignalGuard();  // everything is as it was before

 private:
  static constexpr int signals_[] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ};
  struct sigaction before_[std::size(signals_)];
};

}  // namespace stokes
