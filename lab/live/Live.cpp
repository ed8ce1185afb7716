#include "lab/live/Live.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "lab/fast/GraphArrays.hpp"
#include "lab/live/Recording.hpp"
#include "lab/methods/Costs.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Interrupt.hpp"
#include "lab/stepping/Checkpoint.hpp"

namespace lab {

namespace {

/** The reference of a comparison: order 6, or 2 where there is contact. */
constexpr MethodEntry reference_method = entry_of<Srkn11b>();
constexpr double reference_share = 1 / 3.;  // of its limit
constexpr double most_in_round = 1e4;       // steps of a scene

/** Does a step cost its force evaluations, and nothing else? */
bool only_evaluates(const MethodEntry& m) {
  return m.info.limit != no_limit && !m.info.adaptive && !m.info.multirate;
}
/** The time of a step of @a m, as it was measured, in steps of Verlet. */
double cost_of(const MethodEntry& m) {
  const auto cost = std::ranges::find(
      method_costs, std::string_view(m.info.name), &MethodCost::method);
  return cost != method_costs.end() ? cost->at_limit : m.info.sweeps;
}

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
  /** At the same work. */
  static Round of_work(const MethodEntry& main, const MethodEntry& rival) {
    if (!only_evaluates(main) || !only_evaluates(rival))
      return of_steps(cost_of(rival) / cost_of(main));
    const int a = main.info.sweeps, b = rival.info.sweeps, c = std::gcd(a, b);
    return {b / c, a / c};
  }
};

Distances distances(const Cloth& a, const Cloth& b) {
  double most = 0, sum = 0;
  unsigned count = 0;
  for (Node n : a.nodes()) {
    if (!arrays(b).node_in_use(n.id())) continue;
    const double square = normSq(n.position() - arrays(b).positions()[n.id()]);
    most = std::max(most, square), sum += square, ++count;
  }
  return {std::sqrt(most), count > 0 ? std::sqrt(sum / count) : 0};
}

/** How many nodes lie on a plane or a ball of @a m at time @a t. */
unsigned count_touching(const Model& m, const Cloth& g, double t) {
  constexpr double near = 1e-6;  // [m]
  unsigned count = 0;
  for (Node n : g.nodes()) {
    const Point p = n.position();
    count += std::ranges::any_of(m.planes,
                                 [&](const Wall& w) {
                                   return dot(p - w.at - w.motion.way(t),
                                              w.out()) < near;
                                 }) ||
             std::ranges::any_of(m.spheres, [&](const Solid& s) {
               return norm(p - s.ball.center - s.motion.way(t)) <
                      s.ball.radius + near;
             });
  }
  return count;
}

/** Does the segment from @a p to @a q meet the surface between the rays @a a
 * and @a b, two triangles? A segment through a side that two triangles share
 * meets exactly one of them, as turns() gets each side in one direction. */
bool meets(const Point& p, const Point& q, const Ray& a, const Ray& b) {
  const auto volume = [](const Point& o, const Point& x, const Point& y,
                         const Point& z) {
    return dot(x - o, cross(y - o, z - o));
  };
  // Are p and q on both sides of a triangle?
  const auto parts = [&](const Point& x, const Point& y, const Point& z) {
    return (volume(p, x, y, z) > 0) != (volume(q, x, y, z) > 0);
  };
  // How the line through p and q turns about a side.
  const auto turns = [&](const Point& x, const Point& y) {
    return volume(p, q, x, y) > 0;
  };
  const bool first = turns(a.near, a.far), last = turns(b.near, b.far),
             across = turns(a.near, b.far);
  return (first != across && first == turns(a.far, b.far) &&
          parts(a.near, a.far, b.far)) ||
         (last != across && last == turns(a.near, b.near) &&
          parts(a.near, b.far, b.near));
}

}  // namespace

double dt_unit(const Scene& s, const MethodEntry& m) {
  for (const MethodEntry& like : {m, entry_of<Verlet>()})
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
  from = scene->time(), evaluations = scene->evaluations();
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

void Live::load(Model m, std::uint64_t cloth) {
  PointsAndQuads points = mesh_of(m);
  auto scene = std::make_unique<Scene>(recipe_of(m, points), m.step, *m.method);
  if (cloth != 0 && checksum_of(scene->cloth()) != cloth)
    throw std::invalid_argument(
        "belongs to another cloth: the mesh files or the program changed");
  alone();
  model_ = std::move(m), mesh_ = std::move(points);
  start_nodes_ = scene->cloth().num_nodes();
  start_edges_ = scene->cloth().num_edges();
  main_.emplace(std::move(scene), *model_.method);
}

/** Run a copy of the present state beside it. */
void Live::compare() {
  if (!main_->runs()) return;
  const double dt = main_->scene->dt();
  if (!model_.step.fixed())
    set_step(main_->method, {.dt = dt, .tolerance = model_.step.tolerance});
  const auto copy = [&](const MethodEntry& method) {
    return Side(
        std::make_unique<Scene>(*main_->scene, TimeStep{.dt = dt}, method),
        method);
  };
  rival_.emplace(copy(*rival_method_));
  reference_.emplace(copy(reference_method));
  rival_step_ = rival_share_ * rival_->dt_unit;
  tune();
}

/** Give the rival and the reference the steps by which all three meet. */
void Live::tune() {
  const double dt = main_->scene->dt();
  const Round round = equal_work_
                          ? Round::of_work(main_->method, rival_->method)
                          : Round::of_steps(rival_step_ / dt);
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
  r.method = method.info.name, r.order = method.info.order;
  r.dt = scene->dt(), r.dt_unit = dt_unit;
  if (sharp) sharp_limit = scene->sharp_limit();
  r.safe_limit = safe_limit, r.sharp_limit = sharp_limit;
  r.steps = scene->steps(), r.time = scene->time();
  r.evaluations = scene->evaluations();
  r.evaluations_rate =
      r.time > from ? double(r.evaluations - evaluations) / (r.time - from)
                    : method.info.sweeps / r.dt;
  r.energy = energies(scene->cloth(), scene->recipe().gravity, scene->flow());
  r.drift = scene->drift(r.energy);
  r.failure = scene->failure();
  return r;
}

Live::Live(Model m, std::uint64_t cloth)
    : recording_(std::string(recording_begin) + '\n') {
  load(std::move(m), cloth);
  record(scene_request(model_, checksum_of(scene().cloth())));
}

bool Live::step() {
  if (done()) return false;
  ++calls_;
  const int count = rival_ ? round_ : 1;
  for (int k = 0; k < count && !done() && !interrupted(); ++k)
    main_->scene->step();
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
  r.touching = count_touching(model_, g, r.time);
  r.grabbed = scene().hand() && arrays(g).node_in_use(scene().hand()->node());
  if (!rival_) return r;
  const Cloth &other = rival()->cloth(), &right = reference()->cloth();
  r.comparison = {.rival = rival_->readings(sharp),
                  .equal_work = equal_work_,
                  .apart = distances(g, other),
                  .error = distances(g, right),
                  .rival_error = distances(other, right),
                  .reference = reference_method.info.name,
                  .reference_dt = reference()->dt()};
  return r;
}

std::string Live::recording() const {
  return recording_ + std::to_string(calls_) + " end\n";
}

}  // namespace lab
