// Contact.hpp: post-conditions, and Coulomb's law against theory.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "lab/methods/Splitting.hpp"
#include "lab/methods/SymplecticEuler.hpp"
#include "lab/scenes/Contact.hpp"
#include "lab/scenes/SelfCollision.hpp"

using namespace lab;

namespace {

using CME212::random;
constexpr double infinity = std::numeric_limits<double>::infinity();

Point random_point(double size) {
  return Point(random(-size, size), random(-size, size), random(-size, size));
}

// --------------------------------------------------------------------- Motion

TEST(Motion, EndsAtUntil) {
  const Motion m = {Point(1, -2, 4), 0.5};
  EXPECT_EQ(m.way(-1), Point(-1, 2, -4));  // a stage before the first step
  EXPECT_EQ(m.way(0), Point());
  EXPECT_EQ(m.way(0.25), Point(0.25, -0.5, 1));
  EXPECT_EQ(m.way(0.5), Point(0.5, -1, 2));
  EXPECT_EQ(m.way(3), Point(0.5, -1, 2));
  EXPECT_EQ(m.velocity_at(0), m.velocity);
  EXPECT_EQ(m.velocity_at(std::nextafter(0.5, 0)), m.velocity);
  EXPECT_EQ(m.velocity_at(0.5), Point());
}
TEST(Motion, GoesOnForEverOrNotAtAll) {
  EXPECT_EQ((Motion{Point(1, 0, 0)}.way(1e6)), Point(1e6, 0, 0));
  EXPECT_EQ(Motion().way(1e6), Point());
  EXPECT_EQ(Motion().velocity_at(1e6), Point());
}
TEST(Motion, TurnsAboutAnAxis) {
  const double half_pi = std::acos(0);
  const Motion m = {Point(0, 0, 2), 1, Point(0, 0, half_pi), Point(1, 0, 0)};
  const Point start(3, 0, 5);
  EXPECT_EQ(m.place_of(start, 0), start);
  EXPECT_LT(norm(m.place_of(start, 1) - Point(1, 2, 7)), 1e-15);
  EXPECT_EQ(m.place_of(start, 4), m.place_of(start, 1));
  EXPECT_EQ(m.velocity_of(start, 1), Point());
  const double t = 0.3, h = 1e-5;
  EXPECT_LT(
      norm((m.place_of(start, t + h) - m.place_of(start, t - h)) / (2 * h) -
           m.velocity_of(start, t)),
      1e-9);
}

// -------------------------------------------------------------------- Contact

TEST(Contact, TakesAsMuchAlongTheSurfaceAsFrictionSays) {
  const Point up(0, 0, 1), u(3, 4, -2);  // 5 along, 2 in
  EXPECT_EQ(contact::kick(u, up, 0), Point(0, 0, 2));
  EXPECT_LT(norm(contact::kick(u, up, 1.25) - Point(-1.5, -2, 2)), 1e-15);
  EXPECT_GT(norm(u + contact::kick(u, up, 2.4999)), 1e-4);
  EXPECT_LT(norm(u + contact::kick(u, up, 2.5)), 1e-15);
  EXPECT_LT(norm(u + contact::kick(u, up, 1e9)), 1e-15);
}
// It slid along since it came in, by 3 and 4 fifths of its depth a unit of
// friction: and goes back by what friction would have spared it.
TEST(Contact, PutsBackWhatSlidTooFar) {
  for (double friction : {0.0, 1.25, 2.5, 4.0}) {
    Cloth g;
    Node n = g.add_node(Point(1, 2, 2.5), {Point(5, 5, 5), 1});
    contact::touch(n, 0.5, Point(0, 0, 1), Point(2, 1, 7), friction);
    const double back = 0.5 * std::min(friction, 2.5);
    EXPECT_LT(norm(n.position() - Point(1 - 0.6 * back, 2 - 0.8 * back, 3)),
              1e-15);
  }
}
TEST(Contact, IsFiniteHoweverSlowly) {
  for (double in : {1e-30, 1e-300, 5e-324})
    for (double along : {0.0, 5e-324, 1e-300, 1e-30, 1.0}) {
      Cloth g;
      Node n = g.add_node(Point(), {Point(along, 0, -in), 1});
      contact::touch(n, 0.5, Point(0, 0, 1), Point(), 2);
      EXPECT_LE(norm(n.position()), 0.5 * std::sqrt(5.0) + 1e-15);
      EXPECT_LE(norm(n.value().vel - Point(along, 0, -in)), 3 * in);
    }
}

// ----------------------------------------------------------- Walls and balls

/** 200 nodes in a cube around the origin, with velocities. */
class ScatteredNodes : public ::testing::Test {
 protected:
  Cloth g;
  const Ball ball = {Point(0.1, 0, 0.2), 0.8};

  void SetUp() override {
    CME212::default_generator.seed(3);
    for (int i = 0; i < 200; ++i)
      g.add_node(random_point(1), {random_point(1), 0.1});
    for (unsigned i : {150u, 7u, 0u}) g.remove_node(g.node(i));
  }
  void expect_twice_is_once(const ConstraintPlan& c) {
    c(g, 0.3);
    const Cloth once = g;
    c(g, 0.3);
    for (unsigned i = 0; i < g.num_nodes(); ++i) {
      EXPECT_LT(norm(g.node(i).position() - once.node(i).position()), 1e-15);
      EXPECT_LT(norm(g.node(i).value().vel - once.node(i).value().vel), 1e-14);
    }
  }
  /** Hold @a c at time 0.3 to its post-condition, for an obstacle that moves
   * at @a velocity and from which @a way leads to the nearest point outside.
   * Without friction. */
  void expect_nearest(const ConstraintPlan& c, const Point& velocity,
                      const std::function<Point(const Point&)>& way) {
    const Cloth before = g;
    c(g, 0.3);
    int moved = 0;
    for (unsigned i = 0; i < g.num_nodes(); ++i) {
      const Node was = before.node(i), is = g.node(i);
      const Point w = way(was.position());
      if (w == Point()) {
        EXPECT_EQ(is.position(), was.position());
        EXPECT_EQ(is.value().vel, was.value().vel);
        continue;
      }
      ++moved;
      const Point out = w / norm(w);
      EXPECT_LT(norm(is.position() - was.position() - w), 1e-15);
      EXPECT_LT(norm(way(is.position())), 1e-15);
      const double normal = dot(was.value().vel - velocity, out);
      const Point kick = is.value().vel - was.value().vel;
      EXPECT_LT(norm(kick - std::max(0.0, -normal) * out), 1e-15);
    }
    EXPECT_GT(moved, 40);
    EXPECT_LT(moved, 160);
  }
};

TEST_F(ScatteredNodes, AWallThatMovesTakesNodesToItsNearestPoint) {
  const Motion motion = {Point(0.2, 0.4, -0.6), 5};
  const Point normal = Point(1, 2, 2) / 3;
  expect_nearest(WallConstraint(Point(0.1, 0, 0), 4 * normal, motion),
                 motion.velocity, [&](const Point& p) {
                   const Point at = Point(0.1, 0, 0) + 0.3 * motion.velocity;
                   return std::max(0.0, dot(at - p, normal)) * normal;
                 });
}
TEST_F(ScatteredNodes, ABallAtRestAndOneThatMovesDoSo) {
  for (const Motion& motion : {Motion{}, Motion{Point(0.2, -0.3, 0.1), 2},
                               Motion{Point(0.2, -0.3, 0.1), 0.2}}) {
    const Point center = ball.center + motion.way(0.3);
    expect_nearest(BallConstraint(ball, motion), motion.velocity_at(0.3),
                   [&](const Point& p) {
                     const Point r = p - center;
                     return std::max(0.0, 0.8 - norm(r)) / norm(r) * r;
                   });
    g.clear();
    SetUp();
  }
}
TEST_F(ScatteredNodes, TwiceIsOnce) {
  const Motion motion = {Point(0.2, -0.3, 0.1)};
  for (double friction : {0.0, 0.3, 3.0}) {
    expect_twice_is_once(
        WallConstraint(Point(), Point(1, 2, 3), motion, friction));
    expect_twice_is_once(BallConstraint(ball, motion, friction));
  }
}

TEST(Wall, LeavesANodeThatLiesOnIt) {
  Cloth g;
  Node n = g.add_node(Point(0, 0, -0.75), {Point(0, 0, -1), 1});
  const WallConstraint wall(Point(0, 0, -0.75), Point(0, 0, 1));
  wall(g, 0);
  EXPECT_EQ(n.value().vel, Point(0, 0, -1));
  n.position().z = std::nextafter(-0.75, -1);
  wall(g, 0);
  EXPECT_EQ(n.position().z, -0.75);
  EXPECT_EQ(n.value().vel, Point());
}
TEST(Wall, IsNeverMissed) {
  const ConstraintPlan wall = WallConstraint(Point(), Point(0, 0, 1));
  EXPECT_FALSE(wall.first_hit(Point(0, 0, 1), Point(0, 0, -1)));
  EXPECT_EQ(wall.thinnest(), infinity);
}
TEST(Ball, SendsANodeAtItsCenterToTheTop) {
  Cloth g;
  const Ball ball = {Point(1, 2, 3), 0.5};
  Node n = g.add_node(ball.center, {Point(1, 2, -3), 1});
  BallConstraint c(ball);
  c(g, 0);
  EXPECT_EQ(n.position(), Point(1, 2, 3.5));
  EXPECT_EQ(n.value().vel, Point(1, 2, 0));
  n.value().vel = Point(0, 0, -1);
  c(g, 0);  // on the surface
  EXPECT_EQ(n.value().vel, Point(0, 0, -1));
}
TEST(Ball, IsWatchedWhileItIsAtRest) {
  const Ball ball = {Point(), 0.5};
  const BallConstraint rests(ball), moves(ball, {Point(0, 3, 4), 0.1});
  const Point from(-1, 0, 0), to(1, 0, 0);
  EXPECT_EQ(ConstraintPlan(rests).thinnest(), 0.5);
  EXPECT_EQ(ConstraintPlan(rests).first_hit(from, to),
            lab::first_hit(ball, from, to));
  // Wherever it ends behind the center, it has passed; not before, nor if it
  // slides along the surface.
  const Point hit(-0.5, 0, 0), near = to * 1e-3, on_top(-0.01, 0, 0.5);
  for (const Point& end : {to, to * 0.4, near})
    EXPECT_NEAR(norm(*lab::first_hit(ball, from, end) - hit), 0, 1e-8);
  EXPECT_TRUE(lab::first_hit(ball, hit * (1 - 1e-9), near));
  for (const Point& end : {to * -0.1, hit})
    EXPECT_FALSE(lab::first_hit(ball, from, end));
  EXPECT_FALSE(lab::first_hit(ball, on_top, on_top + Point(0.3, 0, -0.1)));
  EXPECT_FALSE(ConstraintPlan(TearConstraint(ball)).first_hit(from, near));
  EXPECT_TRUE(ConstraintPlan(TearConstraint(ball)).first_hit(from, to));
  EXPECT_EQ(rests.speed(), 0);
  EXPECT_EQ(ConstraintPlan(moves).thinnest(), infinity);
  EXPECT_EQ(ConstraintPlan(moves).first_hit(from, to), std::nullopt);
  EXPECT_EQ(moves.speed(), 5);
}

// ----------------------------------------------------------- Coulomb's law

/** A whole run of either method. */
class Sliding : public ::testing::TestWithParam<MethodEntry> {
 protected:
  Cloth g;
  void run(double dt, double t_end, const ForcePlan& force,
           const ConstraintPlan& c) {
    auto method = GetParam().make();
    const int steps = int(std::lround(t_end / dt));
    for (int k = 0; k < steps; ++k) method->step(g, k * dt, dt, force, c);
  }
  /** How far a sheet slides down a plane inclined by @a angle in 0.5 s [m]. */
  double slides(double angle, double friction, double dt) {
    const Point down(std::cos(angle), 0, -std::sin(angle)), across(0, 1, 0);
    const Point out = cross(down, across);
    auto points = grid_points(3);
    for (Point& p : points) p = p.x * down + p.y * across;
    g.clear();
    build_cloth(g, points, grid_quads(3), MeshSprings::diagonals);
    const Point before = center_of_mass(g);
    run(dt, 0.5, make_combined_force(GravityForce(), MassSpringForce()),
        WallConstraint(Point(), out, {}, friction));
    const Point way = center_of_mass(g) - before;
    EXPECT_NEAR(dot(way, out), 0, 10 * dt * dt);
    EXPECT_NEAR(dot(way, across), 0, 1e-13);
    return dot(way, down);
  }
};
INSTANTIATE_TEST_SUITE_P(Methods, Sliding,
                         ::testing::Values(entry_of<SymplecticEuler>(),
                                           entry_of<Verlet>()),
                         [](const auto& m) {
                           return m.index == 0 ? "SymplecticEuler" : "Verlet";
                         });

// Slides if tan a > friction, then by g (sin a - friction cos a) t^2/2: by
// Verlet to round-off, by symplectic Euler, whose speed is half a step late,
// to dt/t, no more and no less.
TEST_P(Sliding, IsThatOfCoulombsLaw) {
  const double late = GetParam().info.order == 1 ? 1 : 0;
  for (double angle : {0.3, 0.8})
    for (double share : {0.0, 0.5, 0.9}) {
      const double friction = share * std::tan(angle);
      const double exact =
          0.5 * 0.25 * grav * (std::sin(angle) - friction * std::cos(angle));
      for (double dt : {0.01, 0.001})
        EXPECT_NEAR(slides(angle, friction, dt) / exact, 1 - late * dt / 0.5,
                    1e-11);
    }
}
TEST_P(Sliding, BeginsWhereTheSlopeExceedsFriction) {
  for (double angle : {0.1, 0.5, 1.2}) {
    const double tan = std::tan(angle);
    EXPECT_LT(std::abs(slides(angle, 1.0001 * tan, 0.002)), 1e-12);
    EXPECT_GT(slides(angle, 0.999 * tan, 0.002), 5e-5);
  }
}
// A belt takes a node along: v = friction g t, until it is as fast.
TEST_P(Sliding, OnABeltEndsWhenItIsAsFast) {
  const double friction = 0.4, dt = 0.001;
  Node n = g.add_node(Point(1, 2, 0));
  const WallConstraint belt(Point(), Point(0, 0, 1), {Point(0, 1, 0)},
                            friction);
  run(dt, 0.2, GravityForce(), belt);
  EXPECT_NEAR(n.value().vel.y, friction * grav * 0.2, friction * grav * dt);
  const double at_pace = 1 / (friction * grav);  // 0.255 s
  run(dt, 0.4, GravityForce(), belt);            // 0.6 s in all
  EXPECT_NEAR(n.value().vel.y, 1, 1e-12);
  EXPECT_NEAR(n.position().y, 2 + 0.5 * at_pace + (0.6 - at_pace), 2 * dt);
}

// ----------------------------------------------------------------- Moving pins

TEST(MovingPin, TakesItsNodesAlong) {
  Cloth g;
  build_cloth(g, grid_points(4), grid_quads(4), MeshSprings::plain);
  const std::vector<Node> held = {g.node(2), g.node(9)};
  const Point starts[] = {held[0].position(), held[1].position()};
  const PinnedNodes pin(PinConstraint(held), {Point(0, 1, 2), 0.5});
  g.remove_node(g.node(0));  // indices change
  for (Node n : g.nodes()) n.value().vel = Point(1, 0, 0);
  Cloth before = g;
  for (double t : {0.25, 0.5, 0.75, 0.0}) {
    pin(g, t);
    for (int k : {0, 1}) {
      EXPECT_EQ(held[k].position(),
                starts[k] + std::min(t, 0.5) * Point(0, 1, 2));
      EXPECT_EQ(held[k].value().vel, t < 0.5 ? Point(0, 1, 2) : Point());
    }
  }
  for (unsigned i = 0; i < g.num_nodes(); ++i)
    if (g.node(i) != held[0] && g.node(i) != held[1]) {
      EXPECT_EQ(g.node(i).position(), before.node(i).position());
      EXPECT_EQ(g.node(i).value().vel, Point(1, 0, 0));
    }
  std::vector<Node> told;
  ConstraintPlan(pin).each_held(g, [&](Node n) { told.push_back(n); });
  EXPECT_EQ(told, held);
}
TEST(MovingPin, IsPlacedAtAStage) {
  Cloth g;
  const std::vector<Node> held = {g.add_node(Point(1, 0, 0))};
  const Node free = g.add_node(Point(2, 0, 0), {Point(0, 0, 3), 1});
  const PinnedNodes pin(PinConstraint(held), {Point(0, 4, 0), 0.5});
  // Through all that wraps a constraint.
  const WatchedConstraint watched(SelfCollision(0.1, 0, pin));
  const ConstraintPlan plan(watched);
  const auto is = [&](Point place, Point velocity) {
    return held[0].position() == place && held[0].value().vel == velocity;
  };
  plan.place_held_at_rest(g, 0.25);
  plan.set_held_velocities(g, 0.25);
  EXPECT_TRUE(is(Point(1, 1, 0), Point(0, 4, 0)));
  plan.place_held_at_rest(g, -0.25);
  EXPECT_TRUE(is(Point(1, -1, 0), Point()));
  plan.set_held_velocities(g, 0.25);
  EXPECT_TRUE(is(Point(1, -1, 0), Point(0, 4, 0)));
  plan.place_held_at_rest(g, 0.5);
  plan.set_held_velocities(g, 0.5);
  EXPECT_TRUE(is(Point(1, 2, 0), Point()));
  EXPECT_EQ(free.position(), Point(2, 0, 0));
  EXPECT_EQ(free.value().vel, Point(0, 0, 3));
  EXPECT_EQ(plan.next_velocity_jump(0.2), 0.5);
  EXPECT_EQ(plan.next_velocity_jump(0.5 * (1 - 1e-15)), HUGE_VAL);
  EXPECT_EQ(ConstraintPlan(PinConstraint(held)).next_velocity_jump(0),
            HUGE_VAL);
}
TEST(MovingPin, GoesOnWithoutANodeThatWasRemoved) {
  Cloth g;
  const std::vector<Node> held = {g.add_node(Point(1)), g.add_node(Point(2))};
  const PinConstraint pin(held);
  const PinnedNodes moving(pin, {Point(1, 0, 0)});
  g.remove_node(held[0]);
  Node other = g.add_node(Point(9));  // may take its slot
  const std::pair<ConstraintPlan, Point> plans[] = {{moving, Point(3, 2, 2)},
                                                    {pin, Point(2)}};
  for (const auto& [plan, place] : plans) {
    plan(g, 1);
    plan.place_held_at_rest(g, 1);
    plan.set_held_velocities(g, 1);
    EXPECT_EQ(other.position(), Point(9));
    EXPECT_EQ(held[1].position(), place);
  }
}

// --------------------------------------------------------------------- Strain

TEST(Strain, BreaksWhatIsLongerThanTheLimitAndNothingElse) {
  Cloth g;
  Node a = g.add_node(Point()), b = g.add_node(Point(1.25, 0, 0));
  g.add_edge(a, b, {100, 1});
  const StrainConstraint strain(0.25);
  strain(g, 0);
  EXPECT_EQ(g.num_edges(), 1u);
  b.position().x = std::nextafter(1.25, 2);
  strain(g, 0);
  EXPECT_EQ(g.num_edges(), 0u);
  EXPECT_EQ(g.num_nodes(), 2u);
  EXPECT_EQ(b.position().x, std::nextafter(1.25, 2));
}

TEST(Obstacles, TakeAnEmptyCloth) {
  Cloth g;
  WallConstraint(Point(), Point(1))(g, 0);
  BallConstraint(Ball{})(g, 0);
  StrainConstraint(0)(g, 0);
  PinnedNodes(PinConstraint(g), {})(g, 0);
  EXPECT_EQ(g.num_nodes(), 0u);
}

}  // namespace
