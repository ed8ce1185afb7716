#pragma once
/** @file Util.hpp
 * Small helpers of the course: random numbers, a stopwatch, numbers as text,
 * input by lines, and operators derived from == and <. */
// More headers than this file needs: programs of students rely on those that
// the course's Util.hpp and Point.hpp include.
#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include <unistd.h>

/** Derive != from the == of @a T. */
template <typename T>
struct equality_comparable {
  friend bool operator!=(const T& a, const T& b) { return !(a == b); }
};
/** Derive >, <=, >= from the < of @a T.  @pre < is a strict total order */
template <typename T>
struct less_than_comparable {
  friend bool operator>(const T& a, const T& b) { return b < a; }
  friend bool operator<=(const T& a, const T& b) { return !(b < a); }
  friend bool operator>=(const T& a, const T& b) { return !(a < b); }
};
/** Both. */
template <typename T>
struct totally_ordered : equality_comparable<T>, less_than_comparable<T> {};

namespace CME212 {

/** The generator of random(): it gives the same numbers in every run. */
inline std::mt19937 default_generator;

/** A uniform random number in [a, b).  @pre a <= b */
inline double random(double a, double b) {
  assert(a <= b);
  return std::uniform_real_distribution<double>(a, b)(default_generator);
}
/** A uniform random number in [0, 1). */
inline double random() { return random(0, 1); }

/** A stopwatch. It starts when it is constructed. */
class Clock {
 public:
  using clock = std::chrono::steady_clock;
  using time_point = clock::time_point;
  using duration = clock::duration;

  /** Start again from zero. */
  void start() { start_ = clock::now(); }
  duration elapsed() const { return clock::now() - start_; }
  /** Time since the start [s]. */
  double seconds() const {
    return std::chrono::duration<double>(elapsed()).count();
  }

 private:
  time_point start_ = clock::now();
};

/** @a a with 17 significant digits, like %.17g: reading it gives @a a. */
inline std::string to_text(double a) {
  char text[32];
  auto end = std::to_chars(text, text + sizeof text, a,
                           std::chars_format::general, 17);
  return {text, end.ptr};
}

/** @a a with up to 6 significant digits, for people; like %g. */
inline std::string short_text(double a) {
  std::ostringstream out;
  out << a;
  return out.str();
}

/** @a a with 2 significant digits, like %.2g. */
inline std::string two_digits(double a) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", a);
  return text;
}

/** A count in words: "1 node", "2 nodes". */
inline std::string count_of(std::size_t n, const std::string& what) {
  return std::to_string(n) + ' ' + what + (n == 1 ? "" : "s");
}

/** "87 %" for 0.866; below 10 % two significant digits. */
inline std::string percent(double share) {
  const double a = 100 * share;
  return (std::abs(a) < 10 ? two_digits(a) : short_text(std::round(a))) + " %";
}

/** @a a with as few digits as possible so that reading it gives @a a. */
inline std::string exact_text(double a) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, a).ptr};
}

/** Let the calling thread sleep for @a t seconds.  @return 0, as usleep() */
inline int sleep(double t) {
  std::this_thread::sleep_for(std::chrono::duration<double>(t));
  return 0;
}

/** Read N values separated by white space; @a s fails when one is missing. */
template <typename T, std::size_t N>
std::istream& operator>>(std::istream& s, std::array<T, N>& v) {
  for (T& a : v) s >> a;
  return s;
}

/** Read a T from the next line of @a s that is neither blank nor starts with #.
 * @return @a s; it has failed at the end of the file, and if the line is no T
 *
 * The caller can't tell the two apart, and what follows the T on its line is
 * ignored. load_points() is strict, and says which line is wrong and why. */
template <typename T>
std::istream& getline_parsed(std::istream& s, T& value) {
  std::string line;
  auto to_skip = [&line] {
    std::size_t at = line.find_first_not_of(" \t\r");
    return at == std::string::npos || line[at] == '#';
  };
  do std::getline(s, line);
  while (s && to_skip());
  if (!s) return s;
  std::istringstream is(line);
  if (!(is >> value)) s.setstate(std::ios::failbit);
  return s;
}

/** @a text in small letters, those of ASCII. */
inline std::string lower_case(std::string text) {
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}
/** The ending of the file @a path from its last point on, in small letters. */
inline std::string ending_of(std::string_view path) {
  const auto point = path.find_last_of("./");
  if (point == path.npos || path[point] == '/') return "";
  return lower_case(std::string(path.substr(point)));
}

}  // namespace CME212
