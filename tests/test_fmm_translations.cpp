// Expansions side by side in one array: no thread reads what another one writes.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fmm_translations.hpp"

using namespace stokes;

TEST_CASE("the translations of a box do not read what belongs to its neighbours") {
  for (const int order : {8, 15, 16, 23, largest_order}) {
    CAPTURE(order);
    const Translations translations(order);
    Expansions from, to;
    from.resize(3, order);
    to.resize(3, order);
    const int size = 4 * from.stride();
    for (const int neighbour : {0, 2}) std::fill_n(from[neighbour], size, std::numeric_limits<double>::quiet_NaN());
    for (int part = 0; part < 4; ++part)
      for (int k = 0; k <= order; ++k) from[1][part * from.stride() + k] = 1.0 / (1 + k + part);
    translations.multipole_to_multipole(from[1], 2, to[0]);
    translations.multipole_to_local(from[1], offset_number(2, -1), true, to[1]);
    translations.local_to_local(from[1], 3, to[2]);
    for (const int box : {0, 1, 2}) {
      CHECK(std::all_of(to[box], to[box] + size, [](double x) { return std::isfinite(x); }));
      CHECK(std::any_of(to[box], to[box] + size, [](double x) { return x != 0.0; }));
    }
  }
}
