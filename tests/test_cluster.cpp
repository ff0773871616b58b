#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

#include "cluster.hpp"
#include "random_suspension.hpp"
#include "stiv.hpp"

using namespace stokes;

namespace {

using Pairs = std::vector<std::pair<int, int>>;

std::vector<Wrench> random_wrenches(std::mt19937_64& generator, int bodies) {
  std::vector<Wrench> wrenches(bodies);
  for (Wrench& wrench : wrenches) {
    const double size = std::exp(6.0 * uniform(generator)), direction = 2.0 * pi * uniform(generator);
    wrench = {std::polar(size, direction), uniform(generator) - 0.5};
  }
  return wrenches;
}

bool same(const Wrench& a, const Wrench& b) { return a.force == b.force && a.torque == b.torque; }

// 48 ellipses in rows, pushed in random directions by up to their length.
struct Crowd {
  Suspension start;
  std::vector<Pose> trial;
  Crowd() {
    std::mt19937_64 generator(27);
    for (int i = 0; i < 48; ++i) {
      const Pose pose{{0.45 * (i % 7), 0.26 * (i / 7)}, 0.4 * (uniform(generator) - 0.5)};
      const double way = 0.2 * uniform(generator), direction = 2.0 * pi * uniform(generator);
      start.push_back({{0.2, 0.1}, pose, {}, {}});
      trial.push_back({pose.centre + std::polar(way, direction), pose.angle});
    }
  }
};

// All members of a constraint that can differ.
auto contents(const ContactConstraint& c) {
  const GapGradient& g = c.gradient;
  return std::tuple(c.a, c.b, c.region, c.value, c.tolerance, g.centre_a.real(), g.centre_a.imag(),
                    g.centre_b.real(), g.centre_b.imag(), g.angle_a, g.angle_b);
}

}  // namespace

TEST_CASE("cluster: the forces of every cluster sum to zero and only one body of each is changed") {
  std::mt19937_64 generator(11);
  double worst = 0.0;
  int clusters_seen = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const int bodies = 2 + static_cast<int>(18 * uniform(generator));
    Pairs contacts;
    for (int k = 0; k < bodies / 2; ++k) {
      const int a = static_cast<int>(bodies * uniform(generator));
      const int b = static_cast<int>(bodies * uniform(generator));
      if (a != b) contacts.emplace_back(a, b);
    }
    const std::vector<Wrench> before = random_wrenches(generator, bodies);
    std::vector<Wrench> after = before;
    balance_clusters(contacts, after);

    // Without union-find: spreads the smallest label over the contacts until nothing changes.
    std::vector<int> label(bodies);
    for (int i = 0; i < bodies; ++i) label[i] = i;
    for (int round = 0; round < bodies; ++round)
      for (const auto& [a, b] : contacts) label[a] = label[b] = std::min(label[a], label[b]);
    for (int name = 0; name < bodies; ++name) {
      Complex net{0.0, 0.0};
      double size = 0.0;
      int members = 0, changed = 0;
      for (int i = 0; i < bodies; ++i) {
        if (label[i] != name) continue;
        net += after[i].force, size += std::abs(after[i].force);
        ++members, changed += !same(before[i], after[i]);
      }
      if (members == 0) continue;
      CHECK(changed == (members > 1 ? 1 : 0));
      if (members > 1) worst = std::max(worst, std::abs(net) / size), ++clusters_seen;
    }
  }
  CHECK(clusters_seen > 500);
  CHECK(worst < 1e-12);
}

TEST_CASE("cluster: the body with the most partners yields, of equals the largest force, then the first") {
  // Most partners: body 2 of a star, though its force is the smallest.
  std::vector<Wrench> star{{{3.0, 0.0}, 1.0}, {{0.0, 4.0}, 1.0}, {{0.5, 0.0}, 1.0}, {{1.0, 1.0}, 1.0}};
  balance_clusters({{0, 2}, {1, 2}, {2, 3}}, star);
  CHECK(star[2].force == Complex(-4.0, -5.0));
  CHECK(star[2].torque == std::hypot(4.0, 5.0) / 0.5);  // scaled like the force
  CHECK(star[0].torque == 1.0);

  // Equal partners: the largest force.
  std::vector<Wrench> pair{{{1.0, 0.0}, 2.0}, {{-3.0, 0.0}, 6.0}};
  balance_clusters({{0, 1}}, pair);
  CHECK(same(pair[0], {{1.0, 0.0}, 2.0}));
  CHECK(same(pair[1], {{-1.0, 0.0}, 2.0}));

  // Equal forces too: the lowest index.
  std::vector<Wrench> equal{{{0.0, 1.0}, 5.0}, {{1.0, 0.0}, 5.0}};
  balance_clusters({{1, 0}}, equal);
  CHECK(same(equal[0], {{-1.0, 0.0}, 5.0}));
  CHECK(same(equal[1], {{1.0, 0.0}, 5.0}));
}

TEST_CASE("cluster: contacts listed twice, in any order and either way round, count once") {
  std::mt19937_64 generator(5);
  const std::vector<Wrench> before = random_wrenches(generator, 5);
  std::vector<Wrench> plain = before, shuffled = before;
  balance_clusters({{0, 1}, {1, 2}, {2, 3}, {2, 4}}, plain);
  balance_clusters({{4, 2}, {1, 0}, {0, 1}, {0, 1}, {3, 2}, {2, 1}}, shuffled);
  for (int i = 0; i < 5; ++i) CHECK(same(plain[i], shuffled[i]));
  CHECK_FALSE(same(plain[2], before[2]));
}

TEST_CASE("cluster: a torque is not scaled by a ratio of forces that are zero up to rounding") {
  // The middle of a chain is pushed equally from both sides.
  for (const double rounding : {0.0, 1e-17, -3e-17}) {
    std::vector<Wrench> chain{{{-1.0, 0.0}, 0.1}, {{rounding, 0.0}, 0.7}, {{1.0, 0.0}, 0.2}};
    balance_clusters({{0, 1}, {1, 2}}, chain);
    CHECK(chain[1].force == Complex(0.0, 0.0));
    CHECK(chain[1].torque == 0.7);
  }
  // Almost no force before and a force after: there is no factor to scale by.
  for (const double rounding : {0.0, 1e-17}) {
    std::vector<Wrench> idle{{{-1.0, 0.0}, 0.1}, {{rounding, 0.0}, 0.7}, {{3.0, 0.0}, 0.2}};
    balance_clusters({{0, 1}, {1, 2}}, idle);
    CHECK(same(idle[1], {{-2.0, 0.0}, 0.7}));
  }
}

TEST_CASE("cluster: bodies without contact keep their wrench and bad indices are refused") {
  std::vector<Wrench> wrenches{{{1.0, 0.0}, 1.0}, {{2.0, 0.0}, 1.0}};
  balance_clusters({}, wrenches);
  CHECK(same(wrenches[0], {{1.0, 0.0}, 1.0}));
  CHECK(same(wrenches[1], {{2.0, 0.0}, 1.0}));
  for (const auto& bad : Pairs{{0, 2}, {-1, 0}, {1, 1}})
    CHECK_THROWS_AS(balance_clusters({bad}, wrenches), InputError);
}

TEST_CASE("cluster: interference volumes leave every cluster balanced, so that nothing needs to yield") {
  const Crowd crowd;
  for (const StivGradient choice : {StivGradient::full, StivGradient::frozen}) {
    Pairs contacts;
    std::vector<Wrench> before(48);
    double size = 0.0;
    for (const ContactConstraint& c : StivCollector(crowd.start, 0.02, {128, choice}).collect(crowd.trial)) {
      contacts.emplace_back(c.a, c.b);
      before[c.a].force += c.force.centre_a, before[c.a].torque += c.force.angle_a;
      before[c.b].force += c.force.centre_b, before[c.b].torque += c.force.angle_b;
      size = std::max(size, std::abs(c.force.centre_a));
    }
    std::vector<Wrench> after = before;
    balance_clusters(contacts, after);
    double moved = 0.0;
    for (int i = 0; i < 48; ++i) {
      moved = std::max(moved, std::abs(after[i].force - before[i].force));
      CHECK(after[i].torque == before[i].torque);
    }
    CHECK(contacts.size() > 20);
    CHECK(moved < 1e-12 * size);
  }
}

TEST_CASE("cluster: a suspension has the interference volumes of its pairs, sorted, always in the same bits") {
  const Crowd crowd;
  std::vector<decltype(contents({}))> expected, got, again;
  for (int a = 0; a < 48; ++a) {
    for (int b = a + 1; b < 48; ++b) {
      const Suspension pair{crowd.start[a], crowd.start[b]};
      for (ContactConstraint c : StivCollector(pair, 0.02, {128}).collect({crowd.trial[a], crowd.trial[b]}))
        c.a = a, c.b = b, expected.push_back(contents(c));
    }
  }
  const StivCollector collector(crowd.start, 0.02, {128});
  for (const ContactConstraint& c : collector.collect(crowd.trial)) got.push_back(contents(c));
  for (const ContactConstraint& c : collector.collect(crowd.trial)) again.push_back(contents(c));
  CHECK(expected.size() > 20);
  CHECK((got == expected));
  CHECK((again == expected));
}

TEST_CASE("cluster: an obstacle bears what a cluster does not balance, and other clusters balance as ever") {
  // 0 - 1 - 2 with 1 fixed, 3 - 4 with 4 at the container, 5 - 6 free; 7 is fixed and alone.
  std::mt19937_64 generator(5);
  const std::vector<Wrench> before = random_wrenches(generator, 8);
  std::vector<Wrench> after = before;
  balance_clusters({{0, 1}, {1, 2}, {3, 4}, {4, container_index}, {5, 6}}, after, {1, 7});
  for (int i : {0, 1, 2, 3, 4, 7}) CHECK(same(after[i], before[i]));
  CHECK(after[5].force == -after[6].force);
  CHECK_FALSE((same(after[5], before[5]) && same(after[6], before[6])));

  // Without the obstacles these clusters would change.
  after = before;
  balance_clusters({{0, 1}, {1, 2}, {3, 4}}, after);
  CHECK_FALSE(same(after[1], before[1]));
  CHECK_FALSE((same(after[3], before[3]) && same(after[4], before[4])));
  CHECK_THROWS_AS(balance_clusters({}, after, {8}), InputError);
  CHECK_THROWS_AS(balance_clusters({{container_index, 0}}, after), InputError);
}
