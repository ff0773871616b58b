// Right preconditioners for the equations of a suspension.
#pragma once

#include <utility>
#include <vector>

#include "discrete_shape.hpp"

#include <eigen3/Eigen/LU>

namespace stokes {

enum class PreconditionerKind {
  none,
  block,  // D^-1: each body's own block, by the inverse that its shape carries
  pair,   // D^-1 + Sum over close pairs (A_ij^-1 - D_i^-1 - D_j^-1): their 2 x 2 block systems exactly
};

class Preconditioner {
 public:
  // `pairs`: the close pairs (i, j), for PreconditionerKind::pair. Cost O(N^3) per pair.
  Preconditioner(PreconditionerKind kind, const std::vector<PlacedShape>& bodies,
                 const std::vector<std::pair<int, int>>& pairs);

  // out = M in, densities of all bodies in their frames. Independent of the number of threads.
  void apply(const Vector& in, Vector& out) const;

 private:
  // With X = D_i^-1 C_ij and Y = D_j^-1 C_ji the pair's system is [I X; Y I] z = [D_i^-1 r_i; D_j^-1 r_j], and
  // z_i = (I - X Y)^-1 (d_i - X d_j), z_j = d_j - Y z_i.
  struct Pair {
    int i, j;
    Matrix X, Y;
    Eigen::PartialPivLU<Matrix> schur;
  };

  PreconditionerKind kind_;
  const std::vector<PlacedShape>& bodies_;
  std::vector<Pair> pairs_;
};

}  // namespace stokes
