#include "preconditioner.hpp"

#include <algorithm>
#include <cmath>
#include <eigen3/Eigen/LU>
#include <tuple>

#include "threads.hpp"

namespace stokes {

namespace {

// From this ratio of sizes on only a part of a circle interacts with a body.
constexpr double large_circle = 4.0;

// Nodes within a body's length of its circumscribed circle.
std::vector<int> nodes_beside(const PlacedShape& body, const PlacedShape& wall) {
  const double reach = 3.0 * body.shape->shape.circumradius();
  std::vector<int> nodes;
  for (int k = 0; k < wall.size(); ++k)
    if (std::norm(wall.node(k) - body.pose.centre) < reach * reach) nodes.push_back(k);
  return nodes;
}

// C = P Q^T up to a Frobenius norm of `negligible`, with at least one column: a QR factorisation of C with column pivoting
// that ends early. The columns of P are orthonormal.
struct Coupling {
  Eigen::MatrixXf P, Q;
};

Coupling coupling(const Matrix& C, double negligible) {
  constexpr float cancelled = 1e-3f;  // squares of norms that differences have made so much smaller are summed anew
  Eigen::MatrixXf rest = C.cast<float>();
  const Eigen::Index most = std::min(C.rows(), C.cols());
  Eigen::MatrixXf P = Eigen::MatrixXf::Zero(C.rows(), most), Q = Eigen::MatrixXf::Zero(C.cols(), most);
  Eigen::VectorXf left = rest.colwise().squaredNorm(), summed = left;
  Eigen::Index rank = 0, pivot = 0;
  for (; rank < most && left.sum() > negligible * negligible; ++rank) {
    left.maxCoeff(&pivot);
    P.col(rank) = rest.col(pivot).normalized();
    Q.col(rank).noalias() = rest.transpose() * P.col(rank);
    rest.noalias() -= P.col(rank) * Q.col(rank).transpose();
    left -= Q.col(rank).cwiseAbs2();
    for (Eigen::Index k = 0; k < C.cols(); ++k)
      if (left[k] < cancelled * summed[k]) left[k] = summed[k] = rest.col(k).squaredNorm();
  }
  rank = std::max<Eigen::Index>(rank, 1);
  return {P.leftCols(rank), Q.leftCols(rank)};
}


// Groups connected by relative gaps below `tight`, the closest first, within two limits: 6000 unknowns for a group and 2 GB
// for the factors of all groups. Pairs between groups that the limits separate become groups of their own. Members
// increase.
std::vector<std::vector<int>> joined(std::vector<ClosePair> pairs, const std::vector<PlacedShape>& boundaries) {
  constexpr double tight = 1e-3;
  constexpr std::size_t most_members = 8;
  constexpr double most_entries = 3.6e7, most_in_all = 2.5e8;
  std::erase_if(pairs, [](const ClosePair& p) { return !(p.relative_gap < tight); });
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const ClosePair& p, const ClosePair& q) { return p.relative_gap < q.relative_gap; });
  std::vector<std::vector<int>> groups;
  const auto group_of = [&groups](int boundary) {
    return std::find_if(groups.begin(), groups.end(),
                        [boundary](const auto& g) { return std::binary_search(g.begin(), g.end(), boundary); });
  };
  const auto entries = [&boundaries](const std::vector<int>& members) {
    double unknowns = 0.0;
    for (const int i : members) unknowns += 2.0 * boundaries[i].size();
    return unknowns * unknowns;
  };
  double in_all = 0.0;
  const auto fits = [&](const std::vector<int>& members, double replaced) {
    return members.size() <= most_members && entries(members) <= most_entries &&
           in_all - replaced + entries(members) <= most_in_all;
  };
  std::vector<std::vector<int>> between;
  for (const ClosePair& p : pairs) {
    const auto a = group_of(p.i), b = group_of(p.j);
    if (a != groups.end() && a == b) continue;
    std::vector<int> members = a != groups.end() ? *a : std::vector{p.i};
    if (b != groups.end())
      members.insert(members.end(), b->begin(), b->end());
    else
      members.push_back(p.j);
    std::sort(members.begin(), members.end());
    double replaced = 0.0;
    for (const auto& group : {a, b})
      if (group != groups.end()) replaced += entries(*group);
    if (fits(members, replaced)) {
      std::erase_if(groups, [&p](const std::vector<int>& g) {
        return std::binary_search(g.begin(), g.end(), p.i) || std::binary_search(g.begin(), g.end(), p.j);
      });
      in_all += entries(members) - replaced;
      groups.push_back(std::move(members));
    } else if (std::vector<int> both{std::min(p.i, p.j), std::max(p.i, p.j)}; fits(both, 0.0)) {
      in_all += entries(both);
      between.push_back(std::move(both));
    }
  }
  groups.insert(groups.end(), between.begin(), between.end());
  return groups;
}

}  // namespace

Preconditioner::Preconditioner(PreconditionerKind kind, const std::vector<PlacedShape>& boundaries,
                               const std::vector<ClosePair>& pairs, double negligible, const BlockFunction& block)
    : kind_(kind), boundaries_(boundaries) {
  if (kind != PreconditionerKind::pair) return;
  const std::vector<std::vector<int>> groups = joined(pairs, boundaries);
  groups_.resize(groups.size());
  parallel_for(static_cast<long>(groups.size()), [&](long n) { groups_[n] = factorised(groups[n], block); });
  std::vector<std::pair<int, int>> others;
  for (const ClosePair& p : pairs)
    if (std::none_of(groups.begin(), groups.end(), [&p](const std::vector<int>& g) {
          return std::binary_search(g.begin(), g.end(), p.i) && std::binary_search(g.begin(), g.end(), p.j);
        }))
      others.push_back({p.i, p.j});
  pairs_.resize(others.size());
  parallel_for(static_cast<long>(others.size()), [&](long n) { pairs_[n] = prepared(others[n], negligible, block); });
  std::erase_if(pairs_, [](const Pair& p) { return p.part.empty(); });
  pairs_of_.resize(boundaries.size());
  for (std::size_t n = 0; n < pairs_.size(); ++n)
    for (const int member : {pairs_[n].i, pairs_[n].j}) pairs_of_[member].push_back(static_cast<int>(n));
}

Preconditioner::Pair Preconditioner::prepared(std::pair<int, int> members, double negligible,
                                              const BlockFunction& block) const {
  Pair p;
  std::tie(p.i, p.j) = members;
  if (boundaries_[p.j].size() < boundaries_[p.i].size()) std::swap(p.i, p.j);
  const PlacedShape &i = boundaries_[p.i], &j = boundaries_[p.j];
  const bool in_part = j.shape->is_circle() && j.shape->shape.a > large_circle * i.shape->shape.circumradius();
  p.part = in_part ? nodes_beside(i, j) : all_nodes(j);
  if (p.part.empty()) return p;
  const std::vector<int> own = all_nodes(i);
  auto [P_i, Q_i] = coupling(block(p.i, own, p.j, p.part), negligible);
  auto [P_j, Q_j] = coupling(block(p.j, p.part, p.i, own), negligible);
  p.A = i.shape->solve_own(P_i);
  if (in_part)
    p.B = -2.0f * P_j;  // the inverse of a circle's block but for a few smooth modes
  else
    p.B = j.shape->solve_own(P_j);
  p.Q_i = std::move(Q_i);
  p.Q_j = std::move(Q_j);
  const Eigen::MatrixXf there = p.Q_j.transpose() * p.A, back = p.Q_i.transpose() * p.B * there;
  const auto identity = Matrix::Identity(back.rows(), back.rows());
  const Matrix inverse = Eigen::PartialPivLU<Matrix>(identity - back.cast<double>()).solve(identity);
  p.A = (p.A * inverse.cast<float>()).eval();
  return p;
}

Preconditioner::Group Preconditioner::factorised(std::vector<int> members, const BlockFunction& block) const {
  Group g;
  g.members = std::move(members);
  Eigen::Index size = 0;
  for (const int i : g.members) g.first.push_back(size), size += 2 * boundaries_[i].size();
  g.first.push_back(size);
  Matrix system = Matrix::Identity(size, size);
  for (std::size_t a = 0; a < g.members.size(); ++a)
    for (std::size_t b = 0; b < g.members.size(); ++b) {
      if (a == b) continue;
      const int i = g.members[a], j = g.members[b];
      system.block(g.first[a], g.first[b], g.first[a + 1] - g.first[a], g.first[b + 1] - g.first[b]) =
          boundaries_[i].shape->solve_own(block(i, all_nodes(boundaries_[i]), j, all_nodes(boundaries_[j])));
    }
  g.factors.compute(system);
  return g;
}

// The correction to the solutions `own` of single members when a group is solved together; empty outside the set.
Vector Preconditioner::change(const Group& g, const BoundarySet& set, const Vector& own) const {
  if (!std::all_of(g.members.begin(), g.members.end(), [&set](int i) { return set.has(i); })) return {};
  Vector alone(g.first.back());
  for (std::size_t a = 0; a < g.members.size(); ++a)
    alone.segment(g.first[a], g.first[a + 1] - g.first[a]) =
        own.segment(2 * set.first[g.members[a]], g.first[a + 1] - g.first[a]);
  return g.factors.solve(alone) - alone;
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
    own.segment(first, count) = boundaries_[i].shape->solve_own(in.segment(first, count));
  });
  out = own;
  for (const Group& g : groups_) {
    const Vector more = change(g, set, own);
    for (std::size_t a = 0; a < g.members.size() && more.size() > 0; ++a)
      out.segment(2 * set.first[g.members[a]], g.first[a + 1] - g.first[a]) +=
          more.segment(g.first[a], g.first[a + 1] - g.first[a]);
  }
  if (pairs_.empty()) return;
  std::vector<Change> changes(pairs_.size());
  parallel_for_large(static_cast<long>(pairs_.size()), set.size(), [&](long n) {
    const Pair& p = pairs_[n];
    if (set.has(p.i) && set.has(p.j)) changes[n] = change(p, set, own);
  });
  parallel_for_large(static_cast<long>(set.members.size()), set.size(), [&](long m) {
    const int boundary = set.members[m];
    for (const int n : pairs_of_[boundary]) {
      const Pair& p = pairs_[n];
      const Change& change = changes[n];
      if (change.of_i.size() == 0) continue;
      if (boundary == p.i) {
        out.segment(2 * set.first[p.i], change.of_i.size()) += change.of_i.cast<double>();
        continue;
      }
      for (std::size_t k = 0; k < p.part.size(); ++k)
        out.segment<2>(2 * (set.first[p.j] + p.part[k])) +=
            change.of_j.segment<2>(2 * static_cast<Eigen::Index>(k)).cast<double>();
    }
  });
}

// The correction to the solutions `own` of single members when a pair is solved; for j at the nodes that take part.
Preconditioner::Change Preconditioner::change(const Pair& p, const BoundarySet& set, const Vector& own) const {
  const Eigen::VectorXf d_i = own.segment(2 * set.first[p.i], 2 * boundaries_[p.i].size()).cast<float>();
  Eigen::VectorXf d_j(2 * static_cast<Eigen::Index>(p.part.size()));
  for (std::size_t k = 0; k < p.part.size(); ++k)
    d_j.segment<2>(2 * static_cast<Eigen::Index>(k)) = own.segment<2>(2 * (set.first[p.j] + p.part[k])).cast<float>();
  const Eigen::VectorXf at_j = d_j - p.B * (p.Q_j.transpose() * d_i);
  const Eigen::VectorXf of_i = -(p.A * (p.Q_i.transpose() * at_j));
  return {of_i, -(p.B * (p.Q_j.transpose() * (d_i + of_i)))};
}

}  // namespace stokes
