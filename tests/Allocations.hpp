#pragma once
/** @file Allocations.hpp
 * Counts every allocation of the program that includes it, in its one file;
 * none under ThreadSanitizer, whose own operators come before weak ones. Where
 * allocation_fails() says so, there is no memory. */
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

inline std::atomic<long> allocations = 0;
inline bool (*allocation_fails)() = [] { return false; };

[[gnu::noinline, gnu::weak]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = allocation_fails() ? nullptr : std::malloc(size)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline, gnu::weak]] void* operator new(
    std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size);
}
[[gnu::noinline, gnu::weak]] void operator delete(void* p) noexcept {
  std::free(p);
}
[[gnu::noinline, gnu::weak]] void operator delete(void* p,
                                                  std::size_t) noexcept {
  std::free(p);
}
