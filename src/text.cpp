#include "text.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>
#include <system_error>

#include "base.hpp"

namespace stokes {

namespace {

// from_chars knows no '+', and "+-1" must not become -1.
std::optional<std::string_view> without_plus(std::string_view token) {
  if (token.empty() || token.front() != '+') return token;
  token.remove_prefix(1);
  if (token.empty() || token.front() == '-') return std::nullopt;
  return token;
}

template <class Number>
std::optional<Number> parse_whole(std::string_view token) {
  const auto digits = without_plus(token);
  if (!digits) return std::nullopt;
  Number value{};
  const char* const end = digits->data() + digits->size();
  const auto [stop, error] = std::from_chars(digits->data(), end, value);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return value;
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

// A thousand for each edit, ignoring case. An abbreviation (min_sep) is nearer than a word with some
// of the same letters: it scores between one edit and two, the closest length first. A very long word is cut.
long distance_score(std::string_view word, const std::string& name) {
  constexpr std::size_t longest = 64;
  const std::string given = lower_case(word.substr(0, longest)), known = lower_case(name);
  const long score = 1000L * edit_distance(given, known);
  const bool part = known.find(given) != std::string::npos || given.find(known) != std::string::npos;
  if (!part || given.size() < 3 || known.size() < 3) return score;
  return std::min(score, 1500L + std::abs(static_cast<long>(given.size()) - static_cast<long>(known.size())));
}

}  // namespace

std::string format_number(double value) {
  if (std::isnan(value)) return "nan";  // its sign bit, which to_chars shows, means nothing
  char buffer[32];                      // the longest double has 24 characters
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

std::string format_integer(long long value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

std::string brief(double value) {
  if (!std::isfinite(value)) return format_number(value);
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 4).ptr};
}

std::optional<double> parse_number(std::string_view token) {
  const auto value = parse_whole<double>(token);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<long long> parse_integer(std::string_view token) { return parse_whole<long long>(token); }

std::string_view trim(std::string_view text) {
  constexpr std::string_view space = " \t\r\n\v\f";
  const auto first = text.find_first_not_of(space);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(space) - first + 1);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> pieces;
  for (;;) {
    const auto at = text.find(separator);
    pieces.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return pieces;
    text.remove_prefix(at + 1);
  }
}

std::string quote(std::string_view text) {
  constexpr std::size_t longest = 60;
  std::size_t length = std::min(text.size(), longest);
  if (length < text.size())  // not inside a UTF-8 sequence
    while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80) --length;
  std::string shown(text.substr(0, length));
  for (char& c : shown)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  return "'" + shown + (length < text.size() ? "..." : "") + "'";
}

std::string join(const std::vector<std::string>& words, std::string_view separator) {
  std::string result;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) result += separator;
    result += words[i];
  }
  return result;
}

int edit_distance(std::string_view from, std::string_view to) {
  // Row i of the table holds the distances from the first i letters; a swap looks two rows back.
  std::vector<int> before_last(to.size() + 1), last(to.size() + 1), row(to.size() + 1);
  for (std::size_t j = 0; j <= to.size(); ++j) row[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= from.size(); ++i) {
    std::swap(before_last, last);
    std::swap(last, row);
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= to.size(); ++j) {
      const int change = last[j - 1] + (from[i - 1] == to[j - 1] ? 0 : 1);
      row[j] = std::min({change, last[j] + 1, row[j - 1] + 1});
      if (i > 1 && j > 1 && from[i - 1] == to[j - 2] && from[i - 2] == to[j - 1])
        row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row[to.size()];
}

std::string nearest_name(std::string_view word, const std::vector<std::string>& names) {
  std::string best;
  long best_score = 0;
  for (const std::string& name : names) {
    const long score = distance_score(word, name);
    if (best.empty() || score < best_score) best = name, best_score = score;
  }
  return best;
}

std::string suggestion(std::string_view word, const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(word, names);
  const long near = std::min(2000L, 500L * static_cast<long>(word.size()));  // at most half of the letters
  if (nearest.empty() || (distance_score(word, nearest) > near && !nearest.starts_with(word))) return {};
  return concat("did you mean ", quote(nearest), "? ");
}

std::string read_text_file(const std::filesystem::path& path, std::string_view what) {
  const std::string name = path.string();
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    throw InputError(concat(name, ": ", what, " is a folder; name a file in it."));
  const auto close = [](std::FILE* file) { std::fclose(file); };
  const std::unique_ptr<std::FILE, decltype(close)> file(std::fopen(name.c_str(), "rb"), close);
  if (!file) {
    throw InputError(concat(name, ": cannot open ", what, ": ", std::generic_category().message(errno),
                            "; check its name and the folder it is looked for in."));
  }
  std::string text;
  char block[1 << 14];
  for (std::size_t count; (count = std::fread(block, 1, sizeof block, file.get())) > 0;)
    text.append(block, count);
  if (std::ferror(file.get()))
    throw InputError(
        concat(name, ": cannot read ", what, ": ", std::generic_category().message(errno), "."));
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    throw InputError(concat(name, ": ", what, " is a text in UTF-16; save it as UTF-8 or plain text."));
  // Lines of old Macintosh files.
  if (text.find('\n') == std::string::npos) std::replace(text.begin(), text.end(), '\r', '\n');
  return text;
}

std::string padded(std::string_view word, std::size_t width) {
  return std::string(word) + std::string(word.size() < width ? width - word.size() : 1, ' ');
}

}  // namespace stokes
