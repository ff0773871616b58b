// simulate CASE.txt [key=value ...]: runs a suspension described by a case file (case.hpp).
// Exit status: 0 done; 2 bad input, nothing written; 3 numerical failure, everything up to it written; 128 + N ended by
// signal N (129 SIGHUP, 130 SIGINT, 141 SIGPIPE, 143 SIGTERM). An unfinished run leaves a checkpoint, from which the
// same command continues.

#include <cstdio>
#include <new>
#include <string>
#include <vector>

#include "output_folder.hpp"
#include "recorder.hpp"
#include "run.hpp"

namespace {

using namespace stokes;

int run(const std::vector<std::string>& arguments, const std::string& command) {
  Case c = read_case(arguments[0], {arguments.begin() + 1, arguments.end()});
  c.command = command;
  const RunSummary summary = simulate_case(c);
  std::printf("%ld steps, %ld rejected\n", summary.steps, summary.rejected);
  std::printf("preconditioner factorisations: %d (distinct shapes: %d)\n", summary.factorisations, summary.shapes);
  std::printf("results in %s\n", c.output.c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments == std::vector<std::string>{"--help", "columns"}) {
    std::printf("%s", columns_help().c_str());
    return 0;
  }
  if (arguments.empty() || arguments[0] == "--help" || arguments[0] == "-h") {
    std::fprintf(arguments.empty() ? stderr : stdout,
                 "usage: simulate CASE.txt [key=value ...]\n       simulate --help columns   of the results\n\n%s",
                 case_help().c_str());
    return arguments.empty() ? 2 : 0;
  }
  try {
    return run(arguments, command_line({argv, argv + argc}));
  } catch (const Interruption& end) {
    std::fprintf(stderr, "simulate: %s\n", end.message.c_str());
    return 128 + end.signal;
  } catch (const InputError& error) {
    std::fprintf(stderr, "simulate: %s\n", error.what());
    return 2;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "simulate: there is not enough memory; try fewer points_per_body or wall_points\n");
    return 3;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "simulate: %s\n", error.what());
    return 3;
  }
}
