#include "lab/page/Page.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "lab/live/Live.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/page/PageScenes.hpp"

namespace lab {

namespace {

// ----------------------------------------------------------------------- JSON

std::string json(const std::string& text) {
  std::string all = "\"";
  for (char c : text) {
    if (c == '"' || c == '\\') all += '\\';
    all += c;
  }
  return all += '"';
}
std::string json(const char* text) { return json(std::string(text)); }
template <typename T>
requires std::is_arithmetic_v<T>  //
    std::string json(T a) {
  if constexpr (std::is_same_v<T, bool>)
    return a ? "true" : "false";
  else
    return std::isfinite(double(a)) ? CME212::exact_text(double(a)) : "null";
}

/** {"name": value, ...} */
class Object {
 public:
  template <typename T>
  Object& operator()(const char* name, const T& value) {
    return raw(name, json(value));
  }
  Object& raw(const char* name, const std::string& value) {
    if (!text_.empty()) text_ += ',';
    text_.append(json(name)).append(":").append(value);
    return *this;
  }
  std::string text() const { return std::string("{") + text_ + '}'; }

 private:
  std::string text_;
};
template <typename Range, typename ToJson>
std::string json_list(const Range& all, ToJson to_json) {
  std::string text = "[";
  for (const auto& a : all) {
    if (text.size() > 1) text += ',';
    text += to_json(a);
  }
  return text += ']';
}

std::string json_of(const RunReadings& r) {
  return Object()("method", r.method)("dt", r.dt)("unit", r.dt_unit)(
             "safe", r.safe_limit)("sharp", r.sharp_limit)("steps", r.steps)(
             "time", r.time)("evaluations", r.evaluations)(
             "kinetic", r.energy.kinetic)("elastic", r.energy.elastic)(
             "height", r.energy.gravitational)("total", r.energy.total())(
             "drift", r.drift)("failure", r.failure)
      .text();
}

// ---------------------------------------------------------------- What is run

struct Drawn {
  std::unique_ptr<Scene> beyond;  // some steps after a failure
  std::uint64_t version = 0;      // of the cloth, at the last mesh
  bool beyond_drawn = false;      // then
  double changes = 0;
};

/** The one scene of the page, and what was made of it to be drawn. */
struct State {
  std::unique_ptr<Live> live;
  Drawn drawn[2];
  std::vector<float> points;
  std::vector<unsigned> mesh;
  std::vector<double> stroke;
  std::string text;

  const Scene* scene(unsigned side) const {
    if (!live) return nullptr;
    return side == 0 ? &live->scene() : live->rival();
  }
  /** What is drawn of a side. */
  const Scene& shown(unsigned side) const {
    const auto& beyond = drawn[side].beyond;
    return beyond ? *beyond : *scene(side);
  }
  void apply(const Request& r) {
    live->apply(r);
    draw_anew();
  }
  void draw_anew() {
    for (Drawn& d : drawn) d.beyond.reset(), ++d.changes;
  }
  void look_beyond() {
    for (unsigned side : {0u, 1u}) {
      const Scene* s = scene(side);
      if (!s || s->failure().empty() || drawn[side].beyond) continue;
      constexpr double far = 0.1;  // [m]: it grows by much in the last step
      drawn[side].beyond = s->beyond_failure(far);
    }
  }
};

State& state() {
  static State s;
  return s;
}
const char* say(std::string text) {
  state().text = std::move(text);
  return state().text.c_str();
}

}  // namespace

}  // namespace lab

using namespace lab;  // NOLINT

const char* page_about() {
  const auto scenes = json_list(page_scenes(), [](const PageScene& s) {
    const Model m = s.model(2);
    const bool by_area = m.material.modulus.has_value();
    return Object()("name", s.name)("title", s.title)("byArea", by_area)(
               "K", by_area ? *m.material.modulus : m.stiffness)(
               "drag", by_area ? m.material.drag.value_or(0) : m.damping)(
               "gravity", m.gravity)
        .text();
  });
  const auto list = json_list(methods, [](const MethodEntry& m) {
    return Object()("name", m.info.name)("order", m.info.order)(
               "sweeps", m.info.sweeps)("limit", m.info.limit)(
               "goodFor", m.info.good_for)("failsWhen", m.info.fails_when)
        .text();
  });
  return say(Object().raw("scenes", scenes).raw("methods", list).text());
}

void page_load(unsigned scene, unsigned side, unsigned method) {
  Model m = page_scenes()[scene].model(side);
  m.method = &methods[method];
  State& s = state();
  s.live = std::make_unique<Live>(std::move(m));
  s.draw_anew();
}
const char* page_setting() {
  const Recipe& recipe = state().live->scene().recipe();
  const auto point = [](const Point& p) {
    return json_list(std::array{p.x, p.y, p.z}, [](Real a) { return json(a); });
  };
  const auto obstacles = json_list(recipe.obstacles, [&](const Obstacle& o) {
    return Object()("kind", o.kind == Obstacle::Kind::floor ? "floor"
                            : o.kind == Obstacle::Kind::ball
                                ? "ball"
                                : "tears")("radius", o.radius)
        .raw("at", point(o.at))
        .text();
  });
  return say(Object()
                 .raw("obstacles", obstacles)
                 .raw("room", json_list(recipe.room, point))
                 .text());
}
void page_set_share(double share) { state().apply(SetStepShare{share}); }
void page_set_method(unsigned method) {
  state().apply(SetMethod{&methods[method]});
}
void page_set_stiffness(double K) { state().apply(SetStiffness{K}); }
void page_set_drag(double c) { state().apply(SetDrag{c}); }
void page_set_gravity(double g) { state().apply(SetGravity{g}); }
void page_compare(int method, double share) {
  if (method < 0) return state().apply(StopComparing());
  state().apply(Compare{&methods[unsigned(method)], share});
}

void page_grab(unsigned node, double x, double y, double z) {
  state().live->apply(Grab{node, Point(x, y, z)});
}
void page_move_hand(double x, double y, double z) {
  state().live->apply(MoveGrab{Point(x, y, z)});
}
void page_release() { state().live->apply(Release()); }
void page_toggle_pin(unsigned node) {
  State& s = state();
  if (s.live->is_pinned(node))
    s.apply(UnpinNode{node});
  else
    s.apply(PinNode{node});
}
double* page_stroke(unsigned rays) {
  state().stroke.resize(std::size_t(6) * rays);
  return state().stroke.data();
}
void page_cut(unsigned rays) {
  State& s = state();
  std::vector<Ray> stroke;
  const double* a = s.stroke.data();
  for (unsigned k = 0; k < rays; ++k, a += 6)
    stroke.push_back({Point(a[0], a[1], a[2]), Point(a[3], a[4], a[5])});
  auto edges = crossed_edges(s.live->scene().cloth(), stroke);
  if (!edges.empty()) s.apply(Cut{std::move(edges)});
}

double page_step() {
  State& s = state();
  s.live->step();
  return s.live->scene().time();
}
int page_check() {
  State& s = state();
  s.live->check();
  s.look_beyond();
  return !s.live->scene().failure().empty();
}
const char* page_failure(unsigned side) {
  const Scene* s = state().scene(side);
  return say(s ? s->failure() : "");
}
const char* page_readings(int sharp) {
  const Readings r = state().live->readings(sharp != 0);
  Object all;
  all.raw("main", json_of(r))("nodes", r.nodes)("edges", r.edges)(
      "tornNodes", r.torn_nodes)("tornEdges", r.torn_edges)(
      "touching", r.touching)("grabbed", r.grabbed);
  if (const auto& c = r.comparison)
    all.raw("rival", json_of(c->rival))("apart", c->apart.rms)(
        "error", c->error.rms)("rivalError", c->rival_error.rms);
  return say(all.text());
}

unsigned page_slots(unsigned side) {
  const Scene* s = state().scene(side);
  return s ? s->cloth().node_slots() : 0;
}
const Real* page_positions(unsigned side) {
  static_assert(sizeof(Point) == 3 * sizeof(Real));
  return &state().scene(side)->cloth().positions()[0].x;
}
const float* page_points(unsigned side) {
  State& s = state();
  const Cloth& g = s.shown(side).cloth();
  s.points.assign(std::size_t(4) * g.node_slots(), 0);
  for (Node n : g.nodes()) {
    float* to = &s.points[std::size_t(4) * n.id()];
    for (int k = 0; k < 3; ++k) to[k] = float(std::as_const(n).position()[k]);
  }
  for (Edge e : g.edges()) {
    const double L = e.value().L;
    const auto strain = float(L > 0 ? std::abs(e.length() / L - 1) : 0);
    for (Node n : {e.node1(), e.node2()}) {
      float& most = s.points[std::size_t(4) * n.id() + 3];
      most = std::max(most, strain);
    }
  }
  return s.points.data();
}
double page_version(unsigned side) {
  State& s = state();
  Drawn& d = s.drawn[side];
  const std::uint64_t now = s.shown(side).cloth().version();
  if (now != d.version || d.beyond_drawn != bool(d.beyond)) ++d.changes;
  d.version = now, d.beyond_drawn = bool(d.beyond);
  return d.changes;
}
const unsigned* page_mesh(unsigned side) {
  State& s = state();
  const Scene& scene = s.shown(side);
  const Cloth& g = scene.cloth();
  std::vector<unsigned> triangles, pins;
  if (const auto& built = scene.recipe().built)
    for (const Quad& q : quads_left(g, *built))
      for (int k : {0, 1, 2, 1, 3, 2})  // the sides are 01, 02, 13 and 23
        triangles.push_back(built->ids[q[unsigned(k)]]);
  for (const HeldNodes& held : scene.held())
    for (const auto& h : held.nodes)
      if (h.id < g.node_slots() && g.node_in_use(h.id)) pins.push_back(h.id);
  s.mesh = {g.num_edges(), unsigned(triangles.size() / 3),
            unsigned(pins.size())};
  for (Edge e : g.edges())
    for (Node n : {e.node1(), e.node2()}) s.mesh.push_back(n.id());
  for (const auto* list : {&triangles, &pins})
    s.mesh.insert(s.mesh.end(), list->begin(), list->end());
  return s.mesh.data();
}
int page_failed_node(unsigned side) {
  const Scene* s = state().scene(side);
  if (!s || !s->failed_at()) return -1;
  const Node n = s->failed_at()->node;
  return s->cloth().has_node(n) ? int(n.id()) : -1;
}
