#include "lab/live/Live.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "lab/Interrupt.hpp"
#include "lab/live/Recording.hpp"
#include "lab/methods/Costs.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Checkpoint.hpp"

namespace lab {

namespace {

/** Of what is compared, the reference: order 6, or 2 where there is contact. */
constexpr MethodEntry reference_method = entry_of<Srkn11b>();
constexpr double reference_share = 1 / 3.;  // of its limit

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

}  // namespace

/** The fewest steps after which two runs meet: @a main ones of the one are as
 * long as @a rival ones of the other. */
struct Round {
  int main = 1, rival = 1;

  /** The most steps that a scene takes in one. */
  static constexpr double most = 1e4;

  /** @param ratio rival's step / main's step, which it is to 2 %, up to most */
  static Round of_steps(double ratio) {
    const double up = std::min(std::max(ratio, 1 / ratio), most);
    int few = 0, many = 0;
    do {
      many = int(std::lround(++few * up));
    } while (std::abs(many / (few * up) - 1) > 0.02);
    return ratio >= 1 ? Round{many, few} : Round{few, many};
  }
  /** Of the same work. */
  static Round of_work(const MethodEntry& main, const MethodEntry& rival) {
    if (!only_evaluates(main) || !only_evaluates(rival))
      return of_steps(cost_of(rival) / cost_of(main));
    const int a = main.info.sweeps, b = rival.info.sweeps, c = std::gcd(a, b);
    return {b / c, a / c};
  }
};

namespace {

Distances distances(const Cloth& a, const Cloth& b) {
  double most = 0, sum = 0;
  unsigned count = 0;
  for (Node n : a.nodes()) {
    if (!b.node_in_use(n.id())) continue;
    const double square = normSq(n.position() - b.positions()[n.id()]);
    most = std::max(most, square), sum += square, ++count;
  }
  return {std::sqrt(most), count > 0 ? std::sqrt(sum / count) : 0};
}

/** How many nodes lie on a plane or a ball of @a m at time @a t. */
unsigned count_touching(const Model& m, const Cloth& g, double t) {
  constexpr double near = 1e-6;  // [m]
  const auto on_plane = [t](const Point& p, const Wall& w) {
    return dot(p - w.at - w.motion.way(t), w.out()) < near;
  };
  const auto on_ball = [t](const Point& p, const Solid& s) {
    return norm(p - s.ball.center - s.motion.way(t)) < s.ball.radius + near;
  };
  unsigned count = 0;
  for (Node n : g.nodes()) {
    const auto touched = [&](auto on) {
      return
          [&, on](const auto& obstacle) { return on(n.position(), obstacle); };
    };
    count += std::ranges::any_of(m.planes, touched(on_plane)) ||
             std::ranges::any_of(m.spheres, touched(on_ball));
  }
  return count;
}

/** Does the segment from @a p to @a q meet the surface between the rays @a a
 * and @a b, two triangles? Of what passes exactly through a side that two
 * triangles share, one of them has it: each side is asked for in one way. */
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

struct Live::Parts {
  /** A scene, and what its readings need. */
  struct Side {
    std::unique_ptr<Scene> scene;
    MethodEntry method;
    double dt_unit, safe_limit, sharp_limit;  // [s]; sharp: when last asked for
    double from = 0;                          // since the last change [s]
    long long evaluations = 0;                // at that time

    Side(std::unique_ptr<Scene> s, const MethodEntry& m)
        : scene(std::move(s)), method(m) {
      scene->follow_drag();
      mark();
      sharp_limit = safe_limit;
    }
    void mark() {
      from = scene->time(), evaluations = scene->evaluations();
      safe_limit = scene->safe_limit();
      dt_unit = unit_of(*scene, method);
    }
    bool runs() const { return scene->failure().empty(); }
    RunReadings readings(bool sharp);
  };

  Model model;
  PointsAndQuads mesh;
  std::optional<Side> main, rival, reference;
  Compare asked = {};     // if there is a rival
  double rival_step = 0;  // that asked for [s]
  Round round;
  unsigned nodes = 0, edges = 0;  // at the start
  long long calls = 0;
  std::string recording;

  explicit Parts(Model m) {
    (*this)(LoadScene{std::move(m)});
    recording = begin_recording();
    record(LoadScene{model});
  }

  static double unit_of(const Scene& s, const MethodEntry& m);
  /** What runs beside a scene that failed waits for it. */
  void each_running(auto use) {
    if (!main->runs()) return;
    for (auto* side : {&main, &rival, &reference})
      if (*side && (*side)->runs()) use((*side)->scene);
  }
  void record(const Request& r) {
    const bool is_scene = std::holds_alternative<LoadScene>(r);
    recording +=
        recorded({.calls = calls,
                  .request = r,
                  .cloth = is_scene ? checksum_of(main->scene->cloth()) : 0});
  }
  void set_step(const MethodEntry& method, const TimeStep& step);
  void change_forces();
  void tune();

  void operator()(const SetMethod& r);
  void operator()(const SetStepShare& r);
  void operator()(const SetStiffness& r);
  void operator()(const SetDrag& r);
  void operator()(const SetGravity& r);
  void operator()(const LoadScene& r);
  void operator()(const BreakIt& r) { (*this)(LoadScene{r.failure->model()}); }
  void operator()(const Restart&);
  void operator()(const Grab& r);
  void operator()(const MoveGrab& r);
  void operator()(const Release&);
  void operator()(const Cut& r);
  void operator()(const PinNode& r);
  void operator()(const UnpinNode& r);
  void operator()(const Compare& r);
  void operator()(const StopComparing&) { rival.reset(), reference.reset(); }
};

/** What a share of 1 is: RunReadings::dt_unit. */
double Live::Parts::unit_of(const Scene& s, const MethodEntry& m) {
  for (const MethodEntry& like : {m, entry_of<Verlet>()})
    if (const double limit = s.safe_limit(like);
        limit > 0 && std::isfinite(limit))
      return limit;
  return TimeStep().dt;
}

void Live::Parts::set_step(const MethodEntry& method, const TimeStep& step) {
  main->scene->change_method(method, step);
  main->method = method, model.step = step;
  main->mark();
  if (rival) tune();
}

void Live::Parts::operator()(const SetMethod& r) {
  TimeStep step = model.step;
  if (step.fixed()) step.dt = main->scene->dt();
  try {
    set_step(*r.method, step);
  } catch (const std::invalid_argument&) {  // it can't choose
    step.dt = main->scene->dt(), step.rule = StepRule::fixed;
    set_step(*r.method, step);
  }
  model.method = r.method;
}

void Live::Parts::operator()(const SetStepShare& r) {
  TimeStep step = model.step;
  step.dt = r.share * main->dt_unit, step.rule = StepRule::fixed;
  set_step(main->method, step);
}

/** To those of the model as it is now. */
void Live::Parts::change_forces() {
  const Recipe recipe = recipe_of(model, mesh);
  for (auto* side : {&main, &rival, &reference})
    if (*side) (*side)->scene->change_forces(recipe), (*side)->mark();
  if (rival) tune();
}
void Live::Parts::operator()(const SetStiffness& r) {
  (model.material.modulus ? *model.material.modulus : model.stiffness) = r.K;
  change_forces();
}
void Live::Parts::operator()(const SetDrag& r) {
  (model.material.drag ? *model.material.drag : model.damping) = r.c;
  change_forces();
}
void Live::Parts::operator()(const SetGravity& r) {
  model.gravity = r.g;
  change_forces();
}

void Live::Parts::operator()(const LoadScene& r) {
  Model m = r.model;
  PointsAndQuads points = mesh_of(m);
  auto scene = std::make_unique<Scene>(recipe_of(m, points), m.step, *m.method);
  (*this)(StopComparing());
  model = std::move(m), mesh = std::move(points);
  nodes = scene->cloth().num_nodes(), edges = scene->cloth().num_edges();
  main.emplace(std::move(scene), *model.method);
}

void Live::Parts::operator()(const Restart&) {
  main->scene->restart();
  main->mark();
  if (rival) (*this)(asked);
}

void Live::Parts::operator()(const Grab& r) {
  each_running([&](auto& scene) { scene->grab(r.node, r.target); });
  main->mark();
}
void Live::Parts::operator()(const MoveGrab& r) {
  each_running([&](auto& scene) {
    if (scene->hand()) scene->move_hand(r.target);
  });
}
void Live::Parts::operator()(const Release&) {
  each_running([&](auto& scene) { scene->release(); });
  main->mark();
}
void Live::Parts::operator()(const Cut& r) {
  each_running([&](auto& scene) { scene->cut(r.edges); });
}
void Live::Parts::operator()(const PinNode& r) {
  each_running([&](auto& scene) { scene->pin(r.node); });
}
void Live::Parts::operator()(const UnpinNode& r) {
  each_running([&](auto& scene) { scene->unpin(r.node); });
  main->mark();
  if (rival) tune();
}

void Live::Parts::operator()(const Compare& r) {
  if (!main->runs()) return;
  asked = r;
  const double dt = main->scene->dt();
  if (!model.step.fixed())
    set_step(main->method, {.dt = dt, .tolerance = model.step.tolerance});
  const auto copy = [&](const MethodEntry& method) {
    return Side(
        std::make_unique<Scene>(*main->scene, TimeStep{.dt = dt}, method),
        method);
  };
  rival.emplace(copy(*r.method));
  reference.emplace(copy(reference_method));
  rival_step = r.share * rival->dt_unit;
  tune();
}

/** Let the rival and the reference have the steps by which they meet. */
void Live::Parts::tune() {
  const double dt = main->scene->dt();
  round = asked.at == Compare::At::equal_work
              ? Round::of_work(main->method, rival->method)
              : Round::of_steps(rival_step / dt);
  const double whole = round.main * dt;
  const auto set = [](Side& side, double step) {
    side.scene->change_method(side.method, {.dt = step});
    side.mark();
  };
  set(*rival, whole / round.rival);
  const double steps = whole / (reference_share * reference->dt_unit);
  set(*reference, whole / std::min(std::ceil(steps), Round::most));
}

RunReadings Live::Parts::Side::readings(bool sharp) {
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

Live::Live(Model m) : parts_(std::make_unique<Parts>(std::move(m))) {}
Live::~Live() = default;

void Live::apply(const Request& r) {
  Parts& p = *parts_;
  // Whoever looked may have found a failure, which else would be found later.
  p.each_running([](auto& scene) { scene->settle(); });
  std::visit(p, r);
  p.record(r);
}

bool Live::step() {
  Parts& p = *parts_;
  if (done()) return false;
  ++p.calls;
  const int count = p.rival ? p.round.main : 1;
  for (int k = 0; k < count && !done() && !interrupted(); ++k)
    p.main->scene->step(p.model.t_end);
  const double time = p.main->scene->time();
  for (auto* side : {&p.rival, &p.reference}) {
    if (!*side || !(*side)->runs()) continue;
    Scene& s = *(*side)->scene;
    while (!s.done(time) && !interrupted())
      s.steps_at_once(Scene::guard_interval, time);
    s.check();
  }
  return !done();
}

bool Live::check() {
  parts_->each_running([](auto& scene) { scene->check(); });
  return parts_->main->runs();
}
bool Live::done() const { return scene().done(parts_->model.t_end); }
long long Live::calls() const { return parts_->calls; }
const Model& Live::model() const { return parts_->model; }
const Scene& Live::scene() const { return *parts_->main->scene; }
const Scene* Live::rival() const {
  return parts_->rival ? parts_->rival->scene.get() : nullptr;
}
const Scene* Live::reference() const {
  return parts_->reference ? parts_->reference->scene.get() : nullptr;
}
std::optional<Grab> Live::hand() const {
  const auto& hand = scene().hand();
  if (!hand || !scene().cloth().node_in_use(hand->node())) return std::nullopt;
  return Grab{hand->node(), hand->target()};
}
bool Live::is_pinned(unsigned node) const { return scene().is_pinned(node); }

Readings Live::readings(bool sharp) {
  Parts& p = *parts_;
  Readings r;
  static_cast<RunReadings&>(r) = p.main->readings(sharp);
  if (!r.failure.empty()) r.failure = scene().explanation();
  const Cloth& g = scene().cloth();
  r.nodes = g.num_nodes(), r.edges = g.num_edges();
  r.torn_nodes = p.nodes - r.nodes, r.torn_edges = p.edges - r.edges;
  r.touching = count_touching(p.model, g, r.time);
  r.grabbed = hand().has_value();
  r.done = done();
  if (!p.rival) return r;
  const Cloth &other = rival()->cloth(), &right = reference()->cloth();
  r.comparison = {.rival = p.rival->readings(sharp),
                  .at = p.asked.at,
                  .apart = distances(g, other),
                  .error = distances(g, right),
                  .rival_error = distances(other, right),
                  .reference = reference_method.info.name,
                  .reference_dt = reference()->dt()};
  return r;
}

std::string Live::recording() const {
  return parts_->recording + end_recording(parts_->calls);
}

void RequestQueue::push(Request r) {
  const bool overrides = std::holds_alternative<MoveGrab>(r) ||
                         std::holds_alternative<SetStepShare>(r) ||
                         std::holds_alternative<SetStiffness>(r) ||
                         std::holds_alternative<SetDrag>(r) ||
                         std::holds_alternative<SetGravity>(r);
  const std::lock_guard lock(mutex_);
  if (overrides && !waiting_.empty() && waiting_.back().index() == r.index())
    waiting_.back() = std::move(r);
  else
    waiting_.push_back(std::move(r));
}

}  // namespace lab
