/** @file film.cpp
 * The method "yours" of a ./cloth: film.py links this file with cloth.cpp,
 * twice. In the jail it is a stranger's step, which writes where the nodes are
 * after each step to the descriptor TRY_PIPE:
 *   -DTRY_FILE='"mine.hpp"' -DTRY_UNDEFINED='"x.hpp"' -DTRY_STEP=my_step
 * Outside of it, without TRY_FILE, it puts the nodes where the file TRY_STATES
 * says. Both get -DTRY_ORDER=2 -DTRY_SWEEPS=1 -DTRY_LIMIT=2.0 of make try. */
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>

#include "lab/methods/Methods.hpp"
// The step comes last: it may use all headers above.
#include "mass_spring.hpp"
#ifdef TRY_FILE
#include TRY_FILE
#include TRY_UNDEFINED
#endif

namespace lab {
namespace {

using State = std::array<double, 6>;  // of a node: x, v

#ifdef TRY_FILE
/** Write the state in which the constraint is called for time @a at; or, for
 * time -1, that at the end of a step. */
void write(const Cloth& g, double at) {
  static std::FILE* const out = fdopen(std::atoi(std::getenv("TRY_PIPE")), "w");
  std::fwrite(&at, sizeof at, 1, out);
  for (Node n : g.nodes()) {
    const Point x = n.position(), v = n.value().vel;
    const State state = {x.x, x.y, x.z, v.x, v.y, v.z};
    std::fwrite(&state, sizeof state, 1, out);
  }
  std::fflush(out);
}
double yours(Cloth& g, double t, double dt, const ForcePlan& force,
             const ConstraintPlan& constraint) {
  long long calls = 0;
  const auto on = [&](auto n, double at) {
    if (calls++ % std::max(1u, g.num_nodes()) == 0) force.count_evaluation();
    const unsigned id = n.id();
    Point f = force.springs() * MassSpringForce()(n, at);
    f.z -= force.gravity() * n.value().mass;
    f -= force.drag()[id] * n.value().vel;
    force.add_others({g, id, id + 1}, at, {&f, 1});
    return f;
  };
  const auto hold = [&](Cloth& cloth, double at) {
    write(cloth, at);
    constraint(cloth, at);
  };
  const double end = TRY_STEP(g, t, dt, on, hold);
  write(g, -1);
  return end;
}
#else
double yours(Cloth& g, double t, double dt, const ForcePlan& force,
             const ConstraintPlan& constraint) {
  static std::ifstream states(std::getenv("TRY_STATES"), std::ios::binary);
  const auto read = [](auto& to) {
    if (!states.read(reinterpret_cast<char*>(&to), sizeof to))
      throw StepError("the step of your own ended");
  };
  if (t == 0) states.seekg(0);  // else it goes on
  for (int sweep = 0; sweep < TRY_SWEEPS; ++sweep) force.count_evaluation();
  for (double at = 0; at != -1;) {
    read(at);
    for (Node n : g.nodes()) {
      State s;
      read(s);
      n.position() = Point(s[0], s[1], s[2]);
      n.value().vel = Point(s[3], s[4], s[5]);
    }
    if (at != -1) constraint(g, at);
  }
  return t + dt;
}
#endif

class Yours : public Method {
 public:
  static constexpr MethodInfo info = {
      "yours", TRY_ORDER, TRY_SWEEPS, TRY_LIMIT, "a step of your own", "", ""};
  double step(Cloth& g, double t, double dt, const ForcePlan& force,
              const ConstraintPlan& constraint) override {
    return yours(g, t, dt, force, constraint);
  }
};

constexpr MethodEntry entry = entry_of<Yours>();
[[maybe_unused]] const bool known = (add_method(entry), true);

}  // namespace
}  // namespace lab
