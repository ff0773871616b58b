// A shape at a given resolution, in its body frame, with everything that is computed once per shape and
// then only rotated: quadrature, rigid-motion moments, close evaluation and the preconditioner block.
#pragma once

#include <map>
#include <memory>
#include <tuple>
#include <variant>
#include <vector>

#include "cauchy.hpp"
#include "close_flow.hpp"
#include "curve.hpp"
#include "interpolation.hpp"
#include "shape.hpp"
#include "suspension.hpp"

namespace stokes {

// Reals of an interleaved density: (Re eta_0, Im eta_0, Re eta_1, ...).
Eigen::Map<const Vector> as_real(const ComplexVector& v);
Eigen::Map<Vector> as_real(ComplexVector& v);

// The real 2T x 2N matrix of eta -> turn * (direct eta + conjugate conj(eta)), interleaved both ways.
Matrix real_matrix(const VelocityRows& rows, Complex turn);

// How the double layer is evaluated close to the curve.
enum class NearSingular {
  cauchy,         // Cauchy integrals, spectrally accurate at any distance (cauchy.hpp)
  interpolation,  // the paper's: upsampling and interpolation from the boundary limit (interpolation.hpp)
};

class DiscreteShape {
 public:
  DiscreteShape(const Shape& shape, int points, NearSingular near_singular);

  int size() const { return curve.size(); }

  // Rigid part of a density: the motion whose quadrature-weighted moments it shares,
  // (U, omega) = G^-1 B_w^T eta with B = [e1, e2, i x] and G = B_w^T B.
  RigidVelocity rigid_part(const Complex* density) const;

  // Rows of the double layer's velocity at points z (body frame) outside the body, at any distance.
  VelocityRows close_rows(const std::vector<Complex>& z) const;

  // Flow of the double layer of a density at points z (both in the body frame) outside the body or on it, at any
  // distance: velocity, pressure and gradient. Cost O(N^2) and, per point, of O(N) (Cauchy) or O(N^1.5).
  std::vector<PointFlow> close_flow(const ComplexVector& density, const std::vector<Complex>& z) const;

  // What the plain trapezoid rule, hence a fast sum, gives for it at points z off the nodes.
  std::vector<PointFlow> trapezoid_flow(const ComplexVector& density, const std::vector<Complex>& z) const;

  Shape shape;
  Curve curve;
  Eigen::Matrix<double, 3, Eigen::Dynamic> moments;  // G^-1 B_w^T, 3 x 2N
  Vector diagonal;   // s-signed diagonal limit -s kappa w/(2 pi) of the double layer, factor of t (t . eta)
  Matrix inverse;    // of the deflated block -I/2 + D - (1/2) B G^-1 B_w^T, 2N x 2N

 private:
  std::variant<CloseEvaluation, InterpolationEvaluation> close_;
};

// A discrete shape where it stands, and the place of its density among those of a suspension.
struct PlacedShape {
  const DiscreteShape* shape;
  Pose pose;
  Complex axis;
  int offset;  // of its first node

  int size() const { return shape->size(); }
  Complex node(int k) const { return pose.centre + axis * shape->curve.position[k]; }
  // A point in the frame of the shape.
  Complex local(Complex x) const { return std::conj(axis) * (x - pose.centre); }
};

// Rows of points z (frame of the shape) that the plain trapezoid rule does not resolve: nearer than seven of
// the curve's largest point spacings. Beyond, it is exact to 1e-10 or better (on a disc the error decays
// like (1 + d/a)^-N).
double near_distance(const DiscreteShape& shape);
// Pressure and gradient take one spacing more for the same 1e-10.
double near_distance_of_gradient(const DiscreteShape& shape);
std::vector<int> near_rows(const DiscreteShape& shape, const std::vector<Complex>& z);

// What the close evaluation adds to the plain trapezoid rule at points z.
VelocityRows near_correction(const DiscreteShape& shape, const std::vector<Complex>& z);

// The double layer of `source` at the nodes of `target`, both densities in their body frames, accurate at any
// distance: real, 2 N_target x 2 N_source.
Matrix interaction(const PlacedShape& target, const PlacedShape& source);

// The shapes in use; each distinct (shape, points) is discretised and factorised once.
class ShapeCache {
 public:
  explicit ShapeCache(NearSingular near_singular = NearSingular::cauchy) : near_singular_(near_singular) {}

  const DiscreteShape& get(const Shape& shape, int points);
  int factorisations() const { return static_cast<int>(shapes_.size()); }

 private:
  NearSingular near_singular_;
  std::map<std::tuple<double, double, int>, std::unique_ptr<DiscreteShape>> shapes_;
};

}  // namespace stokes
