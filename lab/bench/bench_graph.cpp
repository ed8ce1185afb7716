/** @file bench_graph.cpp
 * Costs of a Graph: nanoseconds and bytes a node of a grid with diagonals, of
 * SIDE x SIDE nodes. It needs no more than mass_spring.hpp, so that
 * graph_costs.sh can compile it with another version of that and of Graph.hpp:
 *   bench_graph SIDE */
#include <malloc.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <vector>

#include "mass_spring.hpp"

namespace {

std::vector<Point> points;
std::vector<Quad> quads;

/** Print the least time of a few calls of @a act(), each after @a make(). */
template <typename Make, typename Act>
void time(const char* name, Make make, Act act) {
  double least = 1e9;
  CME212::Clock all;
  for (int k = 0; k < 5 || (k < 200 && all.seconds() < 0.5); ++k) {
    auto what = make();
    CME212::Clock clock;
    act(*what);
    least = std::min(least, clock.seconds());
  }
  std::printf("%s|%.2f\n", name, 1e9 * least / double(points.size()));
}

std::unique_ptr<Cloth> built(bool reserve) {
  auto g = std::make_unique<Cloth>();
  if (reserve) {
    build_cloth(*g, points, quads, MeshSprings::diagonals);
    return g;
  }
  for (const Point& p : points) g->add_node(p);
  const MeshSprings springs(quads, MeshSprings::diagonals);
  for (unsigned s = 0; s < springs.size(); ++s)
    g->add_edge(g->node(springs[s][0]), g->node(springs[s][1]));
  return g;
}

void memory(const char* name, bool reserve) {
  const auto used = [] {
    const auto m = mallinfo2();
    return m.uordblks + m.hblkhd;
  };
  const auto before = used();
  const auto g = built(reserve);
  std::printf("%s|%.1f\n", name,
              double(used() - before) / double(points.size()));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::puts("usage: bench_graph SIDE"), 2;
  const auto side = unsigned(std::atoi(argv[1]));
  points = grid_points(side), quads = grid_quads(side);

  const auto none = [] { return std::make_unique<int>(); };
  time("build, with `reserve()`", none, [](int&) { built(true); });
  time("build, without", none, [](int&) { built(false); });
  const auto g = built(true);
  const auto same = [&g] { return g.get(); };
  std::vector<Point> force(points.size());
  time("loop over springs by proxies", same, [&](Cloth& cloth) {
    std::size_t i = 0;
    for (auto n : nodes(cloth)) {
      Point f;
      for (auto e : edges(n))
        f += spring_force(e.node2().position() - n.position(), e.value());
      force[i++] = f;
    }
  });
  time("step by proxies", same,
       [](Cloth& cloth) { symp_euler_step(cloth, 0, 1e-7, Problem1Force()); });
  std::mt19937 random(212);
  time(
      "remove half of the nodes, in random order",
      [&] {
        auto cloth = built(true);
        std::vector<Node> order(cloth->node_begin(), cloth->node_end());
        std::shuffle(order.begin(), order.end(), random);
        order.resize(order.size() / 2);
        return std::make_unique<
            std::pair<std::unique_ptr<Cloth>, std::vector<Node>>>(
            std::move(cloth), std::move(order));
      },
      [](auto& p) {
        for (const Node& n : p.second) p.first->remove_node(n);
      });
  memory("memory", true);
  memory("memory, built without `reserve()`", false);
}
