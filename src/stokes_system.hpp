// The completed double-layer equations of a suspension at one configuration, and their solution.
//
// Unknown: one density per body, kept in the BODY frame, so that a shape's preconditioner block serves
// every body of that shape unrotated and a density stays attached to its material nodes from one
// configuration to the next. On body j, with all forces and torques given,
//   (-1/2 + D) eta - (1/2) B G^-1 B_w^T eta = -u_inf - Sum_k (completion flow of F_k, L_k),
//   (U_j, omega_j) = (1/2) G^-1 B_w^T eta_j
// (the rigid velocities eliminated; B, G, B_w: discrete_shape.hpp). The operator maps a rigid density to
// -1/2 of itself and a rigid density makes no velocity in the fluid, so the rigid part of the right-hand
// side is solved exactly and GMRES sees only the rest: the tolerance is relative to the straining part
// of the data and does not degrade with a body's distance from the origin.
#pragma once

#include <optional>
#include <vector>

#include "direct_sum.hpp"
#include "discrete_shape.hpp"
#include "flow.hpp"
#include "preconditioner.hpp"
#include "suspension.hpp"

namespace stokes {

struct StokesOptions {
  double gmres_tolerance = 1e-8;  // relative, on the true residual
  int gmres_max_iterations = 1000;
  PreconditionerKind preconditioner = PreconditionerKind::pair;
};

// Result of one solve. `density` carries no part along the rigid right-hand side; it is linear in the
// data, so solutions superpose.
struct StokesSolution {
  ComplexVector density;                // all bodies' nodes in order, body frames
  std::vector<RigidVelocity> velocity;  // one per body, laboratory frame
  int iterations = 0;                   // GMRES iterations
  double residual = 0.0;                // relative true residual
};

class StokesSystem {
 public:
  StokesSystem(const StokesSystem&) = delete;
  StokesSystem& operator=(const StokesSystem&) = delete;

  // Discretises every body with `points` nodes. `shapes` must outlive the system. Cost O(N) plus the
  // close-evaluation blocks of bodies nearer than a few point spacings.
  StokesSystem(const Suspension& bodies, int points, ShapeCache& shapes, const StokesOptions& options);

  int body_count() const { return static_cast<int>(blocks_.size()); }
  int node_count() const { return nodes_.size(); }

  // Rigid velocities and densities for a background flow and given forces and torques (one per body;
  // empty: none). `guess`: a density to start from (empty: zero). NumericalError when GMRES fails.
  StokesSolution solve(const BackgroundFlow& flow, const std::vector<Wrench>& wrenches,
                       const ComplexVector& guess = {}) const;

  // One block-Jacobi sweep of the same equations: each body's own block is solved for, the double layers of
  // the others are taken from `lagged` (a density of this system; empty: zero). Locally implicit stepping.
  StokesSolution sweep(const BackgroundFlow& flow, const std::vector<Wrench>& wrenches,
                       const ComplexVector& lagged) const;

  // Fluid velocity at points in the fluid, accurate up to the boundaries.
  ComplexVector velocity(const std::vector<Complex>& points, const ComplexVector& density,
                         const BackgroundFlow& flow, const std::vector<Wrench>& wrenches) const;

  // Stresslets S_11 + i S_12 of the bodies about their centres, laboratory frame:
  // S_ij = -Int (n_i eta_j + n_j eta_i - delta_ij n.eta) ds plus that of the completion flow.
  std::vector<Complex> stresslets(const ComplexVector& density, const std::vector<Wrench>& wrenches) const;

  // Share of the density's Fourier energy, rigid motions apart, in the top third of the modes
  // (|k| > N/3): the largest over the bodies. A resolution indicator.
  double density_tail(const ComplexVector& density) const;

 private:
  struct NearBlock {  // correction of the trapezoid sum from `source` at some nodes of `target`
    int target, source;
    std::vector<int> rows;  // node numbers within the target body
    Matrix matrix;          // 2 rows x 2N, frames of source and target
  };

  void find_near_blocks();
  ComplexVector in_laboratory(const Complex* density) const;
  void apply(const Vector& in, Vector& out) const;
  Vector straining_data(const BackgroundFlow& flow, const std::vector<Wrench>& wrenches,
                        std::vector<RigidVelocity>& rigid) const;
  void finish(const Vector& density, StokesSolution& solution) const;
  ComplexVector boundary_velocity(const BackgroundFlow& flow, const std::vector<Wrench>& wrenches) const;
  Complex driven_velocity(Complex x, const BackgroundFlow& flow, const std::vector<Wrench>& wrenches) const;

  StokesOptions options_;
  std::vector<PlacedShape> blocks_;  // one per body
  PointArray nodes_, weighted_normal_;
  std::vector<NearBlock> near_;       // ordered by target body
  std::vector<int> first_near_;       // near_ of body i: [first_near_[i], first_near_[i + 1])
  std::optional<Preconditioner> preconditioner_;
};

}  // namespace stokes
