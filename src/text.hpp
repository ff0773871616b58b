// Text input and output: numbers that read back to the same bits, strict parsing, suggestions for misspelt names.
//
// Nothing here depends on the locale. Parsing never guesses: a token is a number or it is not.
#pragma once

#include <concepts>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace stokes {

// Shortest decimal form that reads back to the same double; nan, inf and -inf are spelled so.
std::string format_number(double value);
std::string format_integer(long long value);
// With four digits, for messages.
std::string brief(double value);
template <std::integral Integer>
std::string format_number(Integer value) {
  return format_integer(static_cast<long long>(value));
}

// The whole token as a finite decimal number, or nothing. A leading '+' is allowed; nan, inf, spaces,
// hexadecimal forms, trailing characters and magnitudes a double cannot hold are refused.
std::optional<double> parse_number(std::string_view token);
// The same for a whole number: 32, but neither 32.0 nor 3e1.
std::optional<long long> parse_integer(std::string_view token);

// Removes white space, line ends included, from both ends.
std::string_view trim(std::string_view text);
// The pieces between separators, not trimmed. There is always at least one.
std::vector<std::string_view> split(std::string_view text, char separator);

// 'text' for a message: cut after 60 bytes, control characters shown as '?', so that it stays one line.
std::string quote(std::string_view text);
// The words with `separator` between them.
std::string join(const std::vector<std::string>& words, std::string_view separator);

// The word followed by spaces up to `width`, at least one.
std::string padded(std::string_view word, std::size_t width);

// Number of insertions, deletions, substitutions and swaps of neighbours between two words.
int edit_distance(std::string_view from, std::string_view to);
// The name that `word` most likely stands for: the one of smallest edit distance, ignoring case. A name that contains the
// word, or is contained in it, counts as near. Of equally near names the first is taken.
std::string nearest_name(std::string_view word, const std::vector<std::string>& names);
// "did you mean 'name'? " with the nearest name if it is at most two letters away and half of its letters agree, or if one
// contains the other. Otherwise empty.
std::string suggestion(std::string_view word, const std::vector<std::string>& names);

// The content of a file without its UTF-8 byte order mark, line ends of '\r' alone as '\n'. Throws InputError for a file
// that is missing, is a folder, cannot be read or is UTF-16; `what` names its role, as in "the case file".
std::string read_text_file(const std::filesystem::path& path, std::string_view what);

// The parts one after the other: text as it is, numbers by format_number.
template <class... Parts>
std::string concat(const Parts&... parts) {
  std::string result;
  [[maybe_unused]] const auto append = [&result](const auto& part) {
    using Part = std::remove_cvref_t<decltype(part)>;
    if constexpr (std::is_same_v<Part, char>) {
      result += part;
    } else if constexpr (std::is_convertible_v<const Part&, std::string_view>) {
      result += std::string_view(part);
    } else {
      result += format_number(part);
    }
  };
  (append(parts), ...);
  return result;
}

}  // namespace stokes
