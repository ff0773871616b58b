#include "preconditioner.hpp"

#include "threads.hpp"

namespace stokes {

Preconditioner::Preconditioner(PreconditionerKind kind, const std::vector<PlacedShape>& bodies,
                               const std::vector<std::pair<int, int>>& pairs)
    : kind_(kind), bodies_(bodies) {
  if (kind != PreconditionerKind::pair) return;
  pairs_.resize(pairs.size());
  const long nodes = bodies.empty() ? 0 : bodies.back().offset + bodies.back().size();
  parallel_for_large(static_cast<long>(pairs.size()), nodes, [&](long n) {
    const auto [i, j] = pairs[n];
    Pair& p = pairs_[n];
    p.i = i, p.j = j;
    p.X = bodies[i].shape->inverse * interaction(bodies[i], bodies[j]);
    p.Y = bodies[j].shape->inverse * interaction(bodies[j], bodies[i]);
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
  parallel_for_large(static_cast<long>(bodies_.size()), in.size() / 2, [&](long i) {
    const PlacedShape& b = bodies_[i];
    own.segment(2 * b.offset, 2 * b.size()).noalias() = b.shape->inverse * in.segment(2 * b.offset, 2 * b.size());
  });
  out = own;
  // Each pair's change goes to a place of its own and is added in the order of the pairs.
  std::vector<std::pair<Vector, Vector>> change(pairs_.size());
  parallel_for_large(static_cast<long>(pairs_.size()), in.size() / 2, [&](long n) {
    const Pair& p = pairs_[n];
    const auto d_i = own.segment(2 * bodies_[p.i].offset, 2 * bodies_[p.i].size());
    const auto d_j = own.segment(2 * bodies_[p.j].offset, 2 * bodies_[p.j].size());
    const Vector z_i = p.schur.solve(d_i - p.X * d_j);
    change[n] = {z_i - d_i, -p.Y * z_i};
  });
  for (std::size_t n = 0; n < pairs_.size(); ++n) {
    out.segment(2 * bodies_[pairs_[n].i].offset, change[n].first.size()) += change[n].first;
    out.segment(2 * bodies_[pairs_[n].j].offset, change[n].second.size()) += change[n].second;
  }
}

}  // namespace stokes
