#pragma once
/** @file Cloth.hpp
 * Cloth: a graph of point masses and springs; how it is read from files, and
 * its energies. SI units throughout; z points up. */
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "Graph.hpp"

/** What a node of a cloth carries. */
struct NodeData {
  Point vel;        ///< velocity [m/s]
  double mass = 1;  ///< [kg], > 0
};

/** What an edge of a cloth carries: a linear spring. */
struct EdgeData {
  double K = 100;  ///< spring constant [N/m], >= 0
  double L = 0;    ///< rest length [m], >= 0
};

using Cloth = Graph<NodeData, EdgeData>;
using Node = Cloth::node_type;
using Edge = Cloth::edge_type;

/** Acceleration of free fall [m/s^2]. */
inline constexpr double grav = 9.81;

/** The two corners [m] that the assignment holds fixed. */
inline constexpr std::array<Point, 2> corners = {Point(0, 0, 0),
                                                 Point(1, 0, 0)};
inline constexpr bool is_corner(const Point& p) {
  return p == corners[0] || p == corners[1];
}

// -------------------------------------------------------------------- Springs

/** The force [N] of a spring on its one end, the other end lying at @a u [m]
 * from it: K (l - L) u/l with l = |u|, so it pulls when longer than L.
 * Zero at l = 0, where no direction is defined. */
inline Point spring_force(const Point& u, const EdgeData& s) {
  double l = norm(u);
  return l > 0 ? (s.K * (l - s.L) / l) * u : Point();
}

/** The energy [J] of a spring of length @a l [m]: K (l - L)^2 / 2. */
inline double spring_energy(double l, const EdgeData& s) {
  return 0.5 * s.K * (l - s.L) * (l - s.L);
}

// ------------------------------------------------------------------- Energies

/** Add @a f(id) over all nodes in use, in the order of memory. */
template <typename F>
auto sum_over_nodes(const Cloth& g, F f) {
  decltype(f(0u)) sum{};
  for (unsigned i = 0; i < g.node_slots(); ++i)
    if (g.node_in_use(i)) sum += f(i);
  return sum;
}

/** Sum of m |v|^2 / 2 [J].  O(N) */
inline double kinetic_energy(const Cloth& g) {
  auto node = g.node_values();
  return sum_over_nodes(
      g, [=](unsigned i) { return 0.5 * node[i].mass * normSq(node[i].vel); });
}

/** Sum of m gravity z [J], zero at z = 0.  O(N)
 * @param gravity acceleration of free fall [m/s^2] */
inline double gravitational_energy(const Cloth& g, double gravity = grav) {
  auto x = g.positions();
  auto node = g.node_values();
  return sum_over_nodes(
      g, [=](unsigned i) { return node[i].mass * gravity * x[i].z; });
}

/** Sum of the springs' energies [J].  O(number of edges) */
inline double elastic_energy(const Cloth& g) {
  auto x = g.positions();
  auto spring = g.edge_values();
  double sum = 0;
  for (unsigned e = 0; e < g.edge_slots(); ++e)
    if (g.edge_in_use(e)) {
      auto [i, j] = g.edge_ends()[e];
      sum += spring_energy(norm(x[j] - x[i]), spring[e]);
    }
  return sum;
}

/** Total mass [kg]. */
inline double total_mass(const Cloth& g) {
  auto node = g.node_values();
  return sum_over_nodes(g, [=](unsigned i) { return node[i].mass; });
}

/** Center of mass [m]; the origin for a cloth without nodes. */
inline Point center_of_mass(const Cloth& g) {
  auto x = g.positions();
  auto node = g.node_values();
  double mass = total_mass(g);
  Point sum =
      sum_over_nodes(g, [=](unsigned i) { return node[i].mass * x[i]; });
  return mass > 0 ? sum / mass : Point();
}

// ---------------------------------------------------------------------- Input

/** An input that can't be used; what() is "FILE:LINE: what is wrong, what was
 * expected" (line 0: the file as a whole). */
struct InputError : std::runtime_error {
  InputError(const std::string& file, std::size_t line, const std::string& what)
      : std::runtime_error(file + ":" + std::to_string(line) + ": " + what) {}
};

namespace cloth_detail {

/** A word as it can be shown: short, and printable on any terminal. */
inline std::string quoted(std::string_view word) {
  std::string shown = "'";
  for (unsigned char c : word.substr(0, 24))
    shown += c >= 0x20 && c < 0x7f ? char(c) : '?';
  return shown + (word.size() > 24 ? "...'" : "'");
}

/** Call use(words, line number) for each line of @a text that is neither blank
 * nor a comment (#). Words are separated by blanks and tabs, lines by \n, \r
 * or both. @return the number of lines */
template <typename Use>
std::size_t for_each_line(std::string_view text, Use use) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // UTF-8 mark
  std::vector<std::string_view> words;
  std::size_t number = 0;
  while (!text.empty()) {
    std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end);
    if (!text.empty()) text.remove_prefix(text.starts_with("\r\n") ? 2 : 1);
    ++number;
    words.clear();
    for (;;) {
      line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
      if (line.empty()) break;
      std::size_t length = std::min(line.find_first_of(" \t"), line.size());
      words.push_back(line.substr(0, length));
      line.remove_prefix(length);
    }
    if (!words.empty() && words[0][0] != '#') use(words, number);
  }
  return number;
}

/** The number that @a word is, all of it; or throw what is wrong with it. */
template <typename T>
T parse_number(std::string_view word, const char* kind) {
  T value{};
  const char* first = word.data() + (word.starts_with('+') ? 1 : 0);
  auto [end, error] = std::from_chars(first, word.data() + word.size(), value);
  if (error == std::errc::result_out_of_range)
    throw std::runtime_error(quoted(word) + " is out of range");
  if (error != std::errc() || end != word.data() + word.size())
    throw std::runtime_error(quoted(word) + " is not " + kind);
  return value;
}

/** Read N numbers of type T from each line of @a text. */
template <typename T, std::size_t N, typename Check>
std::vector<std::array<T, N>> read_rows(std::string_view text,
                                        const std::string& file,
                                        const char* kind,
                                        const std::string& expected,
                                        Check check) {
  std::vector<std::array<T, N>> rows;
  std::size_t lines = for_each_line(text, [&](auto& words, std::size_t line) {
    try {
      std::array<T, N> row;
      for (std::size_t k = 0; k < std::min(N, words.size()); ++k)
        row[k] = parse_number<T>(words[k], kind);
      if (words.size() != N)
        throw std::runtime_error(std::to_string(words.size()) +
                                 (words.size() == 1 ? " value" : " values") +
                                 " in the line");
      check(row);
      rows.push_back(row);
    } catch (const std::runtime_error& e) {
      throw InputError(file, line, e.what() + (", expected " + expected));
    }
  });
  if (rows.empty())
    throw InputError(file, lines, "nothing in the file, expected " + expected);
  return rows;
}

/** @a x on the heap as a Base: itself if it is one, else in an Adapter. */
template <typename Base, template <typename> class Adapter, typename T>
std::shared_ptr<const Base> shared_as(T x) {
  if constexpr (std::derived_from<T, Base>)
    return std::make_shared<T>(std::move(x));
  else
    return std::make_shared<Adapter<T>>(std::move(x));
}

/** All of a file.  Throws InputError. */
inline std::string read_file(const std::string& file, const char* expected) {
  auto fail = [&](const std::string& what) {
    throw InputError(file, 0, what + ", expected " + expected);
  };
  if (std::filesystem::is_directory(file)) fail("a directory");
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (!in) fail(std::string("can't be opened (") + std::strerror(errno) + ")");
  if (in.peek() != std::ifstream::traits_type::eof()) text << in.rdbuf();
  if (in.bad() || text.bad()) fail("can't be read");
  return std::move(text).str();
}

}  // namespace cloth_detail

/** Four indices of nodes: a quad with the sides 01, 02, 13 and 23. */
using Quad = std::array<unsigned, 4>;

/** The points [m] of a .nodes file: "x y z" a line. Format: docs/data.md.
 * @param text all of the file   @param file its name, for messages
 * Throws InputError: a line without exactly three finite numbers; no line. */
inline std::vector<Point> parse_points(std::string_view text,
                                       const std::string& file) {
  std::vector<Point> points;
  for (auto [x, y, z] : cloth_detail::read_rows<double, 3>(
           text, file, "a number", "three finite coordinates 'x y z' [m]",
           [](auto& row) {
             for (double a : row)
               if (!std::isfinite(a))
                 throw std::runtime_error("a coordinate is not finite");
           }))
    points.push_back({x, y, z});
  return points;
}

/** The quads of a .tets file: four different indices below @a num_points a
 * line.  Throws InputError: any other line; no line. */
inline std::vector<Quad> parse_quads(std::string_view text,
                                     const std::string& file,
                                     std::size_t num_points) {
  std::vector<Quad> quads;
  for (auto row : cloth_detail::read_rows<long long, 4>(
           text, file, "a whole number",
           "four different node indices from 0 to " +
               std::to_string(num_points - 1),
           [num_points](auto& row) {
             for (int k = 0; k < 4; ++k) {
               if (row[k] < 0 || row[k] >= static_cast<long long>(num_points))
                 throw std::runtime_error("there is no node " +
                                          std::to_string(row[k]));
               for (int other = 0; other < k; ++other)
                 if (row[other] == row[k])
                   throw std::runtime_error("node " + std::to_string(row[k]) +
                                            " comes twice");
             }
           })) {
    Quad& quad = quads.emplace_back();
    for (int k = 0; k < 4; ++k) quad[k] = static_cast<unsigned>(row[k]);
  }
  return quads;
}

/** Which edges a quad gives: its four sides, or both diagonals as well. */
enum class Mesh { plain, diagonals };

/** Add to @a g the points as nodes and the sides of the quads as springs, at
 * rest: velocity 0, mass 1/N [kg] for N points, L = the initial length.
 * @param K spring constant of every edge [N/m]
 * @pre g.size() == 0; the indices in @a quads are below points.size() */
inline void build_cloth(Cloth& g, std::span<const Point> points,
                        std::span<const Quad> quads, Mesh mesh,
                        double K = 100) {
  assert(g.size() == 0);
  std::vector<Node> node;
  for (const Point& p : points)
    node.push_back(g.add_node(p, {Point(), 1.0 / double(points.size())}));
  auto add_spring = [&](unsigned i, unsigned j) {
    g.add_edge(node[i], node[j], {K, norm(points[i] - points[j])});
  };
  for (const Quad& q : quads) {
    add_spring(q[0], q[1]);
    add_spring(q[0], q[2]);
    if (mesh == Mesh::diagonals) {
      add_spring(q[0], q[3]);
      add_spring(q[1], q[2]);
    }
    add_spring(q[1], q[3]);
    add_spring(q[2], q[3]);
  }
}

/** Read a cloth from two files, as build_cloth() from parse_points() and
 * parse_quads().
 * @pre g.size() == 0
 * Throws InputError, and then @a g is as before. */
inline void load_cloth(Cloth& g, const std::string& nodes_file,
                       const std::string& tets_file, Mesh mesh,
                       double K = 100) {
  auto points = parse_points(
      cloth_detail::read_file(nodes_file, "a file of points"), nodes_file);
  auto quads =
      parse_quads(cloth_detail::read_file(tets_file, "a file of quads"),
                  tets_file, points.size());
  build_cloth(g, points, quads, mesh, K);
}
