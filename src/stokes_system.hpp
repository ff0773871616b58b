// The completed double-layer equations of a suspension at one configuration, and their solution.
//
// Unknown: one density per boundary (the bodies in order, then the container), kept in the BODY frame. A shape's
// preconditioner block then serves every body of that shape unrotated, and a density stays attached to its material nodes
// from one configuration to the next. On a free body j with given force and torque
//   (-1/2 + D) eta - (1/2) B G^-1 B_w^T eta = -u_inf - Sum_k (completion flow of F_k, L_k),
//   (U_j, omega_j) = (1/2) G^-1 B_w^T eta_j,
// where the rigid velocities are eliminated (B, G, B_w and the equations of the other kinds of boundaries:
// discrete_shape.hpp). Fixed bodies add to every row the completion flows of their own, unknown, force and torque. The
// equation on walls has the surface velocity on the right. The operator maps a rigid density of a free body to -1/2 of
// itself, and a rigid density makes no velocity in the fluid. The rigid part of the right-hand side is therefore solved
// exactly, and GMRES sees only the rest: its tolerance is relative to the straining part of the data and does not degrade
// with a body's distance from the origin.
#pragma once

#include <optional>
#include <vector>

#include "direct_sum.hpp"
#include "discrete_shape.hpp"
#include "facing.hpp"
#include "flow.hpp"
#include "fmm.hpp"
#include "preconditioner.hpp"
#include "refinement.hpp"
#include "suspension.hpp"

namespace stokes {

// How the double layer of all nodes on all nodes is summed.
enum class Summation {
  automatic,  // the fast multipole method from fmm_crossover nodes on
  direct,
  fmm,  // to a tenth of the tolerance of GMRES
};

struct StokesOptions {
  double gmres_tolerance = 1e-8;  // relative, on the true residual
  int gmres_max_iterations = 1000;
  PreconditionerKind preconditioner = PreconditionerKind::pair;
  Summation summation = Summation::automatic;
};

// Result of one solve. `density` carries no part along the rigid right-hand side; it is linear in the
// data, so solutions superpose.
struct StokesSolution {
  ComplexVector density;                // all boundaries' nodes in order, body frames
  std::vector<RigidVelocity> velocity;  // one per body, laboratory frame; that of its surface for a fixed one
  std::vector<Wrench> reaction;         // of fixed bodies on the fluid, about their centres; zero for free ones
  int iterations = 0;                   // GMRES iterations
  double residual = 0.0;                // relative true residual
  double data_norm = 0.0;               // of the right-hand side, what it is relative to
};

class StokesSystem {
 public:
  StokesSystem(const StokesSystem&) = delete;
  StokesSystem& operator=(const StokesSystem&) = delete;

  // Discretises every body with its own nodes, or every body with `points`, and the container. Cost O(N) plus the
  // close-evaluation blocks of boundaries nearer than a few point spacings.
  StokesSystem(const Suspension& bodies, const std::vector<Discretisation>& nodes, ShapeCache& shapes,
               const StokesOptions& options);
  StokesSystem(const Suspension& bodies, int points, ShapeCache& shapes, const StokesOptions& options)
      : StokesSystem(bodies, equal_nodes(bodies, points), shapes, options) {}

  int body_count() const { return static_cast<int>(surfaces_.size()) - (has_container() ? 1 : 0); }
  int node_count() const { return all_.size(); }
  const std::vector<PlacedShape>& boundaries() const { return boundaries_; }

  // Rigid velocities and densities for a background flow and given forces and torques (one per body, not read for
  // fixed ones; empty: none). `guess`: a density to start from (empty: zero). The tolerance is relative to the norm of
  // the data or, if given, to `scale`: the data_norm of the solution that this one is added to. NumericalError when
  // GMRES fails.
  StokesSolution solve(const BackgroundFlow& flow, const std::vector<Wrench>& wrenches,
                       const ComplexVector& guess = {}, double scale = 0.0) const;

  // The operator and the right preconditioner of GMRES. Input and output are all densities as interleaved reals.
  void apply(const Vector& in, Vector& out) const { apply(all_, in, out); }
  void precondition(const Vector& in, Vector& out) const { preconditioner_->apply(all_, in, out); }

  // One block-Jacobi sweep of the same equations, as in locally implicit stepping: each boundary's own block is solved
  // with the double layers of the others taken from `lagged` (a density of this system; empty: zero).
  StokesSolution sweep(const BackgroundFlow& flow, const std::vector<Wrench>& wrenches,
                       const ComplexVector& lagged) const;

  // The response to wrenches as if there were only the bodies that they act on and the bodies within about a body's length
  // of these. All others do not move. Solved to the given tolerance. Apart from finding these bodies the cost does not
  // depend on the number of bodies.
  StokesSolution solve_nearby(const std::vector<Wrench>& wrenches, double tolerance) const;

  // The same for any velocity on the boundaries (all nodes, laboratory frame) instead of that of the flow and the walls.
  StokesSolution solve_for_velocity(const ComplexVector& velocity, const ComplexVector& guess = {}) const;

  // Velocity, pressure and gradient at points in the fluid or on a boundary (limits from the fluid), accurate at any
  // distance from a boundary. In a container the pressure has a free constant. Cost O(points + nodes) by the fast
  // multipole method; each point near a boundary sums all other nodes directly, and each such boundary costs O(N^2).
  std::vector<PointFlow> flow(const std::vector<Complex>& points, const ComplexVector& density,
                              const BackgroundFlow& background, const std::vector<Wrench>& wrenches) const;

  // Force and torque (about its centre) of the container on the fluid. They balance those of all bodies, since a double
  // layer exerts none. Zero without a container.
  Wrench container_wrench(const ComplexVector& density, const std::vector<Wrench>& wrenches) const;

  // Forces and torques of the fixed bodies on the fluid, from their densities. Zero for free bodies.
  std::vector<Wrench> reactions(const ComplexVector& density) const;

  // Stresslets S_11 + i S_12 of the bodies about their centres, laboratory frame:
  // S_ij = -Int (n_i eta_j + n_j eta_i - delta_ij n.eta) ds plus that of the completion flow.
  std::vector<Complex> stresslets(const ComplexVector& density, const std::vector<Wrench>& wrenches) const;

  // Share of the density's Fourier energy, rigid motions apart, in the top third of the modes
  // (|k| > N/3): the largest over the bodies. A resolution indicator.
  double density_tail(const ComplexVector& density) const;
  // For each boundary max_{|k| > 0.4 N} |eta_k| / max_{k != 0} |eta_k|, with the modes in the parameter s of its nodes. 0
  // for a density that is round-off compared with the others.
  std::vector<double> density_tails(const ComplexVector& density) const;

 private:
  struct NearBlock {  // correction of the trapezoid sum from `source` at some nodes of `target`
    int target, source;
    std::vector<int> rows;  // node numbers within the target
    Matrix matrix;          // 2 rows x 2N, frames of source and target; empty if the source has_series()
  };
  struct LongCircle {  // a source that has_series(), laboratory frame
    int boundary;
    PointArray nodes, weighted_normal;
  };
  struct LongCircleFlow {  // of one density
    CircleFlow series;     // frame of the source
    ComplexVector density; // laboratory frame
  };

  // A cluster of the target that faces a cluster of the source: p_source - p_target of the points of the clusters, and the
  // tangent of the source there, both in the frame of the tangent of the target.
  struct ContactFrame {
    int target, source;
    int target_cluster, source_cluster;
    Complex displacement, turn;
  };

  void place(const Suspension& bodies, const std::vector<Discretisation>& nodes, ShapeCache& shapes);
  void find_contact_frames(const Suspension& bodies);
  void add_contact_frame(int a, int b, const Facing& facing);
  double softening_length() const;
  std::vector<Target> seen_from(int source, int target, const std::vector<int>& rows) const;
  Matrix plain_rows(int target, const std::vector<int>& rows, int source, const std::vector<int>& columns) const;
  bool has_container() const;
  double near_reach(int boundary) const;
  void find_near_blocks();
  void find_own_correction(NearBlock& near) const;
  void find_completion_columns();
  std::vector<ClosePair> close_pairs(const Suspension& bodies) const;
  Matrix interaction(int target, const std::vector<int>& rows, int source, const std::vector<int>& columns) const;
  BoundarySet around(const std::vector<Wrench>& wrenches) const;

  ComplexVector in_laboratory(const BoundarySet& set, const Complex* density) const;
  ComplexVector double_layer(const BoundarySet& set, const Complex* density) const;
  void apply(const BoundarySet& set, const Vector& in, Vector& out) const;
  std::vector<LongCircleFlow> long_circle_flows(const BoundarySet& set, const Complex* density) const;
  void finish_boundary(const BoundarySet& set, int i, const Vector& in, const std::vector<LongCircleFlow>& flows,
                       Complex* result) const;
  void add_long_circle(const NearBlock& near, const std::vector<LongCircleFlow>& flows, Complex* result) const;
  ComplexVector boundary_data(const BoundarySet& set, const BackgroundFlow& flow, const std::vector<Wrench>& wrenches) const;
  Vector straining_data(const BoundarySet& set, ComplexVector data, std::vector<RigidVelocity>& rigid) const;
  StokesSolution solve_data(const BoundarySet& set, ComplexVector data, const ComplexVector& guess, double tolerance,
                            double scale = 0.0) const;
  void finish(const BoundarySet& set, const Vector& density, StokesSolution& solution) const;
  void add_given_motion(const BackgroundFlow& flow, StokesSolution& solution) const;

  std::vector<PointFlow> double_layer_flow(const std::vector<Complex>& points, const ComplexVector& density) const;
  std::vector<PointFlow> summed_flow(const PointArray& points, const ComplexVector& lab_density) const;
  std::vector<int> near_points(const PlacedShape& boundary, const std::vector<Complex>& points) const;

  StokesOptions options_;
  std::vector<PlacedShape> boundaries_;  // bodies, then the container
  std::vector<SurfaceMotion> surfaces_;  // of the boundaries
  std::vector<int> fixed_;               // the fixed bodies
  double log_length_ = 1.0;
  BoundarySet all_;
  double softening_ = 0.0;                // of the sums over nodes
  std::vector<ContactFrame> frames_;      // ordered by target
  std::vector<NearBlock> near_;      // ordered by target
  std::vector<int> first_near_;      // near_ of boundary i: [first_near_[i], first_near_[i + 1])
  std::vector<LongCircle> long_circles_;
  Matrix completion_;                // flows of unit force and torque of the fixed bodies at all nodes, 2N x 3 fixed
  std::optional<FmmPlan> fmm_;
  std::optional<Preconditioner> preconditioner_;
};

}  // namespace stokes
