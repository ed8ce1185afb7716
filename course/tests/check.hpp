/** @file check.hpp
 * The words of a test:
 *
 *   TASK("7.1.remove_node", name) { ... }    a test of the task of this id
 *   DID("ring of ", n, ", removed n3");      what was done; the latest is shown
 *   CHECK_EQUAL(g.num_nodes(), 13);  "Expected g.num_nodes() == 13, got 14."
 *   CHECK_NEAR(x, 1.5, 1e-12);       for numbers and Points; NaN never passes
 *   CHECK(condition, "the loop ends");       "Expected: the loop ends."
 *   CHECK(condition);                        "Expected: condition."
 *
 * A check that fails ends its test; with a grader it goes on, to answer what it
 * is asked: answers tell one mistake from another. The name of a test is unique
 * in all files.
 * A test file includes graph.hpp or cloth.hpp, which bring this file: it comes
 * after the submission's headers, so that their macros change nothing here. */
#ifndef KIT_CHECK_HPP
#define KIT_CHECK_HPP
#include "prelude.hpp"

// Marks a function in a test with "Build: counted" that does not count.
#if defined(__clang__)
#define KIT_NOT_COUNTED __attribute__((no_sanitize("coverage")))
#else
#define KIT_NOT_COUNTED __attribute__((no_sanitize_coverage))
#endif

namespace kit {

// ------------- What a runner defines: main.cpp for students, or a grader's own

/** A task's test, known to the runner from the start of the program. */
struct Registered {
  Registered(const char* id, const char* name, void (*test)());
};
/** Thrown by a failed check. Without a `got` the text is "Expected: ...",
 * with it "Expected ..., got ...". */
struct Failure {
  std::string did, expected, got;
};
void did(std::string what);
[[noreturn]] void fail(std::string expected, std::string got);
/** The same of a check after which the test may go on. */
void miss(std::string expected, std::string got);
/** A check has begun. */
void checked();
/** An aspect (model.hpp) is looked at before the test does anything; 0: it is
 * not any more.  @return false if an earlier run crashed there: look away */
bool probes(unsigned aspect);

// A grader runs each test that draws numbers once more, with other numbers, and
// compares what the submission answers then with what the solution does. So an
// answer is given before what is expected is there, and depends on nothing that
// the assignment leaves open. Its name ends with '?' if it depends on what
// another task asks for: of those with the same first word at least one is to
// be given, and none wrong; with '~' if it may be missing.

/** @a usual, or in the grader's second run a number in [least, most). How many
 * a test draws before an answer depends on no submission. */
double drawn(double usual, double least, double most);
/** The next of the numbers called @a what, right if within @a tolerance. */
void answer(const std::string& what, double number, double tolerance = 1e-9);
Point answer(const std::string& what, const Point& p, double tolerance = 1e-9);

/** Does the solution answer, for all forms of a submission? */
#ifdef KIT_SOLUTION
inline constexpr bool answers_all = true;
#else
inline constexpr bool answers_all = false;
#endif

/** A grader that wants the compiler's own words for what does not compile
 * defines KIT_MUST_COMPILE: then no test looks whether it does. */
#ifdef KIT_MUST_COMPILE
inline constexpr bool must_compile = true;
#else
inline constexpr bool must_compile = false;
#endif

// ------------------ What kit.cpp defines: compiled once, without a submission

/** A word of a text: a value as a reader would write it, the same on every
 * run; what has no such form is "another". */
struct Word {
  std::string text;
  Word(const char* a);
  Word(const std::string& a);
  Word(char a);
  Word(bool a);
  Word(int a);
  Word(unsigned a);
  Word(long a);
  Word(unsigned long a);
  Word(long long a);
  Word(unsigned long long a);
  Word(double a);
  Word(const Point& a);
  Word(const Word& a);
  ~Word();
};
std::string join(std::initializer_list<Word> words);

/** A point up to @a far from @a p along each axis; @a p where none is drawn. */
Point drawn_near(const Point& p, double far = 1);

bool near(double a, double b, double tolerance);
bool near(const Point& a, const Point& b, double tolerance);

/** The largest coordinate, or 1. */
double size(double a);
double size(const Point& a);
inline constexpr char in_float[] = ", as near as a float: is there one?";

void check(bool holds, const char* what);
void check(bool holds, const std::string& what);
/** Two values differ that should be equal, or near. */
void differ(const Word& what, const Word& expected, const Word& got);
void differ(const Word& what, const Word& expected, double tolerance,
            const Word& got);

inline void check_said(const char* condition, bool holds) {
  check(holds, condition);
}
template <typename What>
void check_said(const char*, bool holds, const What& what) {
  check(holds, what);
}

// --------------------------------------------------------- Of all their types

template <typename T>
Word word(const T& a) {
  if constexpr (std::is_convertible_v<const T&, Word>)
    return a;
  else
    return "another";
}
template <typename T>
std::string text(const T& a) {
  return kit::word(a).text;
}
template <typename... T>
std::string words(const T&... parts) {
  return join({kit::word(parts)...});
}

template <typename A, typename B>
bool equal(const A& a, const B& b) {
  if constexpr (std::is_same_v<A, bool>)
    return kit::equal(int(a), b);
  else if constexpr (std::is_same_v<B, bool>)
    return kit::equal(a, int(b));
  else if constexpr (std::is_integral_v<A> && std::is_integral_v<B>)
    return std::cmp_equal(a, b);  // of any two signs and sizes
  else
    return a == b;
}

template <typename A, typename B>
void check_equal(const A& a, const B& b, const Word& what) {
  checked();
  if (!kit::equal(a, b)) differ(what, kit::word(b), kit::word(a));
}
template <typename A, typename B>
void check_near(const A& a, const B& b, double tolerance, const Word& what) {
  checked();
  if (!near(a, b, tolerance))
    differ(what, kit::word(b), tolerance,
           near(a, b, 1e-6 * size(b)) ? words(a, in_float) : kit::word(a));
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
#define DID(...) ::kit::did(::kit::join({__VA_ARGS__}))
#define CHECK(...) ::kit::check_said(#__VA_ARGS__, __VA_ARGS__)
#define CHECK_EQUAL(actual, expected) \
  ::kit::check_equal(actual, expected, #actual)
#define CHECK_NEAR(actual, expected, tolerance) \
  ::kit::check_near(actual, expected, tolerance, #actual)
