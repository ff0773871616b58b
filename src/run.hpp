// Runs a case from its files to its results, for `simulate` and the experiments.
#pragma once

#include <string>

#include "case.hpp"
#include "interruption.hpp"

namespace stokes {

// The options of the simulation of a case.
SimulationOptions options_of(const Case& c, const Suspension& bodies);

// Runs a case. If its output folder holds a checkpoint of the same run, it continues from there and writes the same bytes
// as an uninterrupted run. The record of the run is written to the folder, too (output_folder.hpp). Progress and warnings
// go to stderr; progress lines begin with `label`.
// A signal (SignalGuard) abandons the current step and ends the run with an Interruption. The same command then continues
// the run. If a checkpoint cannot be written, a warning is printed and the run continues.
// InputError before anything is written, NumericalError after all results up to the failure are written.
RunSummary simulate_case(const Case& c, const std::string& label = {});

}  // namespace stokes
