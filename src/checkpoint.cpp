#include "checkpoint.hpp"

#include <cstdint>
#include <limits>

#include "version.hpp"

namespace stokes {

namespace {

constexpr std::string_view first_line = "checkpoint of simulate, format 4";

// What has to be the same for a run to go on: the case, and every number of the bodies at its beginning.
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
  }
  return lines;
}

// One line each: its name and its numbers, groups of numbers after their count.
class Writer {
 public:
  explicit Writer(std::string& text) : text_(text) {}

  template <class... Numbers>
  void line(std::string_view name, const Numbers&... numbers) {
    text_ += name;
    ((text_ += concat(" ", numbers)), ...);
    text_ += '\n';
  }
  void line(std::string_view name, const ComplexVector& values) {
    text_ += concat(name, " ", values.size());
    for (const Complex z : values) text_ += concat(" ", z.real(), " ", z.imag());
    text_ += '\n';
  }
  void line(std::string_view name, const std::vector<double>& values) {
    text_ += concat(name, " ", values.size());
    for (const double x : values) text_ += concat(" ", x);
    text_ += '\n';
  }

 private:
  std::string& text_;
};

// Reads what Writer wrote, in the same order; the text has been found undamaged.
class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(text) {}

  std::string_view line() {
    const auto end = rest_.find('\n');
    const std::string_view result = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    return result;
  }

  // Begins a line with this name; number() then takes its numbers one by one.
  void begin(std::string_view name) {
    numbers_ = line();
    if (numbers_.substr(0, numbers_.find(' ')) != name) throw std::runtime_error(concat(name, " is missing"));
    skip();
  }
  double number() {
    const std::string_view word = numbers_.substr(0, numbers_.find(' '));
    skip();
    if (word == "nan") return std::numeric_limits<double>::quiet_NaN();
    if (word == "inf") return std::numeric_limits<double>::infinity();
    if (word == "-inf") return -std::numeric_limits<double>::infinity();
    const auto value = parse_number(word);
    if (!value) throw std::runtime_error(concat(quote(word), " is not a number"));
    return *value;
  }
  template <class Integer>
  Integer integer() {
    return static_cast<Integer>(number());
  }

  ComplexVector complex_numbers(std::string_view name) {
    begin(name);
    ComplexVector values(integer<Eigen::Index>());
    for (Complex& z : values) {
      const double re = number();
      z = {re, number()};
    }
    return values;
  }
  std::vector<double> numbers(std::string_view name) {
    begin(name);
    std::vector<double> values(integer<std::size_t>());
    for (double& x : values) x = number();
    return values;
  }
  Matrix matrix(std::string_view name, Eigen::Index rows, Eigen::Index cols) {
    const std::vector<double> values = numbers(name);
    if (static_cast<Eigen::Index>(values.size()) != rows * cols) throw std::runtime_error(concat(name, " has a wrong size"));
    return Eigen::Map<const Matrix>(values.data(), rows, cols);
  }

 private:
  void skip() {
    const auto space = numbers_.find(' ');
    numbers_.remove_prefix(space == std::string_view::npos ? numbers_.size() : space + 1);
  }

  std::string_view rest_, numbers_;
};

void write_density(Writer& writer, const StepperMemory::Density& density) {
  writer.line("density", density.path, density.nodes.size());
  for (const Discretisation& nodes : density.nodes) {
    std::vector<double> clusters;
    for (const NodeCluster& c : nodes.clusters)
      clusters.insert(clusters.end(), {c.alpha, c.width, static_cast<double>(c.points)});
    writer.line("points", nodes.points, nodes.upsampling);
    writer.line("clusters", clusters);
  }
  writer.line("values", density.value);
}

StepperMemory::Density read_density(Reader& reader) {
  StepperMemory::Density density;
  reader.begin("density");
  density.path = reader.number();
  density.nodes.resize(reader.integer<std::size_t>());
  for (Discretisation& nodes : density.nodes) {
    reader.begin("points");
    nodes.points = reader.integer<int>();
    nodes.upsampling = reader.integer<int>();
    const std::vector<double> clusters = reader.numbers("clusters");
    for (std::size_t k = 0; k + 2 < clusters.size(); k += 3)
      nodes.clusters.push_back({clusters[k], clusters[k + 1], static_cast<int>(clusters[k + 2])});
  }
  density.value = reader.complex_numbers("values");
  return density;
}

void write_memory(Writer& writer, const StepperMemory& memory) {
  writer.line("memory", memory.path, memory.background.size(), memory.contacts.size());
  for (const StepperMemory::Density& density : memory.background) write_density(writer, density);
  write_density(writer, memory.total);
  std::vector<double> resolution;
  for (const Resolution& r : memory.resolution) resolution.insert(resolution.end(), {static_cast<double>(r.points), r.factor});
  writer.line("resolution", resolution);
  writer.line("known", memory.known.contacts.size(), memory.answers.size());
  for (const KnownContacts::Contact& c : memory.known.contacts) writer.line("contact", c.a, c.b, c.region);
  writer.line("rates", std::vector<double>(memory.known.rates.reshaped().begin(), memory.known.rates.reshaped().end()));
  writer.line("multipliers",
              std::vector<double>(memory.known.multipliers.reshaped().begin(), memory.known.multipliers.reshaped().end()));
  for (const StepperMemory::Density& density : memory.answers) write_density(writer, density);
  for (const auto& [bodies, history] : memory.contacts) {
    writer.line("contact", bodies.first, bodies.second, history.size());
    for (const StepperMemory::Density& density : history) write_density(writer, density);
  }
}

StepperMemory read_memory(Reader& reader) {
  StepperMemory memory;
  reader.begin("memory");
  memory.path = reader.number();
  memory.background.resize(reader.integer<std::size_t>());
  const auto contacts = reader.integer<std::size_t>();
  for (StepperMemory::Density& density : memory.background) density = read_density(reader);
  memory.total = read_density(reader);
  const std::vector<double> resolution = reader.numbers("resolution");
  for (std::size_t k = 0; k + 1 < resolution.size(); k += 2)
    memory.resolution.push_back({static_cast<int>(resolution[k]), resolution[k + 1]});
  reader.begin("known");
  memory.known.contacts.resize(reader.integer<std::size_t>());
  memory.answers.resize(reader.integer<std::size_t>());
  for (KnownContacts::Contact& c : memory.known.contacts) {
    reader.begin("contact");
    c.a = reader.integer<int>(), c.b = reader.integer<int>(), c.region = reader.integer<int>();
  }
  const auto rows = static_cast<Eigen::Index>(memory.known.contacts.size());
  memory.known.rates = reader.matrix("rates", rows, rows);
  memory.known.multipliers = reader.matrix("multipliers", rows, static_cast<Eigen::Index>(memory.answers.size()));
  for (StepperMemory::Density& density : memory.answers) density = read_density(reader);
  for (std::size_t k = 0; k < contacts; ++k) {
    reader.begin("contact");
    const int a = reader.integer<int>(), b = reader.integer<int>();
    auto& history = memory.contacts[{a, b}];
    history.resize(reader.integer<std::size_t>());
    for (StepperMemory::Density& density : history) density = read_density(reader);
  }
  return memory;
}

void write_state(Writer& writer, const Checkpoint& checkpoint) {
  const RunState& run = checkpoint.run;
  const ClockState& clock = run.clock;
  writer.line("failed", checkpoint.stage == RunStage::failed ? 1 : 0);
  writer.line("clock", clock.step, clock.time, clock.dt, clock.easy_steps, clock.since_rejection);
  writer.line("rejected", run.rejected);
  std::vector<double> poses;
  for (const Pose& pose : run.poses)
    for (const double x : {pose.centre.real(), pose.centre.imag(), pose.angle}) poses.push_back(x);
  writer.line("poses", poses);
  write_memory(writer, run.memory);
  const Recorder::Position& recorder = checkpoint.recorder;
  writer.line("bytes", recorder.trajectory_bytes, recorder.steps_bytes);
  writer.line("skipped", recorder.skipped.size());
  for (const Recorder::Row& row : recorder.skipped) writer.line("row", row);
}

Checkpoint read_state(Reader& reader) {
  Checkpoint checkpoint;
  RunState& run = checkpoint.run;
  reader.begin("failed");
  checkpoint.stage = reader.number() != 0.0 ? RunStage::failed : RunStage::under_way;
  reader.begin("clock");
  run.clock.step = reader.integer<long>();
  run.clock.time = reader.number();
  run.clock.dt = reader.number();
  run.clock.easy_steps = reader.integer<int>();
  run.clock.since_rejection = reader.integer<int>();
  reader.begin("rejected");
  run.rejected = reader.integer<long>();
  const std::vector<double> poses = reader.numbers("poses");
  for (std::size_t k = 0; k + 2 < poses.size(); k += 3) run.poses.push_back({{poses[k], poses[k + 1]}, poses[k + 2]});
  run.memory = read_memory(reader);
  reader.begin("bytes");
  checkpoint.recorder.trajectory_bytes = reader.integer<std::uintmax_t>();
  checkpoint.recorder.steps_bytes = reader.integer<std::uintmax_t>();
  reader.begin("skipped");
  checkpoint.recorder.skipped.resize(reader.integer<std::size_t>());
  for (Recorder::Row& row : checkpoint.recorder.skipped) row = reader.numbers("row");
  return checkpoint;
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
    Reader reader(text);
    reader.line();
    const std::string build(reader.line());
    reader.begin("description");
    std::vector<std::string> description(reader.integer<std::size_t>());
    for (std::string& line : description) line = reader.line();
    Checkpoint checkpoint = read_state(reader);
    checkpoint.build = build;
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
  std::string text(first_line);
  text += concat("\n", build_description(), "\n");
  Writer writer(text);
  writer.line("description", description_.size());
  for (const std::string& line : description_) writer.line(line);
  write_state(writer, checkpoint);
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
