// Runs simulate in the background for as long as a test needs it.
#pragma once

#include <atomic>
#include <chrono>
#include <csignal>
#include <functional>
#include <thread>

#include "program.hpp"

namespace stokes {

// Runs simulate in a workspace and sends it a signal once it writes its tables and `ready` holds. A run that ends by
// itself, or is not ready for minutes, gets none.
class RunningProgram {
 public:
  RunningProgram(const Workspace& here, std::vector<std::string> arguments, const std::filesystem::path& output = "out")
      : folder_(here.path() / output), thread_([this, &here, arguments] {
          run_ = here.run_until(300.0, "KILL", arguments);
          ended_ = true;
        }) {}
  ~RunningProgram() {
    if (thread_.joinable()) thread_.join();
  }

  // Waits for the process to have its tables and for `ready`; its number, or 0 if it has ended.
  int wait_until(const std::function<bool()>& ready) {
    while (!ended_) {
      const std::string owner = content_of(folder_ / "lock");
      if (owner.ends_with('\n') && std::filesystem::exists(folder_ / "steps.csv") && ready())
        return std::stoi(owner.substr(std::string("process ").size()));
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return 0;
  }
  int wait() {
    return wait_until([] { return true; });
  }

  // Sends a signal and returns how the program ends.
  ProgramRun end_by(int signal, const std::function<bool()>& ready) {
    if (const int process = wait_until(ready)) kill(process, signal);
    thread_.join();
    return run_;
  }

 private:
  std::filesystem::path folder_;
  ProgramRun run_{};
  std::atomic<bool> ended_ = false;
  std::thread thread_;
};

// Ends a run by a signal after its first steps.
inline ProgramRun stopped(const Workspace& here, int signal, const std::vector<std::string>& arguments) {
  RunningProgram running(here, arguments);
  const std::filesystem::path steps = here.path() / "out/steps.csv";
  std::string first;
  return running.end_by(signal, [&] {  // a run that goes on has more rows than at first
    const std::string now = content_of(steps);
    if (first.empty()) first = now;
    return std::count(now.begin(), now.end(), '\n') > 5 && now.size() != first.size();
  });
}

}  // namespace stokes
