#include "lab/fast/ForcePlan.hpp"

#include <algorithm>
#include <mutex>
#include <utility>

namespace lab {

namespace {

/** By one thread at a time: a functor of the assignment may keep a state. */
void add_calls(const Part& part, const ZeroForce& force, double t,
               std::span<Point> f) {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  for (unsigned i = part.first; i < part.last; ++i)
    if (part.g.node_in_use(i))
      f[i - part.first] += force(part.g.node_with_id(i), t);
}

/** One call an edge, in the order of their ids. */
void add_spring_stiffness(const Cloth& g, const StiffnessVisitor& use) {
  const auto x = g.positions();
  for (unsigned e = 0; e < g.edge_slots(); ++e) {
    if (!g.edge_in_use(e)) continue;
    const auto [i, j] = g.edge_ends()[e];
    use(i, j, spring_stiffness(x[j] - x[i], g.edge_values()[e]));
  }
}

}  // namespace

ForcePlan::ForcePlan(const ZeroForce& force) {
  add(std::shared_ptr<const ZeroForce>(std::shared_ptr<void>(), &force));
}

void ForcePlan::add(std::shared_ptr<const ZeroForce> force) {
  const ZeroForce& f = *force;
  if (auto sum = exactly<CombinedForces, FunctionForce>(f)) {
    for (const auto& part : sum->parts()) add(part);
  } else if (auto weight = exactly<GravityForce, FunctionForce>(f)) {
    terms_.push_back({Kind::weight, weight->gravity(), nullptr});
  } else if (exactly<MassSpringForce, FunctionForce>(f)) {
    terms_.push_back({Kind::springs, 0, nullptr});
  } else if (auto drag = exactly<DampingForce, FunctionForce>(f);
             drag && drag->coefficient() >= 0) {
    drag_.add(drag->coefficient());
  } else if (auto drags = exactly<NodeDrag, FunctionForce>(f)) {
    drag_.add(*drags);
  } else if (dynamic_cast<const SweptForce*>(&f)) {
    terms_.push_back({Kind::swept, 0, std::move(force)});
  } else if (!exactly<ZeroForce, FunctionForce>(f)) {
    terms_.push_back({Kind::call, 0, std::move(force)});
  }
}

void ForcePlan::add_others(const Part& part, double t,
                           std::span<Point> f) const {
  for (const Term& term : terms_)
    if (term.kind == Kind::call)
      add_calls(part, *term.force, t, f);
    else if (term.kind == Kind::swept && term.swept().acts())
      term.swept().add_to(part, t, f);
}

bool ForcePlan::has_others() const {
  return std::ranges::any_of(terms_, [](const Term& term) {
    return term.kind == Kind::call ||
           (term.kind == Kind::swept && term.swept().acts());
  });
}

double ForcePlan::gravity() const {
  double sum = 0;
  for (const Term& term : terms_)
    if (term.kind == Kind::weight) sum += term.factor;
  return sum;
}

double ForcePlan::energy(const Cloth& g) const {
  double sum = 0;
  for (const Term& term : terms_) switch (term.kind) {
      case Kind::weight:
        sum += gravitational_energy(g, term.factor);
        break;
      case Kind::springs:
        sum += elastic_energy(g);
        break;
      case Kind::swept:
        sum += term.swept().energy(g);
        break;
      case Kind::call:
        break;
    }
  return sum;
}

bool ForcePlan::add_stiffness(const Cloth& g,
                              const StiffnessVisitor& use) const {
  for (const Term& term : terms_) switch (term.kind) {
      case Kind::springs:
        add_spring_stiffness(g, use);
        break;
      case Kind::swept:
        if (!term.swept().add_stiffness(g, use)) return false;
        break;
      case Kind::call:
        return false;
      case Kind::weight:
        break;  // it does not depend on positions
    }
  return true;
}

std::optional<int> ForcePlan::spring_multiplicity() const {
  int sum = 0;
  for (const Term& term : terms_) {
    if (term.kind == Kind::call) return std::nullopt;
    if (term.kind == Kind::springs) ++sum;
    if (term.kind != Kind::swept) continue;
    const auto some = term.swept().spring_multiplicity();
    if (!some) return std::nullopt;
    sum += *some;
  }
  return sum;
}

int ForcePlan::springs() const {
  return int(std::ranges::count(terms_, Kind::springs, &Term::kind));
}

}  // namespace lab
