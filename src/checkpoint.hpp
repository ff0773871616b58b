// Checkpoint of an unfinished run: the file `checkpoint` among its results. The same command continues from it and
// writes the same bytes as an uninterrupted run.
//
// A text file: the build of the program, the run's description, its state with every double to the last bit, the
// position of its results, and a checksum. It is replaced as a whole once the new one is on disk. If the process is
// killed or the machine stops meanwhile, the previous checkpoint remains.
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

// The 64-bit hash FNV-1a of Fowler, Noll and Vo.
std::uint64_t checksum(std::string_view text);

struct Checkpoint {
  SavedRun run;
  RunStage stage = RunStage::under_way;
  Recorder::Position recorder;
  std::string build{};  // of the program that wrote it (build_description); of this one if empty
};

class CheckpointFile {
 public:
  // The checkpoint in c.output of the run of a case, which starts with the bodies `initial`.
  CheckpointFile(const Case& c, const Suspension& initial);

  const std::filesystem::path& path() const { return path_; }

  // The checkpoint to continue from, if there is one. InputError if it is damaged or belongs to another case or other
  // bodies; the message says what differs. A checkpoint of another run is ignored if that run failed, since its case then
  // has to be changed, or if it may be overwritten.
  std::optional<Checkpoint> read() const;

  // NumericalError on a write error; the previous checkpoint then remains. Size: about 160 bytes for each node, and the
  // same again for each pair in contact.
  void write(const Checkpoint& checkpoint) const;

  // Removes the checkpoint and what a killed write left behind, if they are there.
  void remove() const;

 private:
  std::filesystem::path path_;
  bool overwrite_;
  std::vector<std::string> description_;
};

}  // namespace stokes
