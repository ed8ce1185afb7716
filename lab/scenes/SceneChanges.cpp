/** @file SceneChanges.cpp
 * What changes a scene between two steps. */
#include <algorithm>
#include <tuple>
#include <utility>

#include "lab/fast/Energy.hpp"
#include "lab/scenes/Scene.hpp"

namespace lab {

Scene::Scene(const Scene& other, const TimeStep& step,
             const MethodEntry& method)
    : recipe_(other.recipe_),
      step_(step),
      entry_(method),
      cloth_(other.cloth_),
      acting_(other.acting_),
      hand_(other.hand_),
      held_(other.held_),
      follows_drag_(other.follows_drag_),
      safe_omega_(other.safe_omega_) {
  make_method();
  clock_ = {.dt = step.dt, .from = other.time()};
  watched_.emplace(recipe_.holding(cloth_, held_));
  plan_changed({});
  start_energy_ = energy().total();
}

/** Settle the steps so far: the present state is good, or the scene has failed
 * and it is the last good one.  @return its energy [J] */
double Scene::begin_change() {
  settle();
  return energy().total();
}

/** Go on from the state as it was changed.
 * @param before what begin_change() gave */
void Scene::end_change(double before) {
  EnergyFlow flow = this->flow();
  flow.work += energy().total() - before;
  plan_changed(flow);
}

/** Make all anew that steps depend on. */
void Scene::plan_changed(const EnergyFlow& flow) {
  plan_forces();
  constraint_ = *watched_;
  balance_.emplace(cloth_, time(), acting_, constraint_, recipe_.gravity);
  balance_->resume(cloth_, time(), constraint_, flow);
  watch_hand();
  method_->restart();
  failure_.clear(), error_.clear();
  worst_.reset(), diagnosis_.reset();
  guard_.emplace(cloth_, recipe_.gravity, clock_.dt, this->flow());
  keep_clock();
  start_control();
  changed_ = true;
}

void Scene::watch_hand() {
  if (hand_ && cloth_.node_in_use(hand_->node()))
    balance_->watch(cloth_.node_with_id(hand_->node()), &*hand_, time());
  else
    balance_->watch({}, nullptr, time());
}

void Scene::change_method(const MethodEntry& method, const TimeStep& step) {
  const double before = begin_change();
  const auto old = std::tuple(entry_, step_, clock_);
  entry_ = method, step_ = step;
  try {
    if (step.fixed())
      clock_.set_dt(step.dt);
    else
      choose_step();
  } catch (...) {
    std::tie(entry_, step_, clock_) = old;
    throw;
  }
  make_method();
  end_change(before);
}

void Scene::make_method() {
  if (method_) work_ += method_->work();
  method_ = entry_.make();
  if (step_.tolerance > 0) method_->set_tolerance(step_.tolerance);
}

void Scene::change_forces(const Recipe& recipe) {
  Cloth fresh;  // its ids are those of this cloth when it was made
  recipe.build(fresh);
  CombinedForces acting = recipe.force(fresh);
  const double before = begin_change();
  recipe_ = recipe;
  acting_ = std::move(acting);
  for (Edge e : cloth_.edges()) e.value().K = fresh.edge_values()[e.id()].K;
  safe_omega_ = -1;
  make_method();
  end_change(before);
}

/** Is there a node of this id? */
bool Scene::is_there(unsigned node) const {
  return node < cloth_.node_slots() && cloth_.node_in_use(node);
}

bool Scene::is_pinned(unsigned node) const {
  return std::ranges::any_of(held_, [node](const HeldNodes& h) {
    return std::ranges::binary_search(h.nodes, node, {}, &HeldNodes::Held::id);
  });
}

bool Scene::pin(unsigned node) {
  if (!is_there(node) || is_pinned(node)) return false;
  const double before = begin_change();
  cloth_.node_values()[node].vel = Point();
  if (held_.empty() || held_.back().motion.velocity != Point())
    held_.emplace_back();
  auto& nodes = held_.back().nodes;
  nodes.insert(std::ranges::lower_bound(nodes, node, {}, &HeldNodes::Held::id),
               {node, cloth_.positions()[node]});
  watched_.emplace(recipe_.holding(cloth_, held_));
  end_change(before);
  return true;
}

bool Scene::unpin(unsigned node) {
  if (!is_pinned(node)) return false;
  const double before = begin_change();
  for (HeldNodes& h : held_)
    std::erase_if(h.nodes,
                  [node](const auto& held) { return held.id == node; });
  std::erase_if(held_, [](const HeldNodes& h) { return h.nodes.empty(); });
  watched_.emplace(recipe_.holding(cloth_, held_));
  safe_omega_ = -1;
  end_change(before);
  return true;
}

unsigned Scene::cut(std::span<const std::array<unsigned, 2>> edges) {
  const double before = begin_change();
  unsigned count = 0;
  const auto node = [this](unsigned id) {
    return is_there(id) ? cloth_.node_with_id(id) : Node();
  };
  for (const auto& [i, j] : edges)
    count += cloth_.remove_edge(node(i), node(j));
  end_change(before);
  return count;
}

bool Scene::grab(unsigned node, const Point& target) {
  constexpr double share = 1 / 8., weights = 2;
  if (!is_there(node)) return false;
  begin_change();
  double sum = 0;  // of K [N/m]
  for (Edge e : cloth_.node_with_id(node).edges()) sum += e.value().K;
  hand_.emplace(node, target, share * sum, weights * total_mass(cloth_) * grav);
  hand_changed();
  return true;
}

void Scene::move_hand(const Point& target) {
  begin_change();
  hand_->move(target);
  hand_changed();
}

void Scene::release() {
  begin_change();
  hand_.reset();
  hand_changed();
}

/** The guard goes on: else a hand that moves all the time would hide from it
 * what diverges slowly. */
void Scene::hand_changed() {
  plan_forces();
  method_->restart();
  watch_hand();
  changed_ = true;
}

}  // namespace lab
