// main() of the programs that read results and references: arguments name=value, exit status 2 for wrong arguments.
#pragma once

#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "base.hpp"
#include "text.hpp"

namespace stokes {

using Arguments = std::map<std::string, std::string>;

// `arguments`: the known names with their defaults; all programs also know missing=fail|allow. `run` gets their
// values and returns the exit status; `help` follows the usage.
template <class Run>
int run_on_results(const std::string& program, const std::string& usage, const std::string& help, Arguments arguments,
                   int argc, char** argv, const Run& run) {
  arguments["missing"] = "fail";
  try {
    for (int i = 1; i < argc; ++i) {
      const std::string argument = argv[i];
      if (argument == "--help" || argument == "-h") {
        std::printf("%s\n\n%s", usage.c_str(), help.c_str());
        return 0;
      }
      const std::size_t equals = argument.find('=');
      const auto named = arguments.find(argument.substr(0, equals));
      if (equals == std::string::npos || named == arguments.end())
        throw InputError(concat("unknown argument ", quote(argument), "; ", usage));
      named->second = argument.substr(equals + 1);
    }
    if (arguments["missing"] != "fail" && arguments["missing"] != "allow")
      throw InputError(concat("missing = fail or allow, not ", quote(arguments["missing"])));
    return run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", program.c_str(), error.what());
    return 2;
  }
}

}  // namespace stokes
