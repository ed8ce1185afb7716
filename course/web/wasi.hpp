#pragma once
/** @file wasi.hpp
 * The parts of the C++ library that wasm32-wasi lacks: threads and files.
 * Included before each source that is compiled for a page, and by nothing
 * else. A page has one thread and no files, so these do nothing. */

// Newer versions of libc++ refuse <thread> here: its guard leaves it out.
#define _LIBCPP_THREAD
#include <chrono>
#include <filesystem>
#include <istream>
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
#if _LIBCPP_VERSION >= 160000 && _LIBCPP_VERSION < 190000  // others have it
template <typename Mutex>
struct lock_guard {
  explicit lock_guard(Mutex&) {}
};
#endif

template <>
class basic_ifstream<char> : public basic_istream<char> {
 public:
  explicit basic_ifstream(const string& = {}, openmode = in)
      : basic_istream<char>(nullptr) {}  // which is bad
  void open(const string&, openmode) {}
  bool is_open() const { return false; }
};
namespace filesystem {
inline bool is_directory(const string&, error_code&) { return false; }
}  // namespace filesystem

}  // namespace std
