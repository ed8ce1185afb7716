#pragma once
/** @file NetParsing.hpp
 * The tools of the readers of nets: numbers, faces and springs from words. */
#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "CME212/Util.hpp"
#include "lab/scenes/Net.hpp"

namespace lab::net_parsing {

using Words = std::span<const std::string_view>;
using mesh_detail::each_line, mesh_detail::quoted;

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
  /** The number of nodes that the file announces. */
  std::size_t announced = 0;
  std::string skipped = {};  ///< what is in the file but not read

  unsigned index(long long i) const {
    if (i < 0 || i >= (long long)std::max(announced, net.points.size()))
      fail("there is no node " + std::to_string(i + first));
    return unsigned(i);
  }
  /** The face with these @a corners around it, as many as there are. */
  void face(std::span<const long long> corners) {
    for (long long c : corners) corners_.push_back(index(c));
    sizes_.push_back(corners.size());
  }
  void spring(long long i, long long j, double K = -1, double L = -1) {
    net.springs.push_back({index(i), index(j), K, L});
    if (i == j) fail("joins node " + std::to_string(i + first) + " to itself");
  }
  void skip(const std::string& what) {
    if (skipped.find(what) == skipped.npos && skipped.size() < 99)
      skipped += (skipped.empty() ? "not read: " : ", ") + what;
  }
  /** Make nodes within 1e-6 of the size of all one node.
   * @param says_so add a note */
  void weld(bool says_so);
  /** The net, with its faces; what they needed is in its notes. */
  Net made() &&;

 private:
  std::vector<unsigned> corners_;  // of all faces, one after the other
  std::vector<std::size_t> sizes_;
};

// Formats that may be binary; as parse_net().
void parse_stl(std::string_view text, const std::string& file, Builder& b);
void parse_ply(std::string_view text, const std::string& file, Builder& b);

}  // namespace lab::net_parsing
