/** @file film.cpp
 * Makes a stranger's step the method "yours" of ./cloth.
 * film.py builds it, with what make try has measured, and links it with
 * cloth.cpp:
 *   -DTRY_FILE='"mine.hpp"' -DTRY_STEP=my_step -DTRY_ORDER=2 -DTRY_SWEEPS=1
 *   -DTRY_LIMIT=2.0 */
#include <algorithm>

#include "lab/methods/Methods.hpp"
// The step comes last: it may use all headers above.
#include "mass_spring.hpp"
#include TRY_FILE

namespace lab {
namespace {

/** A plain step as a method, node by node. */
class PlainMethod : public Method {
 public:
  static constexpr MethodInfo info = {
      "yours", TRY_ORDER, TRY_SWEEPS, TRY_LIMIT, TRY_FILE, "", ""};

  double step(Cloth& g, double t, double dt, const ForcePlan& force,
              const ConstraintPlan& constraint) override {
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
    return TRY_STEP(g, t, dt, on, constraint);
  }
};

constexpr MethodEntry entry = entry_of<PlainMethod>();
[[maybe_unused]] const bool known = (add_method(entry), true);

}  // namespace
}  // namespace lab
