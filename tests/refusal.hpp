// What input is refused with.
#pragma once

#include <string>

#include "base.hpp"

namespace stokes {

// The message of the InputError that an action ends with, or "accepted".
template <class Action>
std::string refusal(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace stokes
