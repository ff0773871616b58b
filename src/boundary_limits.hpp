// Limits from the fluid of the flow of the double layer of one curve, at the nodes of the curve, by singularity
// subtraction and alternate points. This is the published method. It is an alternative to CloseFlow::at_nodes() of
// close_flow.hpp and a check of it.
//
// A constant density has neither pressure nor velocity gradient. At node j the density eta_k is therefore replaced by
// eta_k - eta_j, and principal values (PV) remain. The trapezoid rule on every second node, those with odd k - j, with
// twice their weight gives these with spectral accuracy. With the tangent t, the normal n, eta_s = d eta/ds and
// q = eta_s.t the limits from the fluid are, on either side,
//   u = -eta/2 + D eta,   p = p_PV + q,   vorticity = vorticity_PV - eta_s.perp(t),
//   E = E_PV - (q/2)(t t - n n),   hence sigma = sigma_PV - 2 q t t.
#pragma once

#include <vector>

#include "cauchy.hpp"
#include "point_flow.hpp"

namespace stokes {

// One flow per node, for a density with one value per node. The accuracy is spectral. Pressure and gradient sum over
// half the nodes only and need up to twice the N of the velocity for the same accuracy. An odd number of nodes raises
// InputError. Cost O(N^2).
std::vector<PointFlow> boundary_limits(const Curve& curve, Side side, const ComplexVector& density);

}  // namespace stokes
