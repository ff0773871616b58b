// LaTeX for `report`: text and numbers as source, and the numbers that a document requests.
#pragma once

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base.hpp"
#include "text.hpp"

namespace stokes {

// Plain text with LaTeX's special characters escaped.
inline std::string tex_text(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\') result += "\\textbackslash{}";
    else if (c == '^') result += "\\textasciicircum{}";
    else if (c == '~') result += "\\textasciitilde{}";
    else if (c == '<' || c == '>' || c == '|') result += concat("$", c, "$");
    else if (std::string_view("#$%&_{}").find(c) != std::string_view::npos) result += concat("\\", c);
    else result += c;
  }
  return result;
}

// A sentence of a Markdown file or of a note: Greek letters spelled out, powers like rho^4, indices like sigma_S, quotes
// and `code` become LaTeX.
inline std::string tex_prose(std::string_view text) {
  static const std::map<std::string, std::string, std::less<>> symbols = {
      {"eta", "\\eta"},       {"pi", "\\pi"},       {"rho", "\\rho"},     {"nu", "\\nu"},       {"kappa", "\\kappa"},
      {"lambda", "\\lambda"}, {"gamma", "\\gamma"}, {"sigma", "\\sigma"}, {"delta", "\\delta"}, {"Int", "\\int"}};
  std::string result;
  bool code = false, quoted = false;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i;
    const auto letter = [&](std::size_t k) { return k < text.size() && std::isalpha(static_cast<unsigned char>(text[k])); };
    const auto digit = [&](std::size_t k) { return k < text.size() && std::isdigit(static_cast<unsigned char>(text[k])); };
    while (letter(end)) ++end;
    if (end > i) {
      const std::string_view word = text.substr(i, end - i);
      const auto symbol = symbols.find(word);
      result += !code && symbol != symbols.end() ? concat("$", symbol->second, "$") : std::string(word);
    } else if (text[i] == '^' && digit(i + 1)) {
      for (end = i + 1; digit(end);) ++end;
      result += concat("$^{", text.substr(i + 1, end - i - 1), "}$");
    } else if (!code && text[i] == '_' && letter(i + 1) && !letter(i + 2)) {
      result += concat("$_{", text[i + 1], "}$");
      end = i + 2;
    } else if (!code && text[i] == '"') {
      result += quoted ? "''" : "``";
      quoted = !quoted;
      end = i + 1;
    } else if (text[i] == '`') {
      result += code ? "}" : "\\texttt{";
      code = !code;
      end = i + 1;
    } else {
      result += tex_text(text.substr(i, 1));
      end = i + 1;
    }
    i = end;
  }
  return code ? result + "}" : result;
}

// A decimal number in math mode; the exponent of one like 1.5e-3 becomes a power of ten.
inline std::string tex_decimal(const std::string& text) {
  const std::size_t e = text.find('e');
  if (e == std::string::npos) return concat("$", text, "$");
  return concat("$", text.substr(0, e), "\\times10^{", std::stoi(text.substr(e + 1)), "}$");
}

// A number by a format like 3f, 2g or 1e: digits, and the letter of printf. Powers of ten are written as such; NaN is a
// dash. InputError for another format.
inline std::string tex_number(double value, std::string_view format) {
  if (format.size() != 2 || !std::isdigit(static_cast<unsigned char>(format[0])) ||
      std::string_view("fge").find(format[1]) == std::string_view::npos)
    throw InputError(concat("a number is written by a format like 3f, 2g or 1e, not ", quote(format)));
  if (std::isnan(value)) return "--";
  if (std::isinf(value)) return value > 0.0 ? "$\\infty$" : "$-\\infty$";
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, concat("%.", format, "").c_str(), value);
  return tex_decimal(buffer);
}

// The arguments of every \command{..}.. in a document, `count` of them each, in the order of their first appearance;
// comments and arguments of a definition (with a #) are passed over.
inline std::vector<std::vector<std::string>> requests_in(std::string_view document, const std::string& command, int count) {
  std::vector<std::vector<std::string>> requests;
  for (const std::string_view line : split(document, '\n')) {
    std::size_t comment = line.find('%');
    while (comment != std::string_view::npos && comment > 0 && line[comment - 1] == '\\')
      comment = line.find('%', comment + 1);
    const std::string_view code = line.substr(0, comment);
    const std::string start = concat("\\", command, "{");
    for (std::size_t at = code.find(start); at != std::string_view::npos; at = code.find(start, at + 1)) {
      std::vector<std::string> arguments;
      std::size_t open = at + start.size() - 1;
      while (static_cast<int>(arguments.size()) < count && open < code.size() && code[open] == '{') {
        const std::size_t close = code.find('}', open);
        if (close == std::string_view::npos) break;
        arguments.emplace_back(code.substr(open + 1, close - open - 1));
        open = close + 1;
      }
      if (static_cast<int>(arguments.size()) < count)
        throw InputError(concat("\\", command, " takes ", count, " arguments on one line: ", quote(line)));
      const bool definition = arguments[0].find('#') != std::string::npos;
      const bool known = std::find(requests.begin(), requests.end(), arguments) != requests.end();
      if (!definition && !known) requests.push_back(arguments);
    }
  }
  return requests;
}

}  // namespace stokes
