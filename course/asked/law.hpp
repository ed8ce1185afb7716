/** @file law.hpp
 * Numbers that the grader draws, and the questions that 8.my_step asks. */
#ifndef KIT_LAW_HPP
#define KIT_LAW_HPP
#include "../tests/check.hpp"

namespace kit {

/** Numbers that a secret and a name determine, by splitmix64. */
struct Draw {
  std::uint64_t state = 0;

  static constexpr std::size_t secret = 32;  // bytes
  Draw(const unsigned char* word, std::string_view name) {
    const auto add = [this](unsigned char byte) {
      state = (state ^ byte) * 0x100000001b3u;
    };
    std::for_each(word, word + secret, add);
    std::for_each(name.begin(), name.end(), add);
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
/** What law.cpp is asked of a net, for all bodies at once. */
struct Question {
  enum What { body, start, pin, force } what;  // body: (mass, begin, 0)
  int net;
  double t;
  Point x[12];
  bool operator==(const Question&) const = default;
};
struct Reply {
  Point of[12];
};
Reply told(const Question& question);

}  // namespace kit
#endif
