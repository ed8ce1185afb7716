#pragma once
/** @file wasi.hpp
 * The parts of the C++ library that wasm32-wasi lacks: threads. Included before
 * each source that is compiled for a page, and by nothing else. A page has
 * one thread, so it does nothing. */
#include <chrono>
#include <mutex>

namespace std {

namespace this_thread {
template <typename Rep, typename Period>
void sleep_for(const chrono::duration<Rep, Period>&) {}
}  // namespace this_thread

struct mutex {
  void lock() {}
  void unlock() {}
};

}  // namespace std
