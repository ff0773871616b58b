// Runs build/simulate (or the program that the environment variable SIMULATE names) as a user would, in a
// folder of its own. Only the exit status, the two streams and the files are returned.
#pragma once

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "base.hpp"
#include "csv.hpp"

namespace stokes {

// A fresh folder, removed with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::random_device random;
    do path_ = std::filesystem::temp_directory_path() / concat("stokes_run_", random());
    while (!std::filesystem::create_directory(path_));
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// Every file and folder with its content, by its name in the folder.
inline std::map<std::string, std::string> everything_in(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string();
    files[name] = entry.is_regular_file() ? content_of(entry.path()) : "(not a file)";
  }
  return files;
}

struct ProgramRun {
  int status;  // exit status; 128 + signal if one ended it
  std::string output, errors;
};

inline std::string shell_word(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

// Runs a program in a folder; `before` is shell text ahead of it, `starter` a program that starts it.
inline ProgramRun run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                              const std::filesystem::path& folder, const std::string& starter = "",
                              const std::string& before = "") {
  const TemporaryFolder streams;  // elsewhere, so that the folder holds only what the program itself leaves behind
  const std::string out = (streams.path() / "out").string(), err = (streams.path() / "err").string();
  std::string command = concat("cd ", shell_word(folder.string()), " && ", before, starter, shell_word(program.string()));
  for (const std::string& argument : arguments) command += concat(" ", shell_word(argument));
  const int status = std::system(concat(command, " > ", shell_word(out), " 2> ", shell_word(err)).c_str());
  const int exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return {exit_status, content_of(out), content_of(err)};
}

inline std::filesystem::path simulate_program() {
  const char* name = std::getenv("SIMULATE");
  return std::filesystem::absolute(name ? name : "build/simulate");
}

// The output of a run. Fields are read as numbers, nan and inf included; anything else throws.
struct Results {
  Table trajectory, steps;

  std::vector<double> step_column(std::string_view name) const { return steps.numbers(name); }

  // Down the steps that have rows, for one body.
  std::vector<double> body_column(int body, std::string_view name) const {
    const std::vector<double> bodies = trajectory.numbers("body"), all = trajectory.numbers(name);
    std::vector<double> values;
    for (std::size_t row = 0; row < all.size(); ++row)
      if (bodies[row] == body) values.push_back(all[row]);
    return values;
  }
};

// A folder with a case and its bodies.
class Workspace {
 public:
  Workspace(std::string_view case_file, std::string_view bodies) {
    write("case.txt", case_file);
    write("bodies.csv", bodies);
  }

  void write(const std::filesystem::path& name, std::string_view text) const {
    std::ofstream(path() / name, std::ios::binary) << text;
  }
  const std::filesystem::path& path() const { return folder_.path(); }

  // simulate ARGUMENTS in this folder.
  ProgramRun run(const std::vector<std::string>& arguments) const { return run_by("", arguments); }

  // The same, but no file may have more than so many blocks of 512 bytes (of 1024 in some shells).
  ProgramRun run_limited(int blocks, const std::vector<std::string>& arguments) const {
    const TemporaryFolder counts;  // coverage counts, which the limit would truncate in their usual place
    return run_by("", arguments,
                  concat("export GCOV_PREFIX=", shell_word(counts.path().string()), "; ulimit -f ", blocks, "; "));
  }

  // The same, but after so many seconds the program gets a signal (KILL, TERM, INT).
  // In the foreground `timeout` outlives a KILL, and so waits for the program.
  ProgramRun run_until(double seconds, const std::string& signal, const std::vector<std::string>& arguments) const {
    return run_by(concat("timeout --foreground --preserve-status -s ", signal, " ", seconds, " "), arguments);
  }

  Results results(const std::filesystem::path& output = "out") const {
    return {read_csv(path() / output / "trajectory.csv"), read_csv(path() / output / "steps.csv")};
  }

  std::map<std::string, std::string> everything() const { return everything_in(path()); }

 private:
  ProgramRun run_by(const std::string& starter, const std::vector<std::string>& arguments,
                    const std::string& before = "") const {
    return run_program(simulate_program(), arguments, path(), starter, before);
  }

  TemporaryFolder folder_;
};

// A case of bodies.csv that writes to the folder out; `settings` are further lines.
inline std::string case_text(const std::string& flow, int points, double time_step, double end_time,
                             const std::string& settings = "") {
  return concat("bodies = bodies.csv\nflow = ", flow, "\npoints_per_body = ", points,
                "\ntime_step = ", time_step, "\nend_time = ", end_time, "\noutput = out\n", settings);
}

}  // namespace stokes
