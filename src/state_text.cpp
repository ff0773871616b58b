#include "state_text.hpp"

#include <limits>
#include <stdexcept>

namespace stokes {

void StateWriter::line(std::string_view name, const std::vector<double>& values) {
  text_ += concat(name, " ", values.size());
  for (const double x : values) text_ += concat(" ", x);
  text_ += '\n';
}

void StateWriter::line(std::string_view name, const ComplexVector& values) {
  text_ += concat(name, " ", values.size());
  for (const Complex z : values) text_ += concat(" ", z.real(), " ", z.imag());
  text_ += '\n';
}

std::string_view StateReader::line() {
  const auto end = rest_.find('\n');
  const std::string_view result = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  return result;
}

void StateReader::begin(std::string_view name) {
  numbers_ = line();
  if (numbers_.substr(0, numbers_.find(' ')) != name) throw std::runtime_error(concat(name, " is missing"));
  skip();
}

double StateReader::number() {
  const std::string_view word = numbers_.substr(0, numbers_.find(' '));
  skip();
  if (word == "nan") return std::numeric_limits<double>::quiet_NaN();
  if (word == "inf") return std::numeric_limits<double>::infinity();
  if (word == "-inf") return -std::numeric_limits<double>::infinity();
  const auto value = parse_number(word);
  if (!value) throw std::runtime_error(concat(quote(word), " is not a number"));
  return *value;
}

std::vector<double> StateReader::numbers(std::string_view name) {
  begin(name);
  std::vector<double> values(integer<std::size_t>());
  for (double& x : values) x = number();
  return values;
}

ComplexVector StateReader::complex_numbers(std::string_view name) {
  begin(name);
  ComplexVector values(integer<Eigen::Index>());
  for (Complex& z : values) {
    const double re = number();
    z = {re, number()};
  }
  return values;
}

Matrix StateReader::matrix(std::string_view name, Eigen::Index rows, Eigen::Index cols) {
  const std::vector<double> values = numbers(name);
  if (static_cast<Eigen::Index>(values.size()) != rows * cols) throw std::runtime_error(concat(name, " has a wrong size"));
  return Eigen::Map<const Matrix>(values.data(), rows, cols);
}

void StateReader::skip() {
  const auto space = numbers_.find(' ');
  numbers_.remove_prefix(space == std::string_view::npos ? numbers_.size() : space + 1);
}

}  // namespace stokes
