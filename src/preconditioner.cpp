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

void Preconditioner::apply(const BoundarySet& set, const Vector& in, Vector& out) const {
  if (kind_ == PreconditionerKind::none) {
    out = in;
    return;
  }
  Vector own(in.size());
  parallel_for_large(static_cast<long>(set.members.size()), set.size(), [&](long n) {
    const int i = set.members[n];
    const Eigen::Index first = 2 * set.first[i], count = 2 * boundaries_[i].size();
    own.segment(first, count).noalias() = boundaries_[i].shape->inverse * in.segment(first, count);
  });
  out = own;
  std::vector<const Pair*> pairs;
  for (const Pair& p : pairs_)
    if (set.has(p.i) && set.has(p.j)) pairs.push_back(&p);
  // Each pair's change goes to a place of its own and is added in the order of the pairs.
  std::vector<std::pair<Vector, Vector>> changes(pairs.size());
  parallel_for_large(static_cast<long>(pairs.size()), set.size(), [&](long n) {
    changes[n] = change(*pairs[n], set, own);
  });
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    out.segment(2 * set.first[pairs[n]->i], changes[n].first.size()) += changes[n].first;
    out.segment(2 * set.first[pairs[n]->j], changes[n].second.size()) += changes[n].second;
  }
}

// What solving a pair together adds to the solutions `own` of its members by themselves.
std::pair<Vector, Vector> Preconditioner::change(const Pair& p, const BoundarySet& set, const Vector& own) const {
  const auto d_i = own.segment(2 * set.first[p.i], 2 * boundaries_[p.i].size());
  const auto d_j = own.segment(2 * set.first[p.j], 2 * boundaries_[p.j].size());
  const Vector z_i = p.schur.solve(d_i - p.X * d_j);
  return {z_i - d_i, -p.Y * z_i};
}

}  // namespace stokes
