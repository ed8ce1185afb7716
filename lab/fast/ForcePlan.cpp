#include "lab/fast/ForcePlan.hpp"

#include <algorithm>
#include <mutex>
#include <utility>
#include "lab/fast/GraphArrays.hpp"
#include "lab/fast/LoadForce.hpp"
#include "lab/fast/OneWaySprings.hpp"

namespace lab {

namespace {

/** By one thread at a time: a functor of the assignment may keep a state. */
void add_calls(const Part& part, const ZeroForce& force, double t,
               std::span<Point> f) {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  for (unsigned i = part.first; i < part.last; ++i)
    if (arrays(part.g).node_in_use(i))
      f[i - part.first] += force(arrays(part.g).node_with_id(i), t);
}

/** One call an edge, in the order of their ids. */
void add_spring_stiffness(const Cloth& g, const StiffnessVisitor& use) {
  const auto x = arrays(g).positions();
  for (unsigned e = 0; e < arrays(g).edge_slots(); ++e) {
    if (!arrays(g).edge_in_use(e)) continue;
    const auto [i, j] = arrays(g).edge_ends()[e];
    use(i, j, spring_stiffness(x[j] - x[i], arrays(g).edge_values()[e]));
  }
}

}  // namespace

double Potential::elastic_energy(const Cloth& g) const {
  return one_way ? one_way->energy(g) : lab::elastic_energy(g);
}

double Potential::gravitational_energy(const Cloth& g) const {
  const double sum = lab::gravitational_energy(g, gravity);
  return loads ? sum + loads->energy(g) : sum;
}

Point Potential::load(const Node& n) const {
  return loads ? (*loads)(n, 0) : Point();
}

void ForcePlan::add(std::shared_ptr<const ZeroForce> force) {
  const ZeroForce& f = *force;
  if (auto sum = exactly<CombinedForces, FunctionForce>(f)) {
    for (const auto& part : sum->parts) add(part);
  } else if (auto weight = exactly<GravityForce, FunctionForce>(f)) {
    potential_.gravity.a.z -= weight->gravity;
  } else if (auto tilt = exactly<SidewaysForce, FunctionForce>(f)) {
    potential_.gravity.a += Point(tilt->x, tilt->y, 0);
  } else if (exactly<MassSpringForce, FunctionForce>(f)) {
    ++springs_;
  } else if (auto drag = exactly<DampingForce, FunctionForce>(f)) {
    drag_.add(drag->c);
  } else if (auto drags = exactly<NodeDrag, FunctionForce>(f)) {
    drag_.add(*drags);
  } else if (!exactly<ZeroForce, FunctionForce>(f)) {
    if (auto one_way = exactly<OneWaySprings, FunctionForce>(f))
      potential_.one_way = {force, one_way};
    if (auto loads = exactly<LoadForce, FunctionForce>(f))
      potential_.loads = {force, loads};
    others_.push_back({std::move(force), dynamic_cast<const SweptForce*>(&f)});
  }
}

void ForcePlan::add_others(const Part& part, double t,
                           std::span<Point> f) const {
  for (const Other& other : others_)
    if (!other.swept)
      add_calls(part, *other.force, t, f);
    else if (other.acts())
      other.swept->add_to(part, t, f);
}

bool ForcePlan::has_others() const {
  return std::ranges::any_of(others_, &Other::acts);
}

double ForcePlan::energy(const Cloth& g) const {
  double sum = gravitational_energy(g, potential_.gravity);
  if (springs_ > 0) sum += springs_ * elastic_energy(g);
  for (const Other& other : others_)
    if (other.swept) sum += other.swept->energy(g);
  return sum;
}

bool ForcePlan::add_stiffness(const Cloth& g,
                              const StiffnessVisitor& use) const {
  for (int k = 0; k < springs_; ++k) add_spring_stiffness(g, use);
  return std::ranges::all_of(others_, [&](const Other& other) {
    return other.swept && other.swept->add_stiffness(g, use);
  });
}

void ForcePlan::add_slack(const Cloth& g, const StiffnessVisitor& use) const {
  for (const Other& other : others_)
    if (other.swept) other.swept->add_slack(g, use);
}

std::optional<int> ForcePlan::spring_multiplicity() const {
  int sum = springs_;
  for (const Other& other : others_) {
    const auto some =
        other.swept ? other.swept->spring_multiplicity() : std::optional<int>();
    if (!some) return std::nullopt;
    sum += *some;
  }
  return sum;
}

}  // namespace lab
