// Clusters of bodies in contact and the balance of the contact forces within each.
#pragma once

#include <utility>
#include <vector>

#include "suspension.hpp"

namespace stokes {

// Disjoint sets of 0 .. count - 1. The representative of a set is its smallest element, so that numbering
// sets by representatives does not depend on the order in which they were joined.
class DisjointSets {
 public:
  explicit DisjointSets(int count);
  int find(int element);
  void join(int first, int second);

 private:
  std::vector<int> parent_;
};

// The paper's force balance (its section 3.2). Bodies joined by contacts, directly or through others, form a
// cluster. In each, one body is given the force that balances all the others,
//   F_new = - Sum_{others of the cluster} F,
// and its torque is multiplied by |F_new| / |F_old|. That body is the one in contact with the most other
// bodies. Ties go to the largest |F_old|, then to the lowest index.
// Afterwards the forces of a cluster sum to zero up to the rounding of that sum. Torques do not balance.
//
// The ratio of two forces that are zero up to rounding is meaningless, and a body between two others often has no net
// force. The torque is therefore left as it is where |F_old|, or |F_new - F_old|, is at most 1e-12 of the sum
// of |F| over the others: there is nothing to scale, or the cluster was in balance.
//
// A cluster with a fixed body in it, or with a body that touches the container, stays as it is: the fixed body or the
// container bears whatever the others do not balance.
//
// contacts: pairs of bodies, in any order; a pair listed more than once is one contact. The second of a pair may be
// container_index.
// wrenches: contact force and torque of every body; changed in place. Bodies without contact keep theirs.
// fixed: the bodies that do not move.
// Cost O(bodies + contacts log contacts). Raises InputError for a contact of a body with itself or with one
// that has no wrench, and for a fixed body that has none.
void balance_clusters(const std::vector<std::pair<int, int>>& contacts, std::vector<Wrench>& wrenches,
                      const std::vector<int>& fixed = {});

}  // namespace stokes
