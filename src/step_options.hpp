// How a step is made: the fluid, its discretisation, the contacts, the integrator.
#pragma once

#include "contact.hpp"
#include "flow.hpp"
#include "refinement.hpp"
#include "stiv.hpp"
#include "stokes_system.hpp"

namespace stokes {

enum class Coupling {
  global,  // the complete Stokes problem at every configuration
  local,   // each body's own block; the others' densities are those of the step before (the first: global),
           // and a contact force moves only the body it acts on
};

// The mobility in the matrix of the linear complementarity problems (contact_matrix.hpp).
enum class LcpMatrix {
  full,  // the one that moves the bodies: a Stokes solve for each contact
  near,  // at first the bodies around each contact as if there were no others. Every iterate is moved with the full
         // mobility, by one Stokes solve. The matrix learns from it, for this step and for later ones. If that does not
         // converge, as full
  self,  // each body as if it were alone; every iterate is then moved with the full mobility. The same for
         // Coupling::local
};

// How a step is made of configurations and contact problems (integrator.hpp).
enum class IntegratorKind {
  euler,     // forward Euler: the paper's
  ab2,       // second-order Adams-Bashforth: the cost of forward Euler
  rk3,       // third-order Runge-Kutta, three configurations a step; the one whose error can be estimated
  midpoint,  // implicit midpoint, symmetric in time
};

struct StepperOptions {
  BackgroundFlow flow;
  // Accuracy of the bodies' velocities, in units of the rate and size of what drives them. Nodes, clusters and tolerances
  // are then chosen at every configuration, and points_per_body, refine, Container::points, Body::points and
  // stokes.gmres_tolerance are not used. 0: these values are used.
  double accuracy = 0.0;
  int points_per_body = 32;
  Refine refine = Refine::none;
  StokesOptions stokes;
  NearSingular near_singular = NearSingular::cauchy;
  ContactModel contact = ContactModel::gap;
  double separation = 0.0;  // length
  double contact_tolerance = stokes::contact_tolerance;  // part of the separation by which active contacts may miss it
  IntegratorKind integrator = IntegratorKind::euler;
  double tolerance = 0.0;   // of the local error of a step (error_norm), with rk3; 0: it is not estimated
  Coupling coupling = Coupling::global;
  LcpMatrix lcp_matrix = LcpMatrix::full;
  int stiv_vertices = 0;    // of the polygons of ContactModel::stiv; 0: 4 points_per_body
  StivGradient stiv_gradient = StivGradient::full;
};

}  // namespace stokes
