// Densities of earlier steps, from which later solves start. They are kept in the frames of their boundaries and therefore
// turn with the bodies.
#pragma once

#include <vector>

#include "refinement.hpp"
#include "state_text.hpp"

namespace stokes {

struct Density {
  double path = 0.0;                  // position along the way of the run: the sum of driving times dt
  std::vector<Discretisation> nodes;  // one per boundary
  ComplexVector value;

  ComplexVector on(const std::vector<Discretisation>& other_nodes) const;
  void save(StateWriter& writer) const;
  static Density restored(StateReader& reader);
};

// The latest densities of one quantity, at most three, the newest last.
class DensityHistory {
 public:
  void append(Density density);
  bool empty() const { return densities_.empty(); }

  // The polynomial in the path through these densities, at `path`. If the flow is reversed, the first step back therefore
  // starts from the density that was there. Zero if there are no densities.
  ComplexVector extrapolated(double path, const std::vector<Discretisation>& nodes) const;

  void save(StateWriter& writer) const;
  static DensityHistory restored(StateReader& reader);

 private:
  std::vector<Density> densities_;
};

struct FluidMemory {
  double path = 0.0;                   // of the present configuration
  DensityHistory background;           // contact-free densities at the starts of steps, per unit of driving
  Density total;                       // of the latest step, contact forces included
  std::vector<Resolution> resolution;  // of the boundaries, with an accuracy

  void save(StateWriter& writer) const;
  static FluidMemory restored(StateReader& reader);
};

}  // namespace stokes
