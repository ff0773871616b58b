// Checks that double precision suffices for the positions, sizes and speeds of a suspension.
//
// Positions have a relative precision of 1e-16. Beyond 1e8 semi-axes from the origin, bodies and the gaps between them
// are therefore known to no more than 1e-8 of a semi-axis. Squares of speeds and velocity gradients are formed, which
// overflow or underflow far above 1e100 and far below 1e-100.
#pragma once

#include <string>

#include "flow.hpp"
#include "suspension.hpp"

namespace stokes {

// Says why the poses of the bodies are not known precisely enough, as the end of a message. Empty if they are.
std::string lost_precision(const Suspension& bodies);

// Says what drives the fluid too strongly or too weakly, as the end of a message. Empty if nothing does.
std::string out_of_scale(const Suspension& bodies, const BackgroundFlow& flow);

}  // namespace stokes
