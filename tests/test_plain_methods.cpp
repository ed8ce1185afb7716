// The plain steps of methods.hpp are the oracle of the laboratory's methods of
// the same names: both move the problems of the charts alike, to round-off.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "lab/charts/Problem.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/methods/ImplicitMethods.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/methods/Splitting.hpp"
#include "lab/stability/Spectrum.hpp"
#include "methods.hpp"
#include "tests/MovingEnds.hpp"
#include "tests/Says.hpp"

using namespace lab;

namespace {

// With its drag apart, so that a plain splitting solves it exactly as well.
using Force = WithDrag<CombinedForces>;
using Constraint = CombinedConstraints;

/** A plain step, and the method that is to be equal to it. */
struct Twin {
  const char* name;
  double (*step)(Cloth&, double, double, const Force&, const Constraint&);
  double length;  // dt omega of the steps that are compared
  /** Constraints act once a step, as in the laboratory; or at each stage, where
   * a laboratory's method only places held nodes. */
  bool once = false;
};
#define TWIN(function)                                  \
  [](Cloth& g, double t, double dt, const Force& force, \
     const Constraint& constraint) {                    \
    return function(g, t, dt, force, constraint);       \
  }
constexpr double tight = 1e-14;  // of linear equations
const Twin twins[] = {{"forward-euler", TWIN(forward_euler_step), 0.1, true},
                      {"symplectic-euler", TWIN(symp_euler_step), 1, true},
                      {"verlet", TWIN(verlet_step), 1, true},
                      {"pefrl", TWIN(pefrl_step), 1.5},
                      {"srkn11b", TWIN(srkn11b_step), 2.5},
                      {"rk4", TWIN(rk4_step), 1.5},
                      {"implicit-euler",
                       [](Cloth& g, double t, double dt, const Force& force,
                          const Constraint& constraint) {
                         return implicit_euler_step(g, t, dt, force, constraint,
                                                    tight);
                       },
                       4, true},
                      {"xpbd", TWIN(xpbd_step), 10}};
#undef TWIN

std::unique_ptr<Method> made(const Twin& twin) {
  if (twin.name == ImplicitEuler::info.name)
    return std::make_unique<ImplicitEuler>(tight);
  return find_method(twin.name)->make();
}

/** A wind that changes within a step: forces are to be those of the times at
 * which methods ask for them. */
struct Wind : SweptForce {
  Point operator()(Node n, double t) const override {
    return n.value().mass * Point(0, 3 * std::sin(60 * t), std::cos(60 * t));
  }
  bool add_stiffness(const Cloth&, const StiffnessVisitor&) const override {
    return true;  // none
  }
};

/** A problem of the charts, or with moving ends and wind, from a time on at
 * which it is in full motion, or almost in contact. */
struct Scene {
  Problem problem;
  std::unique_ptr<Start> at;
  double from, omega;

  Scene(Problem p, double t)
      : problem(std::move(p)), at(std::make_unique<Start>(problem)), from(0) {
    omega = omega_safe(at->cloth, at->force, at->constraint);
    const int steps = int(t * omega) + 1;
    Verlet method;
    method.steps(at->cloth, {0, t / steps}, steps, at->force, at->constraint);
    from = t;
    if (!has_contact()) return;
    method.restart();
    const double dt = 0.02 / omega;
    for (; !is_near(); from += dt)
      method.step(at->cloth, from, dt, at->force, at->constraint);
    EXPECT_EQ(at->cloth.num_nodes(), arrays(at->cloth).node_slots());
  }
  bool has_contact() const { return problem.norm == Norm::functionals; }
  bool is_near() const {
    return std::ranges::any_of(
        arrays(at->cloth).positions(), [](const Point& p) {
          return Ball{.radius = Ball().radius + 1e-4}.holds(p);
        });
  }

  /** The same state, with @a constraint as it was made at time 0. */
  void set(Cloth& g, CombinedConstraints& constraint) const {
    problem.build(g);
    constraint = problem.constraints(g);
    std::ranges::copy(arrays(at->cloth).positions(),
                      arrays(g).positions().begin());
    std::ranges::copy(arrays(at->cloth).node_values(),
                      arrays(g).node_values().begin());
  }
  CombinedForces force() const {
    const GravityForce gravity(problem.gravity.size());
    if (problem.driven())
      return make_combined_force(gravity, MassSpringForce(), Wind());
    return make_combined_force(gravity, MassSpringForce());
  }
};

const std::vector<Scene>& scenes() {
  static const std::vector<Scene> all = [] {
    std::vector<Scene> made;
    for (const Problem& p : make_problems())
      if (p.name != "slide" &&  // is_near() waits for a ball
          p.name != "large")    // takes long
        made.emplace_back(p,
                          p.norm == Norm::functionals ? 0.26 : 0.9 * p.t_end);
    made.emplace_back(pulled_chain(0.3), 0.2);
    made.emplace_back(moving_edge(0.4), 0.3);
    return made;
  }();
  return all;
}

class PlainMethod : public ::testing::TestWithParam<Twin> {};
INSTANTIATE_TEST_SUITE_P(Table, PlainMethod, ::testing::ValuesIn(twins),
                         [](const auto& twin) {
                           return test_name(twin.param.name);
                         });

/** The largest distance [m] of two states of the same nodes; of velocities
 * times @a dt, but not of held nodes, which the assignment's step kicks, too.
 */
double distance(const Cloth& a, const Cloth& b, double dt,
                const ConstraintPlan& constraint) {
  std::vector<char> held(arrays(a).node_slots());
  constraint.each_held(b, [&held](Node n) { held[n.id()] = true; });
  double most = 0;
  for (unsigned i = 0; i < arrays(a).node_slots(); ++i) {
    if (arrays(a).node_in_use(i) != arrays(b).node_in_use(i)) return HUGE_VAL;
    if (!arrays(a).node_in_use(i)) continue;
    most = std::max(most,
                    norm(arrays(a).positions()[i] - arrays(b).positions()[i]));
    if (!held[i])
      most = std::max(most, dt * norm(arrays(a).node_values()[i].vel -
                                      arrays(b).node_values()[i].vel));
  }
  return most;
}

// A step rounds each number some ten times, and a sum of springs; the errors of
// a stable method add up. So after n steps, positions, and velocities times dt,
// differ by some hundred n epsilon in meters, as the cloths are 1 m wide.
TEST_P(PlainMethod, EqualsItsTwinOnTheProblemsOfTheCharts) {
  const Twin& twin = GetParam();
  for (const Scene& scene : scenes()) {
    if (scene.has_contact() && !twin.once) continue;
    SCOPED_TRACE(scene.problem.name);
    Cloth plain, fast;
    Constraint on_plain(Constraint::List{}), on_fast = on_plain;
    scene.set(plain, on_plain);
    scene.set(fast, on_fast);
    const double c = scene.problem.damping;
    const Force force(scene.force(), c);
    const ForcePlan same(make_combined_force(scene.force(), DampingForce(c)));
    const ConstraintPlan constraint(on_fast);
    const auto method = made(twin);
    const double dt = twin.length / scene.omega;
    const int steps = twin.length < 1.5 ? 5 : 2;
    double t = scene.from;
    for (int k = 0; k < steps; ++k) {
      method->step(fast, t, dt, same, constraint);
      const double end = twin.step(plain, t, dt, force, on_plain);
      ASSERT_NEAR(end, t + dt, 1e-15);
      t = end;
    }
    const double epsilon = std::numeric_limits<double>::epsilon();
    const double apart = distance(plain, fast, dt, constraint);
    EXPECT_LT(apart, 100 * steps * epsilon);
    EXPECT_GT(distance(plain, scene.at->cloth, dt, constraint), 1e-6);
    if (scene.problem.name == "tear") {
      EXPECT_LT(plain.num_nodes(), 625u);
    }
  }
}

}  // namespace
