#pragma once
/** @file NoDisplay.hpp
 * NoDisplay: the error if nothing can be drawn. */
#include <stdexcept>
#include <string>

namespace CME212 {

/** No display, or no OpenGL 3.3. */
struct NoDisplay : std::runtime_error {
  explicit NoDisplay(const std::string& reason)
      : std::runtime_error("no display: " + reason) {}
};

}  // namespace CME212
