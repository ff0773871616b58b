#include "known_contacts.hpp"

#include <algorithm>
#include <eigen3/Eigen/Cholesky>

namespace stokes {

namespace {

constexpr double least_change = 0.005;  // of the multipliers
constexpr double damping = 1e-3;        // of combinations

}  // namespace

Eigen::Index KnownContacts::find(const Contact& contact) const {
  const auto place = std::lower_bound(contacts.begin(), contacts.end(), contact);
  return place != contacts.end() && *place == contact ? place - contacts.begin() : -1;
}

void learn(Matrix& rates, const Vector& s, const Vector& y, const Vector& present) {
  if (!(rates.diagonal().minCoeff() > 0.0)) return;
  const Vector scale = rates.diagonal().cwiseSqrt(), scaled = scale.cwiseProduct(s);
  if (scaled.norm() <= least_change * present.cwiseProduct(scale).norm()) return;
  const Vector missed = y - rates * s, w = scale.cwiseProduct(scaled) / scaled.squaredNorm();
  rates += missed * w.transpose() + w * missed.transpose() - missed.dot(s) * w * w.transpose();
}

Vector nearest_combination(const Matrix& known, const Vector& wanted, const Vector& scale) {
  const Matrix A = scale.asDiagonal() * known;
  Matrix normal = A.transpose() * A;
  const double size = normal.trace();
  if (!(size > 0.0)) return Vector::Zero(known.cols());
  normal.diagonal().array() += damping * damping * size;
  return normal.llt().solve(A.transpose() * scale.cwiseProduct(wanted));
}

}  // namespace stokes
