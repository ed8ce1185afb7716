#pragma once
/** @file Simulation.hpp
 * What runs from Python, and what it gives. */
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "CME212/Util.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Fields.hpp"
#include "lab/scenes/Interrupt.hpp"
#include "lab/scenes/Net.hpp"
#include "lab/stepping/RestReport.hpp"
#include "lab/stepping/Settled.hpp"

namespace lab {

inline const MethodEntry& method_called(const std::string& name) {
  Model m;
  set_field(m, "method", {name});
  return *m.method;
}

/** Why a run failed, or is not the motion of its scene. */
struct Why {
  std::string kind;
  long long step = 0;
  double time = 0, dt = 0;
  std::optional<long long> node;
  std::string cause, text;
  std::optional<std::pair<std::string, double>> cure;
};

/** Throws Interrupted. */
inline std::optional<Why> why_failed(const Scene& s) {
  Why w;
  if (const auto& f = s.failure()) {
    constexpr const char* kinds[] = {"start", "diverged", "refused"};
    const Explanation e = s.explanation();
    w.kind = kinds[int(f->kind)], w.cause = e.cause, w.text = e.text();
    w.step = f->step, w.time = f->time, w.dt = f->dt;
    if (f->place.index >= 0) w.node = f->place.index;
  } else if (const Verdict* wrong = s.wrong()) {  // as ./cloth ends
    w.kind = "energy", w.cause = wrong->wrong_text();
    w.text = w.cause + "; " + s.remedy();
    w.step = s.steps(), w.time = s.time(), w.dt = s.dt();
  } else {
    return std::nullopt;
  }
  if (const auto& cure = s.diagnosis().cure)
    w.cure = {std::string(cure->method.info.name), cure->dt};
  return w;
}

/** A state of a run. The rows are the nodes of its start; a node that was
 * removed has no position: NaN. */
struct State {
  double t, energy;
  std::vector<Point> x, v;

  explicit State(const Scene& scene)
      : t(scene.time()), energy(scene.energy().total()) {
    const auto a = arrays(scene.cloth());
    const Point none(std::numeric_limits<double>::quiet_NaN());
    for (unsigned id : scene.mesh().ids) {
      const bool there = a.node_in_use(id);
      x.push_back(there ? a.positions()[id] : none);
      v.push_back(there ? a.node_values()[id].vel : none);
    }
  }
};

/** The states of a run, one every so many seconds. */
struct Result {
  std::size_t nodes = 0;
  std::vector<double> t, energy;
  std::vector<Point> x, v;
  long long steps = 0, evaluations = 0;
  std::optional<Why> why;

  void add(const State& s) {
    nodes = s.x.size();
    t.push_back(s.t), energy.push_back(s.energy);
    x.insert(x.end(), s.x.begin(), s.x.end());
    v.insert(v.end(), s.v.begin(), s.v.end());
  }
};

/** A scene at rest. */
struct AtRest : RestReport {
  std::vector<Point> x, force;  // of each node of the mesh

  explicit AtRest(Scene s) : RestReport(s), x(State(s).x) {
    for (Node n : s.cloth().nodes()) force.push_back(s.force()(n, 0));
  }
};

/** A scene, or a net: what a run starts from. */
class Simulation {
 public:
  explicit Simulation(Model m) : model_(std::move(m)), mesh_(mesh_of(model_)) {}
  Simulation(Model m, Net mesh)
      : model_(std::move(m)), mesh_(std::move(mesh)), is_of_arrays_(true) {}

  const Model& model() const { return model_; }
  const Net& mesh() const { return mesh_; }
  bool is_of_arrays() const { return is_of_arrays_; }

  double limit(const std::string& method) const {
    return Scene(model_, mesh_, TimeStep(), method_called(method))
        .least_limit()
        .limit;
  }

  Result run(const std::string& method, std::optional<double> t_end,
             const std::string& dt, std::optional<double> every,
             std::optional<double> atol, std::vector<Point> x0,
             std::vector<Point> v0) const {
    Model m = model_;
    Net mesh = x0.empty() ? mesh_ : moved_to(std::move(x0));
    if (!v0.empty()) mesh.velocities = std::move(v0);
    if (!method.empty()) set_field(m, "method", {method});
    if (t_end) set_field(m, "t-end", {CME212::exact_text(*t_end)});
    const double between = every.value_or(m.t_end);
    if (!(between > 0) && m.t_end > 0)
      throw SceneError("every", CME212::short_text(between),
                       "a time [s] above 0");
    if (dt == "auto" && m.method->info.adaptive)
      m.step = {.dt = std::min(between, m.t_end)};
    else if (!dt.empty())
      set_field(m, "dt", {dt});
    if (atol && !(*atol > 0 && std::isfinite(*atol)))
      throw SceneError("atol", CME212::short_text(*atol),
                       "a length [m] above 0");
    if (atol) m.step.tolerance = *atol;
    check_step(m);
    Scene scene(model_, mesh, m.step, *m.method);
    scene.watch(m.t_end);
    Result r;
    Settled<State> states(scene.stepper(), [&r](const State& s) { r.add(s); });
    states.add(State(scene));
    // Signals are looked for at least every 1e7 springs' forces.
    const double at_once = 1e7 / (double(scene.cloth().num_edges()) + 1);
    while (!scene.done(m.t_end)) {
      end_if_interrupted();
      const double last = states.back() ? states.back()->t : r.t.back();
      const double next = between * (std::floor(last / between + 1e-6) + 1);
      const double left = std::ceil((next - scene.time()) / scene.dt() - 1e-6);
      const int most = int(std::clamp(std::min(left, at_once), 1.,
                                      double(Stepper::guard_interval)));
      scene.steps_at_once(most, m.t_end);
      const bool due = scene.time() >= next - 1e-6 * scene.dt();
      if ((due || scene.done(m.t_end)) && scene.check())
        states.add(State(scene));
    }
    states.finish();
    r.steps = scene.steps(), r.evaluations = scene.evaluations();
    r.why = why_failed(scene);
    return r;
  }

  AtRest rest() const {
    Model m = model_;
    check_has_rest(m);
    m.from_rest = true, m.t_end = 0, m.step = {};
    return AtRest(Scene(m, mesh_));
  }

  /** The force on each node [N] in positions @a x [m] with velocities @a v. */
  std::vector<Point> force(std::span<const Point> x, std::span<const Point> v,
                           double t) {
    if (!at_hand_)
      at_hand_ =
          std::make_shared<Scene>(model_, mesh_, TimeStep(), *model_.method);
    Cloth& g = at_hand_->cloth();
    std::vector<Point> f(x.size());
    for (Node n : g.nodes())
      n.position() = x[n.index()], n.value().vel = v[n.index()];
    for (Node n : g.nodes()) f[n.index()] = at_hand_->force()(n, t);
    return f;
  }

 private:
  /** The net with its nodes at @a x, and its springs as long as before. */
  Net moved_to(std::vector<Point> x) const {
    if (!is_of_arrays_)
      throw SceneError("x0", "of a scene from a file",
                       "a Net: pins of a scene stand by their places");
    Net net = mesh_;
    for (Spring& s : net.springs)
      if (s.L < 0) s.L = norm(net.points[s.i] - net.points[s.j]);
    net.points = std::move(x);
    return net;
  }

  Model model_;
  Net mesh_;
  bool is_of_arrays_ = false;
  std::shared_ptr<Scene> at_hand_;  // of force()
};

}  // namespace lab
