// A graph with removal: handles survive the removal of other nodes.
#include <iostream>
#include "Graph.hpp"
int main() {
  Graph<int, double> g;  // nodes carry an int, edges a double
  auto a = g.add_node(Point(0, 0, 0), 1);
  auto b = g.add_node(Point(3, 0, 4), 2);
  auto c = g.add_node(Point(3, 0, 0), 3);
  g.add_edge(a, b).value() = 0.5;
  g.add_edge(b, c);
  g.remove_node(a);         // removes the edge from a to b, too
  b.position().z = 1;       // b and c still refer to the same nodes
  for (auto e : b.edges())  // e.node1() is b
    std::cout << e.node2().value() << " at distance " << e.length() << '\n';
  std::cout << g.num_nodes() << " nodes, a is there: " << g.has_node(a) << '\n';
}
