// Version, compiler and instruction set of this build, for the files that it writes.
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

// Version, compiler and instruction set: the last digits of a result depend on them.
inline std::string build_description() {
#if defined(__AVX512F__)
  const std::string instructions = "AVX-512";
#elif defined(__AVX2__)
  const std::string instructions = "AVX2";
#else
  const std::string instructions = "no wide";
#endif
  const Comments build = provenance();
  return concat("version ", build[0].second, ", ", build[1].second, ", ", instructions, " instructions");
}

}  // namespace stokes
