/** @file own.hpp
 * For tests of your own: page own-tests. It brings your Graph.hpp and, if it is
 * there, your mass_spring.hpp. In a test `Graph`, `Cloth`, `PinConstraint` and
 * so on are yours.
 *
 *   TASK("7.1.remove_node", takes_its_edges) {     // which task, any name
 *     Graph<int, double> g;
 *     auto a = g.add_node(Point(0, 0, 0)), b = g.add_node(Point(1, 0, 0));
 *     g.add_edge(a, b);
 *     g.remove_node(a);
 *     CHECK(g.num_edges() == 0);
 *     CHECK_NEAR(g.node(0).position(), Point(1, 0, 0), 1e-12);
 *   } */
#if __has_include("mass_spring.hpp")
#include "cloth.hpp"
#else
#include "graph.hpp"
#endif
