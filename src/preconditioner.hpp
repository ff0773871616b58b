// Right preconditioners for the equations of a suspension.
#pragma once

#include <eigen3/Eigen/LU>
#include <functional>
#include <utility>
#include <vector>

#include "discrete_shape.hpp"

namespace stokes {

enum class PreconditionerKind {
  none,
  block,  // D^-1: each boundary's own block, by the inverse that its shape carries
  pair,   // D^-1 + Sum over close pairs (A_ij^-1 - D_i^-1 - D_j^-1), with 2 x 2 block systems solved approximately. Pairs
          // with the smallest gaps form groups of boundaries, which are solved exactly
};

// Two close boundaries and the gap between them, divided by its radius of curvature (facing.hpp).
struct ClosePair {
  int i, j;
  double relative_gap;
};

class Preconditioner {
 public:
  // The block of the operator between nodes of two boundaries, for densities in body frames: 2 rows x 2 columns reals.
  using BlockFunction =
      std::function<Matrix(int target, const std::vector<int>& rows, int source, const std::vector<int>& columns)>;

  // `pairs`: the close pairs, for PreconditionerKind::pair. Their interaction is compressed up to a Frobenius norm of
  // `negligible`. Pairs below a relative gap of 1e-3 are joined to groups, the closest first, of up to 8 boundaries and 6000
  // unknowns, 2 GB for all groups, each with a dense factorisation. Only those nodes of a large circle take part that are
  // beside the other member. Cost per pair O(r N^2), where r is the rank of the interaction.
  Preconditioner(PreconditionerKind kind, const std::vector<PlacedShape>& boundaries,
                 const std::vector<ClosePair>& pairs, double negligible, const BlockFunction& block);

  // out = M in, for densities of a set of boundaries in body frames. Pairs and groups with a member outside the set are
  // left out. The result does not depend on the number of threads.
  void apply(const BoundarySet& set, const Vector& in, Vector& out) const;

 private:
  // The blocks between the members have a low rank, C_ij = P_i Q_i^T and C_ji = P_j Q_j^T. With
  // Y = D_j^-1 C_ji = B Q_j^T and A = D_i^-1 P_i (I - Q_i^T Y D_i^-1 P_i)^-1 the solution of z + D^-1 C z = d is
  //   z_i = d_i - A Q_i^T (d_j - Y d_i),  z_j = d_j - Y z_i.
  // Single precision halves the cost of making and applying them.
  struct Pair {
    int i, j;
    std::vector<int> part;  // nodes of j that take part
    Eigen::MatrixXf A, B, Q_i, Q_j;
  };
  struct Change {
    Eigen::VectorXf of_i, of_j;
  };

  // Factors of 1 + D^-1 C, in double precision because the condition of the equations grows like gap^-1.5.
  struct Group {
    std::vector<int> members;
    std::vector<Eigen::Index> first;  // of each member's reals; the last: of all
    Eigen::PartialPivLU<Matrix> factors;
  };

  Pair prepared(std::pair<int, int> members, double negligible, const BlockFunction& block) const;
  Group factorised(std::vector<int> members, const BlockFunction& block) const;
  Change change(const Pair& pair, const BoundarySet& set, const Vector& own) const;
  Vector change(const Group& group, const BoundarySet& set, const Vector& own) const;

  PreconditionerKind kind_;
  const std::vector<PlacedShape>& boundaries_;
  std::vector<Pair> pairs_;
  std::vector<std::vector<int>> pairs_of_;  // each boundary's, increasing
  std::vector<Group> groups_;
};

}  // namespace stokes
