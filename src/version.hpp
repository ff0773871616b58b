// What a result says of the program that made it.
#pragma once

#include <string>

#include "csv.hpp"

namespace stokes {

inline constexpr const char* version = "0.1.0";

// Version and compiler as `# key: value` lines.
inline Comments provenance() {
#if defined(__clang__)
  const std::string compiler = "clang " __clang_version__;
#else
  const std::string compiler = "gcc " __VERSION__;
#endif
  return {{"version", version}, {"compiler", compiler}};
}

}  // namespace stokes
