#include "csv.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <limits>
#include <system_error>

#include "base.hpp"

namespace stokes {

namespace {

std::string system_message() { return std::generic_category().message(errno); }

// Special files cannot be written to a disk.
bool is_on_disk(int file) { return fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP; }

class Parser {
 public:
  Parser(std::string_view content, const std::string& file) : rest_(content) {
    if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
    table_.file = file;
  }

  Table parse() {
    while (!rest_.empty()) {
      const std::string_view line = trim(rest_.substr(0, rest_.find('\n')));
      if (line.empty() || line.front() == '#') {
        if (!line.empty()) add_comment(trim(line.substr(1)));
        skip_line();
        continue;
      }
      Table::Row row{line_, record()};
      if (table_.header.empty()) {
        table_.header_line = row.line;
        set_header(std::move(row.fields));
      } else {
        add_row(std::move(row));
      }
    }
    if (table_.header.empty())
      fail(1, "the file is empty; its first line must name the columns, as in 'a,b,x,y,theta'.");
    return std::move(table_);
  }

 private:
  template <class... Parts>
  [[noreturn]] void fail(int line, const Parts&... parts) const {
    throw InputError(concat(table_.file, ":", line, ": ", parts...));
  }

  void skip_line() {
    const auto end = rest_.find('\n');
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++line_;
  }

  void add_comment(std::string_view text) {
    const auto colon = text.find(':');
    if (colon == std::string_view::npos) return;
    table_.comments.emplace_back(trim(text.substr(0, colon)), trim(text.substr(colon + 1)));
  }

  void skip_spaces() {
    while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\t')) rest_.remove_prefix(1);
  }

  // Fields up to the end of the line that no quote protects; that line end is consumed.
  std::vector<std::string> record() {
    std::vector<std::string> fields;
    for (;;) {
      skip_spaces();
      if (rest_.starts_with('"')) {
        fields.push_back(quoted_field());
      } else {
        const auto end = std::min(rest_.find_first_of(",\n"), rest_.size());
        fields.emplace_back(trim(rest_.substr(0, end)));
        rest_.remove_prefix(end);
      }
      if (!rest_.starts_with(',')) break;
      rest_.remove_prefix(1);
    }
    skip_line();
    return fields;
  }

  std::string quoted_field() {
    const int opened = line_;
    std::string field;
    for (rest_.remove_prefix(1);; rest_.remove_prefix(1)) {
      if (rest_.empty()) fail(opened, "a quoted field is never closed; add the missing '\"'.");
      if (rest_.starts_with("\"\"")) {
        rest_.remove_prefix(1);  // a doubled quote is one
      } else if (rest_.front() == '"') {
        break;
      }
      if (rest_.front() == '\n') ++line_;
      field += rest_.front();
    }
    rest_.remove_prefix(1);
    const auto end = std::min(rest_.find_first_of(",\n"), rest_.size());
    const std::string_view after = trim(rest_.substr(0, end));
    if (!after.empty()) {
      fail(line_, "text ", quote(after),
           " follows a quoted field; write a quote inside a field twice, and a comma between fields.");
    }
    rest_.remove_prefix(end);
    return field;
  }

  void set_header(std::vector<std::string> names) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i].empty()) {
        fail(table_.header_line, "column ", i + 1, " of ", names.size(),
             " has no name; remove the extra comma or name the column.");
      }
      const auto first = std::find(names.begin(), names.begin() + static_cast<long>(i), names[i]);
      if (first != names.begin() + static_cast<long>(i)) {
        fail(table_.header_line, "column ", quote(names[i]), " is there twice (fields ",
             first - names.begin() + 1, " and ", i + 1, "); keep one.");
      }
    }
    table_.header = std::move(names);
  }

  void add_row(Table::Row row) {
    const std::size_t expected = table_.header.size(), got = row.fields.size();
    if (got != expected) {
      fail(row.line, "too ", got < expected ? "few" : "many", " fields: ", got, " where ", expected,
           " are expected (", quote(join(table_.header, ",")), "); ",
           got < expected ? "complete the row." : "remove what is too much.");
    }
    table_.rows.push_back(std::move(row));
  }

  std::string_view rest_;
  int line_ = 1;
  Table table_;
};

// The new name of a file is on disk once its folder is. Not every file system supports this for a folder.
void sync_folder(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const int opened = open(folder.c_str(), O_RDONLY | O_CLOEXEC);
  if (opened < 0) return;
  fsync(opened);
  ::close(opened);
}

std::string one_line(std::string text) {
  for (char& c : text)
    if (c == '\n' || c == '\r') c = ' ';
  return text;
}

}  // namespace

bool Table::has_column(std::string_view name) const {
  return std::find(header.begin(), header.end(), name) != header.end();
}

int Table::column(std::string_view name) const {
  const auto found = std::find(header.begin(), header.end(), name);
  if (found == header.end()) {
    throw InputError(concat(where_header(), ": there is no column ", quote(name), " among ",
                            quote(join(header, ",")), "; the nearest is ",
                            quote(nearest_name(name, header)), "."));
  }
  return static_cast<int>(found - header.begin());
}

std::string Table::comment(std::string_view key) const {
  for (const auto& [name, value] : comments)
    if (name == key) return value;
  return {};
}

double Table::finite_number(int row, int column) const {
  const std::string& field = text(row, column);
  if (const auto value = parse_number(field)) return *value;
  throw InputError(concat(where(row), ": column ", quote(header[column]), ": ", quote(field),
                          " is not a finite number; write it like -0.25 or 1e-3."));
}

double Table::number(int row, int column) const {
  const std::string& field = text(row, column);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (field == "nan" || field.empty()) return std::numeric_limits<double>::quiet_NaN();
  if (field == "inf") return infinity;
  if (field == "-inf") return -infinity;
  return finite_number(row, column);
}

std::vector<double> Table::numbers(std::string_view column_name) const {
  const int at = column(column_name);
  std::vector<double> values(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) values[i] = number(static_cast<int>(i), at);
  return values;
}

Table read_csv(const std::filesystem::path& path) {
  return parse_csv(read_text_file(path, "the table"), path.string());
}

Table parse_csv(std::string_view content, const std::string& file_name) {
  return Parser(content, file_name).parse();
}

std::string csv_field(std::string_view text) {
  // The reader trims, and takes a line that begins with '#' for a comment: quotes keep both.
  const bool plain = text == trim(text) && text.find_first_of(",\"\n\r#") == std::string_view::npos;
  if (plain) return std::string(text);
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + '"';
}

CsvWriter::CsvWriter(std::string name, std::size_t columns, std::uintmax_t bytes, const char* mode)
    : name_(std::move(name)), columns_(columns), bytes_(bytes), file_(std::fopen(name_.c_str(), mode)) {
  if (!file_) {
    throw InputError(concat(name_, ": cannot create the file: ", system_message(),
                            "; check that its folder exists and can be written."));
  }
}

CsvWriter CsvWriter::continued(const std::filesystem::path& path, std::size_t columns, std::uintmax_t bytes) {
  CsvWriter writer(path.string(), columns, bytes, "ab");
  std::error_code error;
  std::filesystem::resize_file(path, bytes, error);
  if (error) {
    throw NumericalError(concat(path.string(), ": cannot be cut to ", bytes, " bytes: ", error.message(),
                                "; choose another output folder."));
  }
  return writer;
}

CsvWriter::CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& header,
                     const Comments& comments)
    : CsvWriter(path.string(), header.size(), 0, "wb") {
  for (const auto& [key, value] : comments) write(one_line(concat("# ", key, ": ", value)) + '\n');
  std::vector<std::string> names;
  for (const std::string& name : header) names.push_back(csv_field(name));
  write(join(names, ",") + '\n');
}

void CsvWriter::row(std::span<const double> fields) {
  std::vector<std::string> texts;
  texts.reserve(fields.size());
  for (const double value : fields) {
    const bool is_whole = value == std::trunc(value) && value != 0.0 && std::abs(value) < 1e15;
    const std::string number = is_whole ? format_integer(static_cast<long long>(value)) : format_number(value);
    texts.push_back(std::isnan(value) ? std::string() : number);
  }
  write_row(texts);
}

void CsvWriter::write_row(const std::vector<std::string>& fields) {
  if (fields.size() != columns_) {
    throw std::logic_error(
        concat(name_, ": a row of ", fields.size(), " fields in a table of ", columns_, " columns"));
  }
  const std::string line = join(fields, ",");
  write((line.empty() ? "\"\"" : line) + '\n');  // a blank line would not be a row
}

void CsvWriter::write(std::string_view text) {
  if (!file_) throw std::logic_error(concat(name_, ": a row after close()"));
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) fail();
  bytes_ += text.size();
}

void CsvWriter::flush() {
  if (file_ && std::fflush(file_.get()) != 0) fail();
}

void CsvWriter::sync() {
  flush();
  if (file_ && !is_on_disk(fileno(file_.get()))) fail();
}

void CsvWriter::close() {
  if (!file_) return;
  // A write that failed earlier leaves its mark in the stream even if the close itself succeeds.
  const bool failed_before = std::ferror(file_.get()) != 0;
  if (std::fclose(file_.release()) != 0 || failed_before) fail();
}

void CsvWriter::close_after(std::uintmax_t bytes) {
  file_.reset();  // may write once more what is in its buffer
  std::error_code ignored;
  const std::uintmax_t size = std::filesystem::file_size(name_, ignored);
  if (!ignored && size > bytes) std::filesystem::resize_file(name_, bytes, ignored);
}

void CsvWriter::fail() const {
  throw NumericalError(concat(name_, ": cannot write: ", system_message(),
                              "; free some space or choose another output folder."));
}

void write_file_atomically(const std::filesystem::path& path, std::string_view content, Until until) {
  const std::string name = path.string(), temporary = name + ".tmp";
  std::FILE* const file = std::fopen(temporary.c_str(), "wb");
  if (!file) {
    throw InputError(concat(name, ": cannot create the file: ", system_message(),
                            "; check that its folder exists and can be written."));
  }
  bool done = std::fwrite(content.data(), 1, content.size(), file) == content.size();
  if (until == Until::on_disk) done = done && std::fflush(file) == 0 && is_on_disk(fileno(file));
  done = std::fclose(file) == 0 && done;
  if (done && std::rename(temporary.c_str(), name.c_str()) == 0) {
    if (until == Until::on_disk) sync_folder(path);
    return;
  }
  const std::string reason = system_message();
  std::remove(temporary.c_str());
  throw NumericalError(
      concat(name, ": cannot write: ", reason, "; free some space or choose another output folder."));
}

}  // namespace stokes
