#include "output_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <regex>
#include <system_error>

#include "checkpoint.hpp"
#include "csv.hpp"
#include "recorder.hpp"
#include "version.hpp"

namespace stokes {

namespace {

namespace fs = std::filesystem;

std::string read_if_there(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) ? read_text_file(path, "the record of a run") : std::string();
}

bool same_file(const fs::path& p, const fs::path& q) {
  std::error_code ignored;
  return fs::equivalent(p, q, ignored);
}

// False if the run before, which held the lock, has removed the file that was opened.
bool is_still_there(int file, const fs::path& path) {
  struct stat opened {}, named {};
  return fstat(file, &opened) == 0 && stat(path.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

std::string this_process() {
  char host[256] = "";
  if (gethostname(host, sizeof host - 1) != 0) host[0] = '\0';
  return concat("process ", getpid(), " on ", host);
}

// Lines of a record that identify the run; they follow those of the program.
std::vector<std::string> description_in(const std::string& record) {
  std::vector<std::string> lines;
  for (const std::string_view line : split(trim(record), '\n')) {
    const std::string_view key = trim(line.substr(0, line.find('=')));
    if (key != "version" && key != "compiler" && key != "command" && !key.empty()) lines.emplace_back(line);
  }
  return lines;
}

// The files in a folder whose whole name matches.
void add_matching(const fs::path& folder, const std::regex& name, std::vector<fs::path>& files) {
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none))
    if (entry.is_regular_file(none) && std::regex_match(entry.path().filename().string(), name))
      files.push_back(entry.path());
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder) : path_(made_folder(folder) / "lock") {
  for (;;) {
    file_ = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0)
      throw InputError(concat(path_.string(), ": cannot create the file: ", std::generic_category().message(errno),
                              "; choose another output."));
    if (flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      const std::string owner(trim(read_if_there(path_)));
      close(file_);
      throw InputError(concat(quote(folder.string()), " is in use: ", owner.empty() ? "another process" : owner,
                              " writes its results there; wait for its end, or choose another output."));
    }
    if (is_still_there(file_, path_)) break;
    close(file_);
  }
  const std::string text = this_process() + "\n";
  // The lock also holds if there is no room on the disk for the name.
  if (ftruncate(file_, 0) != 0 || ::write(file_, text.data(), text.size()) < 0) return;
}

FolderLock::~FolderLock() {
  unlink(path_.c_str());  // before unlocking, so that the lock file of the next run is not removed
  close(file_);
}

RunRecord::RunRecord(const Case& c, const Suspension& initial)
    : case_(c), folder_(c.output), bodies_(format_bodies(initial)) {
  for (const auto& [key, value] : describe(c))
    if (key != "bodies") description_.push_back(concat(key, " = ", value));
  description_.push_back(concat("bodies = ", std::count(bodies_.begin(), bodies_.end(), '\n') - 1, " with checksum ",
                                std::to_string(checksum(bodies_))));
}

std::vector<fs::path> RunRecord::results() const {
  static const std::regex field("fields_[-+.0-9e]+\\.csv(\\.tmp)?"), picture("step_[0-9]{6,}\\.vtk(\\.tmp)?");
  std::vector<fs::path> files;
  add_matching(folder_, field, files);
  if (std::error_code none; fs::exists(folder_ / "run.vtk.series", none)) files.push_back(folder_ / "run.vtk.series");
  add_matching(folder_ / "vtk", picture, files);
  return files;
}

void RunRecord::check_overwriting() const {
  if (case_.overwrite) return;
  std::vector<fs::path> files = results();
  for (const char* name : {"trajectory.csv", "steps.csv", "run.txt"}) files.push_back(folder_ / name);
  for (const char* name : {"case.txt", "bodies.csv"})
    if (const fs::path file = folder_ / name; !same_file(file, case_.file) && !same_file(file, case_.bodies_path()))
      files.push_back(file);
  const auto first = std::find_if(files.begin(), files.end(), [](const fs::path& file) { return fs::exists(file); });
  if (first == files.end()) return;
  const std::vector<std::string> there = description_in(read_if_there(folder_ / "run.txt"));
  if (there == description_) return;
  const char* const remedy = "; overwrite = yes replaces it, or choose another output.";
  if (there.empty())
    throw InputError(concat(first->string(), ": the file is there already, of a run without a record", remedy));
  std::size_t k = 0;
  while (k < there.size() && k < description_.size() && there[k] == description_[k]) ++k;
  const auto at = [k](const std::vector<std::string>& lines) {
    return k < lines.size() ? quote(lines[k]) : std::string("nothing more");
  };
  throw InputError(concat(folder_.string(), ": another run is there, with ", at(there), " where this one has ",
                          at(description_), remedy));
}

void RunRecord::remove_results() const {
  for (const fs::path& file : results()) fs::remove(file);
  std::error_code not_empty;
  if (!case_.vtk) fs::remove(folder_ / "vtk", not_empty);
}

void RunRecord::write() const {
  std::string record;
  for (const auto& [key, value] : provenance()) record += concat(key, " = ", value, "\n");
  record += concat("command = ", case_.command, "\n", join(description_, "\n"), "\n");
  write_file_atomically(folder_ / "run.txt", record);

  if (const fs::path file = folder_ / "bodies.csv"; !same_file(file, case_.bodies_path()))
    write_file_atomically(file, bodies_);
  if (const fs::path file = folder_ / "case.txt"; !same_file(file, case_.file)) {
    Case again = case_;
    again.bodies = "bodies.csv";
    write_file_atomically(file, format_case(again));
  }
}

std::string command_line(const std::vector<std::string>& arguments) {
  static const std::regex plain("[-A-Za-z0-9_./=,:+@%]+");
  std::vector<std::string> words;
  for (const std::string& argument : arguments) {
    std::string word;
    for (const char c : argument) word += c == '\'' ? "'\\''" : std::string(1, c == '\n' || c == '\r' ? '?' : c);
    words.push_back(std::regex_match(argument, plain) ? argument : concat("'", word, "'"));
  }
  return join(words, " ");
}

}  // namespace stokes
