#include "completion.hpp"

namespace stokes {

namespace {

// With Re >= 0. Without the care of std::sqrt for numbers near the ends of the range.
Complex square_root(Complex p) {
  const double modulus = std::sqrt(std::norm(p)), larger = std::sqrt(0.5 * (modulus + std::abs(p.real())));
  if (larger == 0.0) return 0.0;
  const double smaller = 0.5 * std::abs(p.imag()) / larger;
  const double re = p.real() >= 0.0 ? larger : smaller, im = p.real() >= 0.0 ? smaller : larger;
  return {re, std::copysign(im, p.imag())};
}

// z = A w + B/w with A = (a+b)/2, B = (a-b)/2, |w| >= 1 outside, and s = A w - B/w = sqrt(z^2 - 4AB), 2 sqrt(AB) the
// distance of the foci from the centre.
struct EllipsePoint {
  Complex z, s, w;

  EllipsePoint(double A, Complex focus, Complex z_) : z(z_) {
    // Of the two roots, the one with |w| >= 1 has Re(s/z) > 0 everywhere outside the body.
    s = square_root((z - focus) * (z + focus));
    if (dot(s, z) < 0.0) s = -s;
    w = (z + s) / (2.0 * A);
  }
};

}  // namespace

CompletionFlow::CompletionFlow(const Shape& shape, const Pose& pose, const Wrench& wrench, double log_length)
    : centre_(pose.centre), axis_(pose.axis()), A_(0.5 * (shape.a + shape.b)), B_(0.5 * (shape.a - shape.b)),
      focus_(2.0 * std::sqrt(Complex(A_ * B_, 0.0))), log_unit_(std::log(log_length)),
      force_(std::conj(axis_) * wrench.force / (4.0 * pi)), torque_(0.0, wrench.torque / (4.0 * pi * (A_ * A_ + B_ * B_))) {}

// In the body frame:
//   force F:  u = (1/4 pi) ( -ln|A w| F + F/2 + (conj(F)/2) (z/conj(s) - conj(m)) ),  m = (A^2+B^2)/(A w s)
//   torque L: phi = i Om B/w, psi = i Om A/w + i Om B (A/w + B w)/(A w^2 - B), Om = L/(4 pi (A^2+B^2)),
//             u = phi - z conj(phi') - conj(psi),  A w^2 - B = w s
Complex CompletionFlow::velocity(Complex x) const {
  const auto [z, s, w] = EllipsePoint(A_, focus_, std::conj(axis_) * (x - centre_));
  const Complex by_w = reciprocal(w), by_s = reciprocal(s), both = by_w * by_s;
  const double logarithm = 0.5 * std::log(A_ * A_ * std::norm(w)) - log_unit_;
  Complex u = force_ * (0.5 - logarithm) +
              0.5 * std::conj(force_) * (z * std::conj(by_s) - (A_ * A_ + B_ * B_) / A_ * std::conj(both));
  if (torque_ != 0.0) {
    const Complex decay = B_ * both;
    u += torque_ * (B_ * by_w) + z * std::conj(torque_ * decay) - std::conj(torque_ * (A_ * by_w + decay * (A_ * by_w + B_ * w)));
  }
  return axis_ * u;
}

// The force's own Goursat functions are phi = -(F/8 pi) (log(A w) - 1) and psi = (conj(F) log(A w) + F m)/(8 pi);
// only the real part of the logarithm enters the velocity. d w/dz = w/s, d s/dz = z/s.
PointFlow completion_flow(const Shape& shape, const Pose& pose, const Wrench& wrench, Complex x, double log_length) {
  const Complex axis = pose.axis();
  const double A = 0.5 * (shape.a + shape.b), B = 0.5 * (shape.a - shape.b), norm = A * A + B * B;
  const auto [z, s, w] = EllipsePoint(A, 2.0 * std::sqrt(Complex(A * B, 0.0)), std::conj(axis) * (x - pose.centre));
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
