#include "gmres.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "interruption.hpp"
#include "threads.hpp"

namespace stokes {

namespace {

// Entries of vectors that are worked on together: their sums are added in order, so that no result depends on the
// number of threads, and a piece of w stays in the cache while all basis vectors pass.
constexpr Eigen::Index piece = 8192;

Eigen::Index piece_count(Eigen::Index size) { return (size + piece - 1) / piece; }

// One cycle: the Krylov basis, the Hessenberg matrix reduced by Givens rotations, and its right-hand side.
class Cycle {
 public:
  Cycle(const Vector& residual, int capacity) : capacity_(capacity) {
    const double beta = residual.norm();
    basis_.reserve(capacity + 1);
    basis_.push_back(residual / beta);
    g_.push_back(beta);
  }

  int size() const { return static_cast<int>(h_.size()); }
  bool full() const { return size() == capacity_; }
  double residual() const { return std::abs(g_.back()); }
  const Vector& last() const { return basis_.back(); }

  // Extends the space by w = A z, z = M v and v the last basis vector. Returns false when w lies in the space.
  bool extend(const Vector& z, Vector w) {
    const int k = size();
    directions_.push_back(z);
    Vector h = Vector::Zero(k + 2);
    const double before = w.norm();
    for (int pass = 0; pass < 2; ++pass) {  // the second pass restores orthogonality lost to cancellation
      const Vector c = products(w);
      subtract(c, basis_, w);
      h.head(k + 1) += c;
    }
    h[k + 1] = w.norm();
    const bool independent = h[k + 1] > 1e-15 * before;
    for (int i = 0; i < k; ++i) rotate(h[i], h[i + 1], cosine_[i], sine_[i]);
    const double r = std::hypot(h[k], h[k + 1]);
    cosine_.push_back(r > 0.0 ? h[k] / r : 1.0);
    sine_.push_back(r > 0.0 ? h[k + 1] / r : 0.0);
    rotate(h[k], h[k + 1], cosine_[k], sine_[k]);
    g_.push_back(-sine_[k] * g_[k]);
    g_[k] *= cosine_[k];
    h_.push_back(h.head(k + 1));
    if (independent) basis_.push_back(w / w.norm());
    return independent;
  }

  // Adds the combination of the z that minimises the residual.
  void correct(Vector& x) const {
    const int k = size();
    Vector y(k);
    for (int i = k - 1; i >= 0; --i) {
      double sum = g_[i];
      for (int j = i + 1; j < k; ++j) sum -= h_[j][i] * y[j];
      y[i] = h_[i][i] != 0.0 ? sum / h_[i][i] : 0.0;
    }
    subtract(-y, directions_, x);
  }

 private:
  // <v_i, w> for all basis vectors.
  Vector products(const Vector& w) const {
    const auto count = static_cast<Eigen::Index>(basis_.size());
    Matrix parts(count, piece_count(w.size()));
    parallel_for_large(parts.cols(), w.size(), [&](long p) {
      const Eigen::Index from = p * piece, size = std::min(piece, w.size() - from);
      for (Eigen::Index i = 0; i < count; ++i) parts(i, p) = basis_[i].segment(from, size).dot(w.segment(from, size));
    });
    Vector sums = parts.col(0);
    for (Eigen::Index p = 1; p < parts.cols(); ++p) sums += parts.col(p);
    return sums;
  }

  // w -= Sum_i c_i v_i over the first vectors.
  static void subtract(const Vector& c, const std::vector<Vector>& v, Vector& w) {
    parallel_for_large(piece_count(w.size()), w.size(), [&](long p) {
      const Eigen::Index from = p * piece, size = std::min(piece, w.size() - from);
      for (Eigen::Index i = 0; i < c.size(); ++i) w.segment(from, size) -= c[i] * v[i].segment(from, size);
    });
  }

  static void rotate(double& p, double& q, double c, double s) {
    const double t = c * p + s * q;
    q = -s * p + c * q;
    p = t;
  }

  int capacity_;
  std::vector<Vector> basis_, directions_, h_;
  std::vector<double> g_, cosine_, sine_;
};

}  // namespace

GmresResult gmres(const LinearOperator& A, const LinearOperator& preconditioner, const Vector& b,
                  const Vector& guess, const GmresOptions& options) {
  GmresResult result;
  const double size = b.norm(), scale = options.scale > 0.0 ? std::max(options.scale, 1e-3 * size) : size;
  result.x = guess.size() == b.size() && size > 0.0 ? guess : Vector::Zero(b.size());
  if (size == 0.0) {
    result.converged = true;
    return result;
  }
  Vector image(b.size()), direction(b.size());
  Vector residual = b;
  if (guess.size() == b.size()) {
    A(result.x, image);
    residual -= image;
    if (!(residual.norm() < size)) {  // worse than starting from zero
      result.x.setZero();
      residual = b;
    }
  }
  result.residual = residual.norm() / scale;
  while (result.residual > options.tolerance && result.iterations < options.max_iterations) {
    Cycle cycle(residual, options.restart);
    bool independent = true;
    while (independent && !cycle.full() && result.iterations < options.max_iterations &&
           cycle.residual() > 0.9 * options.tolerance * scale) {
      end_if_interrupted();
      preconditioner(cycle.last(), direction);
      A(direction, image);
      independent = cycle.extend(direction, image);
      ++result.iterations;
    }
    cycle.correct(result.x);
    A(result.x, image);
    residual = b - image;
    const double previous = result.residual;
    result.residual = residual.norm() / scale;
    // A further cycle helps only while cycles still reduce the residual; round-off sets the floor.
    if (!(result.residual < 0.99 * previous)) break;
  }
  result.converged = result.residual <= options.tolerance;
  return result;
}

}  // namespace stokes
