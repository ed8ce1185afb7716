/** @file check.hpp
 * What a test of the kit is written with:
 *
 *   TASK("7.1.remove_node", name) { ... }    a test of the task of this id
 *   DID("ring of ", n, ", removed n3");      what was done; the latest is shown
 *   CHECK_EQUAL(g.num_nodes(), 13);  "Expected g.num_nodes() == 13, got 14."
 *   CHECK_NEAR(x, 1.5, 1e-12);       for numbers and Points; NaN is near
 * nothing CHECK(condition, "the loop ends");       "Expected: the loop ends."
 *
 * A check that fails ends its test. The name of a test is unique in all files.
 * A test file includes graph.hpp or cloth.hpp, which bring this file: it comes
 * after the submission's headers, so that their macros change nothing here. */
#ifndef KIT_CHECK_HPP
#define KIT_CHECK_HPP
#include "prelude.hpp"

namespace kit {

// ------------- What a runner defines: main.cpp for students, or a grader's own

/** A task's test, known to the runner from the start of the program. */
struct Registered {
  Registered(const char* id, const char* name, void (*test)());
};
/** What a failed check throws. Without a `got` the text is "Expected: ...",
 * with it "Expected ..., got ...". */
struct Failure {
  std::string did, expected, got;
};
void did(std::string what);
[[noreturn]] void fail(std::string expected, std::string got);
/** A check has begun. */
void checked();

// ---------------------------------------------------------------------- Words

/** A value as a reader would write it; the same on every run. */
template <typename T>
std::string text(const T& a) {
  if constexpr (std::is_same_v<T, bool>) {
    return a ? "true" : "false";
  } else if constexpr (std::is_same_v<T, char>) {
    return std::string(1, a);
  } else if constexpr (std::is_integral_v<T>) {
    return std::to_string(a);
  } else if constexpr (std::is_floating_point_v<T>) {
    if (a != a) return "nan";
    char digits[40];
    return {digits, std::to_chars(digits, digits + sizeof digits, a).ptr};
  } else if constexpr (std::is_same_v<T, Point>) {
    return '(' + text(a.x) + ", " + text(a.y) + ", " + text(a.z) + ')';
  } else if constexpr (std::is_convertible_v<const T&, std::string>) {
    return a;
  } else {
    return "another";
  }
}
template <typename... T>
std::string words(const T&... parts) {
  return (std::string() + ... + text(parts));
}

// --------------------------------------------------------------------- Checks

template <typename A, typename B>
bool equal(const A& a, const B& b) {
  if constexpr (std::is_same_v<A, bool>)
    return equal(int(a), b);
  else if constexpr (std::is_same_v<B, bool>)
    return equal(a, int(b));
  else if constexpr (std::is_integral_v<A> && std::is_integral_v<B>)
    return std::cmp_equal(a, b);  // of any two signs and sizes
  else
    return a == b;
}
inline bool near(double a, double b, double tolerance) {
  return std::abs(a - b) <= tolerance;  // false of NaN
}
inline bool near(const Point& a, const Point& b, double tolerance) {
  return near(a.x, b.x, tolerance) && near(a.y, b.y, tolerance) &&
         near(a.z, b.z, tolerance);
}

template <typename A, typename B>
void check_equal(const A& a, const B& b, const std::string& what) {
  checked();
  if (!equal(a, b)) fail(words(what, " == ", b), text(a));
}
template <typename A, typename B>
void check_near(const A& a, const B& b, double tolerance,
                const std::string& what) {
  checked();
  if (!near(a, b, tolerance))
    fail(words(what, " == ", b, " (within ", tolerance, ")"), text(a));
}
inline void check(bool holds, const std::string& what) {
  checked();
  if (!holds) fail(what, "");
}

}  // namespace kit
#endif

// Not guarded: whoever includes this file last has these and no others.
#undef TASK
#undef DID
#undef CHECK
#undef CHECK_EQUAL
#undef CHECK_NEAR

#define TASK(id, name)                                        \
  namespace kit {                                             \
  static void name();                                         \
  static const Registered registered_##name(id, #name, name); \
  }                                                           \
  void kit::name()
#define DID(...) ::kit::did(::kit::words(__VA_ARGS__))
#define CHECK(condition, what) ::kit::check(static_cast<bool>(condition), what)
#define CHECK_EQUAL(actual, expected) \
  ::kit::check_equal(actual, expected, #actual)
#define CHECK_NEAR(actual, expected, tolerance) \
  ::kit::check_near(actual, expected, tolerance, #actual)
