/** @file test_checkpoint.cpp
 * A run that goes on from what another saved: the same bits, or an error. */
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "CME212/Archive.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Compose.hpp"
#include "lab/scenes/SceneFile.hpp"

using namespace lab;
using CME212::Archive;

namespace {

TEST(Archive, GivesBackWhatItTook) {
  bool yes = true;
  double pi = 3.25;
  std::vector<Point> points = {Point(1, 2, 3), Point(4, 5, 6)}, none;
  std::string text = "a\0b";
  auto archive = [&](Archive& a) {
    a(yes)(pi)(points)(none)(text)(std::span(points));
  };
  Archive out;
  archive(out);
  yes = false, pi = 0, text.clear(), none = points, points[1] = Point();
  Archive in(out.bytes());
  archive(in);
  EXPECT_TRUE(in.loads() && in.at_end() && yes);
  EXPECT_EQ(pi, 3.25);
  EXPECT_EQ(points, (std::vector{Point(1, 2, 3), Point(4, 5, 6)}));
  EXPECT_EQ(none, std::vector<Point>{});
  EXPECT_EQ(text, "a\0b");
  // Whatever is missing, it says so; and takes no memory for what is not there.
  for (std::size_t size = 0; size < out.bytes().size(); ++size) {
    Archive half(out.bytes().substr(0, size));
    EXPECT_THROW(archive(half), std::runtime_error) << size;
  }
  std::string huge = out.bytes();
  huge.replace(1 + sizeof pi, 8, 8, '\xff');  // the length of points
  Archive wrong(huge);
  EXPECT_THROW(archive(wrong), std::runtime_error);
}

/** A cloth that moves, with drag, held at one side and pulled at another. */
Model moving_cloth() {
  Model m;
  m.sheets.resize(1);
  m.sheets[0].u = Point(1.1, 0, 0.3);
  m.sheets[0].nodes = {7, 6};
  m.damping = 0.1;
  m.pins.resize(2);
  m.pins[0].x = 0, m.pins[1].x = 1.1;
  m.pins[1].motion = {Point(0.2, 0.1, 0), 0.05};
  m.planes.resize(1);
  m.planes[0].at = Point(0, 0, -0.02);
  return m;
}

/** A cloth and what a method needs to move it. */
struct Moved {
  Cloth g;
  CombinedForces all;
  ForcePlan force;
  ConstraintPlan constraint;
  std::unique_ptr<Method> method;

  Moved(const Recipe& r, const MethodEntry& entry)
      : all((r.build(g), r.force(g))),
        force(all),
        constraint(r.constraint(g)),
        method(entry.make()) {}
  void step(int from, int to) {
    for (int k = from; k < to; ++k)
      method->step(g, 0.01 * k, 0.01, force, constraint);
  }
};

// And to be saved does not change a run.
TEST(EveryMethod, GoesOnWithTheSameBits) {
  const Recipe recipe = recipe_of(moving_cloth());
  for (const MethodEntry& m : methods) {
    Moved whole(recipe, m), first(recipe, m), second(recipe, m);
    whole.step(0, 40);
    first.step(0, 17);
    std::ranges::copy(first.g.positions(), second.g.positions().begin());
    std::ranges::copy(first.g.node_values(), second.g.node_values().begin());
    Archive out;
    first.method->archive(out, first.g);
    Archive in(out.bytes());
    second.method->archive(in, second.g);
    EXPECT_TRUE(in.at_end());
    for (Moved* goes_on : {&first, &second}) {
      goes_on->step(17, 40);
      for (unsigned i = 0; i < whole.g.size(); ++i) {
        const Node a = whole.g.node(i), b = goes_on->g.node(i);
        ASSERT_EQ(a.position(), b.position()) << m.info.name << " node " << i;
        ASSERT_EQ(a.value().vel, b.value().vel) << m.info.name << " node " << i;
      }
    }
  }
}

}  // namespace
