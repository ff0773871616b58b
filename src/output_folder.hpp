// The folder of a run's results: who may write there, and the record of what was run.
//
// Beside the results a run leaves three files:
//   run.txt     version, compiler and command, every key of the case, and a checksum of the bodies
//   case.txt    a case file that makes the same run again, from
//   bodies.csv  its bodies
// A case or bodies that are read from these very places stay as they are.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "case.hpp"

namespace stokes {

// Keeps other runs out of a folder for as long as it lives: the file `lock` in it, which names this process, is locked
// by the operating system. When a process ends in any way its lock ends too, so that the file of a killed run keeps
// nobody out. Where the file system has no locks there is none.
class FolderLock {
 public:
  // Makes the folder if it is missing. InputError, with the other process, when the folder is locked.
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
  // Of a run of this case from these bodies.
  RunRecord(const Case& c, const Suspension& initial);

  // InputError where the folder holds results, unless they are of this run or may be overwritten.
  void check_overwriting() const;

  // Removes the results of earlier runs except the tables, which are made anew: pictures and fields.
  void remove_results() const;

  // Writes run.txt, case.txt and bodies.csv. InputError or NumericalError on a write error.
  void write() const;

 private:
  std::vector<std::filesystem::path> results() const;

  const Case& case_;
  std::filesystem::path folder_;
  std::string bodies_;                    // content of bodies.csv
  std::vector<std::string> description_;  // what makes two runs the same
};

// Arguments as a line that a shell reads back.
std::string command_line(const std::vector<std::string>& arguments);

}  // namespace stokes
