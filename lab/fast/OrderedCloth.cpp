#include "lab/fast/OrderedCloth.hpp"

#include <cassert>
#include <vector>

#include "lab/fast/MeshOrder.hpp"

namespace lab {

void build_ordered_cloth(Cloth& g, std::span<const Point> points,
                         std::span<const Quad> quads, MeshSprings::Kind mesh,
                         double K) {
  if (is_local(quads)) return build_cloth(g, points, quads, mesh, K);
  assert(g.size() == 0);
  const MeshSprings springs(quads, mesh);
  g.reserve(unsigned(points.size()), unsigned(springs.expected(points.size())));
  const NodeData at_rest = {Point(), Real(1.0 / double(points.size()))};
  const MeshOrder order = cuthill_mckee(points.size(), quads);
  std::vector<unsigned> node_id(points.size());
  for (unsigned i : order.points)
    node_id[i] = g.add_node(points[i], at_rest).id();
  constexpr unsigned none = -1;  // a spring that came before
  std::vector<unsigned> edge_id(springs.size(), none);
  {
    const auto ordered = in_order(quads, order);
    const MeshSprings local(ordered, mesh);
    const auto n = unsigned(quads.size());
    auto number = [&](unsigned s) { return s / n * n + order.quads[s % n]; };
    for (unsigned s : sorted_springs(local, points.size(), number)) {
      const auto [i, j] = local[s];
      const Node a = g.node(i), b = g.node(j);
      const Real L = Real(norm(a.position() - b.position()));
      edge_id[number(s)] = g.add_edge(a, b, {Real(K), L}).id();
    }
  }
  std::erase(edge_id, none);
  g.reindex_nodes(node_id);
  g.reindex_edges(edge_id);
}

void restore_order(Cloth& g) {
  if (g.node_slots() < 4096 || g.num_nodes() == g.node_slots()) return;
  unsigned descents = 0;  // indices with a smaller id than the index before
  for (unsigned i = 1; i < g.num_nodes(); ++i)
    descents += g.node(i) < g.node(i - 1);
  if (descents > g.node_slots() / 256) g.reindex();
}

}  // namespace lab
