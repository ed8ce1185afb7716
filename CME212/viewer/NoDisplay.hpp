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

namespace no_display_detail {

inline std::terminate_handler other_errors;

[[noreturn]] inline void end_program() {
  try {
    if (const auto error = std::current_exception())
      std::rethrow_exception(error);
  } catch (const NoDisplay& e) {
    std::fprintf(stderr, "%s\n", e.what());
    std::_Exit(4);
  } catch (...) {
  }
  if (other_errors) other_errors();
  std::abort();
}

}  // namespace no_display_detail

/** From now on a NoDisplay that the program does not catch prints its reason
 * and ends the program with status 4. All other errors end it as before. */
inline void end_by_no_display() {
  using namespace no_display_detail;
  if (std::get_terminate() != end_program)
    other_errors = std::set_terminate(end_program);
}

}  // namespace CME212
