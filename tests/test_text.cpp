#include <doctest/doctest.h>

#include <bit>
#include <clocale>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "base.hpp"
#include "text.hpp"

using namespace stokes;

TEST_CASE("every finite double reads back to the same bits") {
  std::mt19937_64 random(1);
  int tested = 0;
  while (tested < 100000) {
    const double value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    ++tested;
    const auto back = parse_number(format_number(value));
    REQUIRE(back.has_value());
    REQUIRE(std::bit_cast<std::uint64_t>(*back) == std::bit_cast<std::uint64_t>(value));
  }
  using Limits = std::numeric_limits<double>;
  for (const double value :
       {0.0, -0.0, Limits::min(), Limits::max(), Limits::lowest(), Limits::denorm_min()})
    CHECK(std::bit_cast<std::uint64_t>(parse_number(format_number(value)).value()) ==
          std::bit_cast<std::uint64_t>(value));
}

TEST_CASE("numbers are written in the shortest form") {
  CHECK(format_number(0.1) == "0.1");
  CHECK(format_number(1.0) == "1");
  CHECK(format_number(1e-8) == "1e-08");
  CHECK(format_number(-2.5) == "-2.5");
  CHECK(format_number(std::numeric_limits<double>::quiet_NaN()) == "nan");
  CHECK(format_number(-std::numeric_limits<double>::quiet_NaN()) == "nan");
  CHECK(format_number(std::numeric_limits<double>::infinity()) == "inf");
  CHECK(format_number(-std::numeric_limits<double>::infinity()) == "-inf");
  CHECK(format_number(-7) == "-7");
  CHECK(format_number(std::size_t{12}) == "12");
  CHECK(format_number(std::numeric_limits<long long>::min()) == "-9223372036854775808");
}

TEST_CASE("numbers do not follow the locale") {
  // A machine may lack these locales; those it has must change nothing.
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"C", "de_DE.UTF-8", "fr_FR.UTF-8", "C.utf8"}) {
    if (!std::setlocale(LC_ALL, name)) continue;
    CHECK(format_number(1234567.5) == "1234567.5");
    CHECK(parse_number("1.5") == 1.5);
    CHECK_FALSE(parse_number("1,5").has_value());
  }
  std::setlocale(LC_ALL, before.c_str());
}

TEST_CASE("a token is a number as a whole or not at all") {
  CHECK(parse_number("+1.5") == 1.5);
  CHECK(parse_number("-.5e-1") == -0.05);
  CHECK(parse_number("3.") == 3.0);
  CHECK(parse_number("1E3") == 1000.0);
  for (const char* token :
       {"",   "+",   "-",     "+-1",    "-+1", "++1", "1x",  "x",    "0x10", "1e",       "1 2", " 1",
        "1 ", "1,5", "1e400", "-1e400", "nan", "NaN", "inf", "-inf", "+inf", "infinity", "1d3", "."}) {
    INFO(token);
    CHECK_FALSE(parse_number(token).has_value());
  }
  CHECK(parse_integer("+32") == 32);
  CHECK(parse_integer("-7") == -7);
  for (const char* token : {"", "+", "+-1", "32.0", "3e1", "0x10", "9223372036854775808", " 1", "1 "}) {
    INFO(token);
    CHECK_FALSE(parse_integer(token).has_value());
  }
}

TEST_CASE("trim removes white space at the ends only, split keeps empty pieces") {
  CHECK(trim(" \t a b \r\n") == "a b");
  CHECK(trim(" \n") == "");
  CHECK(split("a,,b", ',') == std::vector<std::string_view>{"a", "", "b"});
  CHECK(split("", ',') == std::vector<std::string_view>{""});
  CHECK(split("a,", ',') == std::vector<std::string_view>{"a", ""});
}

TEST_CASE("a quoted text stays one short line") {
  CHECK(quote("abc") == "'abc'");
  CHECK(quote("a\nb\x01") == "'a?b?'");
  CHECK(quote(std::string(100, 'x')) == concat("'", std::string(60, 'x'), "...'"));
  // The two bytes of an e with an accent are not parted.
  CHECK(quote(std::string(59, 'x') + "\xC3\xA9y") == concat("'", std::string(59, 'x'), "...'"));
}

TEST_CASE("edit distance counts insertions, deletions, substitutions and swaps") {
  CHECK(edit_distance("", "abc") == 3);
  CHECK(edit_distance("abc", "") == 3);
  CHECK(edit_distance("rate", "rate") == 0);
  CHECK(edit_distance("rtae", "rate") == 1);
  CHECK(edit_distance("kitten", "sitting") == 3);
  std::mt19937_64 random(2);
  const auto word = [&] {
    std::string text(random() % 8, 'a');
    for (char& c : text) c = static_cast<char>('a' + random() % 3);
    return text;
  };
  for (int i = 0; i < 1000; ++i) {
    const std::string u = word(), v = word();
    CHECK(edit_distance(u, v) == edit_distance(v, u));
    CHECK((edit_distance(u, v) == 0) == (u == v));
  }
}

TEST_CASE("the nearest name is the one a user meant") {
  const std::vector<std::string> names = {"rate",
                                          "time_step",
                                          "end_time",
                                          "min_separation",
                                          "min_separation_length",
                                          "gmres_tolerance",
                                          "points_per_body"};
  CHECK(nearest_name("rat", names) == "rate");
  CHECK(nearest_name("timestep", names) == "time_step");
  CHECK(nearest_name("Time-Step", names) == "time_step");
  CHECK(nearest_name("endtime", names) == "end_time");
  CHECK(nearest_name("min_sep", names) == "min_separation");
  CHECK(nearest_name("tolerance", names) == "gmres_tolerance");
  CHECK(nearest_name("point_per_body", names) == "points_per_body");
  CHECK(nearest_name("min_separation_lenght", names) == "min_separation_length");
  CHECK(nearest_name("FLOW", {"rate", "flow"}) == "flow");
  CHECK(nearest_name("anything", {}) == "");
  CHECK(nearest_name(std::string(1000000, 'r'), names) != "");
}

TEST_CASE("concat writes text as it is and numbers by format_number") {
  CHECK(concat("x = ", 0.1, ", n = ", 3, ' ', std::string("end"), std::string_view("!")) ==
        "x = 0.1, n = 3 end!");
  CHECK(concat() == "");
}

TEST_CASE("a file that cannot be read is an input error that names it") {
  const auto folder = std::filesystem::temp_directory_path();
  CHECK_THROWS_WITH_AS(read_text_file(folder, "the case file"),
                       doctest::Contains("the case file is a folder"), InputError);
  CHECK_THROWS_WITH_AS(read_text_file(folder / "not-there-5d1c.txt", "the case file"),
                       doctest::Contains("not-there-5d1c.txt: cannot open the case file"), InputError);
}

TEST_CASE("a suggestion is at most two letters away, or a part") {
  const std::vector<std::string> names = {"rate", "time_step", "gmres_tolerance"};
  CHECK(suggestion("rtae", names) == "did you mean 'rate'? ");
  CHECK(suggestion("timestp", names) == "did you mean 'time_step'? ");
  CHECK(suggestion("tolerance", names) == "did you mean 'gmres_tolerance'? ");
  CHECK(suggestion("r", names) == "did you mean 'rate'? ");
  CHECK(suggestion("dt", names) == "");
  CHECK(suggestion("viscosity", names) == "");
  CHECK(suggestion("anything", {}) == "");
}

TEST_CASE("a number in a message has four digits") {
  CHECK(brief(0.1733333333) == "0.1733");
  CHECK(brief(-2.0) == "-2");
  CHECK(brief(1.23456789e-7) == "1.235e-07");
  CHECK(brief(std::numeric_limits<double>::quiet_NaN()) == "nan");
}
