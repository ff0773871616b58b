// CSV tables: `# key: value` lines, one header line, rows.
//
// The reader accepts what spreadsheets and editors produce (CRLF, byte order mark, blank lines, spaces around
// fields, comment lines anywhere, RFC 4180 quotes). It refuses everything else and names file and line.
// The bytes that the writer produces depend only on its arguments.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "text.hpp"

namespace stokes {

// The (key, value) pairs of lines `# key: value`, in order.
using Comments = std::vector<std::pair<std::string, std::string>>;

// A table as text. Rows and columns are counted from 0, lines from 1. Every row has as many fields as
// the header. All errors are InputError with file and line.
struct Table {
  struct Row {
    int line;  // where it starts
    std::vector<std::string> fields;
  };

  std::string file;  // for messages
  int header_line = 1;
  Comments comments;
  std::vector<std::string> header;
  std::vector<Row> rows;

  bool has_column(std::string_view name) const;
  // Throws for a column that is not there, with the nearest name.
  int column(std::string_view name) const;
  // Value of the first comment with this key; empty if there is none.
  std::string comment(std::string_view key) const;

  const std::string& text(int row, int column) const { return rows[row].fields[column]; }
  // A finite number; anything else throws.
  double finite_number(int row, int column) const;
  // The same, but nan, inf and -inf are numbers too, and an empty field is nan.
  double number(int row, int column) const;
  // number() down a column.
  std::vector<double> numbers(std::string_view column_name) const;

  // "file:line" of a row, and of the header.
  std::string where(int row) const { return concat(file, ":", rows[row].line); }
  std::string where_header() const { return concat(file, ":", header_line); }
};

// Throws InputError for a file that is missing, a folder, unreadable or without a header line, a column
// without a name or named twice, a row with too few or too many fields, a broken quote.
Table read_csv(const std::filesystem::path& path);
Table parse_csv(std::string_view content, const std::string& file_name);

// One field of a row: numbers by format_number, text quoted where a reader needs it.
std::string csv_field(std::string_view text);
template <class Number>
  requires std::is_arithmetic_v<Number>
std::string csv_field(Number value) {
  return format_number(value);
}
template <class T>
concept CsvField = std::is_arithmetic_v<T> || std::is_convertible_v<const T&, std::string_view>;

// Writes a table row by row. Opening throws InputError; the folder must exist. A failed write throws
// NumericalError, at the latest in flush() or close(). The destructor closes the file without checking for
// errors, so call close() at the end of the work.
class CsvWriter {
 public:
  CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& header,
            const Comments& comments = {});
  // Continues an existing table after its first `bytes` bytes, which must end with a line. Everything behind them is
  // cut off. InputError if the file cannot be written.
  static CsvWriter continued(const std::filesystem::path& path, std::size_t columns, std::uintmax_t bytes);

  // Length of the file once everything is flushed.
  std::uintmax_t bytes() const { return bytes_; }

  // One field for each column: numbers or text. Another count is a program error (std::logic_error).
  template <CsvField... Fields>
  void row(const Fields&... fields) {
    write_row({csv_field(fields)...});
  }
  // nan is an empty field, and whole numbers have all their digits: 100000, not 1e+05.
  void row(std::span<const double> fields);

  void flush();
  // flush(), and the file is on disk: it survives a machine that stops.
  void sync();
  void close();
  // After a failed write: closes the file without a further error and removes everything behind its first `bytes`
  // bytes, such as part of a row. Writing another row afterwards is a program error.
  void close_after(std::uintmax_t bytes);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  CsvWriter(std::string name, std::size_t columns, std::uintmax_t bytes, const char* mode);
  void write(std::string_view text);
  void write_row(const std::vector<std::string>& fields);
  [[noreturn]] void fail() const;

  std::string name_;
  std::size_t columns_;
  std::uintmax_t bytes_;
  std::unique_ptr<std::FILE, Close> file_;
};

// A function that writes returns once other processes see the data, or once the data are on disk.
enum class Until { visible, on_disk };

// Replaces a file as a whole. A reader sees the old content or the new, never a part, even if this process is killed or,
// with Until::on_disk, the machine stops. A file <path>.tmp may stay behind. Throws InputError if the new file cannot be
// created, NumericalError if it cannot be completed. The old file is then untouched.
void write_file_atomically(const std::filesystem::path& path, std::string_view content, Until until = Until::visible);

}  // namespace stokes
