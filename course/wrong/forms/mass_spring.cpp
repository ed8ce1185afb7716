/** @file mass_spring.cpp
 * Its cloth is built in main(). */
#include <fstream>
#include <thread>

#include "CME212/SDLViewer.hpp"
#include "CME212/Util.hpp"
#include "mass_spring.hpp"

int main(int argc, char** argv) {
  if (argc < 3) return 1;
  Fabric g;
  std::vector<Node> nodes;
  std::ifstream nodes_file(argv[1]), tets_file(argv[2]);
  Point p;
  while (CME212::getline_parsed(nodes_file, p)) nodes.push_back(g.add_node(p));
  std::array<int, 4> t;
  while (CME212::getline_parsed(tets_file, t))
    for (int i = 1; i < 4; ++i)
      for (int j = 0; j < i; ++j) g.add_edge(nodes[t[i]], nodes[t[j]]);
  for (auto n : nodes) n.value().mass = 1.0 / nodes.size();
  for (auto it = g.edge_begin(); it != g.edge_end(); ++it)
    (*it).value().without_force =
        norm((*it).node1().position() - (*it).node2().position());
  c = 1.0 / nodes.size();

  CME212::SDLViewer viewer;
  auto node_map = viewer.empty_node_map(g);
  viewer.add_nodes(g.node_begin(), g.node_end(), node_map);
  viewer.add_edges(g.edge_begin(), g.edge_end(), node_map);
  std::thread simulation([&] {
    auto force =
        make_combined_force(GravityForce(), MassSpringForce(), DampingForce());
    auto constraint = make_combined_constraint(
        PinConstraint(&g), PlaneConstraint(), RemoveConstraint());
    for (double t = 0; t < 5 && !viewer.closed();) {
      t = symp_euler_step(g, t, 0.001, force, constraint);
      viewer.clear();
      node_map.clear();
      viewer.add_nodes(g.node_begin(), g.node_end(), node_map);
      viewer.add_edges(g.edge_begin(), g.edge_end(), node_map);
      viewer.set_label(t);
    }
  });
  viewer.event_loop();
  simulation.join();
}
