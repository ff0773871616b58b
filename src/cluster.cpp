#include "cluster.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "text.hpp"

namespace stokes {

namespace {

constexpr double negligible = 1e-12;  // of the cluster's forces: well above their rounding

using Pair = std::pair<int, int>;

std::vector<Pair> distinct_pairs(const std::vector<Pair>& contacts, int bodies) {
  std::vector<Pair> pairs;
  for (const auto& [a, b] : contacts) {
    if (a == b || std::min(a, b) < 0 || a >= bodies || (b >= bodies && b != container_index))
      throw InputError(concat("a contact joins two different bodies of 0 to ", bodies - 1, "; got ", a, " and ",
                              b));
    pairs.push_back(std::minmax(a, b));
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

// Gives wrenches[chosen] the force that balances the other members'.
void balance(const std::vector<int>& members, int chosen, std::vector<Wrench>& wrenches) {
  Complex others{0.0, 0.0};
  double size = 0.0;
  for (int body : members) {
    if (body == chosen) continue;
    others += wrenches[body].force;
    size += std::abs(wrenches[body].force);
  }
  Wrench& wrench = wrenches[chosen];
  const Complex before = wrench.force;
  wrench.force = -others;
  if (std::abs(before) > negligible * size && std::abs(wrench.force - before) > negligible * size)
    wrench.torque *= std::abs(wrench.force) / std::abs(before);
}

}  // namespace

DisjointSets::DisjointSets(int count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

int DisjointSets::find(int element) {
  while (parent_[element] != element) element = parent_[element] = parent_[parent_[element]];
  return element;
}

void DisjointSets::join(int first, int second) {
  const auto [low, high] = std::minmax({find(first), find(second)});
  parent_[high] = low;
}

void balance_clusters(const std::vector<Pair>& contacts, std::vector<Wrench>& wrenches,
                      const std::vector<int>& fixed) {
  const int bodies = static_cast<int>(wrenches.size());
  std::vector<int> held = fixed;  // one such body in a cluster is enough
  for (int body : fixed)
    if (body < 0 || body >= bodies)
      throw InputError(concat("the fixed bodies are some of 0 to ", bodies - 1, "; got ", body));
  DisjointSets sets(bodies);
  std::vector<int> partners(bodies, 0);
  for (const auto& [a, b] : distinct_pairs(contacts, bodies)) {
    if (b == container_index) {
      held.push_back(a);
      continue;
    }
    sets.join(a, b);
    ++partners[a], ++partners[b];
  }
  std::vector<std::vector<int>> clusters(bodies);
  for (int i = 0; i < bodies; ++i)
    if (partners[i] > 0) clusters[sets.find(i)].push_back(i);
  for (int body : held) clusters[sets.find(body)].clear();
  for (const std::vector<int>& members : clusters) {
    if (members.empty()) continue;
    // max_element returns the first of equals, which is the lowest index.
    const auto rank = [&](int i) { return std::pair(partners[i], std::abs(wrenches[i].force)); };
    const int chosen = *std::max_element(members.begin(), members.end(),
                                         [&](int i, int j) { return rank(i) < rank(j); });
    balance(members, chosen, wrenches);
  }
}

}  // namespace stokes
