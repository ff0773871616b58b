#include "direct_fields.hpp"

#include <algorithm>
#include <cmath>

#include "pair_kernels.hpp"
#include "text.hpp"
#include "threads.hpp"

namespace stokes {

namespace {

// Strengths as the kernels take them: structures of arrays with the prefactors.
struct ScaledStrengths {
  std::vector<double> ex, ey, fx, fy, torque;
  StressletArrays stresslets{};
  PointForceArrays point_forces{};
  bool has_stresslets, has_point_forces;

  ScaledStrengths(const PointArray& sources, const SourceStrengths& s) {
    const int count = sources.size();
    has_stresslets = s.density && s.density->size() > 0;
    const bool has_force = s.force && s.force->size() > 0, has_torque = s.torque && s.torque->size() > 0;
    has_point_forces = has_force || has_torque;
    if (has_stresslets) {
      ex.resize(count), ey.resize(count);
      for (int j = 0; j < count; ++j) {
        const Complex density = (*s.density)[j] / pi;
        ex[j] = density.real(), ey[j] = density.imag();
      }
      stresslets = {sources.x.data(), sources.y.data(), s.weighted_normal->x.data(),
                    s.weighted_normal->y.data(), ex.data(), ey.data()};
    }
    if (has_point_forces) {
      fx.resize(count), fy.resize(count), torque.resize(count);
      for (int j = 0; j < count; ++j) {
        const Complex force = has_force ? (*s.force)[j] / (4.0 * pi) : Complex{};
        fx[j] = force.real(), fy[j] = force.imag();
        torque[j] = has_torque ? (*s.torque)[j] / (4.0 * pi) : 0.0;
      }
      point_forces = {sources.x.data(), sources.y.data(), fx.data(), fy.data(), torque.data()};
    }
  }
};

template <class FieldPack>
FieldPack sum_sources(const double* x, const double* y, const ScaledStrengths& s, int count) {
  FieldPack sum;
  const Pack px = load(x), py = load(y);
  if (s.has_stresslets) add_stresslets<Coincident::possible>(px, py, s.stresslets, 0, count, sum);
  if (s.has_point_forces) add_point_forces<Coincident::possible>(px, py, s.point_forces, 0, count, sum);
  return sum;
}

void write(const VelocityPack& sum, int first, int count, FlowFields& fields) {
  for (int k = 0; k < count; ++k) fields.velocity[first + k] = {sum.x[k], sum.y[k]};
}

void write(const GradientPack& sum, int first, int count, FlowFields& fields) {
  for (int k = 0; k < count; ++k) {
    fields.velocity[first + k] = {sum.x[k], sum.y[k]};
    fields.pressure[first + k] = sum.pressure[k];
    fields.velocity_x[first + k] = {sum.x_x[k], sum.y_x[k]};
    fields.velocity_y[first + k] = {sum.x_y[k], -sum.x_x[k]};
  }
}

template <class FieldPack>
void sum_targets(const PointArray& targets, int first, int last, const ScaledStrengths& s, int source_count,
                 FlowFields& fields) {
  for (int i = first; i < last; i += lanes) {
    const int n = std::min(lanes, last - i);
    double x[lanes], y[lanes];
    for (int k = 0; k < lanes; ++k) {
      const int from = i + std::min(k, n - 1);
      x[k] = targets.x[from], y[k] = targets.y[from];
    }
    write(sum_sources<FieldPack>(x, y, s, source_count), i, n, fields);
  }
}

template <class Array>
void check_array(const Array& values, int source_count, const char* name) {
  if (values.size() != source_count) {
    throw InputError(concat("point sources: ", source_count, " sources but ", values.size(),
                            " entries of the ", name, "; give one for each source"));
  }
}

void check_finite(Complex value, int j, const char* name) {
  if (std::isfinite(value.real()) && std::isfinite(value.imag())) return;
  throw NumericalError(concat("point sources: the ", name, " of source ", j,
                              " is not finite; look for the step before that produced it"));
}

}  // namespace

void FlowFields::resize(int count, FlowOutput output) {
  const int gradients = output == FlowOutput::gradient ? count : 0;
  velocity.resize(count);
  pressure.resize(gradients), velocity_x.resize(gradients), velocity_y.resize(gradients);
}

void check_strength_sizes(const SourceStrengths& s, int source_count) {
  const bool has_normal = s.weighted_normal && s.weighted_normal->size() > 0;
  if (has_normal != (s.density && s.density->size() > 0)) {
    throw InputError("point sources: stresslets need both weighted normals and densities; one is missing");
  }
  if (has_normal) check_array(*s.weighted_normal, source_count, "weighted normal");
  if (has_normal) check_array(*s.density, source_count, "density");
  if (s.force && s.force->size() > 0) check_array(*s.force, source_count, "force");
  if (s.torque && s.torque->size() > 0) check_array(*s.torque, source_count, "torque");
}

void check_strengths_finite(const SourceStrengths& s) {
  if (s.weighted_normal) {
    const PointArray& n = *s.weighted_normal;
    for (int j = 0; j < n.size(); ++j) check_finite({n.x[j], n.y[j]}, j, "weighted normal");
  }
  if (s.density) {
    for (int j = 0; j < s.density->size(); ++j) check_finite((*s.density)[j], j, "density");
  }
  if (s.force) {
    for (int j = 0; j < s.force->size(); ++j) check_finite((*s.force)[j], j, "force");
  }
  if (s.torque) {
    for (int j = 0; j < s.torque->size(); ++j) check_finite((*s.torque)[j], j, "torque");
  }
}

void direct_fields(const PointArray& targets, const PointArray& sources, const SourceStrengths& strengths,
                   FlowOutput output, FlowFields& fields) {
  const int count = targets.size(), source_count = sources.size();
  check_strength_sizes(strengths, source_count);
  check_strengths_finite(strengths);
  const ScaledStrengths scaled(sources, strengths);
  fields.resize(count, output);
  // Below about 1e5 pairs starting the threads costs more than the sum.
  constexpr long pairs_per_task = 100000;
  const long per_task = std::max<long>(1, pairs_per_task / std::max(1, source_count) / lanes);
  const int chunk = lanes * static_cast<int>(std::min<long>(per_task, count / lanes + 1));
  parallel_for((count + chunk - 1) / chunk, [&](long c) {
    const int first = static_cast<int>(c) * chunk, last = std::min(count, first + chunk);
    if (output == FlowOutput::gradient) {
      sum_targets<GradientPack>(targets, first, last, scaled, source_count, fields);
    } else {
      sum_targets<VelocityPack>(targets, first, last, scaled, source_count, fields);
    }
  });
}

}  // namespace stokes
