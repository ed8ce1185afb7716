// What methods.hpp says of each plain step: order, limit and forces a step,
// neither worse nor better. On the graph of a student, which has nothing but
// what the assignment asks for.
#include "course/starter/open/Graph.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <string>

#include "methods.hpp"

namespace {

struct Mass {
  Point vel;
  double mass = 1;
};
struct Spring {
  double K = 1, L = 1;
};
using Cloth = Graph<Mass, Spring>;

/** The springs at a node. */
const auto springs = [](auto n, double) {
  Point f;
  for (auto e : edges(n)) {
    const Point u = e.node2().position() - e.node1().position();
    f += e.value().K * (1 - e.value().L / norm(u)) * u;
  }
  return f;
};
/** Of these, one counts its calls at new positions. */
struct Counted {
  mutable Point last = Point(std::nan(""));
  mutable int calls = 0, fresh = 0;
  template <typename N>
  Point operator()(N n, double t) const {
    if (n.index() == 0) return springs(n, t);
    ++calls;
    fresh += n.position() != last;
    last = n.position();
    return springs(n, t);
  }
};

/** One mass of 1 kg on a spring of 1 m to a held node: as long as y > -1,
 * y'' + c y' + w^2 y = 0 for the displacement y along x. */
struct Oscillator {
  Cloth g;
  double w, c;
  Oscillator(double w_, double c_, double y, double v) : w(w_), c(c_) {
    g.add_node(Point());
    g.add_node(Point(1 + y, 0, 0), {Point(v, 0, 0), 1});
    g.add_edge(g.node(0), g.node(1)).value() = {w * w, 1};
  }
  static void hold(Cloth& g, double) {
    g.node(0).position() = g.node(0).value().vel = Point();
  }
  double y() const { return g.node(1).position().x - 1; }
  double v() const { return g.node(1).value().vel.x; }
  /** |(y, v/w) - exact| from (y0, 0) after time t, underdamped. */
  double error(double y0, double t) const {
    const double d = std::sqrt(w * w - c * c / 4);
    const double e = y0 * std::exp(-c * t / 2);
    return std::hypot(
        y() - e * (std::cos(d * t) + c / (2 * d) * std::sin(d * t)),
        (v() + e * w * w / d * std::sin(d * t)) / w);
  }
};

constexpr double none = std::numeric_limits<double>::infinity();

// What methods.hpp says: the order; the limit; forces a step; the same with
// those at equal positions counted again; whether drag as an ordinary force
// takes the order.
#define PLAIN(NAME, ORDER, LIMIT, FORCES, CALLS, SPLITS)                     \
  struct NAME {                                                              \
    static constexpr const char* name = #NAME;                               \
    static constexpr int order = ORDER, forces = FORCES, calls = CALLS;      \
    static constexpr double limit = LIMIT;                                   \
    static constexpr bool splits = SPLITS;                                   \
    template <typename F>                                                    \
    static double step(Oscillator& o, double t, double dt, const F& force) { \
      return NAME##_step(o.g, t, dt, force, Oscillator::hold);               \
    }                                                                        \
  };
PLAIN(forward_euler, 1, 0, 1, 1, false)
PLAIN(verlet, 2, 2, 1, 2, true)
PLAIN(yoshida4, 4, 1.5734, 3, 6, true)
PLAIN(pefrl, 4, 2.9894, 4, 4, true)
PLAIN(srkn11b, 6, 9.0736, 11, 12, true)
PLAIN(rk4, 4, 2.8284, 4, 4, false)
PLAIN(implicit_euler, 1, none, 1, 1, false)
PLAIN(xpbd, 1, none, 1, 1, false)
#undef PLAIN

template <typename M>
class PlainStep : public ::testing::Test {
 protected:
  /** The error at t = 1 with w = 2: no multiple of half a period, where order 1
   * looks like order 2. */
  template <bool apart>
  static double error(double c, int steps) {
    Oscillator o(2, c, 0.1, 0);
    const double dt = 1. / steps;
    const WithDrag force(springs, c);
    double t = 0;
    for (int k = 0; k < steps; ++k)
      if constexpr (apart)
        t = M::step(o, t, dt, force);
      else
        t = M::step(o, t, dt,
                    [&](auto n, double now) { return force(n, now); });
    EXPECT_NEAR(t, 1, 1e-12);
    return o.error(0.1, 1);
  }
  /** The slope of the error from the largest number of steps at which round-off
   * does not matter. */
  template <bool apart>
  static double order(double c) {
    int steps = 8;
    while (error<apart>(c, 2 * steps) > 1e-10 && steps < 1 << 8) steps *= 2;
    return std::log2(error<apart>(c, steps / 2) / error<apart>(c, steps));
  }
  /** The largest modulus of the eigenvalues of a step of @a h at w = 1. */
  static double growth(double h) {
    std::array<double, 4> m;
    for (int column : {0, 1}) {
      constexpr double size = 1e-3;  // so small that y > -1 at all stages
      Oscillator o(1, 0, column == 0 ? size : 0, column == 1 ? size : 0);
      M::step(o, 0, h, springs);
      m[column] = o.y() / size, m[2 + column] = o.v() / size;
    }
    const std::complex<double> half = (m[0] + m[3]) / 2;
    const auto root = std::sqrt(half * half - (m[0] * m[3] - m[1] * m[2]));
    return std::max(std::abs(half + root), std::abs(half - root));
  }
};
using All = ::testing::Types<forward_euler, verlet, yoshida4, pefrl, srkn11b,
                             rk4, implicit_euler, xpbd>;
struct Names {
  template <typename M>
  static std::string GetName(int) {
    return M::name;
  }
};
TYPED_TEST_SUITE(PlainStep, All, Names);

TYPED_TEST(PlainStep, HasItsOrder) {
  EXPECT_NEAR(this->template order<false>(0), TypeParam::order, 0.1);
  EXPECT_NEAR(this->template order<true>(0.5), TypeParam::order, 0.1);
}

// What drag as an ordinary force costs.
TYPED_TEST(PlainStep, HasOrderOneWithDragInTheKick) {
  EXPECT_NEAR(this->template order<false>(0.5),
              TypeParam::splits ? 1 : TypeParam::order, 0.1);
}

TYPED_TEST(PlainStep, IsBoundedBelowItsLimitOnly) {
  if (TypeParam::limit == none) {
    EXPECT_LT(this->growth(100), 1);
  } else {
    EXPECT_LE(this->growth(0.997 * TypeParam::limit), 1 + 1e-9);
    EXPECT_GT(this->growth(1.003 * TypeParam::limit + 0.01), 1 + 1e-6);
  }
}

TYPED_TEST(PlainStep, ComputesItsForces) {
  Oscillator o(1, 0, 0.1, 0.3);
  const Counted force;
  for (int k = 0; k < 10; ++k) TypeParam::step(o, 0.1 * k, 0.1, force);
  EXPECT_EQ(force.calls, 10 * TypeParam::calls);
  EXPECT_EQ(force.fresh - 10 * TypeParam::forces,
            TypeParam::calls > TypeParam::forces);
}

TEST(PlainStep, OfSeveralStagesRefusesToTearWithinAStep) {
  Oscillator o(1, 0, 0.1, 0);
  const auto remove = [](Cloth& g, double t) {
    if (t < 0.1) g.remove_node(g.node(0));
  };
  EXPECT_THROW(rk4_step(o.g, 0, 0.1, springs, remove), std::logic_error);
}

}  // namespace
