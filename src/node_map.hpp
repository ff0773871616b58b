// Nodes of a closed curve, at equal steps of its parameter or concentrated around some of its points.
//
// The nodes are at equal steps of s. The map s -> alpha is, with q_k = N_k / N_0 and kernels K_k of mean 1,
//   (1 + Sum_k q_k) s = alpha + Sum_k q_k I_k(alpha - alpha_k) + constant,   I_k(t) = Int_0^t K_k,
//   K = m / sqrt(w^2 + 4 sin^2(t/2)),   m = AGM(sqrt(w^2 + 4), w).
// Around alpha_k the density of nodes is proportional to 1/sqrt(w_k^2 + t^2). A function that varies over w at a contact
// and over t at a distance t from it is then resolved equally well at every distance, with O(log 1/w) nodes. The map is
// analytic, so that the trapezoid rule keeps its accuracy.
#pragma once

#include <vector>

namespace stokes {

// `points` additional nodes around the point `alpha` of a boundary. The width > 0 is measured in the parameter.
struct NodeCluster {
  double alpha;
  double width;
  int points;

  bool operator==(const NodeCluster&) const = default;
};

// Nodes of a boundary: N_0 = `points` all around it and N_k for each cluster. Their sum is even.
struct Discretisation {
  int points = 0;
  std::vector<NodeCluster> clusters;
  int upsampling = 0;  // of the close evaluation (cauchy.hpp); 0: by the aspect ratio of the boundary

  int size() const;
  bool operator==(const Discretisation&) const = default;
};

// A node, and the derivatives of alpha with respect to s there.
struct MappedNode {
  double alpha;  // in [0, 2 pi), up to round-off
  double first, second;
  int cluster;      // the nearest one; -1 without clusters
  double distance;  // alpha - alpha_k of that cluster, in (-2 pi, 2 pi), accurate relative to its own size
};

class NodeMap {
 public:
  explicit NodeMap(const Discretisation& nodes);

  // s in [0, 2 pi) of alpha in [0, 2 pi); s = 0 at alpha = 0.
  double position(double alpha) const;

  // At `count` equal steps of s from 0. Cost: some 5 incomplete elliptic integrals per node and cluster.
  std::vector<MappedNode> at_equal_steps(int count) const;

 private:
  struct Kernel {
    double alpha, width, scale, share, position;  // scale: m; share: q_k; position: s of the cluster

    double integral(double t) const;
    double value(double t) const;
    double slope(double t) const;
  };

  double sum(double alpha) const;
  double apart(std::size_t k, std::size_t l) const;  // cluster k, from cluster l, in alpha
  double from_cluster(std::size_t k, double t) const;
  double first_derivative(std::size_t k, double t) const;  // of s with respect to alpha
  double second_derivative(std::size_t k, double t) const;
  double distance_from_cluster(std::size_t k, double s, double guess) const;  // inverse of from_cluster

  std::vector<Kernel> kernels_;
  std::vector<double> between_;  // of each cluster, the integrals of all kernels up to it
  double total_ = 1.0;  // 1 + Sum q_k
  double start_ = 0.0;
};

}  // namespace stokes
