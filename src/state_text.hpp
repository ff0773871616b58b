// The state of a run as text: lines of a name and its numbers, every double to the last bit. Every object with
// a state writes it with save(StateWriter&) and reads it back, in the same order, with restore(StateReader&).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base.hpp"
#include "text.hpp"

namespace stokes {

class StateWriter {
 public:
  template <class... Numbers>
  void line(std::string_view name, const Numbers&... numbers) {
    text_ += name;
    ((text_ += concat(" ", numbers)), ...);
    text_ += '\n';
  }
  // Groups of numbers follow their count.
  void line(std::string_view name, const std::vector<double>& values);
  void line(std::string_view name, const ComplexVector& values);

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// std::runtime_error if the text differs from what was written.
class StateReader {
 public:
  explicit StateReader(std::string_view text) : rest_(text) {}

  std::string_view line();
  std::string_view rest() const { return rest_; }

  // Begins a line with this name; number() and integer() then take its numbers one by one.
  void begin(std::string_view name);
  double number();
  template <class Integer>
  Integer integer() {
    return static_cast<Integer>(number());
  }

  // Whole lines.
  std::vector<double> numbers(std::string_view name);
  ComplexVector complex_numbers(std::string_view name);
  Matrix matrix(std::string_view name, Eigen::Index rows, Eigen::Index cols);  // column by column

 private:
  void skip();

  std::string_view rest_, numbers_;
};

}  // namespace stokes
