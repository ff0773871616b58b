#include "fmm_strengths.hpp"

#include <algorithm>
#include <atomic>

#include "threads.hpp"

namespace stokes {

void SortedStrengths::sort(const SortedPoints& sources, const SourceStrengths& strengths) {
  sort_stresslets(sources, strengths);
  sort_forces(sources, strengths);
}

void SortedStrengths::sort_stresslets(const SortedPoints& sources, const SourceStrengths& s) {
  has_stresslets_ = s.density && s.density->size() > 0;
  if (!has_stresslets_) return;
  const int count = sources.size();
  nx_.resize(count), ny_.resize(count), ex_.resize(count), ey_.resize(count);
  constexpr int piece = 4096;
  std::atomic<bool> finite = true;
  parallel_for_large((count + piece - 1) / piece, count / 4, [&](long p) {
    double sum = 0.0;
    for (int k = static_cast<int>(p) * piece; k < std::min<long>(count, (p + 1) * piece); ++k) {
      const int j = sources.index[k];
      nx_[k] = s.weighted_normal->x[j], ny_[k] = s.weighted_normal->y[j];
      ex_[k] = (*s.density)[j].real() * (1.0 / pi), ey_[k] = (*s.density)[j].imag() * (1.0 / pi);
      sum += 0.0 * nx_[k] + 0.0 * ny_[k] + 0.0 * ex_[k] + 0.0 * ey_[k];
    }
    if (sum != 0.0) finite = false;  // zero times infinity or nan is nan
  });
  if (!finite) check_strengths_finite(s);
  stresslets_ = {sources.x.data(), sources.y.data(), nx_.data(), ny_.data(), ex_.data(), ey_.data()};
}

void SortedStrengths::sort_forces(const SortedPoints& sources, const SourceStrengths& s) {
  const bool has_force = s.force && s.force->size() > 0, has_torque = s.torque && s.torque->size() > 0;
  has_forces_ = has_force || has_torque;
  if (!has_forces_) return;
  if (has_force) check_strengths_finite({.force = s.force});
  if (has_torque) check_strengths_finite({.torque = s.torque});
  constexpr double factor = 0.25 / pi;
  x_.clear(), y_.clear(), fx_.clear(), fy_.clear(), torque_.clear();
  rank_.assign(sources.size() + 1, 0);
  for (int k = 0; k < sources.size(); ++k) {
    const int j = sources.index[k];
    const Complex force = has_force ? (*s.force)[j] * factor : Complex{};
    const double torque = has_torque ? (*s.torque)[j] * factor : 0.0;
    if (force != 0.0 || torque != 0.0) {
      x_.push_back(sources.x[k]), y_.push_back(sources.y[k]);
      fx_.push_back(force.real()), fy_.push_back(force.imag()), torque_.push_back(torque);
    }
    rank_[k + 1] = static_cast<int>(x_.size());
  }
  forces_ = {x_.data(), y_.data(), fx_.data(), fy_.data(), torque_.data()};
}

}  // namespace stokes
