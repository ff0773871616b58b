// fuzz_input [count=N] [seed=S]: mutated case and bodies files (input_fuzzer.hpp). Exit status 1, with the file on
// stderr, if one is not read as it should be. A crash or a hang ends the program; the number of the batch is then known.

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "input_fuzzer.hpp"
#include "text.hpp"

namespace {

constexpr const char* usage = "usage: fuzz_input [count=N] [seed=S]\n";
constexpr long batch = 1000;
constexpr unsigned batch_seconds = 120;  // then the system ends the program

int run(long count, long seed) {
  stokes::FuzzReport total;
  for (long first = 0; first < count; first += batch) {
    if (first % 100000 == 0) std::fprintf(stderr, "seed %ld, from mutation %ld\n", seed, first);
    alarm(batch_seconds);
    const long size = std::min(batch, count - first);
    const stokes::FuzzReport part = stokes::fuzz_input(first, size, static_cast<std::uint64_t>(seed));
    total.mutations += part.mutations;
    total.accepted_cases += part.accepted_cases;
    total.accepted_suspensions += part.accepted_suspensions;
    total.slowest = std::max(total.slowest, part.slowest);
    if (part.failure.empty()) continue;
    std::fprintf(stderr, "fuzz_input: seed %ld, %s\n", seed, part.failure.c_str());
    return 1;
  }
  std::printf("%ld mutations, %ld cases and %ld suspensions accepted, slowest reading %.3f s\n", total.mutations,
              total.accepted_cases, total.accepted_suspensions, total.slowest);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  long count = 100000, seed = 1;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const auto value = stokes::parse_integer(argument.substr(argument.find('=') + 1));
    if (argument == "--help" || argument == "-h") {
      std::printf("%s\nReads mutated case and bodies files in memory and checks what is accepted.\n", usage);
      return 0;
    }
    if (argument.starts_with("count=") && value && *value > 0) {
      count = static_cast<long>(*value);
    } else if (argument.starts_with("seed=") && value && *value >= 0) {
      seed = static_cast<long>(*value);
    } else {
      std::fputs(usage, stderr);
      return 2;
    }
  }
  return run(count, seed);
}
