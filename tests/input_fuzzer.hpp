// Random mutations of case and bodies files, read and checked in memory; equal seeds give equal mutations.
#pragma once

#include <cstdint>
#include <string>

namespace stokes {

struct FuzzReport {
  long mutations = 0;
  long accepted_cases = 0, accepted_suspensions = 0;
  double slowest = 0.0;  // seconds that the reading of one file took
  std::string failure;   // of the first mutation that is not read as it should be, with its text; empty if there is none
};

// Mutations first, first + 1, ..., each of which depends on the seed and its own number alone, up to the first failure.
// A file must be refused by an InputError of one line, or be accepted, in less than 5 seconds. What is accepted must be
// finite, within the limits of case.hpp and bodies.hpp, and without overlaps, as checked here pair by pair.
FuzzReport fuzz_input(long first, long count, std::uint64_t seed);

}  // namespace stokes
