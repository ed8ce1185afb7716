#pragma once
/** @file wasi.hpp
 * The parts of the C++ library that wasm32-wasi lacks: threads and from_chars()
 * of a double. Included before each source that is compiled
 * for the page, and by nothing else. A page has one thread, so most of it does
 * nothing. */
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <mutex>
#include <string>

namespace std {

namespace this_thread {
template <typename Rep, typename Period>
void sleep_for(const chrono::duration<Rep, Period>&) {}
}  // namespace this_thread

struct mutex {
  void lock() {}
  void unlock() {}
};

inline from_chars_result from_chars(const char* first, const char* last,
                                    double& value) {
  const string text(first, last);
  char* end = nullptr;
  const double a = strtod(text.c_str(), &end);
  if (end == text.c_str()) return {first, errc::invalid_argument};
  value = a;
  return {first + (end - text.c_str()), errc()};
}

}  // namespace std
