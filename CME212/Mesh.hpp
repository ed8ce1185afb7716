#pragma once
/** @file Mesh.hpp
 * The mesh of a cloth: points and quads, read from files or generated. Format
 * of the files: data/README.md. */
#include <locale.h>
#include <stdlib.h>

#ifdef __APPLE__
#include <xlocale.h>
#endif

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <vector>

#include "CME212/Point.hpp"

/** An input that can't be used. what() is "FILE:LINE: what is wrong, what was
 * expected"; or "FILE: ..." if line is 0, which stands for the whole file. */
struct InputError : std::runtime_error {
  InputError(const std::string& file, std::size_t line, const std::string& what)
      : std::runtime_error(file + (line ? ':' + std::to_string(line) : "") +
                           ": " + what) {}
};

namespace mesh_detail {

/** A word for a message: at most 24 characters, all of them printable. */
inline std::string quoted(std::string_view word) {
  std::string shown = "'";
  for (unsigned char c : word.substr(0, 24))
    shown += c >= 0x20 && c < 0x7f ? char(c) : '?';
  return shown + (word.size() > 24 ? "...'" : "'");
}

/** Call use(words, line number) for each line of @a text that has words. They
 * are separated by blanks and tabs, lines by \n, \r or both. A # begins a
 * comment; a \ at the end of a line continues it.
 * @return the number of lines */
template <typename Use>
std::size_t for_each_line(std::string_view text, Use use) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // UTF-8 mark
  const auto ends_line = [&](std::size_t k) {
    return k == text.size() || text[k] == '\n' || text[k] == '\r';
  };
  const auto ends_word = [&](std::size_t k) {
    return ends_line(k) || text[k] == ' ' || text[k] == '\t' ||
           text[k] == '#' || (text[k] == '\\' && ends_line(k + 1));
  };
  const auto next_line = [&](std::size_t k) {
    return k + (text.substr(k).starts_with("\r\n") ? 2 : k < text.size());
  };
  std::vector<std::string_view> words;
  std::size_t lines = 0;
  for (std::size_t at = 0; at < text.size(); at = next_line(at)) {
    const std::size_t number = ++lines;
    words.clear();
    while (!ends_line(at)) {
      const std::size_t first = at;
      while (!ends_word(at)) ++at;
      if (at > first)
        words.push_back(text.substr(first, at - first));
      else if (text[at] == '\\')
        at = next_line(at + 1), ++lines;
      else
        at = text[at] == '#' ? text.find_first_of("\r\n", at) : at + 1;
      at = std::min(at, text.size());
    }
    if (!words.empty()) use(words, number);
  }
  return lines;
}

/** std::from_chars() of a real by the C library: the same values and errors. */
inline std::from_chars_result real_of_c(const char* first, const char* last,
                                        double& value) {
  static const locale_t locale = newlocale(LC_ALL_MASK, "C", nullptr);
  // No hexadecimals, which strtod_l() reads, too; nor blanks and '+' in front.
  auto starts_hex = [](char c) { return c == 'x' || c == 'X'; };
  const std::string text(first, std::find_if(first, last, starts_hex));
  char* end = nullptr;
  errno = 0;
  const double a = strtod_l(text.c_str(), &end, locale);
  if (end == text.c_str() || text[0] == '+' || std::isspace(text[0] & 0xff))
    return {first, std::errc::invalid_argument};
  const char* const behind = first + (end - text.c_str());
  if (errno == ERANGE && (a == 0 || std::isinf(a)))
    return {behind, std::errc::result_out_of_range};
  value = a;
  return {behind, std::errc()};
}

/** std::from_chars(), where the library has all of it: libc++ does not, and its
 * from_chars() of reals makes a page 60 kB larger. */
template <typename T>
std::from_chars_result from_chars(const char* first, const char* last,
                                  T& value) {
#ifndef __cpp_lib_to_chars
  if constexpr (std::is_floating_point_v<T>)
    return real_of_c(first, last, value);
  else
#endif
    return std::from_chars(first, last, value);
}

/** @a word as a number.  Throws std::runtime_error that says what is wrong. */
template <typename T>
T parse_number(std::string_view word, const char* kind) {
  T value{};
  const char* first = word.data();
  if (word.starts_with('+') && !word.starts_with("+-")) ++first;
  auto [end, error] =
      mesh_detail::from_chars(first, word.data() + word.size(), value);
  if (error == std::errc::result_out_of_range)
    throw std::runtime_error(quoted(word) + " is out of range");
  if (error != std::errc() || end != word.data() + word.size())
    throw std::runtime_error(quoted(word) + " is not " + kind);
  return value;
}

/** Call @a use(words) for each line of @a text that has words; what it throws
 * gets its line, and what @a expected() says then.
 * @return the number of lines.  Throws InputError */
template <typename Use, typename Expected>
std::size_t each_line(std::string_view text, const std::string& file, Use use,
                      Expected expected) {
  return for_each_line(text, [&](auto& words, std::size_t line) {
    try {
      use(words);
    } catch (const std::runtime_error& e) {
      throw InputError(file, line, e.what() + (", expected " + expected()));
    }
  });
}

/** Call add(row) for each line of @a text: row is its N numbers of type T. If
 * @a add throws a std::runtime_error, it says what is wrong with the line. */
template <typename T, std::size_t N, typename Add>
void read_rows(std::string_view text, const std::string& file, const char* kind,
               const std::string& expected, Add add) {
  bool any = false;
  const auto use = [&](auto& words) {
    std::array<T, N> row;
    for (std::size_t k = 0; k < std::min(N, words.size()); ++k)
      row[k] = parse_number<T>(words[k], kind);
    if (words.size() != N)
      throw std::runtime_error(std::to_string(words.size()) +
                               (words.size() == 1 ? " value" : " values") +
                               " in the line");
    add(row);
    any = true;
  };
  const std::size_t lines =
      each_line(text, file, use, [&] { return expected; });
  if (!any)
    throw InputError(file, lines, "nothing in the file, expected " + expected);
}

/** The content of a file, or of a pipe up to its end.  Throws InputError. */
inline std::string read_file(const std::string& file, const char* expected) {
  auto fail = [&](const std::string& what) {
    throw InputError(file, 0, what + ", expected " + expected);
  };
  std::error_code none;
  if (std::filesystem::is_directory(file, none)) fail("a directory");
  const auto fail_to = [&](const char* what) {
    fail(std::string("can't be ") + what + " (" + std::strerror(errno) + ')');
  };
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) fail_to("opened");
  std::string text;
  std::array<char, 1 << 16> part;
  while (in.read(part.data(), part.size()), in.gcount() > 0)
    text.append(part.data(), std::size_t(in.gcount()));
  if (in.bad()) fail_to("read");
  return text;
}

}  // namespace mesh_detail

/** Four indices of nodes: a quad with the sides 01, 02, 13 and 23. */
using Quad = std::array<unsigned, 4>;

/** The points [m] of a .nodes file: "x y z" in each line.
 * @param text content of the file   @param file its name, for messages
 * Throws InputError: a line is not three finite numbers; there is no line. */
inline std::vector<Point> parse_points(std::string_view text,
                                       const std::string& file) {
  std::vector<Point> points;
  mesh_detail::read_rows<double, 3>(
      text, file, "a number", "three finite coordinates 'x y z' [m]",
      [&points](auto& row) {
        for (double a : row)
          if (!std::isfinite(a))
            throw std::runtime_error("a coordinate is not finite");
        points.push_back({row[0], row[1], row[2]});
      });
  return points;
}

/** The cells of a file, such as quads: N different indices below @a num_points
 * in each line.  Throws InputError: a line is anything else; there is no line.
 */
template <std::size_t N>
std::vector<std::array<unsigned, N>> parse_cells(std::string_view text,
                                                 const std::string& file,
                                                 std::size_t num_points) {
  constexpr const char* count[] = {"no", "one", "two", "three", "four"};
  std::vector<std::array<unsigned, N>> cells;
  mesh_detail::read_rows<long long, N>(
      text, file, "a whole number",
      std::string(count[N]) + " different node indices from 0 to " +
          std::to_string(num_points - 1) +
          (N == 2 ? "; a .net file has K and L, too" : ""),
      [&cells, num_points](auto& row) {
        std::array<unsigned, N> cell;
        for (std::size_t k = 0; k < N; ++k) {
          if (row[k] < 0 || row[k] >= static_cast<long long>(num_points))
            throw std::runtime_error("there is no node " +
                                     std::to_string(row[k]));
          for (std::size_t other = 0; other < k; ++other)
            if (row[other] == row[k])
              throw std::runtime_error("node " + std::to_string(row[k]) +
                                       " comes twice");
          cell[k] = static_cast<unsigned>(row[k]);
        }
        cells.push_back(cell);
      });
  return cells;
}
inline std::vector<Quad> parse_quads(std::string_view text,
                                     const std::string& file,
                                     std::size_t num_points) {
  return parse_cells<4>(text, file, num_points);
}

/** parse_points() and parse_quads() of a file.  Throw InputError, also if it
 * can't be read. */
inline std::vector<Point> load_points(const std::string& file) {
  return parse_points(mesh_detail::read_file(file, "a file of points"), file);
}
inline std::vector<Quad> load_quads(const std::string& file,
                                    std::size_t num_points) {
  return parse_quads(mesh_detail::read_file(file, "a file of quads"), file,
                     num_points);
}

/** The two corners at the ends of each side of a quad, and of each diagonal. */
inline constexpr std::array<std::array<unsigned, 2>, 4> quad_sides = {
    {{0, 1}, {0, 2}, {1, 3}, {2, 3}}};
inline constexpr std::array<std::array<unsigned, 2>, 2> quad_diagonals = {
    {{0, 3}, {1, 2}}};

/** Those of @a quads whose four sides all have has_side(i, j): where a cloth
 * lost a node or a side, it has a hole. A quad with equal corners, 1 and 3, is
 * a triangle. */
template <typename F>
std::vector<Quad> quads_with_sides(std::span<const Quad> quads, F has_side) {
  std::vector<Quad> left;
  std::ranges::copy_if(quads, std::back_inserter(left), [&](const Quad& q) {
    return std::ranges::all_of(quad_sides, [&](auto side) {
      return q[side[0]] == q[side[1]] || has_side(q[side[0]], q[side[1]]);
    });
  });
  return left;
}

/** The springs of a mesh, numbered: the first spring of each quad, then the
 * second spring of each, and so on; so on a grid consecutive springs have
 * consecutive ends. A spring that several quads share has several numbers. */
class MeshSprings {
 public:
  /** Which springs a quad gives: its four sides, or both diagonals as well. */
  enum Kind { plain, diagonals };
  /** @pre @a quads outlives this */
  MeshSprings(std::span<const Quad> quads, Kind kind)
      : quads_(quads), pairs_(kind == plain ? Pairs(quad_sides) : Pairs(all)) {}

  std::size_t size() const { return pairs_.size() * quads_.size(); }
  /** The points that spring @a s joins.  @pre s < size() */
  std::array<unsigned, 2> operator[](std::size_t s) const {
    const Quad& quad = quads_[s % quads_.size()];
    auto [a, b] = pairs_[s / quads_.size()];
    return {quad[a], quad[b]};
  }
  /** An estimate of the number of different springs. It is not too low if the
   * quads are one piece without holes that has all of @a num_points: then
   * points - sides + quads = 1 (Euler). */
  std::size_t expected(std::size_t num_points) const {
    return num_points + (pairs_.size() - 3) * quads_.size();
  }

 private:
  using Pairs = std::span<const std::array<unsigned, 2>>;
  static constexpr std::array<unsigned, 2> all[] = {{0, 1}, {0, 2}, {0, 3},
                                                    {1, 2}, {1, 3}, {2, 3}};
  std::span<const Quad> quads_;
  Pairs pairs_;
};

// ---------------------------------------------------------------------- Grids

/** n x m points [m] of the unit square at z = 0, with y in the inner loop; of
 * one row, its points at x = 0 or y = 0.  @pre n, m >= 1 */
inline std::vector<Point> grid_points(unsigned n, unsigned m) {
  std::vector<Point> points;
  points.reserve(std::size_t(n) * m);
  for (unsigned i = 0; i < n; ++i)
    for (unsigned j = 0; j < m; ++j)
      points.push_back({i / std::max(1., n - 1.), j / std::max(1., m - 1.), 0});
  return points;
}
inline std::vector<Point> grid_points(unsigned side) {
  return grid_points(side, side);
}

/** Its (n - 1) (m - 1) quads. The corners of each: the first, its neighbors
 * along y and along x, and the opposite one.  @pre n, m >= 1 */
inline std::vector<Quad> grid_quads(unsigned n, unsigned m) {
  std::vector<Quad> quads;
  quads.reserve(std::size_t(n - 1) * (m - 1));
  for (unsigned i = 0; i + 1 < n; ++i)
    for (unsigned j = 0; j + 1 < m; ++j) {
      const unsigned a = i * m + j;
      quads.push_back({a, a + 1, a + m, a + m + 1});
    }
  return quads;
}
inline std::vector<Quad> grid_quads(unsigned side) {
  return grid_quads(side, side);
}
