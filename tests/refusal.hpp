// The message with which input is refused.
#pragma once

#include <string>

#include "base.hpp"

namespace stokes {

// The message of the error that an action ends with, or "accepted".
template <class Error = InputError, class Action>
std::string refusal(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace stokes
