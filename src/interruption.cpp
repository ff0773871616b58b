#include "interruption.hpp"

#include <cstdlib>
#include <ctime>

namespace stokes {

namespace {

std::atomic<std::time_t> caught_at = 0;

extern "C" void catch_signal(int signal) {
  if (detail::caught_signal == 0) {
    caught_at = std::time(nullptr);
    detail::caught_signal = signal;
  } else if (signal != SIGPIPE && std::time(nullptr) > caught_at + 1) {  // SIGPIPE comes again with each line
    std::_Exit(128 + signal);
  }
}

}  // namespace

SignalGuard::SignalGuard() {
  detail::caught_signal = 0;
  for (std::size_t k = 0; k < std::size(signals_); ++k) {
    const int signal = signals_[k];
    sigaction(signal, nullptr, &before_[k]);
    if (before_[k].sa_handler == SIG_IGN) continue;  // as in the background, where Ctrl-C is not for this process
    struct sigaction action {};
    action.sa_handler = signal == SIGXFSZ ? SIG_IGN : catch_signal;
    action.sa_flags = SA_RESTART;
    sigaction(signal, &action, nullptr);
  }
}

SignalGuard::~SignalGuard() {
  for (std::size_t k = 0; k < std::size(signals_); ++k) sigaction(signals_[k], &before_[k], nullptr);
  detail::caught_signal = 0;
}

}  // namespace stokes
