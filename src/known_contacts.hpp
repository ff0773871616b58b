// What the answers of the fluid to contact forces tell about the next answer: the mobility between the contacts, and
// the density to start from. It goes from one step to the next, in which nearly the same bodies are in contact.
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
  Matrix rates;                   // of the value of one by a unit multiplier of another, symmetric
  Matrix multipliers;             // of the latest answers of the fluid, one column each, the newest last

  Eigen::Index find(const Contact& contact) const;  // its row, or -1
};

// Changes the symmetric matrix such that it maps s to y: of all symmetric changes that do, the smallest (Powell's update),
// entries in units of their diagonal ones. Nothing where s is a small part of `present`, whose errors y then shows, or
// where the diagonal is not positive. All of the same length.
void learn(Matrix& rates, const Vector& s, const Vector& y, const Vector& present);

// Coefficients of the combination of the columns of `known` that comes nearest to `wanted`, in units of 1 / scale;
// columns that are nearly dependent get no large ones.
Vector nearest_combination(const Matrix& known, const Vector& wanted, const Vector& scale);

}  // namespace stokes
