// Flow of the double layer of one curve on the curve itself: limits from the fluid by singularity subtraction and
// alternate points, the published method. An alternative, and a check, to CloseFlow::at_nodes() of close_flow.hpp.
//
// A constant density has neither pressure nor velocity gradient, so that at node j the density may be replaced by
// eta_k - eta_j, which leaves principal values; the trapezoid rule on every second node, those with k - j odd and
// twice their weight, finds them with spectral accuracy. With the tangent t, the normal n, eta_s = d eta/ds and
// q = eta_s.t the limits from the fluid are, on either side,
//   u = -eta/2 + D eta,   p = p_PV + q,   vorticity = vorticity_PV - eta_s.perp(t),
//   E = E_PV - (q/2)(t t - n n),   hence sigma = sigma_PV - 2 q t t.
#pragma once

#include <vector>

#include "cauchy.hpp"
#include "point_flow.hpp"

namespace stokes {

// One flow per node, for a density with a value at each. Spectrally accurate; pressure and gradient, for which only
// half the nodes are summed, reach a given accuracy at up to twice the N that the velocity takes. An odd number of
// nodes raises InputError. Cost O(N^2).
std::vector<PointFlow> boundary_limits(const Curve& curve, Side side, const ComplexVector& density);

}  // namespace stokes
