/** @file 7.2.program.cpp
 * The whole program, in its last stage, on a cloth of 3 x 4 nodes, one of which
 * swings through the ball.
 *
 * Define: KIT_PROGRAM   so it is a unit of its own: main() takes long */
#ifndef KIT_PROGRAM
#define KIT_PROGRAM  // before cloth.hpp
#endif
#include "cloth.hpp"
#include "program.hpp"

namespace kit {

/** From the frame on in which nodes were removed, so many more. */
static bool torn_for_a_while(const Film& f) {
  static int since = 0;
  if (f.bodies.size() < f.start.size() && since == 0) since = f.frames;
  return (since > 0 && f.frames >= since + 50) || f.frames >= 6000;
}

static double nearest(const std::vector<Film::Body>& bodies, const Point& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Film::Body& b : bodies) least = std::min(least, norm(b.x - p));
  return least;
}

}  // namespace kit

TASK("7.2.program", cloth_tears_and_hangs) {
#ifdef KIT_HAS_MAIN
  DID("the program on a cloth of 3 x 4 nodes");
  const Film& f = run_program(torn_for_a_while);
  CHECK(f.frames > 1, "the program to draw the cloth, step after step");
  const int nodes_at_first = int(f.start.size());
  CHECK_EQUAL(nodes_at_first, 12);
  CHECK(f.bodies.size() < f.start.size(), "the ball to remove nodes");
  CHECK(f.bodies.size() > f.start.size() / 2, "most of the nodes to stay");
  // Not exactly: this task is not the one for the order in a step.
  const double nearest_to_the_ball = nearest(f.bodies, Point(0.5, 0.5, -0.5));
  CHECK(nearest_to_the_ball > 0.14, "no node inside the ball");
  for (const Point& corner : {Point(0, 0, 0), Point(1, 0, 0)})
    CHECK(nearest(f.bodies, corner) < 0.1, words("a node held at ", corner));
#else
  fail("mass_spring.cpp with a main()", "none");
#endif
}
