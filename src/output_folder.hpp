// The folder of a run's results: its lock, and the record of the run.
//
// Beside the results a run writes three files:
//   run.txt     version, compiler and command, every key of the case, and a checksum of the bodies
//   case.txt    a case file that repeats the run with
//   bodies.csv  its bodies
// If the case or the bodies are read from these very files, they are not rewritten.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "case.hpp"

namespace stokes {

// Keeps other runs out of a folder while it lives. The operating system locks the file `lock` in the folder, which names
// this process. The lock ends with its process, however that ends, so the file of a killed run keeps nobody out. There is
// no protection on file systems without locks.
class FolderLock {
 public:
  // Creates the folder if it is missing. InputError, which names the other process, if the folder is locked.
  explicit FolderLock(const std::filesystem::path& folder);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

 private:
  std::filesystem::path path_;
  int file_ = -1;  // open and locked
};

class RunRecord {
 public:
  // The record of a run of this case with these initial bodies.
  RunRecord(const Case& c, const Suspension& initial);

  // InputError if the folder holds results of another run that may not be overwritten.
  void check_overwriting() const;

  // Removes pictures and fields of earlier runs. The tables are replaced anyway.
  void remove_results() const;

  // Writes run.txt, case.txt and bodies.csv. InputError or NumericalError on a write error.
  void write() const;

 private:
  std::vector<std::filesystem::path> results() const;

  const Case& case_;
  std::filesystem::path folder_;
  std::string bodies_;                    // content of bodies.csv
  std::vector<std::string> description_;  // equal for two runs with the same results
};

// The arguments as one line, quoted for a shell.
std::string command_line(const std::vector<std::string>& arguments);

}  // namespace stokes
