// Nodes, close evaluation and solver from an accuracy of the bodies' velocities, in units of the rate of what drives them
// and of the size of the smallest body; and a solution that has been held against it.
//
// Each boundary begins with the nodes that it needs by itself and clusters at its contacts (refinement.hpp). The equations
// are solved; where the density of a boundary still has modes at the end of its spectrum,
//   tail = max_{|k| > 0.4 N} |eta_k| / max_{k > 0} |eta_k|,   1000 tail^2 (size / smallest size) > accuracy
// (velocities, smooth functionals of densities, are off by 1 to 150 tail^2 of their size in pairs, by up to 1e4 tail^2 in
// random drops), the boundary gets half as many nodes again and the solution starts from the density moved to them, at most
// three times.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "refinement.hpp"
#include "stokes_system.hpp"

namespace stokes {

inline constexpr int most_points = 1024;  // of a boundary

// What a body alone asks for, found once for each form.
class ShapeResolution {
 public:
  // The first N of 24, 32, 48, 64, ... 1024 that gives the angular velocity and the stresslet of the body in shear at two
  // angles, in units of its size, as the next one does, to the tolerance.
  int points(const Shape& shape, double tolerance);
  // By how much N points miss them.
  double error(const Shape& shape, int points);

 private:
  struct Alone {
    double omega[2];
    Complex stresslet[2];
  };
  const Alone& alone(double aspect, int points);

  std::map<std::pair<double, int>, Alone> known_;
};

// Smallest factor with which the close evaluation of a boundary at these nodes keeps a tolerance: the product of the
// density with conj(zeta')/zeta', whose modes beyond (factor - 1) N/2 are below it. At most 8.
int close_upsampling(const Shape& shape, const Discretisation& nodes, double tolerance);

struct ResolvedSystem {
  std::vector<Discretisation> nodes;  // of the bodies and the container
  std::unique_ptr<StokesSystem> system;
  StokesSolution solution;            // its iterations are those of all solves
  int solves = 0;
  double error = 0.0;                 // estimated, of the velocities
  std::vector<int> unresolved;        // boundaries whose estimated error is larger than the accuracy after the last solve

  int clusters() const;
  int most_nodes() const;
};

// What is to be solved; `guess`, if any, gives a density on nodes to start from.
struct ResolvedProblem {
  const Suspension& bodies;
  BackgroundFlow flow;
  std::vector<Wrench> wrenches;
  std::function<ComplexVector(const std::vector<Discretisation>&)> guess;
};

// With options.gmres_tolerance replaced by A sqrt(G/2), A being the accuracy over the largest relative size, G = g kappa the
// smallest relative gap, at most A and at least 1e-12 and the round-off 4e-15/sqrt(G/2) of the equations. That is 8e-15/G
// in the velocities, the least estimated error. `resolution`: of the boundaries, what an earlier solution ended with;
// empty: from their shapes. It is changed to what was needed. The result does not depend on the number of threads.
ResolvedSystem solve_to_accuracy(const ResolvedProblem& problem, double accuracy, StokesOptions options, ShapeCache& shapes,
                                 ShapeResolution& alone, std::vector<Resolution>& resolution);

}  // namespace stokes
