// Nearest points of two boundaries in their parameters, and the width of the gap between them.
#include <doctest/doctest.h>

#include <cmath>

#include "container_gap.hpp"
#include "facing.hpp"

using namespace stokes;

TEST_CASE("nearest points, normal, gap and curvatures are those of gap()") {
  const Body a{{0.7, 0.2}, {{0.1, -0.3}, 0.4}}, b{{0.5, 0.3}, {{0.9, 0.5}, -1.1}};
  const Facing f = facing(a, b);
  const Gap g = gap(a, b);
  CHECK(f.gap == g.value);
  CHECK(f.normal == g.normal);
  CHECK(std::abs(a.pose.centre + a.pose.axis() * a.shape.point(f.alpha_a) - g.point_a) < 1e-14);
  CHECK(std::abs(b.pose.centre + b.pose.axis() * b.shape.point(f.alpha_b) - g.point_b) < 1e-14);
  const Complex t_a = a.pose.axis() * a.shape.derivative(f.alpha_a), t_b = b.pose.axis() * b.shape.derivative(f.alpha_b);
  CHECK(std::abs(t_a / std::abs(t_a) + t_b / std::abs(t_b)) < 1e-14);

  const Container wall{{0.2, 0.1}, 2.0, 64, {}, 0.3};
  const Facing w = facing(a, wall);
  const Gap against = gap(a, wall);
  CHECK(w.gap == against.value);
  CHECK(w.curvature_b == -0.5);
  CHECK(std::abs(wall_pose(wall).centre + wall_pose(wall).axis() * wall_shape(wall).point(w.alpha_b) - against.point_b) <
        1e-14);
}

TEST_CASE("the width of a small gap is sqrt(2 gap/curvature); of a flat one less; of a wide one about the distance") {
  for (const double gap : {1e-8, 1e-5, 1e-3}) {
    const Body a{{1.0, 1.0}, {}}, b{{0.25, 0.25}, {{0.0, 1.25 + gap}, 0.0}};
    CHECK(std::abs(contact_width(facing(a, b), a, b) / std::sqrt(2.0 * gap / 5.0) - 1.0) < 0.1);
    const Body flat{{1.0, 0.05}, {}}, above{{1.0, 0.05}, {{0.0, 0.1 + gap}, 0.0}};
    const double x = std::sqrt(2.0 * gap / 0.1), width = contact_width(facing(flat, above), flat, above);
    CHECK(width < 1.05 * x);
    CHECK(width > 0.9 * x);
    const Container wall{{0.0, 0.0}, 5.0, 64};
    const Body beside{{0.5, 0.5}, {{4.5 - gap, 0.0}, 0.0}};
    CHECK(std::abs(contact_width(facing(beside, wall), beside, wall) / std::sqrt(2.0 * gap / 1.8) - 1.0) < 0.1);
  }
  // Twice 0.2 (1 - sqrt(1 - x^2)) of the flat sides is the gap.
  const Body flat{{1.0, 0.2}, {}}, above{{1.0, 0.2}, {{0.0, 0.4 + 0.2}, 0.0}};
  const double x = std::sqrt(1.0 - 0.25);
  CHECK(std::abs(contact_width(facing(flat, above), flat, above) / std::hypot(x, 0.2) - 1.0) < 0.05);
  const Body large{{100.0, 100.0}, {}}, small{{1.0, 1.0}, {{0.0, 106.0}, 0.0}};
  CHECK(std::abs(contact_width(facing(large, small), large, small) / std::hypot(1.0, 5.0) - 1.0) < 0.05);
}

TEST_CASE("overlapping bodies have a width, too") {
  const Body a{{1.0, 0.3}, {}}, b{{1.0, 1.0}, {{0.0, 1.2}, 0.0}};
  const Facing f = facing(a, b);
  REQUIRE(f.gap < 0.0);
  CHECK(contact_width(f, a, b) > 0.0);
  CHECK(contact_width(f, a, b) < 1e-3);
}
