#include "checkpoint.hpp"

#include <cstdint>

#include "version.hpp"

namespace stokes {

namespace {

constexpr std::string_view first_line = "checkpoint of simulate, format 5";

// What must be equal for a run to continue: the case, and every number of the initial bodies.
std::vector<std::string> description_of(const Case& c, const Suspension& initial) {
  std::vector<std::string> lines;
  for (const auto& [key, value] : describe(c)) lines.push_back(concat(key, " = ", value));
  for (std::size_t i = 0; i < initial.size(); ++i) {
    const Body& body = initial[i];
    std::vector<std::string> numbers;
    for (const double x : {body.shape.a, body.shape.b, body.pose.centre.real(), body.pose.centre.imag(),
                           body.pose.angle, body.force.real(), body.force.imag(), body.torque})
      numbers.push_back(format_number(x));
    lines.push_back(concat("body ", i, ": ", join(numbers, " "), body.fixed ? " fixed" : ""));
    if (body.is_driven())
      lines.back() += concat(" ", body.surface.translation.real(), " ", body.surface.translation.imag(), " ",
                             body.surface.angular_velocity);
  }
  return lines;
}

void write_recorder(StateWriter& writer, const Recorder::Position& recorder) {
  writer.line("bytes", recorder.trajectory_bytes, recorder.steps_bytes);
  writer.line("skipped", recorder.skipped.size());
  for (const Recorder::Row& row : recorder.skipped) writer.line("row", row);
}

Recorder::Position read_recorder(StateReader& reader) {
  Recorder::Position recorder;
  reader.begin("bytes");
  recorder.trajectory_bytes = reader.integer<std::uintmax_t>();
  recorder.steps_bytes = reader.integer<std::uintmax_t>();
  reader.begin("skipped");
  recorder.skipped.resize(reader.integer<std::size_t>());
  for (Recorder::Row& row : recorder.skipped) row = reader.numbers("row");
  return recorder;
}

}  // namespace

std::uint64_t checksum(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return hash;
}

CheckpointFile::CheckpointFile(const Case& c, const Suspension& initial)
    : path_(std::filesystem::path(c.output) / "checkpoint"), overwrite_(c.overwrite),
      description_(description_of(c, initial)) {}

std::optional<Checkpoint> CheckpointFile::read() const {
  if (!std::filesystem::exists(path_)) return std::nullopt;
  const std::string text = read_text_file(path_, "the checkpoint"), name = path_.string();
  const auto start_anew = concat("delete ", name, " to start from the beginning, or choose another output.");
  const auto damaged = [&](std::string_view how) {
    return InputError(concat(name, ": the checkpoint is damaged: ", how, "; put it back, ", start_anew));
  };
  const auto end = text.rfind("checksum ");
  if (!text.starts_with(first_line) || end == std::string::npos) throw damaged("it is not complete, or of another version");
  if (text.substr(end) != concat("checksum ", std::to_string(checksum(std::string_view(text).substr(0, end))), "\n"))
    throw damaged("its checksum is wrong");
  try {
    StateReader reader(std::string_view(text).substr(0, end));
    reader.line();
    const std::string build(reader.line());
    reader.begin("description");
    std::vector<std::string> description(reader.integer<std::size_t>());
    for (std::string& line : description) line = reader.line();
    Checkpoint checkpoint;
    checkpoint.build = build;
    reader.begin("run");
    checkpoint.stage = reader.number() != 0.0 ? RunStage::failed : RunStage::under_way;
    checkpoint.run.step = reader.integer<long>();
    checkpoint.run.time = reader.number();
    checkpoint.recorder = read_recorder(reader);
    checkpoint.run.text = reader.rest();
    if (description == description_) return checkpoint;
    if (checkpoint.stage == RunStage::failed || overwrite_) return std::nullopt;
    std::size_t k = 0;
    while (k < description.size() && k < description_.size() && description[k] == description_[k]) ++k;
    const auto at = [k](const std::vector<std::string>& lines) {
      return k < lines.size() ? quote(lines[k]) : std::string("no further body");
    };
    throw InputError(concat(name, ": the unfinished run there has ", at(description), " where this one has ",
                            at(description_), "; undo the change to finish it, replace it by ",
                            "overwrite = yes, or choose another output."));
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw damaged(error.what());
  }
}

void CheckpointFile::write(const Checkpoint& checkpoint) const {
  StateWriter writer;
  writer.line(first_line);
  writer.line(build_description());
  writer.line("description", description_.size());
  for (const std::string& line : description_) writer.line(line);
  writer.line("run", checkpoint.stage == RunStage::failed ? 1 : 0, checkpoint.run.step, checkpoint.run.time);
  write_recorder(writer, checkpoint.recorder);
  std::string text = writer.text() + checkpoint.run.text;
  text += concat("checksum ", std::to_string(checksum(text)), "\n");
  try {
    write_file_atomically(path_, text, Until::on_disk);
  } catch (const InputError& error) {  // nothing is wrong with the input: the run is under way
    throw NumericalError(error.what());
  }
}

void CheckpointFile::remove() const {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
  std::filesystem::remove(path_.string() + ".tmp", ignored);
}

}  // namespace stokes
