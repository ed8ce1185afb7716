#include "lab/page/Page.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "CME212/PageData.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/live/Live.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/page/PageScenes.hpp"
#include "lab/scenes/Json.hpp"
#include "lab/stepping/Trial.hpp"

namespace lab {

namespace {

using json::Json, json::list, json::members, json::object;

/** The warning of ./cloth about the run of @a s; of its energy with a remedy,
 * which takes as long as to find one; "" if there is none. */
std::string warning_text(const Scene& s) {
  const auto name = &Cure::in_words;
  if (const std::string missed = s.missed_text(name); !missed.empty())
    return missed;
  const Verdict* const wrong = s.wrong();
  return wrong ? wrong->wrong_text() + "; " + s.remedy(name) : "";
}

Json json_of(const RunReadings& r) {
  return object("method", r.method, "dt", r.dt, "unit", r.dt_unit, "safe",
                r.safe_limit, "sharp", r.sharp_limit, "steps", r.steps, "time",
                r.time, "work", r.work, "kinetic", r.energy.kinetic, "elastic",
                r.energy.elastic, "height", r.energy.gravitational, "total",
                r.energy.total(), "drift", r.drift, "failed",
                r.failure.has_value());
}

// ---------------------------------------------------------------- What is run

struct Drawn {
  std::unique_ptr<Scene> beyond;  // so many steps after a failure; or null
  unsigned steps = 0;
  std::uint64_t version = 0;  // of the cloth, at the last mesh
  double changes = 0;

  void go_back() {
    if (beyond) beyond.reset(), steps = 0, ++changes;
  }
};

/** The one scene of the page, and what was made of it to be drawn. */
struct State {
  std::unique_ptr<Live> live;
  Drawn drawn[1 + Live::most_rivals];
  std::vector<float> points;
  std::vector<unsigned> mesh;
  std::string room, text;

  const Scene* scene(unsigned side) const {
    if (!live) return nullptr;
    return side == 0 ? &live->scene() : live->rival(side - 1);
  }
  /** The scene that is drawn for a side. */
  const Scene& shown(unsigned side) const {
    const auto& beyond = drawn[side].beyond;
    return beyond ? *beyond : *scene(side);
  }
};

State& state() {
  static State s;
  return s;
}
const char* say(Json text) {
  state().text = std::move(text.text);
  return state().text.c_str();
}

}  // namespace

}  // namespace lab

using namespace lab;  // NOLINT

const char* page_about() {
  const auto of_scene = [](const StoredScene* s) {
    return object("name", s->name, "title", s->title, "byArea",
                  page_model(*s, 2).material.modulus.has_value(), "fails",
                  always_fails(*s));
  };
  const auto of_method = [](const MethodEntry& m) {
    const char* group =
        m.info.adaptive            ? "Error control: it chooses its inner steps"
        : m.info.limit == no_limit ? "No limit: any step, at a higher cost"
        : m.info.order > 2 ? "Explicit of high order: accurate while nothing "
                             "collides"
                           : "Explicit: cheap steps, up to a limit";
    return object("name", m.info.name, "group", group, "order", m.info.order,
                  "sweeps", m.info.sweeps, "goodFor", m.info.good_for,
                  "failsWhen", m.info.fails_when);
  };
  return say(object("scenes", list(page_scenes(), of_scene), "methods",
                    list(methods, of_method)));
}

void page_load(unsigned scene, unsigned side) {
  State& s = state();
  s.live = std::make_unique<Live>(page_model(*page_scenes()[scene], side));
  for (Drawn& d : s.drawn) d.go_back(), ++d.changes;
}
const char* page_setting() {
  const Model& m = state().live->scene().model();
  const auto point = [](const Point& p) {
    return list(std::array{p.x, p.y, p.z}, [](double a) { return a; });
  };
  const auto obstacle = [&](const Obstacle& o) {
    const char* const kind = o.kind == Obstacle::Kind::floor  ? "floor"
                             : o.kind == Obstacle::Kind::ball ? "ball"
                                                              : "tears";
    return object("kind", kind, "radius", o.radius, "at", point(o.at));
  };
  std::vector<Point> room;
  if (m.view) room = {m.view->from, m.view->to};
  return say(object("obstacles", list(obstacles_of(m), obstacle), "room",
                    list(room, point)));
}
char* page_room(unsigned size) {
  state().room.resize(size);
  return state().room.data();
}
const char* page_request(const char* text) {
  State& s = state();
  if (const auto error = Live::error_in(text); !error.empty())
    return say({error});
  s.live->apply(text);
  for (unsigned side = 0; side < std::size(s.drawn); ++side) {
    Drawn& d = s.drawn[side];
    const Scene* const scene = s.scene(side);
    if (!scene || !scene->failure()) d.go_back();
    if (!Live::overrides(text)) ++d.changes;  // as pins and edges may be
  }
  return "";
}
const char* page_recording() { return say({state().live->recording()}); }

double page_step() {
  State& s = state();
  s.live->step();
  return s.live->scene().time();
}
int page_check() {
  State& s = state();
  s.live->check();
  return s.live->scene().failure().has_value();
}
const char* page_failure(unsigned side) {
  const Scene* s = state().scene(side);
  if (!s || !s->failure()) return say({"null"});
  const Failure& f = *s->failure();
  return say(object("diverged", f.kind == Failure::Kind::diverged, "cause",
                    f.what(), "place", f.where()));
}
double page_beyond(unsigned side, unsigned steps) {
  State& s = state();
  Drawn& d = s.drawn[side];
  if (steps < d.steps) d.go_back();
  for (; d.steps < steps; ++d.steps) d.beyond = s.shown(side).beyond_failure(0);
  return s.shown(side).time();
}
const char* page_explain() {
  const Scene& scene = state().live->scene();
  const Diagnosis& why = scene.diagnosis();
  const auto& cure = why.cure;
  const Failure& f = *scene.failure();
  const bool diverged = f.kind == Failure::Kind::diverged;
  return say(object("cause",
                    (diverged ? "" : f.what() + ": ") + why.cause_text(),
                    "remedy", why.remedy_text(&Cure::in_words), "cure",
                    cure ? object("method", cure->method.info.name, "share",
                                  cure->dt / dt_unit(scene, cure->method))
                         : Json{"null"}));
}
const char* page_readings(int sharp) {
  const Readings r = state().live->readings(sharp != 0);
  const auto parameter = [](const auto& p) {
    return Json{members(p.first, p.second)};
  };
  const auto rival = [](const Readings::Rival& side) {
    Json all = json_of(side.readings);
    all.text.back() = ',';
    return Json{all.text + members("error", side.error) + '}'};
  };
  std::string all =
      members("parameters",
              list(Live::parameters(state().live->model()), parameter, "{}"),
              "main", json_of(r), "nodes", r.nodes, "edges", r.edges,
              "tornNodes", r.torn_nodes, "tornEdges", r.torn_edges, "grabbed",
              r.grabbed, "warning", warning_text(state().live->scene()),
              "rivals", list(r.rivals, rival), "error", r.error);
  const Model& m = state().live->model();
  if (const Measure& what = m.measure; what.quantity < Measure::lost_energy &&
                                       what.quantity != Measure::positions)
    all += ',' + members("measure", name_of(what), "unit", unit_of(what),
                         "answer", list(answer(state().live->scene(), what)));
  return say({'{' + all + '}'});
}

unsigned page_slots(unsigned side) {
  const Scene* s = state().scene(side);
  return s ? arrays(s->cloth()).node_slots() : 0;
}
const double* page_positions(unsigned side) {
  static_assert(sizeof(Point) == 3 * sizeof(double));
  return &arrays(state().scene(side)->cloth()).positions()[0].x;
}
const float* page_points(unsigned side) {
  State& s = state();
  const Cloth& g = s.shown(side).cloth();
  CME212::set_page_points(
      s.points, arrays(g).node_slots(), g.nodes(), g.edges(),
      [](Node n) { return n.id(); }, [](Edge e) { return e.value().L; });
  return s.points.data();
}
double page_version(unsigned side) {
  State& s = state();
  Drawn& d = s.drawn[side];
  const std::uint64_t now = arrays(s.shown(side).cloth()).version();
  if (std::exchange(d.version, now) != now) ++d.changes;
  return d.changes;
}
const unsigned* page_mesh(unsigned side) {
  State& s = state();
  const Scene& scene = s.shown(side);
  const Cloth& g = scene.cloth();
  std::vector<std::array<unsigned, 2>> ends;
  for (Edge e : g.edges()) ends.push_back({e.node1().id(), e.node2().id()});
  std::vector<Quad> faces = quads_left(g, scene.mesh());
  for (Quad& q : faces)
    for (unsigned& corner : q) corner = scene.mesh().ids[corner];
  std::vector<unsigned> pins;
  for (const HeldNodes& held : scene.held())
    for (const auto& h : held.nodes)
      if (h.id < arrays(g).node_slots() && arrays(g).node_in_use(h.id))
        pins.push_back(h.id);
  s.mesh = CME212::page_mesh(ends, faces, pins);
  return s.mesh.data();
}
int page_failed_node(unsigned side) {
  const Scene* s = state().scene(side);
  if (!s || !s->failure()) return -1;
  const Node n = s->failure()->place.node;
  return s->cloth().has_node(n) ? int(n.id()) : -1;
}
