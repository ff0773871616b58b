// Information from earlier solutions for contact forces: the mobility between the contacts, and densities for initial
// guesses. It is passed from one step to the next, in which nearly the same bodies are in contact.
#pragma once

#include <vector>

#include "base.hpp"

namespace stokes {

struct KnownContacts {
  struct Contact {
    int a, b, region;  // as in ContactConstraint
    auto operator<=>(const Contact&) const = default;
  };
  std::vector<Contact> contacts;  // sorted
  Matrix rates;                   // (l, k): rate of value l for a unit multiplier of k; symmetric
  Matrix multipliers;             // of the latest solutions, one column each, the newest last

  Eigen::Index find(const Contact& contact) const;  // its row, or -1
};

// Applies the smallest symmetric change after which the symmetric matrix maps s to y (Powell's update), with entries
// measured in units of the diagonal. Does nothing if s is a small part of `present`, because y is then dominated by its
// errors, or if the diagonal is not positive. All vectors have the same length.
void learn(Matrix& rates, const Vector& s, const Vector& y, const Vector& present);

// Coefficients of the combination of the columns of `known` that is nearest to `wanted`, with rows weighted by `scale`.
// The coefficients of nearly dependent columns stay small.
Vector nearest_combination(const Matrix& known, const Vector& wanted, const Vector& scale);

}  // namespace stokes
