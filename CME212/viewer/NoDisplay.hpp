#pragma once
/** @file NoDisplay.hpp
 * NoDisplay: the error if nothing can be drawn. */
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>

namespace CME212 {

/** No display, or no OpenGL 3.3. */
struct NoDisplay : std::runtime_error {
  explicit NoDisplay(const std::string& reason)
      : std::runtime_error("no display: " + reason) {}
};

/** From now on a NoDisplay that the program does not catch prints its reason
 * and ends the program with status 4. All other errors end it as before. */
inline void end_by_no_display() {
  static const std::terminate_handler other_errors = std::set_terminate([] {
    try {
      if (const auto error = std::current_exception())
        std::rethrow_exception(error);
    } catch (const NoDisplay& e) {
      std::fprintf(stderr, "%s\n", e.what());
      std::_Exit(4);
    } catch (...) {
    }
    other_errors();
  });
}

}  // namespace CME212
