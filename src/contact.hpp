// Contact constraints of a time step and the collector that finds them.
//
// A constraint is a value that must not be negative at the end of the step, its gradient with respect to
// the two bodies' poses there, and the generalised force that a unit multiplier exerts. The
// complementarity solver (ncp.hpp) knows constraints only in this form.
//
// One of the bodies may be fixed, and the second may be the container. The entries of gradient and force of such a
// partner are defined as for any other body: its reaction, about its centre. It does not move.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "gap.hpp"
#include "suspension.hpp"

namespace stokes {

enum class ContactModel {
  none,  // bodies that overlap end the run
  gap,   // exact gap between the bodies
  stiv,  // the paper's: space-time interference volumes between polygons, clusters balanced (stiv.hpp, cluster.hpp)
};

// An active contact may miss the separation by this fraction of it: its gap, or the depth of one vertex of a volume.
inline constexpr double contact_tolerance = 1e-4;

struct ContactConstraint {
  int a, b;              // bodies, a < b; b may be container_index
  int region;            // number of the contact among those of the pair, 0, 1, ...
  double value;          // satisfied when >= 0; an active contact aims at 0
  double tolerance;      // |value| below it counts as 0
  GapGradient gradient;  // of the value, at the trial poses
  GapGradient force;     // on the bodies for a unit multiplier
};

// Finds the contacts of one step from the poses at its start: pairs whose gap at the trial poses is below
// the minimum separation, and pairs that pass through each other on the way there.
//   value = gap - separation, or, for a pair that passed through, the separation of the material points
//   that met first along their normal;
//   force = gradient of the gap in the configuration in which the fluid is solved: the start of the step or a stage of
//   it. There the two forces of a contact are opposite and collinear.
// Two fixed bodies are not a pair. For a mobile body and the container only the gap at the trial pose counts, since no
// body passes through the wall and comes back. If the step turns the normal by more than 60 degrees, the body started
// too far from the wall for its first normal to be meaningful. The force is then along the normal at the trial pose.
// A body so flat that it can touch the wall with both ends (container_gap.hpp) still has a single contact there.
// Iterations that press one end and then the other against the wall may fail to converge.
class GapCollector {
 public:
  // separation >= 0. With 0 the bodies are kept 1e-7 of the smallest semi-axis apart,
  // or 1e-10 of the largest distance of a centre or of the container's wall from the origin.
  // `at`: the configuration in which the fluid is solved, that at the start of the step unless given.
  GapCollector(const Suspension& start, const Suspension& at, double separation, double tolerance = contact_tolerance);
  GapCollector(const Suspension& start, double separation) : GapCollector(start, start, separation) {}

  double separation() const { return separation_; }
  double tolerance() const { return tolerance_; }  // length

  // The violated constraints at the trial poses and those of the `tracked` pairs, violated or not, sorted
  // by pair. Nothing is missed: every pair that comes closer than the tolerance allows is listed.
  std::vector<ContactConstraint> collect(const std::vector<Pose>& trial,
                                         const std::vector<std::pair<int, int>>& tracked) const;

 private:
  ContactConstraint evaluate(int a, int b, const std::vector<Pose>& trial) const;
  ContactConstraint evaluate_wall(int a, const Pose& trial) const;

  const Suspension &start_, &at_;
  double separation_, tolerance_;
};

}  // namespace stokes
