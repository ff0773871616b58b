// A discretised boundary in its body frame, with everything that is computed once per shape and then only
// rotated: quadrature, rigid-motion moments, close evaluation and the preconditioner block.
#pragma once

#include <map>
#include <memory>
#include <tuple>
#include <variant>
#include <vector>

#include "cauchy.hpp"
#include "circle_evaluation.hpp"
#include "close_flow.hpp"
#include "curve.hpp"
#include "direct_sum.hpp"
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

// What is given on a boundary, and the block of its equations. D is the double layer of the boundary on
// itself, B = [e1, e2, i x] are the rigid motions, B_w are these times the quadrature weights.
enum class BoundaryKind {
  free,       // force and torque of a body: -1/2 + D - (1/2) B G^-1 B_w^T, G = B_w^T B; the rigid velocity is
              // half the density's rigid part
  fixed,      // velocity of an obstacle or inner wall: -1/2 + D + C beta B_w^T, C the completion flows of unit
              // force and torque, beta = -2 pi / length: the wrench is beta B_w^T eta
  container,  // velocity of the wall around the fluid: -1/2 + D + nu n Int n.eta, nu = -1/(2 length)
};

class DiscreteShape {
 public:
  // A container must be a disc. log_length: the unit of the distances in the logarithm of Stokeslets.
  // Cost O(N^3); O(N^2) for circles with nodes at equal steps.
  DiscreteShape(const Shape& shape, const Discretisation& nodes, BoundaryKind kind, double log_length,
                NearSingular near_singular);

  int size() const { return curve.size(); }
  // With nodes at equal steps.
  bool is_circle() const { return shape.a == shape.b && nodes.clusters.empty(); }
  Side side() const { return kind == BoundaryKind::container ? Side::interior : Side::exterior; }
  // Weight times normal out of the fluid at a node, body frame.
  Complex weighted_normal(int k) const {
    return (side() == Side::interior ? -1.0 : 1.0) * curve.weight[k] * imaginary_unit * curve.tangent[k];
  }

  // Rigid part of a density: the rigid motion with the same quadrature-weighted moments,
  // (U, omega) = G^-1 B_w^T eta.
  RigidVelocity rigid_part(const Complex* density) const;

  // Solution of the boundary's own block for right-hand sides in the columns of b, 2N reals each, in the precision of b.
  template <class Rhs>
  auto solve_own(const Rhs& b) const {
    using Scalar = typename Rhs::Scalar;
    using Solution = Eigen::Matrix<Scalar, Eigen::Dynamic, Rhs::ColsAtCompileTime>;
    if (inverse_.size() > 0) return Solution(inverse_.template cast<Scalar>() * b);
    const auto motions = motions_.template cast<Scalar>();
    return Solution(motions * (core_.template cast<Scalar>() * (motions.transpose() * b)) - Scalar(2.0) * b);
  }

  // Force and torque of a fixed boundary on the fluid, body frame.
  Wrench wrench(const Complex* density) const;

  // A container's density adds flux_part() n_k to the operator at its node k, where n is the unit normal.
  double flux_part(const Complex* density) const;

  // Rows of the double layer's velocity at points z (body frame) in the fluid, at any distance.
  VelocityRows close_rows(const std::vector<Target>& z) const;
  // The same for some of the nodes of a circle that has_series().
  VelocityRows close_rows(const std::vector<Complex>& z, const std::vector<int>& nodes) const;
  // True for a circle with so many nodes that a CircleFlow for each density is cheaper than rows.
  bool has_series() const;

  // Flow of the double layer of a density at points z (both in the body frame) in the fluid or on the boundary, at any
  // distance: velocity, pressure and gradient. Cost O(N^2), and per point O(N) (Cauchy) or O(N^1.5) (interpolation).
  std::vector<PointFlow> close_flow(const ComplexVector& density, const std::vector<Complex>& z) const;

  Shape shape;
  Discretisation nodes;
  BoundaryKind kind;
  double log_length;
  Curve curve;
  Eigen::Matrix<double, 3, Eigen::Dynamic> moments;  // G^-1 B_w^T, 3 x 2N
  Vector diagonal;   // limit -s kappa w/(2 pi) of the double layer at a node itself, factor of t (t . eta)
  Eigen::Matrix<double, 3, Eigen::Dynamic> closure;  // beta B_w^T, 3 x 2N

 private:
  Matrix own_block() const;

  // The inverse of the block: a matrix or, on a circle, W core W^T - 2. There the block is -1/2 plus a map of the motions
  // e1, e2, n, t into themselves, and W are these motions at the nodes.
  Matrix inverse_;
  Eigen::Matrix<double, Eigen::Dynamic, 4> motions_;
  Eigen::Matrix4d core_;
  std::variant<CloseEvaluation, CircleEvaluation, InterpolationEvaluation> close_;
};

// A discrete shape at its pose, and the position of its density among those of a suspension.
struct PlacedShape {
  std::shared_ptr<const DiscreteShape> shape;
  Pose pose;
  Complex axis;
  int offset;  // of its first node

  int size() const { return shape->size(); }
  Complex node(int k) const { return pose.centre + axis * shape->curve.position[k]; }
  // A point in the frame of the shape.
  Complex local(Complex x) const { return std::conj(axis) * (x - pose.centre); }
};

// The numbers of its nodes.
std::vector<int> all_nodes(const PlacedShape& boundary);

// Some of a suspension's boundaries, taken as if there were no others.
struct BoundarySet {
  std::vector<int> members;          // increasing
  std::vector<int> first;            // of each boundary of the suspension, its first node here; -1: not a member
  PointArray nodes, weighted_normal; // laboratory frame

  BoundarySet() = default;
  BoundarySet(const std::vector<PlacedShape>& boundaries, std::vector<int> members);
  int size() const { return nodes.size(); }
  bool has(int boundary) const { return first[boundary] >= 0; }
};

// Distance beyond which the plain trapezoid rule gives the velocity to `accuracy`: 0.7 times the curve's largest point
// spacing for each digit (on a disc the error decays like (1 + d/a)^-N).
double near_distance(const DiscreteShape& shape, double accuracy);
// The same for pressure and gradient to 1e-10.
double near_distance_of_gradient(const DiscreteShape& shape);
// Rows of points z (frame of the shape) nearer than that.
std::vector<int> near_rows(const DiscreteShape& shape, const std::vector<Complex>& z, double distance);

// Interpolates a density from one set of nodes of a shape to another, trigonometrically in s (node_map.hpp).
ComplexVector move_density(const ComplexVector& density, const Discretisation& from, const Discretisation& to);

// The same for the densities of several boundaries, one after the other.
ComplexVector move_densities(const ComplexVector& density, const std::vector<Discretisation>& from,
                             const std::vector<Discretisation>& to);

// The shapes in use. Each distinct shape with nodes at equal steps is discretised and factorised once. Shapes with
// clusters belong to one configuration and are not kept.
class ShapeCache {
 public:
  explicit ShapeCache(NearSingular near_singular = NearSingular::cauchy) : near_singular_(near_singular) {}

  std::shared_ptr<const DiscreteShape> get(const Shape& shape, const Discretisation& nodes, BoundaryKind kind,
                                           double log_length);
  // Number of factorised shapes with nodes at equal steps.
  int factorisations() const { return static_cast<int>(shapes_.size()); }
  NearSingular near_singular() const { return near_singular_; }

 private:
  using Key = std::tuple<double, double, int, int, BoundaryKind, double>;

  NearSingular near_singular_;
  std::map<Key, std::shared_ptr<const DiscreteShape>> shapes_;
};

}  // namespace stokes
