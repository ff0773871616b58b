// Which numbers a suspension may have so that double precision has room for what is computed from them.
//
// Positions are known to 1e-16 of their distance from the origin: beyond 1e8 semi-axes, bodies and the gaps between
// them are known to no more than 1e-8 of a semi-axis. Speeds and their gradients enter by their squares, which
// overflow or vanish far beyond 1e100 and 1e-100.
#pragma once

#include <string>

#include "flow.hpp"
#include "suspension.hpp"

namespace stokes {

// Why the poses of the bodies are not known precisely enough, or nothing: the end of a message.
std::string lost_precision(const Suspension& bodies);

// What of all that drives the fluid is too strong or too weak, or nothing: the end of a message.
std::string out_of_scale(const Suspension& bodies, const BackgroundFlow& flow);

}  // namespace stokes
