#include "gap.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace stokes {

namespace {

// v in the frame whose first axis is `axis`, and back. std::complex's own product tests for NaN.
Complex to_frame(Complex v, Complex axis) { return {dot(axis, v), cross(axis, v)}; }
Complex from_frame(Complex v, Complex axis) {
  return {v.real() * axis.real() - v.imag() * axis.imag(),
          v.real() * axis.imag() + v.imag() * axis.real()};
}

Complex unit(Complex v) { return v / std::sqrt(dot(v, v)); }

// The separation along one direction n, s(n), with s'(n) for a counter-clockwise turn of n.
struct Sample {
  Complex n;
  double value, slope;
  Complex arm_a, arm_b;  // support points relative to the centres
  Complex reach;         // from A's support point to B's: s(m) <= <m, reach> for every m, equal at m = n
  double radius_a, radius_b;  // radii of curvature at the support points
};

struct Pair {
  const Shape& shape_a;
  const Shape& shape_b;
  Complex axis_a, axis_b;
  Complex d;  // c_B - c_A

  Pair(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b)
      : shape_a(a), shape_b(b), axis_a(pose_a.axis()), axis_b(pose_b.axis()),
        d(pose_b.centre - pose_a.centre) {}

  Sample at(Complex n) const {
    const Support a = shape_a.support(to_frame(n, axis_a));
    const Support b = shape_b.support(to_frame(-n, axis_b));
    const Complex arm_a = from_frame(a.point, axis_a), arm_b = from_frame(b.point, axis_b);
    const Complex reach = d + arm_b - arm_a;
    return {n,     dot(n, d) - a.height - b.height, cross(n, reach), arm_a, arm_b,
            reach, a.curvature_radius,              b.curvature_radius};
  }
};

// Directions between two samples, less than half a turn apart, and a bound on s over them: s is below both
// <n, left.reach> and <n, right.reach>, which cross at `crossing`.
struct Arc {
  Sample left, right;
  Complex crossing;
  double bound;

  // Arcs are at most a quarter turn, so <n, reach> cannot have its maximum |reach| inside and still be
  // negative at the crossing; where it is positive, the bodies are at most |reach| apart.
  Arc(const Sample& l, const Sample& r) : left(l), right(r) {
    const Complex chord = l.reach - r.reach;
    crossing = chord == Complex{} ? l.n : -perp(unit(chord));
    bound = dot(crossing, l.reach);
    if (bound > 0.0) bound = std::sqrt(std::min(dot(l.reach, l.reach), dot(r.reach, r.reach)));
  }

  // True if s'' = -s - R_A - R_B is certainly negative all over the arc. For an arc of width w and both ends'
  // largest height h, heights in between are at most h / cos(w/2), because a support function is convex when
  // extended to all vectors. Hence -s is at most the maximum of its end values / cos(w/2). Since an
  // ellipse has R = a^2 b^2 / h^3, each R is at least the minimum of its end values times cos^3(w/2).
  bool concave() const {
    const double cosine_squared = 0.5 * (1.0 + dot(left.n, right.n));
    const double radius = std::min(left.radius_a, right.radius_a) + std::min(left.radius_b, right.radius_b);
    return radius * cosine_squared * cosine_squared > std::max({0.0, -left.value, -right.value});
  }
};

// The maximum of s in an arc where s' changes from positive to negative: Newton's iteration for s' = 0,
// kept inside the shrinking arc, and bisection wherever it is slow (by itself it can cycle for ever
// around the bend of s at the flat side of a slender body).
Sample maximise(const Pair& pair, const Arc& arc, double size) {
  Complex low = arc.left.n, high = arc.right.n, n = arc.crossing;
  double last_slope = std::max(arc.left.slope, -arc.right.slope);
  for (int iteration = 0;; ++iteration) {
    const Sample sample = pair.at(n);
    const double slope = std::abs(sample.slope);
    if (iteration == 100 || slope <= 1e-16 * size) return sample;
    (sample.slope > 0.0 ? low : high) = n;
    const double curvature = -sample.value - sample.radius_a - sample.radius_b;
    const double turn = -sample.slope / curvature;
    n = unit(n + turn * perp(n));
    // The error after a turn is its square times at most about the aspect ratio.
    if (curvature < 0.0 && std::abs(turn) < 1e-9) return pair.at(n);
    const bool inside = curvature < 0.0 && cross(low, n) > 0.0 && cross(n, high) > 0.0;
    if (!inside || slope > 0.5 * last_slope) n = unit(low + high);
    last_slope = slope;
  }
}

// The global maximum of s, by branch and bound: the arc that may hold the largest value is either concave,
// and settled by Newton's iteration, or split. Only where s is nearly constant over a range of
// directions (nearly circular bodies, nearly concentric) are there arcs left after `splits`, and these
// are then narrow enough to be taken for concave.
Sample largest_separation(const Pair& pair) {
  constexpr int splits = 64;
  const double distance = std::abs(pair.d);
  const double size = distance + pair.shape_a.circumradius() + pair.shape_b.circumradius();
  const Complex first = distance > 1e-12 * size ? pair.d / distance : pair.axis_a;

  std::vector<Arc> arcs;
  arcs.reserve(8);
  const Sample corners[] = {pair.at(first), pair.at(perp(first)), pair.at(-first), pair.at(-perp(first))};
  Sample best = corners[0];
  for (int k = 0; k < 4; ++k) {
    if (corners[k].value > best.value) best = corners[k];
    arcs.emplace_back(corners[k], corners[(k + 1) % 4]);
  }
  for (int split = 0; !arcs.empty();) {
    const auto top = std::max_element(arcs.begin(), arcs.end(),
                                      [](const Arc& x, const Arc& y) { return x.bound < y.bound; });
    if (!(top->bound > best.value + 1e-15 * size)) break;
    const Arc arc = *top;
    *top = arcs.back();
    arcs.pop_back();
    const bool settled = split == splits || arc.concave();
    if (settled && !(arc.left.slope > 0.0 && arc.right.slope < 0.0)) continue;
    const Sample sample = settled ? maximise(pair, arc, size) : pair.at(arc.crossing);
    if (sample.value > best.value) best = sample;
    if (settled) continue;
    ++split;
    arcs.emplace_back(arc.left, sample);
    arcs.emplace_back(sample, arc.right);
  }
  return best;
}

bool is_disc(const Shape& shape) { return shape.a == shape.b; }

Gap gap_of_discs(double radius_a, Complex a, double radius_b, Complex b) {
  const Complex d = b - a;
  const double distance = std::abs(d);
  const Complex n = distance > 0.0 ? d / distance : Complex{1.0, 0.0};
  return {distance - radius_a - radius_b, n, a + radius_a * n, b - radius_b * n};
}

}  // namespace

Gap gap(const Shape& shape_a, const Pose& a, const Shape& shape_b, const Pose& b) {
  if (is_disc(shape_a) && is_disc(shape_b)) return gap_of_discs(shape_a.a, a.centre, shape_b.a, b.centre);
  const Sample best = largest_separation({shape_a, a, shape_b, b});
  // On a flat side, round-off in n moves the support points apart along it. Placed about their common
  // midpoint, opposite forces along n at the two points are on one line.
  const Complex middle = 0.5 * ((a.centre + best.arm_a) + (b.centre + best.arm_b));
  const Complex half = 0.5 * best.value * best.n;
  return {best.value, best.n, middle - half, middle + half};
}

GapGradient gradient(const Gap& gap, const Pose& a, const Pose& b) {
  const Complex n = gap.normal;
  return {-n, n, -cross(gap.point_a - a.centre, n), cross(gap.point_b - b.centre, n)};
}

namespace {

// Two bodies moving linearly in centre and angle over tau in [0, 1].
struct Motion {
  const Shape& shape_a;
  const Pose& a_start;
  const Pose& a_end;
  const Shape& shape_b;
  const Pose& b_start;
  const Pose& b_end;
  Complex way = (b_end.centre - a_end.centre) - (b_start.centre - a_start.centre);
  double turn_a = a_end.angle - a_start.angle, turn_b = b_end.angle - b_start.angle;

  Pose a(double tau) const { return interpolate(a_start, a_end, tau); }
  Pose b(double tau) const { return interpolate(b_start, b_end, tau); }
  double reach() const { return shape_a.circumradius() + shape_b.circumradius(); }

  Gap gap_at(double tau) const { return gap(shape_a, a(tau), shape_b, b(tau)); }

  // Time derivative of a separation with that gradient.
  double rate(const GapGradient& g) const {
    return dot(g.centre_b, way) + g.angle_a * turn_a + g.angle_b * turn_b;
  }
};

struct Interval {
  double start, end;
};

// The part of [0, 1] in which the circumscribed circles are within `distance`, a little widened; empty
// (start > end) if they never are.
Interval meeting_interval(const Motion& motion, double distance) {
  const Complex d = motion.b_start.centre - motion.a_start.centre;
  const double limit = (1.0 + 1e-9) * (motion.reach() + distance) + 1e-15 * std::abs(d);
  const double speed = std::abs(motion.way);
  if (speed == 0.0) return std::abs(d) > limit ? Interval{1.0, 0.0} : Interval{0.0, 1.0};
  const Complex direction = motion.way / speed;
  const double miss = std::abs(cross(direction, d));
  if (miss > limit) return {1.0, 0.0};
  const double middle = -dot(direction, d), half = std::sqrt((limit - miss) * (limit + miss));
  return {std::max(0.0, (middle - half) / speed), std::min(1.0, (middle + half) / speed)};
}

// The longest safe advance from tau; zero if the separation along n at tau is within `tolerance` of the
// target. During the advance that separation, and with it the gap, stays above the target: for an ellipse
// of long and short semi-axis a and b, |dh/dtheta| <= a - b bounds its rate of change from below, and
// d^2 h/dtheta^2 <= a^2/b - b its second derivative.
double safe_advance(const Motion& motion, Complex n, double tau, double target, double tolerance) {
  const Pose a = motion.a(tau), b = motion.b(tau);
  const Sample sample = Pair(motion.shape_a, a, motion.shape_b, b).at(n);
  const double excess = sample.value - target;
  if (!(excess > tolerance)) return 0.0;
  double fall = -dot(n, motion.way), bend = 0.0;
  const auto add = [&](const Shape& shape, double turn) {
    const double longer = shape.circumradius(), shorter = shape.inradius();
    fall += (longer - shorter) * std::abs(turn);
    bend += (longer - shorter) * (longer + shorter) / shorter * turn * turn;
  };
  add(motion.shape_a, motion.turn_a);
  add(motion.shape_b, motion.turn_b);
  if (fall <= 0.0) return 2.0;
  // The positive root of excess + rate t - bend t^2 / 2.
  const double rate = motion.rate({-n, n, -cross(sample.arm_a, n), cross(sample.arm_b, n)});
  const double root = std::sqrt(rate * rate + 2.0 * bend * excess);
  const double rising = bend > 0.0 ? (rate + root) / bend : 2.0;
  return std::max(excess / fall, rate < 0.0 ? 2.0 * excess / (root - rate) : rising);
}

}  // namespace

std::optional<Hit> first_hit(const Shape& shape_a, const Pose& a_start, const Pose& a_end,
                             const Shape& shape_b, const Pose& b_start, const Pose& b_end, double threshold) {
  const Motion motion{shape_a, a_start, a_end, shape_b, b_start, b_end};
  const double tolerance = std::max(1e-3 * threshold, 1e-12 * motion.reach());
  const Interval meeting = meeting_interval(motion, threshold + tolerance);
  if (meeting.start > meeting.end) return std::nullopt;
  double tau = meeting.start, target = threshold;
  Hit hit{};
  for (int advances = 0; advances < 200; ++advances) {
    hit = {tau, motion.gap_at(tau)};
    if (hit.gap.value > threshold + tolerance) {
      target = threshold;
    } else if (tau == 0.0) {
      const double rate = motion.rate(gradient(hit.gap, motion.a(0.0), motion.b(0.0)));
      if (!(rate >= -tolerance)) return hit;
      target = hit.gap.value - 2.0 * tolerance;
    } else if (!(hit.gap.value > target + tolerance)) {
      return hit;
    }
    const auto advance = [&] { return safe_advance(motion, hit.gap.normal, tau, target, 0.5 * tolerance); };
    if (target < threshold) {
      tau += 0.5 * advance();  // about the time of the largest gap before it can be back at the target
    } else {
      // As far as one normal leads, which costs much less than a gap with a new normal.
      for (int steps = 0; steps < 64 && tau < meeting.end; ++steps) {
        const double step = advance();
        if (step == 0.0) break;
        tau += step;
      }
    }
    if (tau >= meeting.end) return std::nullopt;
  }
  return hit;
}

SeparatingPlane separating_plane(const Gap& gap, const Pose& a, const Pose& b) {
  return {gap.normal, to_frame(gap.point_a - a.centre, a.axis()),
          to_frame(gap.point_b - b.centre, b.axis())};
}

double separation(const SeparatingPlane& plane, const Pose& a, const Pose& b) {
  const Complex arm_a = from_frame(plane.material_a, a.axis());
  const Complex arm_b = from_frame(plane.material_b, b.axis());
  return dot(plane.normal, (b.centre - a.centre) + (arm_b - arm_a));
}

GapGradient gradient(const SeparatingPlane& plane, const Pose& a, const Pose& b) {
  const Complex n = plane.normal;
  return {-n, n, -cross(from_frame(plane.material_a, a.axis()), n),
          cross(from_frame(plane.material_b, b.axis()), n)};
}

}  // namespace stokes
