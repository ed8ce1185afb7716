#pragma once
/** @file NetParsing.hpp
 * The tools of the readers of nets: numbers, faces and springs from words. */
#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "CME212/Util.hpp"
#include "lab/scenes/Net.hpp"

namespace lab::net_parsing {

using Words = std::span<const std::string_view>;
using mesh_detail::quoted;

[[noreturn]] inline void fail(const std::string& what) {
  throw std::runtime_error(what);
}

inline double number(std::string_view word) {
  const auto a = mesh_detail::parse_number<double>(word, "a number");
  if (!std::isfinite(a)) fail("a number is not finite");
  return a;
}
inline long long whole(std::string_view word) {
  return mesh_detail::parse_number<long long>(word, "a whole number");
}
inline long long index_of(double a) {
  if (!(std::abs(a) < 1e15) || a != std::floor(a))
    fail("there is no node " + CME212::short_text(a));
  return (long long)(a);
}
inline const Point& finite(const Point& p) {
  if (!is_finite(p)) fail("a number is not finite");
  return p;
}
/** The three coordinates in @a words from number @a k on. */
inline Point point(Words words, std::size_t k) {
  if (words.size() < k + 3)
    fail(CME212::count_of(words.size() - k, "coordinate"));
  return {number(words[k]), number(words[k + 1]), number(words[k + 2])};
}

/** Adds faces and springs to a net, whose points may come later. */
class Builder {
 public:
  Net net;
  int first = 0;  ///< the number of the first node in the file, for messages

  unsigned index(long long i) const {
    if (i < 0 || i >= (long long)net.points.size())
      fail("there is no node " + std::to_string(i + first));
    return unsigned(i);
  }
  /** The face with these @a corners around it. */
  void face(std::span<const long long> corners) {
    const std::size_t n = corners.size();
    if (n != 3 && n != 4) fail("a face of " + CME212::count_of(n, "corner"));
    for (std::size_t k = 0; k < n; ++k)
      if (std::ranges::count(corners, corners[k]) > 1)
        fail("node " + std::to_string(corners[k] + first) + " comes twice");
    const auto at = [&](std::size_t k) { return index(corners[k]); };
    net.quads.push_back(n == 3 ? face_around(at(0), at(1), at(2))
                               : face_around(at(0), at(1), at(2), at(3)));
  }
  void spring(long long i, long long j, double K = -1, double L = -1) {
    net.springs.push_back({index(i), index(j), K, L});
    if (i == j) fail("joins node " + std::to_string(i + first) + " to itself");
  }
};

/** Call @a use(words) for each line of @a text; what it throws gets its line,
 * and what @a expected() says then. */
template <typename Use>
void each_line(std::string_view text, const std::string& file, Use use,
               const std::function<std::string()>& expected) {
  mesh_detail::for_each_line(text, [&](auto& words, std::size_t line) {
    try {
      use(Words(words));
    } catch (const std::runtime_error& e) {
      throw InputError(file, line, e.what() + (", expected " + expected()));
    }
  });
}

inline const std::string corners = "faces of three or four different nodes";

// Formats that may be binary; as parse_net().
Net parse_stl(std::string_view text, const std::string& file);
Net parse_ply(std::string_view text, const std::string& file);

}  // namespace lab::net_parsing
