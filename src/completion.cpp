#include "completion.hpp"

namespace stokes {

namespace {

// z = A w + B/w with A = (a+b)/2, B = (a-b)/2, |w| >= 1 outside, and s = A w - B/w = sqrt(z^2 - 4AB).
struct EllipsePoint {
  double A, B;
  Complex z, s, w;

  EllipsePoint(const Shape& shape, Complex z_) : A(0.5 * (shape.a + shape.b)), B(0.5 * (shape.a - shape.b)), z(z_) {
    // Of the two roots, the one with |w| >= 1 has Re(s/z) > 0 everywhere outside the body.
    const Complex focus = 2.0 * std::sqrt(Complex(A * B, 0.0));
    s = std::sqrt((z - focus) * (z + focus));
    if (dot(s, z) < 0.0) s = -s;
    w = (z + s) / (2.0 * A);
  }
};

}  // namespace

// In the body frame:
//   force F:  u = (1/4 pi) ( -ln|A w| F + F/2 + (conj(F)/2) (z/conj(s) - conj(m)) ),  m = (A^2+B^2)/(A w s)
//   torque L: phi = i Om B/w, psi = i Om A/w + i Om B (A/w + B w)/(A w^2 - B), Om = L/(4 pi (A^2+B^2)),
//             u = phi - z conj(phi') - conj(psi)
Complex completion_velocity(const Shape& shape, const Pose& pose, const Wrench& wrench, Complex x,
                            double log_length) {
  const Complex axis = pose.axis();
  const auto [A, B, z, s, w] = EllipsePoint(shape, std::conj(axis) * (x - pose.centre));
  const double norm = A * A + B * B;
  const Complex F = std::conj(axis) * wrench.force;
  const Complex m = norm / (A * w * s);
  const double logarithm = std::log(std::abs(A * w) / log_length);
  const Complex from_force =
      (F * (0.5 - logarithm) + 0.5 * std::conj(F) * (z / std::conj(s) - std::conj(m))) / (4.0 * pi);

  const Complex iOm(0.0, wrench.torque / (4.0 * pi * norm));
  const Complex phi = iOm * B / w;
  const Complex dphi = -iOm * B / (A * w * w - B);
  const Complex psi = iOm * A / w + iOm * B * (A / w + B * w) / (A * w * w - B);
  const Complex from_torque = phi - z * std::conj(dphi) - std::conj(psi);

  return axis * (from_force + from_torque);
}

// The force's own Goursat functions are phi = -(F/8 pi) (log(A w) - 1) and psi = (conj(F) log(A w) + F m)/(8 pi);
// only the real part of the logarithm enters the velocity. d w/dz = w/s, d s/dz = z/s.
PointFlow completion_flow(const Shape& shape, const Pose& pose, const Wrench& wrench, Complex x, double log_length) {
  const Complex axis = pose.axis();
  const auto [A, B, z, s, w] = EllipsePoint(shape, std::conj(axis) * (x - pose.centre));
  const double norm = A * A + B * B;
  const Complex inverse = 1.0 / s, decay = inverse + z * inverse * inverse;  // -d log(1/(w s))/dz
  const Complex f = std::conj(axis) * wrench.force / (8.0 * pi), conjugate = std::conj(f);
  const double logarithm = std::log(std::abs(A * w) / log_length);
  const Complex m = norm / (A * w) * inverse;
  const GoursatValues force{f * (1.0 - logarithm), -f * inverse, f * z * inverse * inverse * inverse,
                            conjugate * logarithm + f * m, conjugate * inverse - f * m * decay};

  const Complex iOm(0.0, wrench.torque / (4.0 * pi * norm));
  const Complex g = iOm * B / w * inverse, plus = A / w + B * w, minus = A / w - B * w;
  const GoursatValues torque{iOm * B / w, -g, g * decay, iOm * A / w + g * plus,
                             -iOm * A / w * inverse - g * (minus * inverse + plus * decay)};

  return turned(goursat_flow(z, force) + goursat_flow(z, torque), axis);
}

// On |w| = 1: u = (1/4 pi) ( (1/2 - ln A) F + (B/2A) conj(F) )  and  omega = Om.
RigidVelocity completion_trace(const Shape& shape, const Pose& pose, const Wrench& wrench, double log_length) {
  const double A = 0.5 * (shape.a + shape.b), B = 0.5 * (shape.a - shape.b);
  const Complex axis = pose.axis(), F = std::conj(axis) * wrench.force;
  return {axis * ((0.5 - std::log(A / log_length)) * F + 0.5 * B / A * std::conj(F)) / (4.0 * pi),
          wrench.torque / (4.0 * pi * (A * A + B * B))};
}

Complex completion_stresslet(const Shape& shape, const Pose& pose, const Wrench& wrench) {
  const double a2 = shape.a * shape.a, b2 = shape.b * shape.b;
  return std::polar(1.0, 2.0 * pose.angle) * Complex(0.0, -0.5 * wrench.torque * (a2 - b2) / (a2 + b2));
}

}  // namespace stokes
