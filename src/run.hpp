// A case, run from its files to its results: what `simulate` and the experiments share.
#pragma once

#include <string>

#include "case.hpp"

namespace stokes {

// A signal ended a run, which left a checkpoint.
struct Interruption {
  int signal;
  std::string message;
};

// How the steps of a case are made.
SimulationOptions options_of(const Case& c, const Suspension& bodies);

// Runs a case, from the checkpoint in its output folder if there is one of the same run: with the results that an
// uninterrupted run writes, to the byte. What it is goes into the folder, too (output_folder.hpp). Progress and warnings go to stderr, progress lines behind `label`.
// SIGINT and SIGTERM end it with an Interruption after the step under way, a second signal at once.
// InputError before anything is written, NumericalError after everything up to it is.
RunSummary simulate_case(const Case& c, const std::string& label = {});

}  // namespace stokes
