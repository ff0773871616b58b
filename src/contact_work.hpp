// The power of contact forces in the motion that they cause.
#pragma once

#include <string>
#include <vector>

#include "suspension.hpp"

namespace stokes {

// Advice where nodes do not resolve a gap.
inline constexpr const char* finer_nodes = "write accuracy = 1e-4 in place of points_per_body, or a smaller accuracy";

// In a viscous fluid, with the motions `with` and `without` the contact forces and torques on the bodies,
//   power = Sum_i (F_i . (U_i - U_i') + L_i (omega_i - omega_i')) >= 0.
// A single body may move against its contact force, pushed by others; the sum cannot be negative. Returns an empty string
// or, if the power is negative, the end of a message: the power, the body with the most negative part of it, and advice.
// All arguments have one entry for each body.
std::string negative_work(const std::vector<Wrench>& contact, const std::vector<RigidVelocity>& with,
                          const std::vector<RigidVelocity>& without);

}  // namespace stokes
