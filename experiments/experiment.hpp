// What the experiment programs share: their command line and their result files.
//
//   program case=NAME [results=DIR]   computes one case, writes DIR/<experiment>/<case>.csv;
//           [checkpoint_every=SECONDS]  for cases that continue after an interruption (case_run.hpp)
//           [threads=K]               1 if not given: `make -j` runs cases side by side
//   program collect   [results=DIR]   combines the existing cases into tables and summary.csv
//   program list                      prints the names of the cases
//   program --help                    says what it makes
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <new>
#include <string>
#include <vector>

#include "about.hpp"
#include "base.hpp"
#include "csv.hpp"
#include "output_folder.hpp"
#include "run.hpp"
#include "threads.hpp"
#include "version.hpp"

namespace stokes {

// One row of named numbers: the result of a case, read by `verify` by these names.
using Quantities = std::vector<std::pair<std::string, double>>;

class Results {
 public:
  // `settings`: those of cases that are runs of simulate_case(), as given by the user; `command` runs the program.
  Results(const std::filesystem::path& root, const std::string& experiment, std::vector<std::string> settings = {},
          std::string command = {})
      : folder_(root / experiment), settings_(std::move(settings)), command_(std::move(command)) {
    std::filesystem::create_directories(folder_);
  }

  const std::filesystem::path& folder() const { return folder_; }
  std::filesystem::path path(const std::string& name) const { return folder_ / (name + ".csv"); }
  bool has(const std::string& name) const { return std::filesystem::exists(path(name)); }
  const std::vector<std::string>& settings() const { return settings_; }
  const std::string& command() const { return command_; }

  // Writes <name>.csv as a whole: version, compiler and `parameters` as comment lines, then the rows.
  void write(const std::string& name, const std::vector<std::string>& header,
             const std::vector<std::vector<double>>& rows, const Comments& parameters = {}) const {
    std::string text;
    for (const Comments& comments : {provenance(), parameters})
      for (const auto& [key, value] : comments) text += concat("# ", key, ": ", value, "\n");
    text += join(header, ",") + "\n";
    for (const std::vector<double>& row : rows) {
      std::vector<std::string> fields;
      for (double value : row) fields.push_back(format_number(value));
      text += join(fields, ",") + "\n";
    }
    write_file_atomically(path(name), text);
  }
  void write(const std::string& name, const Quantities& quantities, const Comments& parameters = {}) const {
    std::vector<std::string> header;
    std::vector<double> row;
    for (const auto& [key, value] : quantities) header.push_back(key), row.push_back(value);
    write(name, header, {row}, parameters);
  }

  // Of another experiment in the same root.
  Results of(const std::string& experiment) const { return {folder_.parent_path(), experiment}; }

  // A number that a case has written in its only row.
  double quantity(const std::string& name, const std::string& column) const {
    const Table table = read_csv(path(name));
    return table.number(0, table.column(column));
  }

 private:
  std::filesystem::path folder_;
  std::vector<std::string> settings_;
  std::string command_;
};

// The value of a published number in reference_data/<experiment>.csv; NaN if there is none.
inline double published_value(const std::string& experiment, const std::string& case_name, const std::string& quantity) {
  const Table table = read_csv(std::filesystem::path("reference_data") / (experiment + ".csv"));
  for (int row = 0; row < static_cast<int>(table.rows.size()); ++row)
    if (table.text(row, table.column("case")) == case_name && table.text(row, table.column("quantity")) == quantity)
      return table.finite_number(row, table.column("value"));
  return std::nan("");
}

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

struct Experiment {
  std::string name;
  std::vector<std::string> cases;
  std::function<void(const std::string& case_name, const Results&)> run;
  std::function<void(const Results&)> collect;
};

inline std::string usage_of(const std::string& experiment) {
  return concat("usage: ", experiment, " case=NAME|collect|list [results=DIR]");
}

inline std::string help_of(const Experiment& experiment) {
  const std::string& name = experiment.name;
  std::string text = concat(usage_of(name), "\n\n", about(name), "\n\n",
                            "case=NAME    computes one case and writes DIR/", name, "/NAME.csv\n",
                            "collect      combines the cases that are there into tables in DIR/", name, "\n",
                            "list         prints the names of the cases\n",
                            "results=DIR  folder of all results, `results` if not given\n",
                            "checkpoint_every=SECONDS  of long cases, 60 if not given\n",
                            "threads=K    that the case uses, 1 if not given; results are the same for any number\n\n",
                            "`make ", name, "` does all of it. The cases:\n");
  for (const std::string& each : experiment.cases) text += concat("  ", each, "\n");
  return text;
}

inline int parse_threads(const std::string& argument) {
  const auto count = parse_integer(argument.substr(argument.find('=') + 1));
  if (!count || *count < 1 || *count > most_threads)
    throw InputError(concat(quote(argument), " must be a whole number from 1 to ", most_threads));
  return static_cast<int>(*count);
}

// main() of an experiment: exit status 0, 2 for wrong arguments, 3 for a numerical failure.
inline int run_experiment(const Experiment& experiment, int argc, char** argv) {
  const std::string usage = usage_of(experiment.name);
  try {
    std::string task, root = "results";
    std::vector<std::string> settings;
    int threads = 1;
    for (int i = 1; i < argc; ++i) {
      const std::string argument = argv[i];
      if (argument.starts_with("results="))
        root = argument.substr(8);
      else if (argument.starts_with("checkpoint_every="))
        settings.push_back(argument);
      else if (argument.starts_with("threads="))
        threads = parse_threads(argument);
      else if (task.empty())
        task = argument;
      else
        throw InputError(concat("unexpected argument ", quote(argument), "; ", usage));
    }
    if (task == "--help" || task == "-h") {
      std::printf("%s", help_of(experiment).c_str());
      return 0;
    }
    if (task == "list") {
      for (const std::string& name : experiment.cases) std::printf("%s\n", name.c_str());
      return 0;
    }
    if (task == "collect") {
      experiment.collect(Results(root, experiment.name));
      return 0;
    }
    if (!task.starts_with("case=")) throw InputError(usage);
    const std::string name = task.substr(5);
    if (std::find(experiment.cases.begin(), experiment.cases.end(), name) == experiment.cases.end())
      throw InputError(
          concat("no case ", quote(name), "; ", suggestion(name, experiment.cases), "`list` prints their names"));
    set_thread_count(threads);
    experiment.run(name, Results(root, experiment.name, settings, command_line({argv, argv + argc})));
    return 0;
  } catch (const Interruption& end) {
    std::fprintf(stderr, "%s: %s\n", experiment.name.c_str(), end.message.c_str());
    return 128 + end.signal;
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s: %s\n", experiment.name.c_str(), error.what());
    return 2;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "%s: there is not enough memory\n", experiment.name.c_str());
    return 3;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", experiment.name.c_str(), error.what());
    return 3;
  }
}

}  // namespace stokes
