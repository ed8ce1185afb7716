#include "lab/live/Live.hpp"

#include <algorithm>
#include <cmath>

#include "lab/fast/GraphArrays.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Interrupt.hpp"

namespace lab {

namespace {

/** The reference of a comparison: order 6, or 2 where there is contact. */
const MethodEntry& reference_method = table::srkn11b;
constexpr double reference_share = 1 / 3.;  // of its limit
constexpr double most_in_round = 1e4;       // steps of a scene

/** The steps of a rival in @a main steps of the main run, at least one.
 * @param ratio rival's step / main's step */
double steps_of_rival(int main, double ratio) {
  return std::clamp(std::round(main / ratio), 1., most_in_round);
}
/** Few steps of the main run in which each rival makes whole steps, of its
 * ratio to 2 %, if that is from 10^-4 to 10^4. */
int round_of(const std::vector<double>& ratios) {
  const auto error = [&](int main) {
    double most = 0;
    for (double ratio : ratios) {
      ratio = std::clamp(ratio, 1 / most_in_round, most_in_round);
      const double is = main / steps_of_rival(main, ratio) / ratio;
      most = std::max(most, std::max(is, 1 / is) - 1);
    }
    return most;
  };
  int best = 1;
  while (best < most_in_round && error(best) > 0.02) ++best;
  // One of a few more may be nearer.
  const double last = std::min(1.05 * best, most_in_round);
  for (int main = best; main <= last; ++main)
    if (error(main) < error(best)) best = main;
  return best;
}

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

/** The work of a step of @a dt [s] of @a s, if it ran by @a m. */
double work_of_step(const Scene& s, const MethodEntry& m, double dt) {
  return work_of_step(m.info, dt / dt_unit(s, table::verlet),
                      std::sqrt(double(s.cloth().num_nodes())));
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

Live::Side::Side(std::unique_ptr<Scene> s) : scene(std::move(s)) {
  scene->stepper().follow_drag();
  mark();
  sharp_limit = safe_limit;
}
void Live::Side::count() {
  work += double(scene->steps() - counted) * of_step;
  counted = scene->steps();
}
void Live::Side::mark() {
  count();
  changes_left = scene->changes_left();
  of_step = work_of_step(*scene, method(), scene->dt());
  safe_limit = scene->safe_limit();
  dt_unit = lab::dt_unit(*scene, method());
}

void Live::set_step(const MethodEntry& method, const TimeStep& step) {
  main_->scene->change_method(method, step);
  main_->mark();
  tune();
}

/** Fit steps to limits that may have changed. */
void Live::fit_steps() {
  const double before = main_->safe_limit;
  for (Side* side : sides()) side->mark();
  if (main_->safe_limit == before) return;
  if (main_->runs()) main_->scene->fit_step(), main_->mark();
  tune();
}

std::vector<Live::Side*> Live::sides() {
  std::vector<Side*> all{&*main_};
  for (Side& rival : rivals_) all.push_back(&rival);
  if (reference_) all.push_back(&*reference_);
  return all;
}
Live::Side Live::copy(const MethodEntry& method) const {
  const TimeStep step{.dt = main_->scene->dt()};
  return Side(std::make_unique<Scene>(*main_->scene, step, method));
}

/** Run copies of the present state beside it, in place of those that do. */
void Live::compare(const std::vector<Lane>& rivals) {
  if (!main_->runs()) return;
  rivals_.clear(), reference_.reset(), round_ = 1;
  if (rivals.empty()) return;
  if (const TimeStep& now = scene().stepper().time_step(); !now.fixed())
    set_step(main_->method(), {.dt = scene().dt(), .tolerance = now.tolerance});
  for (const Lane& r : rivals) {
    rivals_.push_back(copy(*r.method));
    rivals_.back().asked = r.share * rivals_.back().dt_unit;
  }
  reference_.emplace(copy(reference_method));
  tune();
}

/** Steps by which @a methods work as much a second as the main run does. */
std::vector<Live::Lane> Live::at_equal_work(
    const std::vector<const MethodEntry*>& methods) const {
  const Scene& s = *main_->scene;
  const double a_second = work_of_step(s, main_->method(), s.dt()) / s.dt();
  constexpr double longest = 1;  // [s]
  std::vector<Lane> all;
  for (const MethodEntry* method : methods) {
    double step = s.dt();
    for (int k = 0; k < 50; ++k)  // the work of a long implicit step is more
      step = std::min(longest, work_of_step(s, *method, step) / a_second);
    all.push_back({method, step / lab::dt_unit(s, *method)});
  }
  return all;
}

/** Give the rivals and the reference the steps by which all meet. */
void Live::tune() {
  if (rivals_.empty()) return;
  const double dt = main_->scene->dt();
  std::vector<double> ratios;
  for (const Side& rival : rivals_) ratios.push_back(rival.asked / dt);
  round_ = round_of(ratios);
  const double whole = round_ * dt;
  const auto set = [](Side& side, double step) {
    side.scene->change_method(side.method(), {.dt = step});
    side.mark();
  };
  for (Side& rival : rivals_)
    set(rival, whole / steps_of_rival(round_, rival.asked / dt));
  const double steps = whole / (reference_share * reference_->dt_unit);
  set(*reference_, whole / std::min(std::ceil(steps), most_in_round));
}

RunReadings Live::Side::readings(bool sharp) {
  RunReadings r;
  r.method = method().info.name;
  r.dt = scene->dt(), r.dt_unit = dt_unit;
  if (sharp) sharp_limit = scene->stepper().sharp_limit();
  r.safe_limit = safe_limit, r.sharp_limit = sharp_limit;
  r.steps = scene->steps(), r.time = scene->time();
  count(), r.work = work;
  r.energy = scene->energy();
  r.drift = scene->stepper().drift(r.energy);
  r.failure = scene->failure();
  return r;
}

Live::Live(const Model& m) : Live(m, mesh_of(m)) {}
Live::Live(const Model& m, Net mesh) {
  main_.emplace(std::make_unique<Scene>(m, std::move(mesh)));
  main_->scene->watch(m.t_end);
  start_nodes_ = scene().cloth().num_nodes();
  start_edges_ = scene().cloth().num_edges();
}

void Live::restart(const Model& m) {
  rivals_.clear(), reference_.reset(), round_ = 1;
  calls_ = 0, recording_.clear();
  main_->scene->restart();
  main_->scene->change_forces(m);
  set_step(*m.method, m.step);
}

bool Live::step() {
  if (done()) return false;
  ++calls_;
  for (int k = 0; k < round_ && !done() && !interrupted(); ++k)
    main_->scene->step(model().t_end);
  const double time = main_->scene->time();
  for (Side* side : sides()) {
    if (side == &*main_ || !side->runs()) continue;
    Scene& s = *side->scene;
    while (!s.done(time) && !interrupted())
      s.steps_at_once(Stepper::guard_interval, time);
    s.check();
  }
  if (main_->changes_left != scene().changes_left()) fit_steps();
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
  if (!reference_) return r;
  const Cloth& right = reference()->cloth();
  r.error = distance(g, right);
  for (Side& rival : rivals_) {
    const Cloth& other = rival.scene->cloth();
    r.rivals.push_back(
        {.readings = rival.readings(sharp), .error = distance(other, right)});
  }
  return r;
}

std::string Live::recording() const {
  return recording_ + std::to_string(calls_) + " end\n";
}

}  // namespace lab
