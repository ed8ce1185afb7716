/** @file graph.cpp
 * Builds a cloth with a graph that somebody has written, computes the forces
 * of its springs and removes nodes; graphs.py counts the instructions in
 * measured(). It is compiled with -DTRY_FILE='"Graph.hpp"', against the
 * assignment's interface alone, or with -DTRY_FLAT for arrays in its place.
 *   graph N    a cloth of N x N nodes: build, force, remove; then its size */
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <utility>
#include <vector>

#include "CME212/Point.hpp"
#ifndef TRY_FLAT
#include TRY_FILE
#endif

namespace {

struct Mass {
  Point vel;
  double mass = 1;
};
struct Spring {
  double K = 100, L = 0;
};
struct Pair {
  unsigned i, j;
};

std::vector<Pair> springs(unsigned n) {
  std::vector<Pair> all;
  for (unsigned k = 0; k < n * n; ++k) {
    if (k >= n) all.push_back({k - n, k});
    if (k % n) all.push_back({k - 1, k});
    if (k >= n && k % n)
      all.push_back({k - n - 1, k}), all.push_back({k - n, k - 1});
  }
  return all;
}
Point place(unsigned k, unsigned n) {
  return Point(k / n * .1, k % n * .1, .01 * (k % 7));
}
Point pull(const Point& u, const Spring& s) {
  const double l = norm(u);
  return s.K * (l - s.L) / l * u;
}

#ifdef TRY_FLAT
/** Arrays: for each node the other ends of its springs, in one row. */
struct Cloth {
  std::vector<Point> x;
  std::vector<unsigned> first, ends;
  std::vector<Spring> spring;
  void build(unsigned n, const std::vector<Pair>& all) {
    for (unsigned k = 0; k < n * n; ++k) x.push_back(place(k, n));
    first.resize(x.size() + 1), ends.resize(2 * all.size());
    spring.resize(ends.size());
    for (auto [i, j] : all) ++first[i], ++first[j];
    for (std::size_t k = 1; k < first.size(); ++k) first[k] += first[k - 1];
    for (auto [i, j] : all)
      for (auto [a, b] : {Pair{i, j}, Pair{j, i}}) {
        ends[--first[a]] = b;
        spring[first[a]].L = norm(x[i] - x[j]) * .9;
      }
  }
  Point forces() const {
    Point sum;
    for (std::size_t i = 0; i < x.size(); ++i) {
      Point f;
      for (unsigned k = first[i]; k < first[i + 1]; ++k)
        f += pull(x[ends[k]] - x[i], spring[k]);
      sum += double(i % 5) * f;
    }
    return sum;
  }
  void remove(unsigned) {}
  unsigned nodes() const { return unsigned(x.size()); }
};
#else
struct Cloth {
  Graph<Mass, Spring> g;
  void build(unsigned n, const std::vector<Pair>& all) {
    for (unsigned k = 0; k < n * n; ++k) g.add_node(place(k, n), Mass());
    for (auto [i, j] : all) {
      auto e = g.add_edge(g.node(i), g.node(j));
      e.value().L = norm(g.node(i).position() - g.node(j).position()) * .9;
    }
  }
  Point forces() {
    Point sum;
    unsigned i = 0;
    for (auto n = g.node_begin(); n != g.node_end(); ++n, ++i) {
      Point f;
      for (auto e = (*n).edge_begin(); e != (*n).edge_end(); ++e)
        f += pull((*e).node2().position() - (*n).position(), (*e).value());
      sum += double(i % 5) * f;
    }
    return sum;
  }
  void remove(unsigned count) {
    for (unsigned k = 0; k < count; ++k)
      g.remove_node(g.node(unsigned(k * 7919ull % g.num_nodes())));
  }
  unsigned nodes() const { return g.num_nodes(); }
};
#endif

std::function<void()> job;

}  // namespace

extern "C" __attribute__((noinline)) void measured() { job(); }

int main(int count, char** words) {
  const unsigned n = unsigned(std::atoi(count > 1 ? words[1] : "0"));
  const auto all = springs(n);
  Cloth cloth;
  Point sum;
  for (const auto& part :
       {std::function<void()>([&] { cloth.build(n, all); }),
        std::function<void()>([&] { sum = cloth.forces(); }),
        std::function<void()>([&] { cloth.remove(n * n / 4); })}) {
    job = part;
    measured();
  }
  std::printf("sum %.9g %.9g %.9g nodes %u\n", sum.x, sum.y, sum.z,
              cloth.nodes());
}
