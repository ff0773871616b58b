// Mutated input is refused or read, and defects that fuzzing once found stay fixed. `make fuzz` tries far more input.
#include <doctest/doctest.h>

#include "case.hpp"
#include "input_fuzzer.hpp"
#include "refusal.hpp"

using namespace stokes;

namespace {

const std::string complete = "bodies = b.csv\nflow = shear\npoints_per_body = 32\ntime_step = 0.1\nend_time = 2\n";

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("2000 mutated inputs are refused with one line, or accepted finite and without overlaps") {
  const FuzzReport report = fuzz_input(0, 2000, 7);
  CHECK(report.failure == "");
  CHECK(report.mutations == 2000);
  // Some input is refused and some accepted.
  CHECK(report.accepted_suspensions > 100);
  CHECK(report.accepted_suspensions < report.accepted_cases);
  CHECK(report.accepted_cases < 2000);
}

TEST_CASE("mutations are the same ones in any batch") {
  const FuzzReport whole = fuzz_input(0, 200, 3), first = fuzz_input(0, 70, 3), second = fuzz_input(70, 130, 3);
  CHECK(whole.accepted_cases == first.accepted_cases + second.accepted_cases);
  CHECK(whole.accepted_suspensions == first.accepted_suspensions + second.accepted_suspensions);
}

TEST_CASE("a name longer than a file can have is refused") {
  const auto parse = [](const std::string& output) {
    return refusal([&] { parse_case(concat(complete, "output = ", output, "\n"), "case.txt"); });
  };
  CHECK(parse("out") == "accepted");
  CHECK(contains(parse(std::string(300, 'x')), "cannot be the output folder"));
  CHECK(contains(parse(std::string(5000, 'x')), "cannot be the output folder"));
}

TEST_CASE("a separation beyond every length is refused") {
  for (const char* key : {"min_separation", "min_separation_length"}) {
    const std::string text = concat(complete, "output = out\n", key, " = ");
    CHECK(refusal([&] { parse_case(text + "1e100\n", "case.txt"); }) == "accepted");
    CHECK(contains(refusal([&] { parse_case(text + "1.1e100\n", "case.txt"); }), "is above 1e100"));
  }
}

TEST_CASE("a semi-axis whose square is no number is refused") {
  const std::string header = "a,b,x,y,theta\n";
  CHECK(refusal([&] { parse_bodies(header + "1e-100,1,0,0,0\n", "b.csv"); }) == "accepted");
  CHECK(contains(refusal([&] { parse_bodies(header + "1,9e-101,0,0,0\n", "b.csv"); }), "b.csv:2: the semi-axis b"));
}

TEST_CASE("piles of many bodies are refused without looking at every pair, and close but separate ones are not") {
  std::string same = "a,b,x,y,theta\n", close = same, crowd = same, lattice = same;
  for (int k = 0; k < 20000; ++k) {
    same += ".1,2,6,-3,.75\n";
    close += concat(".1,.2,", 1e-6 * k, ",3,.75\n");
    crowd += concat("1,1,", k % 140, ",", k / 140, ",0\n");  // a wrong unit: radii as large as distances
    lattice += concat("1,1,", 2.001 * (k % 140), ",", 2.001 * (k / 140), ",0\n");
  }
  CHECK(contains(refusal([&] { parse_bodies(same, "b.csv"); }), "overlap by"));
  CHECK(contains(refusal([&] { parse_bodies(close, "b.csv"); }), "overlap by"));
  CHECK(contains(refusal([&] { parse_bodies(crowd, "b.csv"); }), "overlap by"));
  CHECK(refusal([&] { parse_bodies(lattice, "b.csv"); }) == "accepted");
}
