/** @file asked.hpp
 * Questions that the grader asks a submission beside its tests. A test runs in
 * one process with the submission, which could change its verdict. So each task
 * is also asked for numbers:
 *
 *   ASKED("3.1.position", position_asked) {
 *     ...drawn(-1, 1)...              an input, from the grader's seed
 *     answer("position", p);          a result: never one that the kit computes
 *   }
 *
 * The grader has the answers of the solution to the same seed, in a process of
 * its own, and compares: who can't compute them can't forge them. An answer
 * does not depend on what the assignment leaves open, such as the order of
 * nodes. The name of one ends with '?' if it depends on what another task asks
 * for: of those with
 * the same first word at least one is to be given, and none wrong; with
 * '~' if it may be missing.
 *
 * ID.cpp comes after tests/ID.cpp in its unit, and uses its functions. Students
 * do not get these files. */
#ifndef KIT_ASKED_HPP
#define KIT_ASKED_HPP
#include "../tests/model.hpp"

namespace kit {

#ifdef KIT_SOLUTION
inline constexpr bool answers_all = true;
#else
inline constexpr bool answers_all = false;
#endif

/** Numbers that a secret and the id of a task determine, by splitmix64. */
struct Draw {
  std::uint64_t state = 0;

  static constexpr std::size_t secret = 32;  // bytes
  Draw(const unsigned char* word, std::string_view id) {
    const auto add = [this](unsigned char byte) {
      state = (state ^ byte) * 0x100000001b3u;
    };
    std::for_each(word, word + secret, add);
    std::for_each(id.begin(), id.end(), add);
  }
  /** In [least, most). */
  double operator()(double least, double most) {
    std::uint64_t x = state += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    x ^= x >> 31;
    return least + (most - least) * double(x >> 11) / 9007199254740992.;
  }
};
/** The next number in [least, most). Runs of one task draw the same. */
double drawn(double least, double most);
/** What law.cpp says of a net: the task 8.my_step asks it. */
struct Question {
  enum What { body, start, pin, force } what;  // body: (mass, begin, 0)
  int net, node;
  double t;
  Point x[12];
};
Point told(const Question& question);
/** The next of the numbers called @a what, right if within @a tolerance. */
void answer(const std::string& what, double number, double tolerance = 1e-9);

inline int drawn_below(int n) { return int(drawn(0, n)); }
inline Point drawn_point(double size = 1) {
  const double x = drawn(-size, size), y = drawn(-size, size);
  return Point(x, y, drawn(-size, size));
}
inline void answer(const std::string& what, const Point& p,
                   double tolerance = 1e-9) {
  answer(what, double(p.x), tolerance);
  answer(what, double(p.y), tolerance);
  answer(what, double(p.z), tolerance);
}

/** Answer what @a g holds, in all ways of @a works: tell.cpp. */
void tell(View& g, unsigned works);

}  // namespace kit

#define ASKED(id, name) TASK("?" id, name)
#endif
