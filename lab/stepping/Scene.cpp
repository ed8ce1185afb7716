#include "lab/stepping/Scene.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "CME212/Util.hpp"
#include "lab/fast/Energy.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Interrupt.hpp"
#include "lab/stepping/Trial.hpp"

namespace lab {

Scene::Scene(const Model& m) : Scene(m, mesh_of(m)) {}
Scene::Scene(const Model& m, Net mesh)
    : Scene(m, std::move(mesh), m.step, *m.method) {}
Scene::Scene(const Model& m, Net mesh, const TimeStep& step,
             const MethodEntry& method)
    : made_of_(m),
      model_(m),
      mesh_{std::move(mesh), {}},
      stepper_(build(), step, method),
      first_(method),
      changes_(read_changes(m.at)) {
  begin();
}

Scene::Scene(const Scene& other, const TimeStep& step,
             const MethodEntry& method)
    : made_of_(other.made_of_),
      model_(other.model_),
      mesh_(other.mesh_),
      held_(other.held_),
      built_(other.built_),
      rest_(other.rest_),
      stepper_(hold(), step, method, other.time()),
      first_(method),
      changes_(other.changes_.begin() + std::ptrdiff_t(other.made_),
               other.changes_.end()),
      changed_(true) {
  if (method.info.name != other.method().name)
    std::erase_if(changes_,
                  [](const Change& c) { return c.name() == "method"; });
  if (other.stepper_.follows_drag()) stepper_.follow_drag();
  begin();
}

void Scene::begin() {
  stepper_.confirm_by([this](const Energies& e) { return confirms(e); });
  await_change();
}

/** Build the system as it starts.  @return it */
System& Scene::build() {
  Cloth& g = built_.cloth;
  g.clear();
  build_model(g, model_, mesh_.mesh);
  mesh_.ids = ids_of(g);
  take_forces(force_of(model_, mesh_.mesh, g));
  built_.hand.reset();
  held_ = held_of(model_, mesh_.mesh, g);
  built_.watched.emplace(constraint_of(model_, mesh_.mesh, g));
  if (model_.from_rest)
    rest_ = Equilibrium(model_, g, built_.acting, *built_.watched).find();
  built_.overlaps = false;
  for (Node n : g.nodes())
    built_.overlaps |= model_.starts_inside(n.position());
  if (const auto& most = model_.tear_strain)
    for (Edge e : g.edges())
      built_.overlaps |= e.length() > (1 + *most) * e.value().L;
  return built_;
}

void Scene::take_forces(CombinedForces acting) {
  built_.acting = std::move(acting);
  built_.potential = ForcePlan(built_.acting).potential();
  built_.wind = model_.wind ? model_.wind->velocity : Point();
}

/** Make the constraint anew, with the pins held_.  @return the system */
System& Scene::hold() {
  built_.overlaps = false;
  built_.watched.emplace(constraint_of(model_, built_.cloth, held_));
  return built_;
}

void Scene::restart() {
  changed_ = false, diagnosis_.reset(), made_ = 0;
  if (first_.info.name != method().name)
    stepper_.change_method(first_, stepper_.time_step());
  model_ = made_of_;
  build();
  stepper_.restart();
  await_change();
  if (witness_) witness_->restart();
}

// ------------------------------------------------------------------- Changes

template <typename Change>
void Scene::edit(Change change) {
  stepper_.edit(change);
  note_change(true);
}

void Scene::change_method(const MethodEntry& method, const TimeStep& step) {
  stepper_.change_method(method, step);
  if (!makes_) first_ = method;
  note_change(steps() > 0);
}

void Scene::take_method(const MethodEntry& method) {
  TimeStep step = stepper_.time_step();
  if (step.fixed()) step.dt = dt();
  try {
    change_method(method, step);
  } catch (const std::invalid_argument&) {  // it can't choose
    step.dt = dt(), step.rule = StepRule::fixed;
    change_method(method, step);
  }
}

void Scene::fit_step() {
  if (!stepper_.time_step().fixed() && dt() > safe_limit())
    change_method(stepper_.method_entry(), stepper_.time_step());
}

/** @param by_hand it is a change that no finer run makes by itself */
void Scene::note_change(bool by_hand) {
  if (makes_) return;
  changed_ |= by_hand;
  diagnosis_.reset();
  if (witness_) witness_->change();
}

/** Let the next change of Model::at come when it is due. */
void Scene::await_change() {
  stepper_.at(changes_left() > 0 ? changes_[made_].time : no_limit,
              [this] { make_change(); });
}

void Scene::make_change() {
  makes_ = true;
  Line words(changes_[made_++].request);
  scene_requests().find(words)->run(words, this);
  fit_step();
  makes_ = false;
  await_change();
}

Scene::Limit Scene::least_limit() const {
  Limit least = {safe_limit()};
  if (changes_.empty()) return least;
  Scene ahead(made_of_, mesh_.mesh, stepper_.time_step(), first_);
  while (ahead.changes_left() > 0) {
    const double since = ahead.changes_[ahead.made_].time;
    ahead.make_change();
    if (const double limit = ahead.safe_limit(); limit < least.limit)
      least = {limit, since};
  }
  return least;
}

void Scene::archive(Archive& a) {
  std::string made;
  for (std::size_t k = 0; k < made_; ++k) made += changes_[k].request + '\n';
  a(made);
  if (a.loads()) {
    std::string before;
    while (before.size() < made.size() && changes_left() > 0) {
      before += changes_[made_].request + '\n';
      if (made.starts_with(before)) make_change();
    }
    if (before != made)
      throw SceneError("at",
                       "does not begin with the changes that were made "
                       "until the checkpoint");
  }
  for (HeldNodes& h : held_)
    for (auto& [id, place] : h.nodes) a(place);
  if (a.loads() && made_ > 0) stepper_.edit([this] { hold(); });
  stepper_.archive(a);
  Witness::archive(a, witness_.get());
}

void Scene::change_forces(const Model& m) {
  Cloth fresh;  // has the ids that this cloth had when it was built
  build_model(fresh, m, mesh_.mesh);
  CombinedForces acting = force_of(m, mesh_.mesh, fresh);
  if (!makes_) made_of_ = m;
  stepper_.edit([&] {
    model_ = m;
    take_forces(std::move(acting));
    for (Edge e : cloth().edges())
      e.value().K = arrays(fresh).edge_values()[e.id()].K;
    stepper_.forget_limits();
    stepper_.make_method();
  });
  note_change(steps() > 0);
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
  if (!is_there(cloth(), node) || is_pinned(node)) return false;
  edit([&] {
    arrays(cloth()).node_values()[node].vel = Point();
    if (held_.empty() || held_.back().motion.moves()) held_.emplace_back();
    auto& nodes = held_.back().nodes;
    nodes.insert(
        std::ranges::lower_bound(nodes, node, {}, &HeldNodes::Held::id),
        {node, arrays(cloth()).positions()[node]});
    hold();
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
    hold();
    // A pin may have held the node in an obstacle, which pushes it out now.
    if (!model_.planes.empty() || !model_.spheres.empty()) try {
        (*built_.watched)(cloth(), time());
      } catch (const StepError&) {  // the next step says why
      }
    stepper_.forget_limits();
  });
  return true;
}

unsigned Scene::cut(std::span<const std::array<unsigned, 2>> edges) {
  unsigned count = 0;
  edit([&] {
    const auto node = [this](unsigned id) {
      return is_there(cloth(), id) ? arrays(cloth()).node_with_id(id) : Node();
    };
    for (const auto& [i, j] : edges)
      count += cloth().remove_edge(node(i), node(j));
  });
  return count;
}

bool Scene::grab(unsigned node, const Point& target) {
  constexpr double share = 1 / 8., weights = 2;
  if (!is_there(cloth(), node)) return false;
  double sum = 0;  // of K [N/m]
  for (Edge e : arrays(cloth()).node_with_id(node).edges()) sum += e.value().K;
  pull(HandForce(node, target, share * sum,
                 weights * total_mass(cloth()) * grav));
  return true;
}

void Scene::move_hand(const Point& target) {
  HandForce hand = *built_.hand;
  hand.move(target);
  pull(hand);
}

void Scene::release() { pull(std::nullopt); }

/** Continue with @a hand, or with none. */
void Scene::pull(std::optional<HandForce> hand) {
  stepper_.set_hand(std::move(hand));
  changed_ = true;
  if (witness_) witness_->change();
}

// ------------------------------------------------------------------- Failure

std::string Scene::missed_text(CureName name) const {
  if (watched().count() == 0) return "";
  using CME212::short_text;
  const auto& missed = watched().first();
  const double share =
      std::min(0.5, watched().inner().thinnest() / missed.length);
  const MethodEntry& method = stepper_.method_entry();
  return "node " + std::to_string(missed.node) + " moved " +
         short_text(missed.length) +
         " m in the step to t = " + short_text(time()) +
         " s and would have tunnelled through an obstacle; it was put on the "
         "surface. Use " +
         (Cure{method, share * dt()}.*name)(method);
}

namespace {

FailedRun failed_run(const Scene& s) {
  const Stepper& stepper = s.stepper();
  const MethodEntry& method = stepper.method_entry();
  const auto& failure = s.failure();  // none: its energy is wrong
  FailedRun run = {.method = method, .dt = s.dt(), .time = no_limit};
  if (failure && failure->kind == Failure::Kind::start) return run;
  run.time = std::min(s.time() + s.dt(), stepper.t_end());
  run.solver = failure && failure->kind == Failure::Kind::refused;
  run.sharp = stepper.sharp_limit(40);
  run.safe = s.safe_limit();
  run.safe_without_drag = stepper.limits().safe_without_drag(method);
  run.verlet = s.safe_limit(table::verlet);
  run.flat = is_flat(s.cloth());
  const Verdict* verdict = s.witness() ? s.witness()->said() : nullptr;
  run.rigid =
      !failure && verdict &&
      (verdict->scale <= verdict->slack || verdict->gain > 2 * verdict->mine);
  if (failure || !verdict) return run;
  if (!verdict->has_answer()) run.asked = verdict->asked;
  if (!verdict->gains() && !verdict->is_off()) run.apart = verdict->apart;
  return run;
}

/** Run with @a cure until @a t_end, or until it took @a left, and let a witness
 * judge that run: one that does not fail may still be wrong. */
Attempt attempt(const Scene& failed, const Cure& cure, double t_end,
                double left) {
  try {
    const auto trial = failed.anew(cure);
    t_end = std::min(t_end, trial->time() + left / trial->work_of(1) * cure.dt);
    trial->watch(t_end, true);
    Observer observer(*trial);
    if (!trial->run_to(t_end, observer.after_steps()))
      return {false, trial->time()};
    if (!trial->witness()) return {true, trial->time()};
    const Verdict& v = trial->witness()->verdict(&observer);
    return {!v.wrong() && !v.was_off(), trial->time(), v.apart, v.answer};
  } catch (const std::invalid_argument&) {  // not with this force
    return {false, 0};
  }
}

}  // namespace

const Diagnosis& Scene::diagnosis() const {
  if (diagnosis_) return *diagnosis_;
  const FailedRun run = failed_run(*this);
  const double t_end = stepper_.t_end();
  const bool ends = std::isfinite(t_end);  // else somebody waits for the cure
  const double end = ends ? t_end : std::max(5., 2 * run.time);
  return diagnosis_.emplace(diagnose(run, [&](const Cure& cure) {
    return attempt(*this, cure, end, trial_work);
  }));
}

Explanation Scene::explanation() const {
  try {
    return {*failure(), &diagnosis()};
  } catch (const Interrupted&) {
    return {*failure(), nullptr};
  }
}

std::string Scene::remedy(CureName name) const {
  try {
    return diagnosis().remedy_text(name);
  } catch (const Interrupted&) {
    return Explanation::interrupted;
  }
}

void Scene::watch(double t_end, bool whole) {
  const auto is_it = [this](const MethodEntry& m) {
    return m.info.name == method().name;
  };
  if (std::ranges::any_of(methods, is_it))
    witness_ = std::make_unique<Witness>(*this, t_end, whole);
}

const Verdict* Scene::wrong() const {
  if (failure() || control() || !witness_) return nullptr;
  const Verdict& verdict = witness_->verdict();
  return verdict.wrong() ? &verdict : nullptr;
}

/** @a share of the present step; of steps that are chosen, of the mean one. */
TimeStep Scene::finer_step(double share) const {
  constexpr double usual = 1e-6, stricter = 16;  // RungeKutta
  TimeStep step = {.dt = share * dt()};
  if (control() && steps() > 0)
    step.dt = share * std::min(dt(), time() / double(steps()));
  if (const double t = stepper_.time_step().tolerance; method().adaptive)
    step.tolerance = (t > 0 ? t : usual) / (share < 1 ? stricter : 1);
  return step;
}

std::unique_ptr<Scene> Scene::finer() const {
  if (changed_) return branch(0.5);
  auto finer =
      std::make_unique<Scene>(made_of_, mesh_.mesh, finer_step(0.5), first_);
  finer->stepper_.confirm_by([](const Energies&) { return true; });
  return finer;
}

std::unique_ptr<Scene> Scene::branch(double share) const {
  auto branch = std::make_unique<Scene>(*this, finer_step(share),
                                        stepper_.method_entry());
  branch->stepper_.confirm_by([](const Energies&) { return true; });
  return branch;
}

/** Has a finer run, from an earlier state, this energy now, too, to 10 %? */
bool Scene::confirms(const Energies& e) const {
  constexpr double same = 1.1;
  const Scene* kept = witness_ ? witness_->kept() : nullptr;
  if (!kept && (changed_ || work_of(2 * double(steps())) > trial_work))
    return false;
  const auto other = kept ? kept->branch(1) : finer();
  if (other->time() >= time() || !other->run_to(time())) return false;
  const double mine = e.internal(), there = other->energy().internal();
  return mine <= same * there && there <= same * mine;
}

std::unique_ptr<Scene> Scene::anew(const Cure& cure) const {
  const TimeStep step = {.dt = cure.dt,
                         .tolerance = cure.method.info.adaptive
                                          ? stepper_.time_step().tolerance
                                          : 0};
  if (!changed_)
    return std::make_unique<Scene>(made_of_, mesh_.mesh, step, cure.method);
  const Scene* kept = witness_ ? witness_->kept() : nullptr;
  return std::make_unique<Scene>(kept ? *kept : *this, step, cure.method);
}

std::unique_ptr<Scene> Scene::beyond_failure(double distance) const {
  const auto copy = [this] {
    auto scene = std::make_unique<Scene>(
        *this,
        TimeStep{.dt = dt(), .tolerance = stepper_.time_step().tolerance},
        stepper_.method_entry());
    scene->stepper_.set_failure(failure());
    return scene;
  };
  auto ahead = copy();
  const auto is_far = [&] {
    const auto now = arrays(std::as_const(ahead->cloth())).positions();
    for (Node n : cloth().nodes())
      if (arrays(ahead->cloth()).node_in_use(n.id()) &&
          norm(now[n.id()] - n.position()) > distance)
        return true;
    return false;
  };
  for (int left = 1000; left > 0 && !is_far() && ahead->stepper_.advance();
       --left)
    if (interrupted()) break;
  return ahead->stepper_.is_finite() ? std::move(ahead) : copy();
}

}  // namespace lab
