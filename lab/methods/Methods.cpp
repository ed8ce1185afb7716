#include "lab/methods/Methods.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "lab/methods/Costs.hpp"
#include "lab/methods/ImplicitMethods.hpp"
#include "lab/methods/MollifiedImpulse.hpp"
#include "lab/methods/RungeKutta.hpp"
#include "lab/methods/Splitting.hpp"
#include "lab/methods/SymplecticEuler.hpp"
#include "lab/methods/Xpbd.hpp"

namespace lab {

namespace {

constexpr std::array lines = {
    entry_of<ForwardEuler>(),  entry_of<SymplecticEuler>(),
    entry_of<Verlet>(),        entry_of<MollifiedImpulse>(),
    entry_of<Pefrl>(),         entry_of<Srkn11b>(),
    entry_of<Rk4>(),           entry_of<Rkn64>(),
    entry_of<ImplicitEuler>(), entry_of<ImplicitMidpoint>(),
    entry_of<TrBdf2>(),        entry_of<Xpbd>()};

/** The line of @a M. It does not compile if there is none. */
template <typename M>
constexpr const MethodEntry& line = *std::ranges::find(
    lines, M::info.name, [](const MethodEntry& m) { return m.info.name; });

/** Null of a method without measured costs. */
const MethodCost* cost_of(const MethodInfo& info) {
  const auto cost =
      std::ranges::find(method_costs, info.name, &MethodCost::method);
  return cost == method_costs.end() ? nullptr : &*cost;
}

}  // namespace

// Constants, so that they can be used before main() begins.
constinit const std::span<const MethodEntry> methods = lines;

namespace table {
constinit const MethodEntry& forward_euler = line<ForwardEuler>;
constinit const MethodEntry& symplectic_euler = line<SymplecticEuler>;
constinit const MethodEntry& verlet = line<Verlet>;
constinit const MethodEntry& mollified_impulse = line<MollifiedImpulse>;
constinit const MethodEntry& pefrl = line<Pefrl>;
constinit const MethodEntry& srkn11b = line<Srkn11b>;
constinit const MethodEntry& rk4 = line<Rk4>;
constinit const MethodEntry& rkn64 = line<Rkn64>;
constinit const MethodEntry& implicit_euler = line<ImplicitEuler>;
constinit const MethodEntry& tr_bdf2 = line<TrBdf2>;
constinit const MethodEntry& xpbd = line<Xpbd>;
}  // namespace table

const MethodEntry* find_method(std::string_view name) {
  for (const MethodEntry& m : lines)
    if (m.info.name == name) return &m;
  return nullptr;
}

double work_of_step(const MethodInfo& method, double limits, double side) {
  // Measured on cloths of 36 to 1681 nodes with 1 to 3000 times Verlet's limit:
  // it grows by this power of the step, and is at most so many force
  // evaluations for each node along a side, with which Newton's iterations by
  // sparse factorizations are cheaper.
  constexpr double more_iterations = 0.6, of_factor = 10;
  const MethodCost* cost = cost_of(method);
  const bool solves = method.limit == no_limit || method.adaptive;
  if (!solves || !cost) return method.sweeps;
  limits = std::max(1.0, limits);
  // Inner steps are about as long as Verlet's limit.
  if (method.adaptive) return cost->at_limit * std::ceil(limits);
  const double grows = cost->at_ten / cost->at_limit;
  double by_step = cost->at_limit * std::pow(grows, std::log10(limits));
  if (limits > 10)
    by_step =
        cost->at_ten *
        (work_varies(method) ? std::pow(limits / 10, more_iterations) : 1);
  return std::min(by_step, of_factor * side);
}
bool work_varies(const MethodInfo& method) {
  const MethodCost* cost = cost_of(method);
  return cost && (method.adaptive || cost->at_ten > 1.1 * cost->at_limit);
}

}  // namespace lab
