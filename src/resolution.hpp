// Chooses nodes, close evaluation and solver tolerance for an accuracy of the bodies' velocities, in units of the rate of
// what drives them and of the size of the smallest body, and checks the solution against this accuracy.
//
// Each boundary begins with the nodes that it needs by itself and clusters at its contacts (refinement.hpp). The equations
// are solved. A boundary whose density still has modes at the end of its spectrum,
//   tail = max_{|k| > 0.4 N} |eta_k| / max_{k != 0} |eta_k|,   1000 tail^2 (size / smallest size) > accuracy,
// then gets half as many nodes again, and the next solve starts from the density moved to them. This is repeated at most
// three times. Velocities are smooth functionals of densities: their errors are 1 to 150 tail^2 of their size in pairs, and
// up to 1e4 tail^2 in random drops.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "refinement.hpp"
#include "stokes_system.hpp"

namespace stokes {

inline constexpr int most_points = 1024;  // of a boundary

// The nodes that a body needs by itself, found once for each shape.
class ShapeResolution {
 public:
  // The first N of 24, 32, 48, 64, ... 1024 that gives the angular velocity and the stresslet of the body in shear at two
  // angles, in units of its size, as the next one does, to the tolerance.
  int points(const Shape& shape, double tolerance);
  // The largest change of these quantities from N points to the next N.
  double error(const Shape& shape, int points);

 private:
  struct Alone {
    double omega[2];
    Complex stresslet[2];
  };
  const Alone& alone(double aspect, int points);

  std::map<std::pair<double, int>, Alone> known_;
};

// The smallest upsampling with which the close evaluation of a boundary at these nodes keeps a tolerance. It resolves the
// product of the density with conj(zeta')/zeta', whose modes beyond (factor - 1) N/2 are below the tolerance. At most 8.
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

// The problem to be solved. `guess`, if any, gives an initial density on the chosen nodes.
struct ResolvedProblem {
  const Suspension& bodies;
  BackgroundFlow flow;
  std::vector<Wrench> wrenches;
  std::function<ComplexVector(const std::vector<Discretisation>&)> guess;
};

// Solves with options.gmres_tolerance replaced by A sqrt(G/2) or, if that is smaller, rate_tolerance(G). Here A is the
// accuracy over the largest relative size, and G = g kappa the smallest relative gap. The tolerance is at least 1e-12 and
// the round-off 4e-15/sqrt(G/2) of the equations. This round-off is 8e-15/G in the velocities, the least estimated error.
// `resolution` has what each boundary needed in an earlier solve; empty: chosen by the shapes. It is changed to what was
// needed. The result does not depend on the number of threads.
ResolvedSystem solve_to_accuracy(const ResolvedProblem& problem, double accuracy, StokesOptions options, ShapeCache& shapes,
                                 ShapeResolution& alone, std::vector<Resolution>& resolution);

}  // namespace stokes
