// A case of an experiment that is a run of simulate_case(): its files in <experiment>/<case>/, before and after.
// Killed or interrupted, it goes on with the same command from its checkpoint there.
#pragma once

#include "experiment.hpp"
#include "run.hpp"

namespace stokes {

// Writes case.txt and bodies.csv, which `simulate` reads too, and returns the case that they make.
inline Case write_case(const std::string& name, Case c, const Suspension& bodies, const Results& results) {
  const std::filesystem::path folder = results.folder() / name;
  std::filesystem::create_directories(folder);
  c.bodies = "bodies.csv";
  c.output = folder.string();
  write_file_atomically(folder / c.bodies, format_bodies(bodies));
  write_file_atomically(folder / "case.txt", format_case(c));
  return read_case(folder / "case.txt", {concat("threads=", thread_count())});
}

}  // namespace stokes
