// Headers of other projects and of the language that most files use, compiled once for all of them: the makefile includes
// this ahead of every file. Every file still includes what it uses, and compiles without this one.

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <eigen3/Eigen/Core>
