#include "lab/live/Live.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <tuple>

#include "lab/Interrupt.hpp"
#include "lab/live/Line.hpp"
#include "lab/live/Recording.hpp"
#include "lab/methods/Costs.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Checkpoint.hpp"

namespace lab {

namespace {

/** Of what is compared, the reference: order 6, or 2 where there is contact. */
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

/** What a share of 1 is: RunReadings::dt_unit. */
double unit_of(const Scene& s, const MethodEntry& m) {
  for (const MethodEntry& like : {m, entry_of<Verlet>()})
    if (const double limit = s.safe_limit(like);
        limit > 0 && std::isfinite(limit))
      return limit;
  return TimeStep().dt;
}

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

Live::Side::Side(std::unique_ptr<Scene> s, const MethodEntry& m)
    : scene(std::move(s)), method(m) {
  scene->follow_drag();
  mark();
  sharp_limit = safe_limit;
}
void Live::Side::mark() {
  from = scene->time(), evaluations = scene->evaluations();
  safe_limit = scene->safe_limit();
  dt_unit = unit_of(*scene, method);
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
        "is of another cloth: its files, or how the program makes it, have "
        "changed");
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

// ------------------------------------------------------- The table of requests

namespace {

struct Share {
  double of_unit;
};
using Ends = std::array<unsigned, 2>;

// read(in, value): the next words as a value of a request.
void read(Line& in, unsigned& node) {
  node = in.number<unsigned>("the id of a node");
}
void read(Line& in, Point& p) {
  for (int k = 0; k < 3; ++k) p[k] = Real(in.number("three coordinates [m]"));
}
void read(Line& in, Ends& edge) { read(in, edge[0]), read(in, edge[1]); }
void read(Line& in, Ray& r) { read(in, r.near), read(in, r.far); }
template <typename T>
void read(Line& in, std::vector<T>& all) {
  while (!in.at_end()) read(in, all.emplace_back());
}
void read(Line& in, Share& s) {
  constexpr double least = std::numeric_limits<double>::denorm_min();
  s.of_unit = in.number("a share above 0", least);
}
void read(Line& in, const MethodEntry*& method) {
  const auto name_of = [](const MethodEntry& m) { return m.info.name; };
  method = in.one_of("method", methods, name_of);
}
void read(Line& in, const Breakage*& failure) {
  failure = in.one_of("failure", breakages(), &Breakage::name);
}
void read(Line& in, bool& equal_work) {
  static constexpr const char* ways[] = {"equal-time", "equal-work"};
  equal_work =
      in.one_of("equal-time or equal-work", ways, std::identity()) == &ways[1];
}
void read(Line& in, std::string& rest) { rest = in.rest(); }

}  // namespace

/** The table of requests: what a line of text means that starts with a name. */
struct Live::Table {
  enum Kind {
    plain,
    override,  // see Live::overrides()
    expand,    // recorded as the requests that it makes
  };
  struct Request {
    std::string_view name;
    Kind kind;
    /** Read what follows the name; if the scene is not null, change it.
     * @pre null, or the line makes sense */
    std::function<void(Line&, Live*)> run;
    double& (*parameter)(Model&) = nullptr;  // that it sets, if it sets one
  };
  std::vector<Request> all;

  Table();
  /** The one that the next word of @a in names; null if @a in fails. */
  static const Request* find(Line& in) {
    return in.one_of("request", get().all, &Request::name);
  }
  static const Table& get() {
    static const Table table;
    return table;
  }
  /** A request whose values are of the types that @a apply takes. */
  void on(std::string_view name, Kind kind, auto apply) {
    add(name, kind, std::function(apply));
  }
  template <typename... Values>
  void add(std::string_view name, Kind kind,
           const std::function<void(Live&, Values...)>& apply) {
    const auto run = [apply](Line& in, Live* live) {
      std::tuple<Values...> values;
      std::apply([&](auto&... v) { (read(in, v), ...); }, values);
      in.end();
      if (live) std::apply([&](auto&... v) { apply(*live, v...); }, values);
    };
    all.push_back({name, kind, run});
  }
  /** A request that sets a number of the model, which is @a least or more. */
  void sets(std::string_view name, const char* expected, double least,
            double& (*parameter)(Model&)) {
    const auto run = [=](Line& in, Live* live) {
      const double a = in.number(expected, least);
      in.end();
      if (live) parameter(live->model_) = a, live->change_forces();
    };
    all.push_back({name, override, run, parameter});
  }
};

Live::Table::Table() {
  // From now on by this method; the step stays.
  on("method", plain,
     [](Live& live, const MethodEntry* m) { live.set_method(*m); });
  // From now on by steps of this share of RunReadings::dt_unit.
  on("step", override, [](Live& live, Share share) {
    TimeStep step = live.model_.step;
    step.dt = share.of_unit * live.main_->dt_unit;
    step.rule = StepRule::fixed;
    live.set_step(live.main_->method, step);
  });
  // K [N/m], or the modulus of a scene that has one; rest lengths stay.
  sets("stiffness", "0 N/m or more", 0, [](Model& m) -> double& {
    return m.material.modulus ? *m.material.modulus : m.stiffness;
  });
  // c of each node [kg/s]; or by area [kg/(s m^2)], if the scene has that.
  sets("drag", "0 or more", 0, [](Model& m) -> double& {
    return m.material.drag ? *m.material.drag : m.damping;
  });
  // g [m/s^2]
  sets("gravity", "a number", -no_limit,
       [](Model& m) -> double& { return m.gravity; });
  // Load the scene that scene_request() wrote.
  on("scene", expand, [](Live& live, std::string rest) {
    SceneRequest r = read_scene("scene " + rest);
    live.load(std::move(r.model), r.cloth);
    live.record(scene_request(live.model_, checksum_of(live.scene().cloth())));
  });
  on("break", plain,
     [](Live& live, const Breakage* b) { live.load(b->model()); });
  // Back to t = 0, with the parameters as they are.
  on("restart", plain, [](Live& live) {
    live.main_->scene->restart();
    live.main_->mark();
    if (live.rival_) live.compare();
  });
  // Pull a node towards a point; move that point; let the node go.
  on("grab", plain, [](Live& live, unsigned node, Point target) {
    live.each_running([&](Scene& s) { s.grab(node, target); });
    live.main_->mark();
  });
  on("move", override, [](Live& live, Point target) {
    live.each_running([&](Scene& s) {
      if (s.hand()) s.move_hand(target);
    });
  });
  on("release", plain, [](Live& live) {
    live.each_running([](Scene& s) { s.release(); });
    live.main_->mark();
  });
  // Remove edges, each by its ends; or all that a stroke of rays crosses.
  on("cut", plain, [](Live& live, std::vector<Ends> edges) {
    live.each_running([&](Scene& s) { s.cut(edges); });
  });
  on("stroke", expand, [](Live& live, std::vector<Ray> rays) {
    std::string cut = "cut";
    for (const auto& [i, j] : crossed_edges(live.scene().cloth(), rays))
      cut += request_word(i) + request_word(j);
    if (cut != "cut") live.apply(cut);
  });
  // Hold a node where it is, at rest; let it go, whatever pin holds it; or
  // whichever of both changes something.
  on("pin", plain, [](Live& live, unsigned node) {
    live.each_running([&](Scene& s) { s.pin(node); });
  });
  on("unpin", plain, [](Live& live, unsigned node) {
    live.each_running([&](Scene& s) { s.unpin(node); });
    live.main_->mark();
    if (live.rival_) live.tune();
  });
  on("toggle", expand, [](Live& live, unsigned node) {
    const bool held = live.main_->scene->is_pinned(node);
    live.apply(request(held ? "unpin" : "pin", node));
  });
  // Run a copy of the present state beside it by another method: at equal
  // time by this share of its dt_unit; at equal work by the step at which
  // a simulated second costs both the same.
  on("compare", plain,
     [](Live& live, const MethodEntry* m, Share share, bool work) {
       if (!live.main_->runs()) return;
       live.rival_method_ = m, live.rival_share_ = share.of_unit,
       live.equal_work_ = work;
       live.compare();
     });
  on("alone", plain, [](Live& live) { live.alone(); });
}

void Live::apply(const std::string& text) {
  if (const auto error = error_in(text); !error.empty())
    throw std::invalid_argument(error);
  Line in(text);
  const Table::Request& request = *Table::find(in);
  // A guard that looks now may find a failure that it would find later.
  if (request.kind != Table::expand)
    each_running([](Scene& scene) { scene.settle(); });
  request.run(in, this);
  if (request.kind != Table::expand) record(text);
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

std::string Live::error_in(std::string_view request) {
  Line in(request);
  if (const auto* found = Table::find(in)) found->run(in, nullptr);
  return in.error();
}
bool Live::overrides(std::string_view request) {
  Line in(request);
  const auto* found = Table::find(in);
  return found && found->kind == Table::override;
}
std::vector<std::pair<std::string_view, double>> Live::parameters(Model m) {
  std::vector<std::pair<std::string_view, double>> all;
  for (const auto& r : Table::get().all)
    if (r.parameter) all.emplace_back(r.name, r.parameter(m));
  return all;
}

bool Live::step() {
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
  if (!r.failure.empty()) r.failure = scene().explanation();
  const Cloth& g = scene().cloth();
  r.nodes = g.num_nodes(), r.edges = g.num_edges();
  r.torn_nodes = start_nodes_ - r.nodes, r.torn_edges = start_edges_ - r.edges;
  r.touching = count_touching(model_, g, r.time);
  r.grabbed = scene().hand() && g.node_in_use(scene().hand()->node());
  r.done = done();
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

void RequestQueue::push(std::string request) {
  const auto name = [](const std::string& r) {
    return r.substr(0, r.find(' '));
  };
  const std::lock_guard lock(mutex_);
  if (!waiting_.empty() && name(waiting_.back()) == name(request) &&
      Live::overrides(request))
    waiting_.back() = std::move(request);
  else
    waiting_.push_back(std::move(request));
}

}  // namespace lab
