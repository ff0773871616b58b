#include "preconditioner.hpp"

#include <algorithm>

#include "threads.hpp"

namespace stokes {

Preconditioner::Preconditioner(PreconditionerKind kind, const std::vector<PlacedShape>& boundaries,
                               const std::vector<std::pair<int, int>>& pairs, const BlockFunction& block)
    : kind_(kind), boundaries_(boundaries) {
  if (kind != PreconditionerKind::pair) return;
  pairs_.resize(pairs.size());
  const long nodes = boundaries.empty() ? 0 : boundaries.back().offset + boundaries.back().size();
  parallel_for_large(static_cast<long>(pairs.size()), nodes, [&](long n) {
    Pair& p = pairs_[n];
    p.i = pairs[n].first, p.j = pairs[n].second;
    if (boundaries[p.j].size() < boundaries[p.i].size()) std::swap(p.i, p.j);
    p.X.noalias() = boundaries[p.i].shape->inverse * block(p.i, p.j);
    p.Y.noalias() = boundaries[p.j].shape->inverse * block(p.j, p.i);
    Matrix schur = -p.X * p.Y;
    schur.diagonal().array() += 1.0;
    p.schur.compute(schur);
  });
}

void Preconditioner::apply(const Vector& in, Vector& out) const {
  if (kind_ == PreconditionerKind::none) {
    out = in;
    return;
  }
  Vector own(in.size());
  parallel_for_large(static_cast<long>(boundaries_.size()), in.size() / 2, [&](long i) {
    const PlacedShape& b = boundaries_[i];
    own.segment(2 * b.offset, 2 * b.size()).noalias() = b.shape->inverse * in.segment(2 * b.offset, 2 * b.size());
  });
  out = own;
  // Each pair's change goes to a place of its own and is added in the order of the pairs.
  std::vector<std::pair<Vector, Vector>> changes(pairs_.size());
  parallel_for_large(static_cast<long>(pairs_.size()), in.size() / 2, [&](long n) {
    changes[n] = change(pairs_[n], own);
  });
  for (std::size_t n = 0; n < pairs_.size(); ++n) {
    out.segment(2 * boundaries_[pairs_[n].i].offset, changes[n].first.size()) += changes[n].first;
    out.segment(2 * boundaries_[pairs_[n].j].offset, changes[n].second.size()) += changes[n].second;
  }
}

// What solving a pair together adds to the solutions `own` of its members by themselves.
std::pair<Vector, Vector> Preconditioner::change(const Pair& p, const Vector& own) const {
  const auto d_i = own.segment(2 * boundaries_[p.i].offset, 2 * boundaries_[p.i].size());
  const auto d_j = own.segment(2 * boundaries_[p.j].offset, 2 * boundaries_[p.j].size());
  const Vector z_i = p.schur.solve(d_i - p.X * d_j);
  return {z_i - d_i, -p.Y * z_i};
}

void Preconditioner::apply_to_some(const std::vector<int>& boundaries, const Vector& in, Vector& out) const {
  out = Vector::Zero(in.size());
  const auto part = [this](auto& v, int i) { return v.segment(2 * boundaries_[i].offset, 2 * boundaries_[i].size()); };
  for (const int i : boundaries) part(out, i).noalias() = boundaries_[i].shape->inverse * part(in, i);
  if (boundaries.size() != 2) return;
  for (const Pair& p : pairs_)
    if (std::minmax(p.i, p.j) == std::minmax(boundaries[0], boundaries[1])) {
      const auto [first, second] = change(p, out);
      part(out, p.i) += first;
      part(out, p.j) += second;
    }
}

}  // namespace stokes
