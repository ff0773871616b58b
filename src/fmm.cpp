#include "fmm.hpp"

#include <algorithm>
#include <cmath>

#include "fmm_points.hpp"
#include "fmm_strengths.hpp"
#include "fmm_translations.hpp"
#include "interaction_lists.hpp"
#include "quadtree.hpp"
#include "text.hpp"
#include "threads.hpp"

namespace stokes {

namespace {

// The error falls by a factor of 2.09 per term, from 0.35 (measured, the worst over point sets and quantities); the order
// is for a quarter of the requested error.
int order_for(double tolerance) {
  if (!(tolerance >= 1e-13 && tolerance <= 0.1)) {
    throw InputError(concat("fast multipole method: the tolerance is ", tolerance,
                            "; it must lie between 1e-13 and 0.1"));
  }
  return static_cast<int>(std::ceil(std::log(1.4 / tolerance) / std::log(2.09)));
}

// Measured: between 20 and 60 points per leaf the time varies by a tenth; the optimum grows with the order.
int leaf_size_for(int order) { return 40 + order; }

// log(|s|^2) - 1: what a_0 contributes to A_0 at a distance s.
double logarithm_factor(int offset, double size) {
  const Complex s = size * offset_vector(offset);
  return std::log(dot(s, s)) - 1.0;
}

void write(const VelocityPack& sum, const int* index, int count, FlowFields& fields) {
  for (int k = 0; k < count; ++k) fields.velocity[index[k]] = {sum.x[k], sum.y[k]};
}

void write(const GradientPack& sum, const int* index, int count, FlowFields& fields) {
  for (int k = 0; k < count; ++k) {
    fields.velocity[index[k]] = {sum.x[k], sum.y[k]};
    fields.pressure[index[k]] = sum.pressure[k];
    fields.velocity_x[index[k]] = {sum.x_x[k], sum.y_x[k]};
    fields.velocity_y[index[k]] = {sum.x_y[k], -sum.x_x[k]};
  }
}

}  // namespace

struct FmmPlan::Parts {
  Translations translations;
  Quadtree tree;
  InteractionLists lists;
  SortedStrengths strengths;
  Expansions multipoles, locals;

  Parts(const PointArray& sources, const PointArray* targets, const FmmOptions& options);

  ExpansionFrame frame(const Box& box) const {
    return {box.x, box.y, tree.box_size(box.level), translations.order(), multipoles.stride()};
  }
  template <class Body>
  void for_boxes(int level, const Body& body) const;
  void find_multipole(int b);
  void find_local(int b);
  template <class FlowPack>
  FlowPack near_flow(int b, Pack x, Pack y) const;
  template <class FlowPack>
  void evaluate_leaf(int b, FlowFields& fields) const;
  template <class FlowPack>
  void evaluate(FlowFields& fields);
};

FmmPlan::Parts::Parts(const PointArray& sources, const PointArray* targets, const FmmOptions& options)
    : translations(order_for(options.tolerance)),
      tree(sources, targets, leaf_size_for(translations.order())),
      lists(find_interactions(tree, translations.order())) {
  multipoles.resize(tree.box_count(), translations.order());
  locals.resize(tree.box_count(), translations.order());
}

// Calls body(b) for the boxes of a level, in any order and side by side.
template <class Body>
void FmmPlan::Parts::for_boxes(int level, const Body& body) const {
  constexpr int piece = 4;              // some microseconds of work
  constexpr long points_of_a_box = 64;  // in the time they take
  const int begin = tree.first_box(level), end = tree.first_box(level + 1);
  parallel_for_large((end - begin + piece - 1) / piece, points_of_a_box * (end - begin), [&](long p) {
    const int first = begin + static_cast<int>(p) * piece;
    for (int b = first; b < std::min(end, first + piece); ++b) body(b);
  });
}

void FmmPlan::Parts::find_multipole(int b) {
  const Box& box = tree.boxes()[b];
  if (box.sources.size() == 0) return;
  double* const to = multipoles[b];
  std::fill_n(to, 4 * multipoles.stride(), 0.0);
  if (box.is_leaf()) {
    const PointRange forces = strengths.forces_among(box.sources);
    if (strengths.has_stresslets()) add_to_multipole(frame(box), strengths.stresslets(), box.sources, to);
    if (forces.size() > 0) add_to_multipole(frame(box), strengths.forces(), forces, to);
    return;
  }
  for (int c = box.first_child; c < box.first_child + box.child_count; ++c) {
    const Box& child = tree.boxes()[c];
    if (child.sources.size() > 0) translations.multipole_to_multipole(multipoles[c], child.quadrant(), to);
  }
}

void FmmPlan::Parts::find_local(int b) {
  const Box& box = tree.boxes()[b];
  if (box.targets.size() == 0) return;
  const int stride = locals.stride();
  double* const to = locals[b];
  std::fill_n(to, 4 * stride, 0.0);
  for (const FarSource source : lists.far[b]) {
    const double* const from = multipoles[source.box];
    translations.multipole_to_local(from, source.offset, strengths.has_forces(), to);
    if (strengths.has_forces()) {
      const double factor = logarithm_factor(source.offset, tree.box_size(box.level));
      to[0] += factor * from[0], to[stride] += factor * from[stride];
    }
  }
  for (const int leaf : lists.coarse[b]) {
    const PointRange sources = tree.boxes()[leaf].sources, forces = strengths.forces_among(sources);
    if (strengths.has_stresslets()) add_to_local(frame(box), strengths.stresslets(), sources, to);
    if (forces.size() > 0) add_to_local(frame(box), strengths.forces(), forces, to);
  }
  if (box.parent >= 0) translations.local_to_local(locals[box.parent], box.quadrant(), to);
}

template <class FlowPack>
FlowPack FmmPlan::Parts::near_flow(int b, Pack x, Pack y) const {
  const Box& box = tree.boxes()[b];
  FlowPack sum;
  if (strengths.has_stresslets()) {
    const StressletArrays& s = strengths.stresslets();
    // Points that coincide share a leaf.
    if (!box.coincident) {
      add_stresslets<Coincident::possible>(x, y, s, box.sources.begin, box.sources.end, sum);
    }
    for (const PointRange r : lists.near[b]) add_stresslets<Coincident::absent>(x, y, s, r.begin, r.end, sum);
  }
  if (strengths.has_forces()) {
    const PointForceArrays& s = strengths.forces();
    const PointRange own = strengths.forces_among(box.sources);
    if (!box.coincident) add_point_forces<Coincident::possible>(x, y, s, own.begin, own.end, sum);
    for (const PointRange sources : lists.near[b]) {
      const PointRange r = strengths.forces_among(sources);
      add_point_forces<Coincident::absent>(x, y, s, r.begin, r.end, sum);
    }
  }
  return sum;
}

template <class FlowPack>
void FmmPlan::Parts::evaluate_leaf(int b, FlowFields& fields) const {
  const Box& box = tree.boxes()[b];
  const SortedPoints& targets = tree.targets();
  for (int i = box.targets.begin; i < box.targets.end; i += lanes) {
    const int n = std::min(lanes, box.targets.end - i);
    double px[lanes], py[lanes];
    for (int k = 0; k < lanes; ++k) {
      px[k] = targets.x[i + std::min(k, n - 1)], py[k] = targets.y[i + std::min(k, n - 1)];
    }
    const Pack x = load(px), y = load(py);
    FlowPack sum = near_flow<FlowPack>(b, x, y);
    add_local_flow(frame(box), locals[b], x, y, sum);
    for (const int source : lists.fine[b]) {
      const Box& small = tree.boxes()[source];
      add_multipole_flow(frame(small), multipoles[source], strengths.has_forces(), x, y, sum);
    }
    write(sum, targets.index.data() + i, n, fields);
  }
}

template <class FlowPack>
void FmmPlan::Parts::evaluate(FlowFields& fields) {
  for (int level = tree.level_count() - 1; level >= 0; --level) {
    for_boxes(level, [this](int b) { find_multipole(b); });
  }
  for (int level = 0; level < tree.level_count(); ++level) {
    for_boxes(level, [&](int b) {
      find_local(b);
      if (tree.boxes()[b].is_leaf()) evaluate_leaf<FlowPack>(b, fields);
    });
  }
}

FmmPlan::FmmPlan(const PointArray& points, const FmmOptions& options)
    : parts_(std::make_unique<Parts>(points, nullptr, options)) {}

FmmPlan::FmmPlan(const PointArray& sources, const PointArray& targets, const FmmOptions& options)
    : parts_(std::make_unique<Parts>(sources, &targets, options)) {}

FmmPlan::~FmmPlan() = default;
FmmPlan::FmmPlan(FmmPlan&&) noexcept = default;
FmmPlan& FmmPlan::operator=(FmmPlan&&) noexcept = default;

void FmmPlan::evaluate(const SourceStrengths& strengths, FlowOutput output, FlowFields& fields) const {
  Parts& parts = *parts_;
  check_strength_sizes(strengths, parts.tree.sources().size());
  parts.strengths.sort(parts.tree.sources(), strengths);
  fields.resize(parts.tree.targets().size(), output);
  if (output == FlowOutput::gradient) {
    parts.evaluate<GradientPack>(fields);
  } else {
    parts.evaluate<VelocityPack>(fields);
  }
}

}  // namespace stokes
