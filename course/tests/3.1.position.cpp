/** @file 3.1.position.cpp
 * Positions that can be changed. */
#include "graph.hpp"

namespace kit {
/** Move node @a v of @a s and look at it through other handles. */
template <typename S>
static void check_move(S& s, int v) {
  auto n = s.node(v), copy = n;
  constexpr bool assigns = must_compile || requires { n.position() = Point(); };
  constexpr bool adds = must_compile || requires { n.position() += Point(); };
  need<assigns && adds>("n.position() = p and n.position() += p");
  constexpr bool reads = must_compile || requires {
    std::as_const(n).position();
  };
  need<reads>("position() of a const Node");
  if constexpr (assigns && adds && reads) {
    check_equal(Point(std::as_const(n).position()), place(v),
                "position() of a const Node");
    const auto index = n.index();
    auto others = [&s, index] {
      std::vector<Point> all;
      for (std::size_t i = 0; i < s.m.nodes.size(); ++i)
        if (!equal(index, i)) all.push_back(position_of(node_at(s.g, i)));
      return all;
    };
    const auto before = others();
    const Point p = drawn_near(Point(0, 5, 1)), more = Point(1, 0, 1);
    DID("n.position() = ", p);
    n.position() = p;
    check_equal(position_of(n), p, "n.position()");
    DID("n.position() = ", p, ", with an older copy of n");
    check_equal(answer("copy", position_of(copy)), p, "copy.position()");
    DID("n.position() = ", p);
    check_equal(position_of(s.g.node(index)), p,
                "g.node(n.index()).position()");
    DID("n.position() += ", more);
    n.position() += more;
    check_equal(answer("place", position_of(s.g.node(index))), p + more,
                "g.node(n.index()).position()");
    CHECK_EQUAL(n.index(), index);
    if constexpr (requires { n.position().x += 1; }) {
      DID("n.position().x += 1");
      n.position().x += 1;
      check_equal(position_of(copy), p + more + Point(1, 0, 0),
                  "copy.position()");
    }
    DID("n.position() = p");
    CHECK(before == others(), "the positions of all other nodes stay");
    n.position() = place(v);
  }
}
}  // namespace kit

TASK("3.1.position", a_node_is_moved) {
  for (int v : {0, 3, 5}) {
    TestSubject s(ring(6));
    check_move(s, v);
    DID("moved a node of a ring of 6 and put it back");
    s.hold();
  }
}

namespace kit {
template <typename S>
static void check_moves_in_a_loop(S& s) {
  auto it = s.g.node_begin(), end = s.g.node_end();
  constexpr bool there = must_compile || requires {
    (*it).position() += Point();
  };
  need<there>("(*it).position() += p");
  if constexpr (there) {
    for (; !same(it, end); ++it) (*it).position() += Point(0, 0, 0.5);
    for (int v = 0; v < int(s.m.nodes.size()); ++v)
      check_equal(position_of(node_at(s.g, v)), place(v) + Point(0, 0, 0.5),
                  words("the position of ", name(v)));
  }
}
}  // namespace kit

TASK("3.1.position", all_nodes_are_moved_in_a_loop) {
  TestSubject s(ring(6));
  if (!(s.works & node_loop)) return;  // the fault of another task
  DID("(*it).position() += (0, 0, 0.5) for all nodes of a ring of 6");
  check_moves_in_a_loop(s);
}
