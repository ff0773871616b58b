#include "completion.hpp"

namespace stokes {

namespace {

// z = A w + B/w with A = (a+b)/2, B = (a-b)/2, |w| >= 1 outside, and s = A w - B/w = sqrt(z^2 - 4AB), 2 sqrt(AB) the
// distance of the foci from the centre.
struct EllipsePoint {
  Complex z, s, w;

  EllipsePoint(double A, Complex focus, Complex z_) : z(z_) {
    // Of the two roots, the one with |w| >= 1 has Re(s/z) > 0 everywhere outside the body.
    s = std::sqrt((z - focus) * (z + focus));
    if (dot(s, z) < 0.0) s = -s;
    w = (z + s) / (2.0 * A);
  }
};

// The same s, from its square p. Without the care of std::sqrt for numbers near the ends of the range.
ComplexPack outer_root(ComplexPack p, ComplexPack z) {
  const Pack modulus = sqrt(squared(p)), larger = sqrt(0.5 * (modulus + absolute(p.re)));
  const Pack smaller = 0.5 * absolute(p.im) / larger;
  const auto right = p.re >= 0.0;
  const Pack re = right ? larger : smaller, im = flip_sign(right ? smaller : larger, sign_bits(p.im));
  const PackBits flip = sign_bits(re * z.re + im * z.im);
  return {flip_sign(re, flip), flip_sign(im, flip)};
}

ComplexPack broadcast(Complex value) { return {stokes::broadcast(value.real()), stokes::broadcast(value.imag())}; }

}  // namespace

CompletionFlow::CompletionFlow(const Shape& shape, const Pose& pose, const Wrench& wrench, double log_length)
    : centre_(pose.centre), axis_(pose.axis()), A_(0.5 * (shape.a + shape.b)), B_(0.5 * (shape.a - shape.b)),
      focus_(2.0 * std::sqrt(Complex(A_ * B_, 0.0))), log_unit_(std::log(log_length)),
      force_(std::conj(axis_) * wrench.force / (4.0 * pi)), torque_(0.0, wrench.torque / (4.0 * pi * (A_ * A_ + B_ * B_))) {}

// In the body frame:
//   force F:  u = (1/4 pi) ( -ln|A w| F + F/2 + (conj(F)/2) (z/conj(s) - conj(m)) ),  m = (A^2+B^2)/(A w s)
//   torque L: phi = i Om B/w, psi = i Om A/w + i Om B (A/w + B w)/(A w^2 - B), Om = L/(4 pi (A^2+B^2)),
//             u = phi - z conj(phi') - conj(psi),  A w^2 - B = w s
ComplexPack CompletionFlow::velocity(ComplexPack x) const {
  const ComplexPack force = broadcast(force_), torque = broadcast(torque_), axis = broadcast(axis_);
  const ComplexPack z = conj(axis) * (x - broadcast(centre_)), focus = broadcast(focus_);
  const ComplexPack s = outer_root((z - focus) * (z + focus), z), w = 0.5 / A_ * (z + s);
  const ComplexPack by_w = inverse(w), by_s = inverse(s), both = by_w * by_s;
  const Pack logarithm = 0.5 * log(A_ * A_ * squared(w)) - log_unit_;
  ComplexPack u = (0.5 - logarithm) * force + 0.5 * conj(force) * (z * conj(by_s) - (A_ * A_ + B_ * B_) / A_ * conj(both));
  if (torque_ != 0.0) {
    const ComplexPack decay = B_ * both;
    u = u + torque * (B_ * by_w) + z * conj(torque * decay) - conj(torque * (A_ * by_w + decay * (A_ * by_w + B_ * w)));
  }
  return axis * u;
}

Complex CompletionFlow::velocity(Complex x) const {
  const ComplexPack u = velocity(broadcast(x));
  return {u.re[0], u.im[0]};
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
