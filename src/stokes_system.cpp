#include "stokes_system.hpp"

#include <algorithm>
#include <cmath>

#include "completion.hpp"
#include "container_gap.hpp"
#include "gap.hpp"
#include "neighbours.hpp"
#include "text.hpp"
#include "threads.hpp"

namespace stokes {

namespace {

// Pairs closer than this part of the smaller circumradius are solved together by the preconditioner.
constexpr double close_pair = 0.35;

}  // namespace

StokesSystem::StokesSystem(const Suspension& bodies, const std::vector<Discretisation>& nodes, ShapeCache& shapes,
                           const StokesOptions& options)
    : options_(options) {
  place(bodies, nodes, shapes);
  find_near_blocks();
  find_completion_columns();
  if (options.summation == Summation::fmm ||
      (options.summation == Summation::automatic && node_count() >= fmm_crossover))
    fmm_.emplace(all_.nodes, FmmOptions{std::clamp(0.1 * options.gmres_tolerance, 1e-12, 1e-3)});
  const bool pairs = options.preconditioner == PreconditionerKind::pair;
  preconditioner_.emplace(options.preconditioner, boundaries_,
                          pairs ? close_pairs(bodies) : std::vector<std::pair<int, int>>{},
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
  // The cache is filled by one thread; nodes of this configuration alone do not enter it.
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
    boundaries_.push_back({shapes.get({c.radius, c.radius}, {c.points, {}}, BoundaryKind::container, log_length_),
                           {c.centre, c.angle}, std::polar(1.0, c.angle), 0});
    surfaces_.push_back(c.surface);
  }
  int offset = 0;
  for (PlacedShape& b : boundaries_) b.offset = offset, offset += b.size();
  std::vector<int> members;
  for (std::size_t i = 0; i < boundaries_.size(); ++i) members.push_back(static_cast<int>(i));
  all_ = BoundarySet(boundaries_, std::move(members));
}

double StokesSystem::near_reach(int boundary) const {
  return near_distance(*boundaries_[boundary].shape, 0.1 * options_.gmres_tolerance);
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
  std::sort(near_.begin(), near_.end(), [](const NearBlock& a, const NearBlock& b) {
    return std::pair(a.target, a.source) < std::pair(b.target, b.source);
  });
  parallel_for(static_cast<long>(near_.size()), [&](long n) {
    NearBlock& near = near_[n];
    const PlacedShape &target = boundaries_[near.target], &source = boundaries_[near.source];
    std::vector<Complex> z(target.size());
    for (int k = 0; k < target.size(); ++k) z[k] = source.local(all_.nodes[target.offset + k]);
    near.rows = near_rows(*source.shape, z, near_reach(near.source));
    if (near.rows.empty() || source.shape->has_series()) return;
    std::vector<Complex> close;
    for (int row : near.rows) close.push_back(z[row]);
    near.matrix = real_matrix(near_correction(*source.shape, close), source.axis * std::conj(target.axis));
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
          const Complex u = source.axis * std::conj(b.axis) *
                            completion_velocity(source.shape->shape, {}, unit, source.local(all_.nodes[b.offset + k]), log_length_);
          completion_(2 * (b.offset + k), 3 * f + j) = u.real();
          completion_(2 * (b.offset + k) + 1, 3 * f + j) = u.imag();
        }
    }
  });
}

// Pairs whose gap is small.
std::vector<std::pair<int, int>> StokesSystem::close_pairs(const Suspension& bodies) const {
  std::vector<Complex> centres;
  std::vector<double> radii;
  double reach = 0.0;
  for (const Body& body : bodies) {
    centres.push_back(body.pose.centre);
    radii.push_back(body.shape.circumradius());
    if (!body.fixed) reach = std::max(reach, close_pair * radii.back());
  }
  std::vector<std::pair<int, int>> pairs;
  for (const auto& [i, j] : neighbour_pairs(centres, centres, radii, reach))
    if (gap(bodies[i], bodies[j]).value < close_pair * std::min(radii[i], radii[j])) pairs.push_back({i, j});
  for (int i = 0; bodies.container && i < body_count(); ++i)
    if (gap(bodies[i], *bodies.container).value < close_pair * radii[i]) pairs.push_back({i, body_count()});
  return pairs;
}

// The operator's block between nodes of two boundaries: the double layer, accurate at any distance, and a fixed
// source's completion flows.
Matrix StokesSystem::interaction(int target, const std::vector<int>& rows, int source, const std::vector<int>& columns) const {
  const PlacedShape &t = boundaries_[target], &s = boundaries_[source];
  std::vector<Complex> z;
  for (const int k : rows) z.push_back(s.local(t.node(k)));
  Matrix block = real_matrix(trapezoid_rows(s.shape->curve, s.shape->side(), z, columns), s.axis * std::conj(t.axis));
  const auto add = [&](Eigen::Index r, const Eigen::Ref<const Matrix>& whole_row) {
    for (std::size_t c = 0; c < columns.size(); ++c)
      block.block<2, 2>(2 * r, 2 * static_cast<Eigen::Index>(c)) += whole_row.middleCols(2 * columns[c], 2);
  };
  for (int n = first_near_[target]; n < first_near_[target + 1]; ++n) {
    if (near_[n].source != source) continue;
    std::vector<std::pair<Eigen::Index, std::size_t>> found;  // rows of the block and of the near block
    for (std::size_t k = 0; k < near_[n].rows.size(); ++k)
      if (const auto r = std::lower_bound(rows.begin(), rows.end(), near_[n].rows[k]); r != rows.end() && *r == near_[n].rows[k])
        found.push_back({r - rows.begin(), k});
    if (near_[n].matrix.size() > 0) {
      for (const auto& [r, k] : found) add(r, near_[n].matrix.middleRows(2 * static_cast<Eigen::Index>(k), 2));
      continue;
    }
    std::vector<Complex> close;
    for (const auto& [r, k] : found) close.push_back(z[r]);
    const Matrix correction = real_matrix(near_correction(*s.shape, close, columns), s.axis * std::conj(t.axis));
    for (std::size_t c = 0; c < found.size(); ++c)
      block.middleRows(2 * found[c].first, 2) += correction.middleRows(2 * static_cast<Eigen::Index>(c), 2);
  }
  if (s.shape->kind == BoundaryKind::fixed) {
    const auto f = std::lower_bound(fixed_.begin(), fixed_.end(), source) - fixed_.begin();
    for (std::size_t r = 0; r < rows.size(); ++r)
      add(static_cast<Eigen::Index>(r), Matrix(completion_.block(2 * (t.offset + rows[r]), 3 * f, 2, 3) * s.shape->closure));
  }
  return block;
}

}  // namespace stokes
