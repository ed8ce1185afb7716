#include "lab/live/Live.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lab/fast/GraphArrays.hpp"
#include "lab/live/Line.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Interrupt.hpp"
#include "lab/scenes/KeyValues.hpp"

namespace lab {

namespace {

/** The reference of a comparison: order 6, or 2 where there is contact. */
const MethodEntry& reference_method = table::srkn11b;
constexpr double reference_share = 1 / 3.;  // of its limit
constexpr double most_in_round = 1e4;       // steps of a scene

/** The fewest steps after which two runs meet: of the main one and of the
 * rival. */
struct Round {
  int main, rival;

  /** @param ratio rival's step / main's step, which it is to 2 %, up to 10^4 */
  static Round of_steps(double ratio) {
    const double up = std::min(std::max(ratio, 1 / ratio), most_in_round);
    int few = 0, many = 0;
    do {
      many = int(std::lround(++few * up));
    } while (std::abs(many / (few * up) - 1) > 0.02);
    return ratio >= 1 ? Round{many, few} : Round{few, many};
  }
};

/** The RMS distance of the nodes that both have [m]. */
double distance(const Cloth& a, const Cloth& b) {
  double sum = 0;
  unsigned count = 0;
  for (Node n : a.nodes()) {
    if (!arrays(b).node_in_use(n.id())) continue;
    sum += normSq(n.position() - arrays(b).positions()[n.id()]), ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

}  // namespace

double dt_unit(const Scene& s, const MethodEntry& m) {
  for (const MethodEntry& like : {m, table::verlet})
    if (const double limit = s.safe_limit(like);
        limit > 0 && std::isfinite(limit))
      return limit;
  return TimeStep().dt;
}

std::vector<std::array<unsigned, 2>> crossed_edges(
    const Cloth& g, std::span<const Ray> stroke) {
  std::vector<std::array<unsigned, 2>> all;
  for (Edge e : g.edges()) {
    const Point p = e.node1().position(), q = e.node2().position();
    for (std::size_t k = 1; k < stroke.size(); ++k) {
      if (!meets(p, q, stroke[k - 1], stroke[k])) continue;
      all.push_back({e.node1().id(), e.node2().id()});
      break;
    }
  }
  return all;
}

// ----------------------------------------------------------------------- Live

Live::Side::Side(std::unique_ptr<Scene> s, const MethodEntry& m)
    : scene(std::move(s)), method(m) {
  scene->follow_drag();
  mark();
  sharp_limit = safe_limit;
}
void Live::Side::mark() {
  safe_limit = scene->safe_limit();
  dt_unit = lab::dt_unit(*scene, method);
}

void Live::set_step(const MethodEntry& method, const TimeStep& step) {
  main_->scene->change_method(method, step);
  main_->method = method, model_.step = step;
  main_->mark();
  if (rival_) tune();
}

/** The step stays the same. */
void Live::set_method(const MethodEntry& method) {
  TimeStep step = model_.step;
  if (step.fixed()) step.dt = main_->scene->dt();
  try {
    set_step(method, step);
  } catch (const std::invalid_argument&) {  // it can't choose
    step.dt = main_->scene->dt(), step.rule = StepRule::fixed;
    set_step(method, step);
  }
  model_.method = find_method(method.info.name);
}

/** Use the forces of the model as it is now. */
void Live::change_forces() {
  const Recipe recipe = recipe_of(model_, mesh_);
  for (auto* side : {&main_, &rival_, &reference_})
    if (*side) (*side)->scene->change_forces(recipe), (*side)->mark();
  if (rival_) tune();
}

/** Run a copy of the present state beside it, by steps of @a share. */
void Live::compare(const MethodEntry& method, double share) {
  if (!main_->runs()) return;
  const double dt = main_->scene->dt();
  if (!model_.step.fixed())
    set_step(main_->method, {.dt = dt, .tolerance = model_.step.tolerance});
  const auto copy = [&](const MethodEntry& m) {
    return Side(std::make_unique<Scene>(*main_->scene, TimeStep{.dt = dt}, m),
                m);
  };
  rival_.emplace(copy(method));
  reference_.emplace(copy(reference_method));
  rival_step_ = share * rival_->dt_unit;
  tune();
}

/** Give the rival and the reference the steps by which all three meet. */
void Live::tune() {
  const double dt = main_->scene->dt();
  const Round round = Round::of_steps(rival_step_ / dt);
  round_ = round.main;
  const double whole = round_ * dt;
  const auto set = [](Side& side, double step) {
    side.scene->change_method(side.method, {.dt = step});
    side.mark();
  };
  set(*rival_, whole / round.rival);
  const double steps = whole / (reference_share * reference_->dt_unit);
  set(*reference_, whole / std::min(std::ceil(steps), most_in_round));
}

RunReadings Live::Side::readings(bool sharp) {
  RunReadings r;
  r.method = method.info.name;
  r.dt = scene->dt(), r.dt_unit = dt_unit;
  if (sharp) sharp_limit = scene->stepper().sharp_limit();
  r.safe_limit = safe_limit, r.sharp_limit = sharp_limit;
  r.steps = scene->steps(), r.time = scene->time();
  r.evaluations = scene->evaluations();
  r.energy = energies(scene->cloth(), scene->recipe().gravity, scene->flow());
  r.drift = scene->drift(r.energy);
  r.failure = scene->failure();
  return r;
}

std::vector<Change> read_changes(const std::vector<std::string>& lines) {
  std::vector<Change> all;
  for (const std::string& line : lines) {
    Line in(line);
    const double time = in.number("a time [s]", 0.);
    if (!all.empty() && time < all.back().time)
      in.fail("comes after " + CME212::short_text(all.back().time) + " s");
    all.push_back({time, std::string(in.rest())});
    std::string error = in.error();
    if (error.empty()) error = Live::error_in(all.back().request);
    if (!error.empty()) throw SceneError("at", in_quotes(line) + ": " + error);
  }
  return all;
}

Live::Live(Model m, std::vector<Change> changes)
    : model_(std::move(m)),
      mesh_(mesh_of(model_)),
      changes_(std::move(changes)) {
  main_.emplace(std::make_unique<Scene>(recipe_of(model_, mesh_), model_.step,
                                        *model_.method),
                *model_.method);
  start_nodes_ = scene().cloth().num_nodes();
  start_edges_ = scene().cloth().num_edges();
}

void Live::restart(const Model& m) {
  rival_.reset(), reference_.reset();
  model_ = m, next_ = 0, calls_ = 0, recording_.clear();
  main_->scene->restart();
  change_forces();
  set_step(*m.method, m.step);
}

bool Live::step() {
  constexpr double round_off = 1e-9;  // of a step
  const auto is_due = [this](const Change& c) {
    return c.time <= scene().time() + round_off * scene().dt();
  };
  for (; changes_left() > 0 && is_due(changes_[next_]); ++next_)
    apply(changes_[next_].request);
  if (done()) return false;
  ++calls_;
  const int count = rival_ ? round_ : 1;
  for (int k = 0; k < count && !done() && !interrupted(); ++k)
    main_->scene->step(model_.t_end);
  const double time = main_->scene->time();
  for (auto* side : {&rival_, &reference_}) {
    if (!*side || !(*side)->runs()) continue;
    Scene& s = *(*side)->scene;
    while (!s.done(time) && !interrupted())
      s.steps_at_once(Scene::guard_interval, time);
    s.check();
  }
  return !done();
}

bool Live::check() {
  each_running([](Scene& scene) { scene.check(); });
  return main_->runs();
}
Readings Live::readings(bool sharp) {
  Readings r;
  static_cast<RunReadings&>(r) = main_->readings(sharp);
  const Cloth& g = scene().cloth();
  r.nodes = g.num_nodes(), r.edges = g.num_edges();
  r.torn_nodes = start_nodes_ - r.nodes, r.torn_edges = start_edges_ - r.edges;
  r.grabbed = scene().hand() && arrays(g).node_in_use(scene().hand()->node());
  if (!rival_) return r;
  const Cloth &other = rival()->cloth(), &right = reference()->cloth();
  r.comparison = {.rival = rival_->readings(sharp),
                  .apart = distance(g, other),
                  .error = distance(g, right),
                  .rival_error = distance(other, right)};
  return r;
}

std::string Live::recording() const {
  return recording_ + std::to_string(calls_) + " end\n";
}

}  // namespace lab
