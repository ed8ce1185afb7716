/** @file model.hpp
 * What a graph should hold, as plain data beside it; the shapes that tests
 * start from; and how a difference is put into words. */
#ifndef KIT_MODEL_HPP
#define KIT_MODEL_HPP
#include "check.hpp"

namespace kit {

inline std::string name(int v) {
  return v < 0 ? "no node that was added" : words('n', v);
}
/** Where node v stands, which no other node does. */
inline Point place(int v) { return Point(v, 2 * v, -v); }
/** The node that stands at @a p, or -1. */
inline int node_named(const Point& p) {
  if (!(p.x >= 0 && p.x < 1e6)) return -1;
  const int v = int(p.x);
  return p == place(v) ? v : -1;
}
inline int value_of_node(int v) { return 1000 + v; }
inline double value_of_edge(int a, int b) {
  return 100.5 * std::min(a, b) + std::max(a, b);
}

/** An edge by its ends, the lesser first. */
struct Ends {
  int a, b;
  Ends(int v, int w) : a(std::min(v, w)), b(std::max(v, w)) {}
  bool operator==(const Ends& e) const { return a == e.a && b == e.b; }
  bool has(int v) const { return a == v || b == v; }
  double value() const { return value_of_edge(a, b); }
};
inline std::string name(Ends e) { return name(e.a) + '-' + name(e.b); }

struct Model {
  std::vector<int> nodes;
  std::vector<Ends> edges;

  bool has(int v) const {
    return std::find(nodes.begin(), nodes.end(), v) != nodes.end();
  }
  bool has(Ends e) const {
    return std::find(edges.begin(), edges.end(), e) != edges.end();
  }
  std::vector<Ends> edges_at(int v) const {
    std::vector<Ends> here;
    for (Ends e : edges)
      if (e.has(v)) here.push_back(e);
    return here;
  }
  void remove(int v) {
    std::erase(nodes, v);
    std::erase_if(edges, [v](Ends e) { return e.has(v); });
  }
  void remove(Ends e) { std::erase(edges, e); }
};

// Shapes: the nodes n0, n1, ... and some edges.
inline Model nodes(int n) {
  Model m;
  for (int v = 0; v < n; ++v) m.nodes.push_back(v);
  return m;
}
inline Model ring(int n) {
  Model m = nodes(n);
  for (int v = 0; v < n; ++v) m.edges.push_back({v, (v + 1) % n});
  return m;
}
/** The hub n0 and a ring of the others. */
inline Model wheel(int n) {
  Model m = nodes(n);
  for (int v = 1; v < n; ++v) {
    m.edges.push_back({0, v});
    m.edges.push_back({v, v % (n - 1) + 1});
  }
  return m;
}
inline Model complete(int n) {
  Model m = nodes(n);
  for (int v = 0; v < n; ++v)
    for (int w = 0; w < v; ++w) m.edges.push_back({w, v});
  return m;
}
/** Squares, n nodes on a side. */
inline Model grid(int n) {
  Model m = nodes(n * n);
  for (int v = 0; v < n * n; ++v) {
    if (v % n != n - 1) m.edges.push_back({v, v + 1});
    if (v < n * (n - 1)) m.edges.push_back({v, v + n});
  }
  return m;
}

/** Random numbers: the same in every run and on every machine. */
class Dice {
 public:
  explicit Dice(std::uint32_t seed) : state_(seed) {}
  /** In [0, n). */
  int operator()(std::size_t n) {
    state_ = state_ * 1664525u + 1013904223u;
    return int((state_ >> 8) % n);
  }

 private:
  std::uint32_t state_;
};

// ------------------------------------------------------ What may be wrong

/** What is wrong, as fail() takes it; nothing if `expected` is empty. */
struct Fault {
  std::string expected, got;
  explicit operator bool() const { return !expected.empty(); }
};

/** How often something was met that should be met once, or never. */
template <typename T>
Fault not_once(const std::vector<T>& seen, const std::vector<T>& expected,
               const std::string& range) {
  auto wrong = [&](const T& x, const char* times) -> Fault {
    auto n = std::count(seen.begin(), seen.end(), x);
    return {words(range, " to reach ", name(x), ' ', times),
            n == 0   ? "never"
            : n == 1 ? "once"
            : n == 2 ? "twice"
                     : words(n, " times")};
  };
  for (const T& x : expected)
    if (std::count(seen.begin(), seen.end(), x) != 1) return wrong(x, "once");
  for (const T& x : seen)
    if (std::find(expected.begin(), expected.end(), x) == expected.end())
      return wrong(x, "never");
  return {};
}
inline Fault endless(const std::string& range, std::size_t steps) {
  return {words(range, " to end after ", steps, " steps"), "more"};
}
inline Fault unequal(const std::string& what, double expected, double got) {
  return {words(what, " == ", expected), text(got)};
}

}  // namespace kit
#endif
