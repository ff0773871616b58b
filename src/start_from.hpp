// The state of an earlier run that another one starts from.
#pragma once

#include <filesystem>
#include <string>

namespace stokes {

struct EarlierState {
  double time = 0.0;
  std::string bodies;          // content of a bodies' file: that of the run with the centres and angles of the state
  std::filesystem::path file;  // bodies.csv of the run, absolute
};

// `text`: the folder of the run and, behind a space, a time of its trajectory.csv; without a time the latest state there.
// Numbers keep all their bits. InputError for files that are missing or do not belong together, and for a time without a
// state; the message names the nearest time with a state.
EarlierState earlier_state(const std::string& text);

}  // namespace stokes
