/** @file 7.2.TearConstraint.cpp
 * A ball that removes the nodes inside it, from cloths where they follow each
 * other, come last, or are all there are. */
#include "cloth.hpp"

namespace kit {

/** The class that tears, or Missing. */
template <typename C>
using ClassOrMissing = std::conditional_t<Complete<C>, C, Missing>;
using Tear = ClassOrMissing<KIT_CONSTRAINT(KIT_TEAR)>;

static bool in_ball(const Point& p) {
  const Point u = p - Point(0.5, 0.5, -0.5);
  return u.x * u.x + u.y * u.y + u.z * u.z < 0.15 * 0.15;
}

/** Nodes in a row, inside the ball where @a inside says 'i', each joined to
 * the two before it. */
static Bodies row(const char* inside) {
  Bodies b;
  for (; *inside; ++inside) {
    const double s = 0.001 * b.size;
    const Point center(0.5, 0.5, -0.5);
    b.add(*inside == 'i' ? center + Point(s, 0, 0) + 0.1 * Point(0, 0, 1)
                         : center + (0.151 + s) * Point(0, 1, 0),
          1, Point(0, 0, s));
  }
  for (int i = 1; i < b.size; ++i) {
    b.join(i - 1, i, given_K, 0.5);
    if (i > 1) b.join(i - 2, i, given_K, 0.5);
  }
  return b;
}

/** The index of a body, found by its velocity; or -1. */
static int index_of(Cloth& g, const Bodies& b, int i) {
  for (int k = 0; k < int(g.num_nodes()); ++k)
    if (velocity(g, k) == b.v[i]) return k;
  return -1;
}

template <typename T>
static void tear_and_compare(const Bodies& b) {
  Cloth g;
  fill(g, b);
  if constexpr (Present<T>) {
    auto tear = made_sphere<T>();
    constrain(tear, g);
  } else {
    fail("a class TearConstraint", "none");
  }
  answer("nodes", double(g.num_nodes()));
  answer("edges", double(g.num_edges()));
  int left = 0;
  for (int i = 0; i < b.size; ++i) {
    const int k = index_of(g, b, i);
    answer("left", k >= 0);
    left += !in_ball(b.x[i]);
    if (in_ball(b.x[i])) {
      CHECK(k < 0, words("the node at ", b.x[i], ", inside, to be removed"));
    } else {
      CHECK(k >= 0, words("the node at ", b.x[i], ", outside, to stay"));
      if (k < 0) continue;
      const Point position = place(g, k);
      CHECK_NEAR(position, b.x[i], 0);
    }
  }
  CHECK_EQUAL(g.num_nodes(), left);
  int edges_left = 0;
  for (int k = 0; k < b.num_springs; ++k) {
    const Spring& s = b.springs[k];
    if (in_ball(b.x[s.a]) || in_ball(b.x[s.b])) continue;
    ++edges_left;
    const int a = index_of(g, b, s.a), c = index_of(g, b, s.b);
    if (a < 0 || c < 0) continue;
    CHECK(g.has_edge(node_of(g, a), node_of(g, c)),
          "the edges between nodes outside to stay");
  }
  CHECK_EQUAL(g.num_edges(), edges_left);
}

}  // namespace kit

TASK("7.2.TearConstraint", tear_removes_what_is_inside) {
  for (const char* row_of : {"oooo", "oioo", "ioooo", "oooi", "ooiioo",
                             "oiiiiii", "iiiiiio", "ioioioioii", "iiii"}) {
    DID("nodes inside (i) and outside (o) the ball, added in the order ",
        row_of);
    tear_and_compare<Tear>(row(row_of));
  }
}

TASK("7.2.TearConstraint", tear_takes_a_ball) {
  with_ball<Tear>([](auto& ball, Cloth& g) {
    constrain(ball, g);
    CHECK_EQUAL(g.num_nodes(), 1);
    const Point position = place(g, 0);
    CHECK_NEAR(position, Point(0.5, 0.5, -0.5), 0);
  });
}

TASK("7.2.TearConstraint", tear_looks_at_the_radius) {
  Bodies b;
  for (double radius :
       std::initializer_list<double>{0.149, 0.151, 0.1, 0.2, 0.3, 0.05})
    for (const Point& d : {Point(0, 0, 1), Point(0, 0, -1), Point(0.6, 0, 0.8),
                           Point(-0.6, -0.8, 0)})
      b.add(Point(0.5, 0.5, -0.5) + radius * d, 1, Point(0, 0, 0.001 * b.size));
  b.vary(0.05);
  for (int i = 1; i < b.size; ++i) b.join(i - 1, i, given_K, 0.1);
  DID("24 nodes at 0.05 to 0.3 m from the center of the ball");
  tear_and_compare<Tear>(b);
}
