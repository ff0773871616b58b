#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>

#include "base.hpp"
#include "csv.hpp"

using namespace stokes;
namespace fs = std::filesystem;

namespace {

// A fresh folder for the files of one test.
struct Folder {
  fs::path path;
  Folder() {
    std::random_device random;
    do path = fs::temp_directory_path() / concat("stokes_csv_", random());
    while (!fs::create_directory(path));
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

std::string content(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

// The message with which a text is refused.
std::string refusal(std::string_view text) {
  try {
    parse_csv(text, "t.csv");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

#define CHECK_CONTAINS(text, part) CHECK_MESSAGE((text).find(part) != std::string::npos, (text))

using Fields = std::vector<std::string>;

}  // namespace

TEST_CASE("a table has its comments, header and rows with their lines") {
  const Table table = parse_csv("# seed: 7\n# a note\nx,y\n1,2\n\n# unit: length: m\n3,4\n", "t.csv");
  CHECK(table.comments == Comments{{"seed", "7"}, {"unit", "length: m"}});
  CHECK(table.comment("seed") == "7");
  CHECK(table.comment("none") == "");
  CHECK(table.header == Fields{"x", "y"});
  REQUIRE(table.rows.size() == 2);
  CHECK(table.where_header() == "t.csv:3");
  CHECK(table.where(0) == "t.csv:4");
  CHECK(table.where(1) == "t.csv:7");
  CHECK(table.rows[1].fields == Fields{"3", "4"});
  CHECK(table.numbers("y") == std::vector<double>{2.0, 4.0});
}

TEST_CASE("line ends, byte order mark, blanks and spaces do not matter") {
  const std::string plain = "# k: v\nx,y\n1,2\n3,4\n";
  const Table expected = parse_csv(plain, "t.csv");
  for (const std::string text : {"\xEF\xBB\xBF# k: v\r\nx,y\r\n1,2\r\n3,4\r\n", "# k: v\nx,y\n1,2\n3,4",
                                 "\n  \n#k:v\n\t x ,  y\t\n\n 1 ,2 \n \r\n   # more\n3,\t4\n\n"}) {
    const Table table = parse_csv(text, "t.csv");
    CHECK(table.comments == expected.comments);
    CHECK(table.header == expected.header);
    REQUIRE(table.rows.size() == 2);
    for (int i = 0; i < 2; ++i) CHECK(table.rows[i].fields == expected.rows[i].fields);
  }
}

TEST_CASE("quoted fields hold commas, quotes, line ends, spaces and number signs") {
  const Table table = parse_csv(
      "name,value\n\"a,b\",1\n \"say \"\"hi\"\"\" ,2\n\"two\nlines\",3\n\"# no comment\",\"\"\n",
      "t.csv");
  REQUIRE(table.rows.size() == 4);
  CHECK(table.text(0, 0) == "a,b");
  CHECK(table.text(1, 0) == "say \"hi\"");
  CHECK(table.text(2, 0) == "two\nlines");
  CHECK(table.text(3, 0) == "# no comment");
  CHECK(table.text(3, 1) == "");
  CHECK(table.where(2) == "t.csv:4");
  CHECK(table.where(3) == "t.csv:6");
}

TEST_CASE("a malformed table is refused with file, line and what is expected") {
  CHECK_CONTAINS(refusal("x,y\n1,2\n3\n"), "t.csv:3: too few fields: 1 where 2 are expected ('x,y')");
  CHECK_CONTAINS(refusal("x,y\n\n1,2,3\n"), "t.csv:3: too many fields: 3 where 2 are expected");
  CHECK_CONTAINS(refusal("x,y\n1,2,\n"), "t.csv:2: too many fields: 3 where 2");
  CHECK_CONTAINS(refusal(""), "t.csv:1: the file is empty");
  CHECK_CONTAINS(refusal("# only: this\n\n"), "the file is empty");
  CHECK_CONTAINS(refusal("# c\nx,y,x\n"), "t.csv:2: column 'x' is there twice (fields 1 and 3)");
  CHECK_CONTAINS(refusal("x,y,\n"), "t.csv:1: column 3 of 3 has no name");
  CHECK_CONTAINS(refusal("x\n\"1\n2\n"), "t.csv:2: a quoted field is never closed");
  CHECK_CONTAINS(refusal("x\n\"1\"2\n"), "t.csv:2: text '2' follows a quoted field");
}

TEST_CASE("a number in a table is refused with file, line and column") {
  const Table table = parse_csv("x,theta\n1,+2.5\n1,abc\n1,nan\n1,-inf\n1,\n", "t.csv");
  CHECK(table.column("theta") == 1);
  CHECK(table.finite_number(0, 1) == 2.5);
  CHECK_THROWS_WITH_AS(table.finite_number(1, 1),
                       doctest::Contains("t.csv:3: column 'theta': 'abc' is not a finite number"),
                       InputError);
  CHECK_THROWS_WITH_AS(table.finite_number(2, 1), doctest::Contains("t.csv:4: column 'theta': 'nan'"),
                       InputError);
  CHECK_THROWS_WITH_AS(table.finite_number(3, 1), doctest::Contains("t.csv:5: column 'theta': '-inf'"),
                       InputError);
  CHECK(std::isnan(table.number(4, 1)));
  CHECK_THROWS_WITH_AS(table.finite_number(4, 1), doctest::Contains("t.csv:6: column 'theta': ''"), InputError);
  CHECK(std::isnan(table.number(2, 1)));
  CHECK(table.number(3, 1) == -std::numeric_limits<double>::infinity());
  CHECK_THROWS_WITH_AS(
      table.column("thetta"),
      doctest::Contains("t.csv:1: there is no column 'thetta' among 'x,theta'; the nearest is 'theta'"),
      InputError);
}

TEST_CASE("a table that is missing or a folder is refused") {
  const Folder folder;
  CHECK_THROWS_WITH_AS(read_csv(folder.path), doctest::Contains("is a folder"), InputError);
  CHECK_THROWS_WITH_AS(read_csv(folder.path / "no.csv"), doctest::Contains("no.csv: cannot open"),
                       InputError);
}

TEST_CASE("a written table is comments, header and rows, byte for byte") {
  const Folder folder;
  const fs::path path = folder.path / "t.csv";
  CsvWriter writer(path, {"step", "x", "note"}, {{"version", "1"}, {"text", "two\nlines"}});
  writer.row(0, 0.1, "plain");
  writer.row(1L, std::numeric_limits<double>::quiet_NaN(), std::string("a,\"b\""));
  writer.row(std::vector<double>{2.0, std::numeric_limits<double>::infinity(), -0.5});
  CHECK_THROWS_AS(writer.row(1, 2), std::logic_error);
  writer.close();
  CHECK(
      content(path) ==
      "# version: 1\n# text: two lines\nstep,x,note\n0,0.1,plain\n1,nan,\"a,\"\"b\"\"\"\n2,inf,-0.5\n");
  CHECK_THROWS_AS(writer.row(1, 2, 3), std::logic_error);
}

TEST_CASE("random tables of numbers and of awkward text read back as written") {
  const Folder folder;
  std::mt19937_64 random(3);
  constexpr std::string_view letters = " ,\"\n\r#:ab\t";
  std::vector<std::pair<double, std::string>> rows;
  const auto path = folder.path / "t.csv", words = folder.path / "words.csv";
  CsvWriter writer(path, {"text", "number"}), one_column(words, {"text"});
  for (int i = 0; i < 2000; ++i) {
    std::string text(random() % 6, ' ');
    for (char& c : text) c = letters[random() % letters.size()];
    rows.emplace_back(std::bit_cast<double>(random()), text);
    writer.row(text, rows.back().first);
    one_column.row(text);
  }
  writer.close();
  one_column.close();
  const Table table = read_csv(path), texts = read_csv(words);
  REQUIRE(table.rows.size() == rows.size());
  REQUIRE(texts.rows.size() == rows.size());
  for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
    const auto& [number, text] = rows[i];
    REQUIRE(table.text(i, 0) == text);
    REQUIRE(texts.text(i, 0) == text);
    const double back = table.number(i, 1);
    REQUIRE((std::isnan(number)
                 ? std::isnan(back)
                 : std::bit_cast<std::uint64_t>(back) == std::bit_cast<std::uint64_t>(number)));
  }
}

TEST_CASE("rows written before a writer is dropped without close are kept") {
  const Folder folder;
  const fs::path path = folder.path / "t.csv";
  {
    CsvWriter writer(path, {"x"});
    writer.row(1);
    writer.flush();
    CHECK(content(path) == "x\n1\n");
    writer.row(2);
  }
  CHECK(content(path) == "x\n1\n2\n");
}

TEST_CASE("a file that cannot be created is an input error") {
  const Folder folder;
  CHECK_THROWS_WITH_AS(CsvWriter(folder.path / "no" / "t.csv", {"x"}),
                       doctest::Contains("t.csv: cannot create"), InputError);
  CHECK_THROWS_WITH_AS(CsvWriter(folder.path, {"x"}), doctest::Contains("cannot create"), InputError);
  CHECK_THROWS_WITH_AS(write_file_atomically(folder.path / "no" / "t.txt", ""),
                       doctest::Contains("t.txt: cannot create"), InputError);
}

TEST_CASE("a full disk is a numerical error that names the file") {
  if (!fs::exists("/dev/full")) return;
  CsvWriter flushed("/dev/full", {"x"});
  CHECK_THROWS_WITH_AS(flushed.flush(), doctest::Contains("/dev/full: cannot write"), NumericalError);
  CsvWriter closed("/dev/full", {"x"});
  CHECK_THROWS_WITH_AS(closed.close(), doctest::Contains("/dev/full: cannot write"), NumericalError);
  CsvWriter written("/dev/full", {"x"});
  const auto fill = [&written] {
    for (int i = 0; i < 1000000; ++i) written.row(i);
  };
  CHECK_THROWS_WITH_AS(fill(), doctest::Contains("/dev/full: cannot write"), NumericalError);
}

TEST_CASE("a file is replaced as a whole or not at all") {
  const Folder folder;
  const fs::path path = folder.path / "state.txt";
  write_file_atomically(path, "old");
  write_file_atomically(path, std::string("new\0bytes\n", 10));
  CHECK(content(path) == std::string("new\0bytes\n", 10));
  CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 1);

  // A folder with the name of the file cannot be replaced; nothing is left behind.
  fs::create_directory(folder.path / "taken");
  std::ofstream(folder.path / "taken" / "file") << "x";
  CHECK_THROWS_WITH_AS(write_file_atomically(folder.path / "taken", "x"),
                       doctest::Contains("taken: cannot write"), NumericalError);
  CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 2);
}

TEST_CASE("rows of numbers have empty fields for nan and all digits of whole numbers, which read back the same") {
  const Folder folder;
  const std::filesystem::path path = folder.path / "numbers.csv";
  const std::vector<double> row = {100000.0, std::nan(""), -7e14, 1e15, 1e300, -0.0, 0.1, 2.0};
  CsvWriter writer(path, {"a", "b", "c", "d", "e", "f", "g", "h"});
  writer.row(row);
  writer.close();
  std::ifstream file(path);
  std::string header, line;
  std::getline(file, header), std::getline(file, line);
  CHECK(line == "100000,,-700000000000000,1e+15,1e+300,-0,0.1,2");
  const Table table = read_csv(path);
  for (int k = 0; k < static_cast<int>(row.size()); ++k) {
    const double back = table.number(0, k);
    CHECK((std::isnan(back) ? std::isnan(row[k]) : back == row[k]));
    CHECK(std::signbit(back) == std::signbit(row[k]));
  }
  CHECK_THROWS_AS(table.finite_number(0, 1), InputError);
}
