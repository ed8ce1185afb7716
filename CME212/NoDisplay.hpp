#pragma once
/** @file NoDisplay.hpp
 * NoDisplay: the error of whoever can't draw. */
#include <stdexcept>
#include <string>

namespace CME212 {

/** There is nothing to draw on: no display, or no OpenGL 3.3. */
struct NoDisplay : std::runtime_error {
  explicit NoDisplay(const std::string& reason)
      : std::runtime_error("no display: " + reason) {}
};

}  // namespace CME212
