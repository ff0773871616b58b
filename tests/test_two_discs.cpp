// Two discs in shear, as in the experiments of section 4.1.
#include <doctest/doctest.h>

#include "two_discs.hpp"

using namespace stokes;

// Figure 2 with the densities of the other disc taken from the step before. An independent two-disc simulation gives
// .165, .188 and .236 in three digits. The exact flow returns the disc to its height, so all of it is due to the scheme.
TEST_CASE("locally implicit stepping displaces a disc in shear as an independent simulation says") {
  struct Known {
    double separation_over_h, displacement;
  };
  for (const Known& known : {Known{0.0, 0.165}, Known{2.0, 0.188}, Known{3.0, 0.236}}) {
    CAPTURE(known.separation_over_h);
    TwoDiscs parameters;
    parameters.coupling = Coupling::local;
    parameters.separation_over_h = known.separation_over_h;
    const TwoDiscRun run = complete_two_discs(parameters);
    CHECK(std::abs(run.left.back().imag() - parameters.first.imag() - known.displacement) < 0.002);
  }
}
