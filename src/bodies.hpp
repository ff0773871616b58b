// The CSV of a suspension's bodies: the columns a,b,x,y,theta in any order, optional force_x,force_y,torque,fixed and, of
// fixed bodies, ux,uy,omega.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "annulus.hpp"

namespace stokes {

// Reads and checks the bodies of a suspension in unbounded flow: no fixed bodies, zero net force (relative
// to the sum of the magnitudes, 1e-12), no overlap. InputError with file and line for anything else.
Suspension read_bodies(const std::filesystem::path& path);
// The same for the content of such a file; the name is for messages.
Suspension parse_bodies(std::string_view content, const std::string& file_name);

// The same for bodies between walls: `walls` has a container and at most an inner wall, which are added to the bodies.
// Bodies may be fixed, forces may have any sum (a force on a fixed body does nothing), and no body may overlap or touch
// another body or a wall.
Suspension parse_bodies(std::string_view content, const std::string& file_name, const Suspension& walls);

// The content of a file from which the same bodies are read: every column, and ux,uy,omega if a body is driven. Walls have
// no row.
std::string format_bodies(const Suspension& bodies);

// Help for users: the columns of the file.
std::string bodies_help();

}  // namespace stokes
