// Checkpoint of an unfinished run: the file `checkpoint` among its results, from which the same command goes on
// to the same bytes that an uninterrupted run writes.
//
// A text file: the build of the program, the run's description, its state with every double to the last bit, the
// position of its results, and a checksum. Replaced as a whole and on disk before it counts, so that a process that is
// killed or a machine that stops while it is written leaves the one before.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "case.hpp"
#include "recorder.hpp"
#include "simulation.hpp"

namespace stokes {

// Fowler, Noll and Vo's hash of 64 bits, FNV-1a.
std::uint64_t checksum(std::string_view text);

struct Checkpoint {
  RunState run;
  RunStage stage = RunStage::under_way;
  Recorder::Position recorder;
  std::string build{};  // of the program that wrote it (build_description); of this one if empty
};

class CheckpointFile {
 public:
  // Of the run of a case, from the bodies it starts with, whose results are in c.output.
  CheckpointFile(const Case& c, const Suspension& initial);

  const std::filesystem::path& path() const { return path_; }

  // The checkpoint to go on from, if there is one. InputError for one of another case or other bodies, which
  // says what differs, and for one that is damaged. That of another run counts as none if it failed, so that its case
  // had to be changed, or if it may be overwritten.
  std::optional<Checkpoint> read() const;

  // NumericalError on a write error; the checkpoint before is then still there. Cost: about 160 bytes a node, and as
  // much again for each pair in contact.
  void write(const Checkpoint& checkpoint) const;

  // Also what a killed write left; nothing if there is neither.
  void remove() const;

 private:
  std::filesystem::path path_;
  bool overwrite_;
  std::vector<std::string> description_;
};

}  // namespace stokes
