// Forces on the boundaries from the fluid's traction there, and the average stress of a suspension in a container.
#pragma once

#include <vector>

#include "stokes_system.hpp"

namespace stokes {

// sigma n ds at each node of a boundary (bodies in order, then the container), with n out of the fluid: the force of that
// part of the boundary on the fluid, laboratory frame. The other arguments and the cost are those of
// StokesSystem::flow().
std::vector<Complex> node_forces(const StokesSystem& system, int boundary, const ComplexVector& density,
                                 const BackgroundFlow& background, const std::vector<Wrench>& wrenches);

// Stress averaged over the fluid and the free bodies (area V). The divergence theorem gives it from the walls, which are
// the container and the fixed bodies,
//   <sigma> = (1/V) Sum_walls oint sym((sigma n) (x) x) ds,   x from the container's centre.
// Contact forces between free bodies count as stress along the line of centres; its deviatoric part is that of
//   2 <E> + (1/V) (Sum_free S_j + Sum_contacts sym(F_AB (x) (c_B - c_A))),   F_AB on A by B,
// and the pressure has the free constant of a bounded flow. Contact forces of walls act on the bodies, not on the fluid,
// and are not included. With such forces or external forces the result depends on the origin of x.
// InputError without a container. Accuracy and cost: those of the flow at the walls' nodes.
Stress average_stress(const StokesSystem& system, const ComplexVector& density, const BackgroundFlow& background,
                      const std::vector<Wrench>& wrenches);

}  // namespace stokes
