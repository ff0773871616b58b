#include "stokes_system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "completion.hpp"
#include "facing.hpp"
#include "neighbours.hpp"
#include "text.hpp"
#include "threads.hpp"

namespace stokes {

namespace {

// Pairs closer than this fraction of the smaller circumradius are solved together by the preconditioner.
constexpr double close_pair = 0.35;

// Singular values of their interaction below this are left out. Larger ones would cost iterations, first for symmetric
// arrangements of bodies, and the sooner the tighter the tolerance.
double pair_negligible(double gmres_tolerance) { return std::clamp(1e3 * gmres_tolerance, 1e-6, 3e-4); }

}  // namespace

StokesSystem::StokesSystem(const Suspension& bodies, const std::vector<Discretisation>& nodes, ShapeCache& shapes,
                           const StokesOptions& options)
    : options_(options) {
  place(bodies, nodes, shapes);
  if (options.summation == Summation::fmm ||
      (options.summation == Summation::automatic && node_count() >= fmm_crossover))
    fmm_.emplace(all_.nodes, FmmOptions{std::clamp(0.1 * options.gmres_tolerance, 1e-12, 1e-3)});
  find_contact_frames(bodies);
  softening_ = fmm_ ? 0.0 : softening_length();
  find_near_blocks();
  find_completion_columns();
  const bool pairs = options.preconditioner == PreconditionerKind::pair;
  preconditioner_.emplace(options.preconditioner, boundaries_,
                          pairs ? close_pairs(bodies) : std::vector<ClosePair>{}, pair_negligible(options.gmres_tolerance),
                          [this](int target, const auto& rows, int source, const auto& columns) {
                            return interaction(target, rows, source, columns);
                          });
}

bool StokesSystem::has_container() const {
  return !boundaries_.empty() && boundaries_.back().shape->kind == BoundaryKind::container;
}

void StokesSystem::place(const Suspension& bodies, const std::vector<Discretisation>& nodes, ShapeCache& shapes) {
  if (bodies.container) log_length_ = bodies.container->radius;
  const long count = static_cast<long>(bodies.size());
  boundaries_.resize(count);
  const auto make = [&](long i) {
    const Body& body = bodies[i];
    const BoundaryKind kind = body.fixed ? BoundaryKind::fixed : BoundaryKind::free;
    boundaries_[i] = {shapes.get(body.shape, nodes[i], kind, log_length_), body.pose, body.pose.axis(), 0};
  };
  // One thread fills the cache. Nodes that belong to this configuration alone do not enter it.
  for (long i = 0; i < count; ++i)
    if (nodes[i].clusters.empty()) make(i);
  parallel_for(count, [&](long i) {
    if (!nodes[i].clusters.empty()) make(i);
  });
  for (long i = 0; i < count; ++i) {
    surfaces_.push_back(bodies[i].surface);
    if (bodies[i].fixed) fixed_.push_back(static_cast<int>(i));
  }
  if (bodies.container) {
    const Container& c = *bodies.container;
    const Discretisation own = static_cast<long>(nodes.size()) > count ? nodes[count] : Discretisation{c.points, {}};
    boundaries_.push_back({shapes.get(wall_shape(c), own, BoundaryKind::container, log_length_), wall_pose(c),
                           wall_pose(c).axis(), 0});
    surfaces_.push_back(c.surface);
  }
  int offset = 0;
  for (PlacedShape& b : boundaries_) b.offset = offset, offset += b.size();
  std::vector<int> members;
  for (std::size_t i = 0; i < boundaries_.size(); ++i) members.push_back(static_cast<int>(i));
  all_ = BoundarySet(boundaries_, std::move(members));
}

// The frames of all pairs of clusters that contain a pair of nearest points.
void StokesSystem::find_contact_frames(const Suspension& bodies) {
  const auto clustered = [this](int i) { return !boundaries_[i].shape->nodes.clusters.empty(); };
  std::vector<Complex> centres;
  std::vector<double> radii;
  double reach = 0.0;
  for (int i = 0; i < body_count(); ++i) {
    centres.push_back(bodies[i].pose.centre);
    radii.push_back(bodies[i].shape.circumradius());
    if (clustered(i)) reach = std::max(reach, radii.back());
  }
  if (reach == 0.0) return;
  for (const auto& [i, j] : neighbour_pairs(centres, centres, radii, reach))
    if (clustered(i) && clustered(j)) add_contact_frame(i, j, facing(bodies[i], bodies[j]));
  const int wall = body_count();
  for (int i = 0; has_container() && i < body_count(); ++i)
    if (clustered(i) && clustered(wall)) add_contact_frame(i, wall, facing(bodies[i], *bodies.container));
  std::sort(frames_.begin(), frames_.end(), [](const ContactFrame& f, const ContactFrame& g) {
    return std::pair(f.target, f.source) < std::pair(g.target, g.source);
  });
}

// With nearest points q and their clusters' points p, p_b - p_a = (q_a - p_a) + (q_b - q_a) - (q_b - p_b), where
// q_b - q_a is the gap along the normal, which is -i times the tangent of a.
void StokesSystem::add_contact_frame(int a, int b, const Facing& facing) {
  if (!(facing.gap > 0.0)) return;
  struct End {
    int cluster = -1;
    Complex offset;  // q - p in the frame of p
    Complex turn;    // tangent at p in the frame of q
  };
  const auto end = [](const DiscreteShape& shape, double alpha) {
    End e;
    double nearest = 4.0 * pi;
    const auto& clusters = shape.nodes.clusters;
    for (std::size_t k = 0; k < clusters.size(); ++k) {
      const double t = std::remainder(alpha - clusters[k].alpha, 2.0 * pi);
      if (std::abs(t) > clusters[k].width || std::abs(t) >= std::abs(nearest)) continue;
      nearest = t;
      const Complex there = shape.shape.derivative(alpha),
                    turn = shape.curve.clusters.tangent[k] * std::conj(there) / std::abs(there);
      e = {static_cast<int>(k), shape.shape.offset(clusters[k].alpha, t), t == 0.0 ? Complex(1.0) : turn};
    }
    return e;
  };
  const DiscreteShape &of_a = *boundaries_[a].shape, &of_b = *boundaries_[b].shape;
  const End at_a = end(of_a, facing.alpha_a), at_b = end(of_b, facing.alpha_b);
  if (at_a.cluster < 0 || at_b.cluster < 0) return;
  const double way = of_b.side() == Side::interior ? 1.0 : -1.0;  // tangent of b at q_b in the frame of that of a
  // In the frame of p_a, whose direction there is conj(at_a.turn).
  const Complex contact = std::conj(at_a.turn), turn = way * contact * at_b.turn;
  const Complex displacement = at_a.offset - imaginary_unit * facing.gap * contact - turn * at_b.offset;
  frames_.push_back({a, b, at_a.cluster, at_b.cluster, displacement, turn});
  frames_.push_back({b, a, at_b.cluster, at_a.cluster, -std::conj(turn) * displacement, std::conj(turn)});
}

// At most half the spacing of nodes without clusters, whose sums need no correction, and a fraction of clustered bodies.
double StokesSystem::softening_length() const {
  constexpr double part = 1e-2;
  double length = 0.0, most = std::numeric_limits<double>::infinity();
  for (const PlacedShape& b : boundaries_) {
    if (b.shape->nodes.clusters.empty())
      most = std::min(most, 0.5 * b.shape->curve.weight.minCoeff());
    else
      most = std::min(most, length = part * b.shape->shape.inradius());
  }
  return length > 0.0 ? most : 0.0;
}

// Nodes of the target as points near the source; for the source itself its own nodes.
std::vector<Target> StokesSystem::seen_from(int source, int target, const std::vector<int>& rows) const {
  const PlacedShape &t = boundaries_[target], &s = boundaries_[source];
  std::vector<Target> result;
  for (const int k : rows) {
    if (target == source) {
      result.push_back(s.shape->curve.node(k));
      continue;
    }
    result.push_back({s.local(all_.nodes[t.offset + k])});
    const Target own = t.shape->curve.node(k);
    for (const ContactFrame& f : frames_)
      if (f.target == target && f.source == source && f.target_cluster == own.cluster)
        result.back().cluster = f.source_cluster, result.back().offset = std::conj(f.turn) * (own.offset - f.displacement);
  }
  return result;
}

// The double layer of some nodes at others as the sum over nodes gives it; zero for a node itself.
Matrix StokesSystem::plain_rows(int target, const std::vector<int>& rows, int source,
                                const std::vector<int>& columns) const {
  const PlacedShape &t = boundaries_[target], &s = boundaries_[source];
  const double least = std::max(std::pow(softening_, 4), 1e-148);
  VelocityRows plain{Matrix(rows.size(), columns.size()), ComplexMatrix(rows.size(), columns.size())};
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const int k = s.offset + columns[c];
    const Complex normal = all_.weighted_normal[k] / (2.0 * pi);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Complex r = all_.nodes[t.offset + rows[i]] - all_.nodes[k];
      const double square = std::norm(r), f = dot(r, normal) / std::max(square * square, least);
      plain.direct(i, c) = f * square;
      plain.conjugate(i, c) = f * std::conj(s.axis * s.axis) * (r * r);
    }
  }
  return real_matrix(plain, s.axis * std::conj(t.axis));
}

double StokesSystem::near_reach(int boundary) const {
  return near_distance(*boundaries_[boundary].shape, 0.1 * options_.gmres_tolerance);
}

// Correction between nodes of one boundary. Its body frame and clusters give their differences more accurately.
void StokesSystem::find_own_correction(NearBlock& near) const {
  const PlacedShape& b = boundaries_[near.target];
  near.rows = all_nodes(b);
  VelocityRows rows = trapezoid_rows(b.shape->curve, b.shape->side(), seen_from(near.target, near.target, near.rows));
  rows.direct.diagonal().setZero(), rows.conjugate.diagonal().setZero();
  near.matrix = real_matrix(rows, 1.0) - plain_rows(near.target, near.rows, near.target, near.rows);
}

void StokesSystem::find_near_blocks() {
  std::vector<Complex> centres;
  std::vector<double> radii;
  double reach = 0.0;
  const auto limit = [this](int i, int j) { return std::max(near_reach(i), near_reach(j)); };
  const auto add = [this](int i, int j) {
    near_.push_back({i, j, {}, {}});
    near_.push_back({j, i, {}, {}});
  };
  for (int i = 0; i < body_count(); ++i) {
    const PlacedShape& b = boundaries_[i];
    centres.push_back(b.pose.centre);
    radii.push_back(b.shape->shape.circumradius());
    reach = std::max(reach, near_reach(i));
    const int wall = body_count();
    if (has_container() && boundaries_[wall].shape->shape.circumradius() - radii[i] -
                                   std::abs(centres[i] - boundaries_[wall].pose.centre) < limit(i, wall))
      add(i, wall);
  }
  for (const auto& [i, j] : neighbour_pairs(centres, centres, radii, reach))
    if (std::abs(centres[i] - centres[j]) - radii[i] - radii[j] < limit(i, j)) add(i, j);
  for (int i = 0; i < static_cast<int>(boundaries_.size()); ++i)
    if (!boundaries_[i].shape->nodes.clusters.empty()) near_.push_back({i, i, {}, {}});
  std::sort(near_.begin(), near_.end(), [](const NearBlock& a, const NearBlock& b) {
    return std::pair(a.target, a.source) < std::pair(b.target, b.source);
  });
  parallel_for(static_cast<long>(near_.size()), [&](long n) {
    NearBlock& near = near_[n];
    const PlacedShape &target = boundaries_[near.target], &source = boundaries_[near.source];
    if (near.target == near.source) return find_own_correction(near);
    std::vector<Complex> z(target.size());
    for (int k = 0; k < target.size(); ++k) z[k] = source.local(all_.nodes[target.offset + k]);
    near.rows = near_rows(*source.shape, z, near_reach(near.source));
    if (near.rows.empty() || source.shape->has_series()) return;
    const Complex turn = source.axis * std::conj(target.axis);
    near.matrix = real_matrix(source.shape->close_rows(seen_from(near.source, near.target, near.rows)), turn) -
                  plain_rows(near.target, near.rows, near.source, all_nodes(source));
  });
  std::erase_if(near_, [](const NearBlock& n) { return n.rows.empty(); });
  first_near_.assign(boundaries_.size() + 1, 0);
  for (const NearBlock& n : near_) ++first_near_[n.target + 1];
  for (std::size_t i = 0; i < boundaries_.size(); ++i) first_near_[i + 1] += first_near_[i];
  for (int i = 0; i < static_cast<int>(boundaries_.size()); ++i)
    if (boundaries_[i].shape->has_series()) {
      const BoundarySet alone(boundaries_, {i});
      long_circles_.push_back({i, alone.nodes, alone.weighted_normal});
    }
}

// Column 3 f + j: unit force along the first or second axis, or unit torque, of fixed body f, everything in
// body frames.
void StokesSystem::find_completion_columns() {
  completion_.resize(2 * node_count(), 3 * static_cast<Eigen::Index>(fixed_.size()));
  parallel_for_large(static_cast<long>(fixed_.size()), node_count(), [&](long f) {
    const PlacedShape& source = boundaries_[fixed_[f]];
    for (int j = 0; j < 3; ++j) {
      const Wrench unit{{j == 0 ? 1.0 : 0.0, j == 1 ? 1.0 : 0.0}, j == 2 ? 1.0 : 0.0};
      for (const PlacedShape& b : boundaries_)
        for (int k = 0; k < b.size(); ++k) {
          const Complex u =
              source.axis * std::conj(b.axis) *
              completion_velocity(source.shape->shape, {}, unit, source.local(all_.nodes[b.offset + k]), log_length_);
          completion_(2 * (b.offset + k), 3 * f + j) = u.real();
          completion_(2 * (b.offset + k) + 1, 3 * f + j) = u.imag();
        }
    }
  });
}

// Pairs whose gap is small.
std::vector<ClosePair> StokesSystem::close_pairs(const Suspension& bodies) const {
  std::vector<Complex> centres;
  std::vector<double> radii;
  double reach = 0.0;
  for (const Body& body : bodies) {
    centres.push_back(body.pose.centre);
    radii.push_back(body.shape.circumradius());
    if (!body.fixed) reach = std::max(reach, close_pair * radii.back());
  }
  std::vector<ClosePair> pairs;
  const auto add = [&](int i, int j, double limit, const Facing& f) {
    if (f.gap < limit) pairs.push_back({i, j, f.gap * f.curvature()});
  };
  for (const auto& [i, j] : neighbour_pairs(centres, centres, radii, reach))
    add(i, j, close_pair * std::min(radii[i], radii[j]), facing(bodies[i], bodies[j]));
  for (int i = 0; bodies.container && i < body_count(); ++i)
    add(i, body_count(), close_pair * radii[i], facing(bodies[i], *bodies.container));
  return pairs;
}

// The operator's block between nodes of two boundaries: the double layer, accurate at any distance, and a fixed
// source's completion flows.
Matrix StokesSystem::interaction(int target, const std::vector<int>& rows, int source,
                                 const std::vector<int>& columns) const {
  const PlacedShape &t = boundaries_[target], &s = boundaries_[source];
  Matrix block = plain_rows(target, rows, source, columns);
  const auto add = [&](Eigen::Index r, const Eigen::Ref<const Matrix>& whole_row) {
    for (std::size_t c = 0; c < columns.size(); ++c)
      block.block<2, 2>(2 * r, 2 * static_cast<Eigen::Index>(c)) += whole_row.middleCols(2 * columns[c], 2);
  };
  for (int n = first_near_[target]; n < first_near_[target + 1]; ++n) {
    if (near_[n].source != source) continue;
    std::vector<std::pair<Eigen::Index, std::size_t>> found;  // rows of the block and of the near block
    for (std::size_t k = 0; k < near_[n].rows.size(); ++k)
      if (const auto r = std::lower_bound(rows.begin(), rows.end(), near_[n].rows[k]);
          r != rows.end() && *r == near_[n].rows[k])
        found.push_back({r - rows.begin(), k});
    if (near_[n].matrix.size() > 0) {
      for (const auto& [r, k] : found) add(r, near_[n].matrix.middleRows(2 * static_cast<Eigen::Index>(k), 2));
      continue;
    }
    std::vector<Complex> close;
    for (const auto& [r, k] : found) close.push_back(s.local(t.node(rows[r])));
    const Matrix exact = real_matrix(s.shape->close_rows(close, columns), s.axis * std::conj(t.axis));
    for (std::size_t c = 0; c < found.size(); ++c)
      block.middleRows(2 * found[c].first, 2) = exact.middleRows(2 * static_cast<Eigen::Index>(c), 2);
  }
  if (s.shape->kind == BoundaryKind::fixed) {
    const auto f = std::lower_bound(fixed_.begin(), fixed_.end(), source) - fixed_.begin();
    for (std::size_t r = 0; r < rows.size(); ++r)
      add(static_cast<Eigen::Index>(r), Matrix(completion_.block(2 * (t.offset + rows[r]), 3 * f, 2, 3) * s.shape->closure));
  }
  return block;
}

}  // namespace stokes
