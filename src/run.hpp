// A case, run from its files to its results: what `simulate` and the experiments share.
#pragma once

#include <string>

#include "case.hpp"
#include "interruption.hpp"

namespace stokes {

// How the steps of a case are made.
SimulationOptions options_of(const Case& c, const Suspension& bodies);

// Runs a case, from the checkpoint in its output folder if there is one of the same run: with the results that an
// uninterrupted run writes, to the byte. The record of the run goes into the folder, too (output_folder.hpp). Progress
// and warnings go to stderr, progress lines behind `label`.
// A signal (SignalGuard) gives the step under way up and ends the run with an Interruption, from which the same command
// goes on. A checkpoint that cannot be written is a warning: the run, or what ended it, goes on.
// InputError before anything is written, NumericalError after everything up to it is.
RunSummary simulate_case(const Case& c, const std::string& label = {});

}  // namespace stokes
