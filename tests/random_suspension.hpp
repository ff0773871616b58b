// Suspensions for several tests. Draws are in braces or in statements of their own: in parentheses compilers differ in their
// order.
#pragma once

#include <algorithm>
#include <random>

#include "gap.hpp"
#include "suspension.hpp"

namespace stokes {

// Uniform in [0, 1), the same on every machine.
inline double uniform(std::mt19937_64& generator) { return static_cast<double>(generator() >> 11) * 0x1p-53; }

struct RandomNumbers {
  std::mt19937_64 engine;
  double between(double low, double high) { return low + (high - low) * uniform(engine); }
  Complex direction() { return std::polar(1.0, between(0.0, 2.0 * pi)); }
  Complex within(double low, double high) {  // at that distance from 0
    const double distance = between(low, high);
    return distance * direction();
  }
};

// Six ellipses of three shapes with gaps of at least 0.2.
inline Suspension six_ellipses() {
  std::mt19937_64 generator(7);
  const Shape shapes[] = {{1.0, 0.5}, {0.9, 0.3}, {0.6, 0.6}};
  Suspension bodies;
  while (bodies.size() < 6) {
    const Body body{shapes[bodies.size() % 3],
                    {{5.0 * uniform(generator), 4.0 * uniform(generator)}, 2.0 * pi * uniform(generator)}, {}, {}};
    bool apart = true;
    for (const Body& other : bodies) apart = apart && gap(body, other).value >= 0.2;
    if (apart) bodies.push_back(body);
  }
  return bodies;
}

// Ellipses at gaps of at least `least`, placed at random in a square where they fit.
inline Suspension random_drop(std::mt19937_64& generator, int count, double side, double least) {
  Suspension bodies;
  while (static_cast<int>(bodies.size()) < count) {
    const double a = 0.35 + 0.25 * uniform(generator), b = a * (0.45 + 0.55 * uniform(generator));
    const Complex centre{side * uniform(generator), side * uniform(generator)};
    const Body next{{a, b}, {centre, 2.0 * pi * uniform(generator)}, {}, {}};
    const bool apart = std::all_of(bodies.begin(), bodies.end(),
                                   [&](const Body& other) { return gap(next, other).value >= least; });
    if (apart) bodies.push_back(next);
  }
  return bodies;
}

// Entries uniform in (-1, 1).
inline Matrix random_matrix(int rows, int columns, unsigned seed) {
  std::mt19937_64 generator(seed);
  Matrix m(rows, columns);
  for (int j = 0; j < columns; ++j)
    for (int i = 0; i < rows; ++i) m(i, j) = 2.0 * uniform(generator) - 1.0;
  return m;
}

}  // namespace stokes
