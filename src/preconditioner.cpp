#include "preconditioner.hpp"

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
  std::vector<std::pair<Vector, Vector>> change(pairs_.size());
  parallel_for_large(static_cast<long>(pairs_.size()), in.size() / 2, [&](long n) {
    const Pair& p = pairs_[n];
    const auto d_i = own.segment(2 * boundaries_[p.i].offset, 2 * boundaries_[p.i].size());
    const auto d_j = own.segment(2 * boundaries_[p.j].offset, 2 * boundaries_[p.j].size());
    const Vector z_i = p.schur.solve(d_i - p.X * d_j);
    change[n] = {z_i - d_i, -p.Y * z_i};
  });
  for (std::size_t n = 0; n < pairs_.size(); ++n) {
    out.segment(2 * boundaries_[pairs_[n].i].offset, change[n].first.size()) += change[n].first;
    out.segment(2 * boundaries_[pairs_[n].j].offset, change[n].second.size()) += change[n].second;
  }
}

}  // namespace stokes
