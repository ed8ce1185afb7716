#include "lab/stepping/Scene.hpp"

#include <algorithm>
#include <utility>

#include "lab/fast/Energy.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/scenes/Interrupt.hpp"

namespace lab {

Scene::Scene(Recipe recipe, const TimeStep& step, const MethodEntry& method)
    : Stepper(step, method, Cloth()), recipe_(std::move(recipe)) {
  restart();
}
Scene::Scene(const Model& m) : Scene(recipe_of(m), m.step, *m.method) {}

Scene::Scene(const Scene& other, const TimeStep& step,
             const MethodEntry& method)
    : Stepper(step, method, other.cloth_),
      recipe_(other.recipe_),
      held_(other.held_),
      changed_(true) {
  gravity_ = recipe_.gravity, acting_ = other.acting_, hand_ = other.hand_;
  follows_drag_ = other.follows_drag_;
  watched_.emplace(recipe_.holding(cloth_, held_));
  begin(other.time());
}

void Scene::restart() {
  cloth_.clear();
  recipe_.build(cloth_);
  acting_ = recipe_.force(cloth_), gravity_ = recipe_.gravity;
  hand_.reset(), held_.clear(), changed_ = false, diagnosis_.reset();
  if (recipe_.held) held_ = recipe_.held(cloth_);
  watched_.emplace(recipe_.constraint(cloth_));
  forget_limits();
  begin(0);
}

// ------------------------------------------------------------------- Changes

/** Make sure that the present state is good, or go back to the last good one.
 * Then apply @a change and continue. */
template <typename Change>
void Scene::edit(Change change) {
  settle();
  const double before = energy().total();
  change();
  EnergyFlow flow = this->flow();
  flow.work += energy().total() - before;
  start(flow);
  changed_ = true, diagnosis_.reset();
}

void Scene::change_method(const MethodEntry& method, const TimeStep& step) {
  settle();
  const double dt = step.fixed() ? step.dt : limits().chosen(method, step.rule);
  edit([&] {
    entry_ = method, step_ = step;
    clock_.set_dt(dt);
    make_method();
  });
}

void Scene::change_forces(const Recipe& recipe) {
  Cloth fresh;  // has the ids that this cloth had when it was built
  recipe.build(fresh);
  CombinedForces acting = recipe.force(fresh);
  edit([&] {
    recipe_ = recipe, gravity_ = recipe.gravity;
    acting_ = std::move(acting);
    for (Edge e : cloth_.edges())
      e.value().K = arrays(fresh).edge_values()[e.id()].K;
    forget_limits();
    make_method();
  });
}

namespace {
bool is_there(const Cloth& g, unsigned node) {
  return node < arrays(g).node_slots() && arrays(g).node_in_use(node);
}
}  // namespace

bool Scene::is_pinned(unsigned node) const {
  return std::ranges::any_of(held_, [node](const HeldNodes& h) {
    return std::ranges::binary_search(h.nodes, node, {}, &HeldNodes::Held::id);
  });
}

bool Scene::pin(unsigned node) {
  if (!is_there(cloth_, node) || is_pinned(node)) return false;
  edit([&] {
    arrays(cloth_).node_values()[node].vel = Point();
    if (held_.empty() || held_.back().motion.velocity != Point())
      held_.emplace_back();
    auto& nodes = held_.back().nodes;
    nodes.insert(
        std::ranges::lower_bound(nodes, node, {}, &HeldNodes::Held::id),
        {node, arrays(cloth_).positions()[node]});
    watched_.emplace(recipe_.holding(cloth_, held_));
  });
  return true;
}

bool Scene::unpin(unsigned node) {
  if (!is_pinned(node)) return false;
  edit([&] {
    for (HeldNodes& h : held_)
      std::erase_if(h.nodes,
                    [node](const auto& held) { return held.id == node; });
    std::erase_if(held_, [](const HeldNodes& h) { return h.nodes.empty(); });
    watched_.emplace(recipe_.holding(cloth_, held_));
    forget_limits();
  });
  return true;
}

unsigned Scene::cut(std::span<const std::array<unsigned, 2>> edges) {
  unsigned count = 0;
  edit([&] {
    const auto node = [this](unsigned id) {
      return is_there(cloth_, id) ? arrays(cloth_).node_with_id(id) : Node();
    };
    for (const auto& [i, j] : edges)
      count += cloth_.remove_edge(node(i), node(j));
  });
  return count;
}

bool Scene::grab(unsigned node, const Point& target) {
  constexpr double share = 1 / 8., weights = 2;
  if (!is_there(cloth_, node)) return false;
  double sum = 0;  // of K [N/m]
  for (Edge e : arrays(cloth_).node_with_id(node).edges()) sum += e.value().K;
  pull(HandForce(node, target, share * sum,
                 weights * total_mass(cloth_) * grav));
  return true;
}

void Scene::move_hand(const Point& target) {
  HandForce hand = *hand_;
  hand.move(target);
  pull(hand);
}

void Scene::release() { pull(std::nullopt); }

/** Continue with @a hand, or with none. */
void Scene::pull(std::optional<HandForce> hand) {
  settle();
  hand_ = std::move(hand);
  hand_changed();
  changed_ = true;
}

// ------------------------------------------------------------------- Failure

Explanation Scene::explanation() const {
  try {
    return {*failure_, &diagnosis()};
  } catch (const Interrupted&) {
    return {*failure_, nullptr};
  }
}

std::unique_ptr<Scene> Scene::anew(const Cure& cure) const {
  const TimeStep step = {
      .dt = cure.dt,
      .tolerance = cure.method.info.adaptive ? step_.tolerance : 0};
  return changed_ ? std::make_unique<Scene>(*this, step, cure.method)
                  : std::make_unique<Scene>(recipe_, step, cure.method);
}

std::unique_ptr<Scene> Scene::beyond_failure(double distance) const {
  const auto copy = [this] {
    auto scene = std::make_unique<Scene>(
        *this, TimeStep{.dt = clock_.dt, .tolerance = step_.tolerance}, entry_);
    scene->failure_ = failure_;
    return scene;
  };
  auto ahead = copy();
  const auto is_far = [&] {
    const auto now = arrays(std::as_const(ahead->cloth_)).positions();
    for (Node n : cloth_.nodes())
      if (arrays(ahead->cloth_).node_in_use(n.id()) &&
          norm(now[n.id()] - n.position()) > distance)
        return true;
    return false;
  };
  for (int left = 1000; left > 0 && !is_far() && ahead->advance(); --left)
    if (interrupted()) break;
  return ahead->is_finite() ? std::move(ahead) : copy();
}

}  // namespace lab
