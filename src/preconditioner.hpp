// Right preconditioners for the equations of a suspension.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "discrete_shape.hpp"

namespace stokes {

enum class PreconditionerKind {
  none,
  block,  // D^-1: each boundary's own block, by the inverse that its shape carries
  pair,   // D^-1 + Sum over close pairs (A_ij^-1 - D_i^-1 - D_j^-1): their 2 x 2 block systems exactly
};

class Preconditioner {
 public:
  // The operator's block between nodes of two boundaries, densities in their frames: 2 rows x 2 columns.
  using BlockFunction = std::function<Matrix(int target, const std::vector<int>& rows, int source, const std::vector<int>& columns)>;

  // `pairs`: the close pairs (i, j) of boundaries, for PreconditionerKind::pair. Of a large circle only the nodes beside
  // the other member take part. Cost per pair O(N_i N_j^2 + N_i^3), N_i the smaller number of nodes.
  Preconditioner(PreconditionerKind kind, const std::vector<PlacedShape>& boundaries,
                 const std::vector<std::pair<int, int>>& pairs, const BlockFunction& block);

  // out = M in, densities of a set of boundaries in their frames: pairs with both members in it count. Independent of
  // the number of threads.
  void apply(const BoundarySet& set, const Vector& in, Vector& out) const;

 private:
  // With X = D_i^-1 C_ij and Y = D_j^-1 C_ji the pair's system is [I X; Y I] z = [D_i^-1 r_i; D_j^-1 r_j], and
  // z_i = (I - X Y)^-1 (d_i - X d_j), z_j = d_j - Y z_i. In single precision, which halves what they cost to make and to apply.
  struct Pair {
    int i, j;
    std::vector<int> part;  // nodes of j that take part
    Eigen::MatrixXf X, Y, inverse;
  };

  Pair prepared(std::pair<int, int> members, const BlockFunction& block) const;
  std::pair<Vector, Vector> change(const Pair& pair, const BoundarySet& set, const Vector& own) const;

  PreconditionerKind kind_;
  const std::vector<PlacedShape>& boundaries_;
  std::vector<Pair> pairs_;
};

}  // namespace stokes
