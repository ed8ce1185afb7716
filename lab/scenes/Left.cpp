// The part of Compose.hpp that reads a cloth that was built: its mesh as it is
// now, without what was torn.
#include "lab/fast/GraphArrays.hpp"
#include "lab/fast/OneWaySprings.hpp"
#include "lab/scenes/Compose.hpp"

namespace lab {

std::vector<unsigned> ids_of(const Cloth& g) {
  std::vector<unsigned> ids;
  for (Node n : g.nodes()) ids.push_back(n.id());
  return ids;
}

std::vector<Acts> ways_of(const Net& net, const std::vector<unsigned>& ids,
                          const Cloth& g) {
  std::vector<Acts> all;
  for (const Spring& s : net.springs) {
    if (s.acts == Acts::both) continue;
    all.resize(arrays(g).edge_slots());
    for (const auto& [node, edge] : arrays(g).neighbors(ids[s.i]))
      if (node == ids[s.j]) all[edge] = s.acts;
  }
  return all;
}

std::vector<Quad> quads_left(const Cloth& g, const BuiltMesh& built) {
  const auto a = arrays(g);
  return quads_with_sides(built.mesh.quads, [&](unsigned i, unsigned j) {
    const unsigned p = built.ids[i], q = built.ids[j];
    return a.node_in_use(p) && a.node_in_use(q) &&
           g.has_edge(a.node_with_id(p), a.node_with_id(q));
  });
}

Net mesh_left(const Cloth& g, const BuiltMesh& built) {
  Net left;
  std::vector<unsigned> number(built.ids.size());
  for (unsigned i = 0; i < number.size(); ++i) {
    if (!arrays(g).node_in_use(built.ids[i])) continue;
    const Node n = arrays(g).node_with_id(built.ids[i]);
    number[i] = unsigned(left.points.size());
    left.points.push_back(n.position());
    left.velocities.push_back(n.value().vel);
  }
  left.quads = quads_left(g, built);
  for (Quad& q : left.quads)
    for (unsigned& i : q) i = number[i];
  return left;
}

Net net_left(const Cloth& g, const BuiltMesh& built,
             const std::vector<HeldNodes>& held) {
  Net left = mesh_left(g, built);
  left.bare_faces = !left.quads.empty();
  std::vector<unsigned> index(arrays(g).node_slots());  // by id
  for (unsigned id : built.ids)
    if (arrays(g).node_in_use(id)) {
      index[id] = unsigned(left.masses.size());
      left.masses.push_back(arrays(g).node_with_id(id).value().mass);
    }
  const OneWaySprings one_way(ways_of(built.mesh, built.ids, g));
  for (Edge e : g.edges())
    left.springs.push_back({index[e.node1().id()], index[e.node2().id()],
                            e.value().K, e.value().L, one_way.way(e.id())});
  for (const auto& [i, force] : built.mesh.loads)
    if (arrays(g).node_in_use(built.ids[i]))
      left.loads.push_back({index[built.ids[i]], force});
  for (const HeldNodes& h : held)
    for (const auto& node : h.nodes)
      if (arrays(g).node_in_use(node.id)) left.held.push_back(index[node.id]);
  return left;
}

}  // namespace lab
