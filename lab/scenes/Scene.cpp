#include "lab/scenes/Scene.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "CME212/Util.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Checkpoint.hpp"
#include "lab/stability/StepLimit.hpp"

namespace lab {

namespace {
constexpr double no_step = 1e-9;  // of a step
static_assert(TimeStep{}.gain == energy_tolerance);
}  // namespace

Scene::Scene(Recipe recipe, const TimeStep& step, const MethodEntry& method)
    : recipe_(std::move(recipe)), step_(step), entry_(method) {
  restart();
}
Scene::Scene(const Model& m) : Scene(recipe_of(m), m.step, *m.method) {}

void Scene::restart() {
  cloth_.clear();
  recipe_.build(cloth_);
  acting_ = recipe_.force(cloth_);
  force_.reset(), hand_.reset(), changed_ = false;
  make_method();
  evaluations_ = 0, work_ = {};
  held_.clear();
  if (recipe_.held) held_ = recipe_.held(cloth_);
  plan_forces();
  watched_.emplace(recipe_.constraint(cloth_));
  constraint_ = *watched_;
  balance_.emplace(cloth_, 0, acting_, constraint_, recipe_.gravity);
  clock_ = {.dt = step_.dt};
  safe_omega_ = -1;
  start_energy_ = energy().total();
  failure_.clear();
  worst_.reset();
  diagnosis_.reset();
  if (!is_finite()) {
    worst_.emplace(cloth_);
    failure_ = "the energy at the start is not finite: " + worst_->text(cloth_);
  } else if (!step_.fixed()) {
    choose_step();
  }
  guard_.emplace(cloth_, recipe_.gravity, clock_.dt, flow());
  keep_clock();
  start_control();
  if (watch_) watch_.emplace(energy(), clock_.dt, *guard_);
}

void Scene::watch_energy(double t_end) {
  constexpr double looks = 64;
  watch_interval_ =
      int(std::clamp(t_end / clock_.dt / looks, 1., double(guard_interval)));
  watch_.emplace(energy(), clock_.dt, *guard_);
}

Work Scene::work() const {
  Work all = work_;
  return all += method_->work();
}

/** The plan of all that acts: what the recipe has, and the hand. */
void Scene::plan_forces() {
  CombinedForces::List all = acting_.parts();
  if (hand_) all.push_back({std::shared_ptr<void>(), &*hand_});  // it moves
  if (force_) evaluations_ += force_->evaluations();
  force_.emplace(CombinedForces(std::move(all)));
}

/** Choose the steps from here on, if they are to be chosen. */
void Scene::start_control() {
  control_.reset();
  if (!failure_.empty()) return;
  if (!step_.fixed() || follows_drag_) start_drag();
  if (step_.fixed()) return;
  const double longest = longest_step();
  if (longest < clock_.dt) clock_.set_dt(longest);
  const Energies now = energy();
  control_.emplace(
      clock_.dt, now,
      StepControl::Limits{.share = step_.gain,
                          .floor = guard_->floor(),
                          .rest = guard_->round_off() + 1e-10 * now.internal(),
                          .longest = longest,
                          .early = entry_.info.order == 1},
      flow());
  looked_ = time();
  keep_both();
}

/** A step beyond which the method takes energy that only drag should take. */
double Scene::longest_step() const {
  if (drag_.none() || entry_.info.multirate) return no_limit;
  if (safe_omega_ < 0) safe_limit();
  return mild_step(entry_, clock_.dt, with_hand(safe_omega_), largest_gamma_,
                   step_.gain);
}

void Scene::start_drag() {
  drag_ = force_->drag(), largest_gamma_ = largest_gamma(cloth_, drag_);
  drag_power_ = drag_.power(cloth_);
  sampled_ = time();
}

void Scene::follow_drag() {
  follows_drag_ = true;
  if (!control_) start_drag();
}

double Scene::drift(const Energies& now) const {
  const EnergyFlow& f = flow();
  return now.total() - start_energy_ - f.work + f.removed + drag_loss();
}

double Scene::drag_loss() const {
  const double power = drag_.power(cloth_);
  return flow().drag + 0.5 * (drag_power_ + power) * (time() - sampled_);
}

void Scene::Clock::archive(Archive& a) {
  a(dt)(from)(steps)(from_steps);
  a.require(dt > 0 && std::isfinite(dt) && from >= 0 && 0 <= from_steps &&
            from_steps <= steps && steps < 1LL << 53 && std::isfinite(time()));
}

void Scene::archive(Archive& a) {
  archive_cloth(a, cloth_);
  a(clock_)(checked_)(flow_)(safe_omega_);
  const auto not_after = [&](const Clock& c) {
    return c.steps <= clock_.steps && c.time() <= clock_.time();
  };
  a.require(std::isfinite(safe_omega_) && not_after(checked_) &&
            clock_.steps - checked_.steps <= guard_interval);
  watched_->archive(a);
  balance_->archive(a);
  guard_->archive(a);
  method_->archive(a, cloth_);
  if (a.loads()) version_ = cloth_.version();
  long long evaluated = evaluations();
  Work worked = work();
  a(evaluated)(worked)(sampled_)(drag_power_);
  if (a.loads())
    evaluations_ = evaluated - force_->evaluations(), work_ = worked;
  a.require(clock_.dt == (control_ ? clock_.dt : step_.dt) && evaluated >= 0 &&
            std::min({worked.inner, worked.newton, worked.products,
                      worked.factors}) >= 0 &&
            sampled_ <= time() && std::isfinite(sampled_ + drag_power_));
  if (watch_) a(*watch_);
  if (!control_) return;
  control_->archive(a);
  a(looked_);
  a.require(clock_.dt <= control_->dt() && looked_ <= time() &&
            std::isfinite(looked_));
  for (Snapshot* s : {&before_, &latest_}) {
    bool whole = s->version == cloth_.version();  // nothing torn since
    a(s->nodes)(s->clock)(s->flow)(s->control)(whole);
    a.require(not_after(s->clock));
    if (a.loads()) s->version = whole ? cloth_.version() : ~cloth_.version();
  }
}

bool Scene::steps_at_once(int most, double t_end) {
  t_end_ = t_end;
  if (control_ && control_->lengthen(flow()))
    clock_.set_dt(without_resonance(control_->dt()));
  const bool steered = control_ && control_->can_shorten();
  most = steps_to_look(most);
  if (!advance(most))
    return steered ? take_back() : replay(clock_.steps + most);
  const bool now = cloth_.version() != version_ || done(t_end);
  const bool judged =
      control_ && (now || clock_.steps % StepControl::look_interval == 0);
  const bool guarded = now || clock_.steps - checked_.steps >= guard_interval;
  const bool watched = watch_ && (now || clock_.steps % watch_interval_ == 0);
  if ((control_ || follows_drag_) && !drag_.none())
    sample_drag(now || (guarded && !control_));
  if (!judged && !guarded && !watched) return true;
  const Energies e = energy();
  if (watched) watch_->look(e);
  if (judged && !judge(e)) return take_back();
  return !guarded || look(e);
}

bool Scene::check() {
  if (!failure_.empty()) return false;
  return is_finite() || replay(clock_.steps);
}

Energies Scene::energy() const {
  return energies(cloth_, recipe_.gravity, flow());
}

bool Scene::is_finite() const { return std::isfinite(energy().total()); }

/** Steps between two samples of drag. */
int Scene::drag_interval() const {
  constexpr double most = 0.005;  // of a velocity
  return int(std::clamp(most / (largest_gamma_ * clock_.dt), 1.,
                        double(StepControl::look_interval)));
}

/** How many steps, up to @a most, nobody has to look at but the last one; 1 if
 * work is done on the cloth, which is summed up step by step. Symplectic Euler
 * puts held nodes where they were to be at the start of a step, so what comes
 * to rest moves them once more. */
int Scene::steps_to_look(int most) const {
  if (hand_ || !constraint_.is_at_rest(time() - clock_.dt)) return 1;
  const auto up_to_multiple = [&](int interval) {
    most = std::min(most, interval - int(clock_.steps % interval));
  };
  most = std::min(most, guard_interval - int(clock_.steps - checked_.steps));
  if (watch_) up_to_multiple(watch_interval_);
  if (control_) up_to_multiple(StepControl::look_interval);
  if ((control_ || follows_drag_) && !drag_.none()) {
    up_to_multiple(drag_interval());
    up_to_multiple(StepControl::look_interval);
  }
  return std::max(most, 1);
}

/** Add what drag took since the last sample, if velocities may have changed
 * since then, or if there is a look @a now. */
void Scene::sample_drag(bool now) {
  if (!now && clock_.steps % drag_interval() != 0 &&
      clock_.steps % StepControl::look_interval != 0)
    return;
  const double power = drag_.power(cloth_);
  balance_->add_drag(0.5 * (drag_power_ + power) * (time() - sampled_));
  drag_power_ = power, sampled_ = time();
}

/** Of the one who chooses the step, at the energy @a e.
 * @return false: take it back */
bool Scene::judge(const Energies& e) {
  const double h = time() - looked_;
  looked_ = time();
  using Verdict = StepControl::Verdict;
  const Verdict verdict = control_->look(e, flow(), h, time() / t_end_);
  if (verdict == Verdict::take_back) return false;
  if (cloth_.version() != version_) {
    keep_both();  // what is gone does not come back
  } else if (verdict == Verdict::keep) {
    std::swap(before_, latest_);
    keep(latest_);
  }
  return true;
}

/** Make the present state one to go back to. */
void Scene::keep(Snapshot& s) const {
  s.nodes.keep(cloth_);
  s.clock = clock_, s.flow = flow(), s.control = control_->state();
  s.version = cloth_.version();
}
void Scene::keep_both() {
  keep(latest_);
  before_ = latest_;
}

/** On from a state before, by a shorter step.  @return true: no failure */
bool Scene::take_back() {
  const long long steps = clock_.steps - before_.clock.steps;
  before_.nodes.restore(cloth_);
  EnergyFlow flow = before_.flow;
  if (cloth_.version() != before_.version)  // torn meanwhile
    flow.removed += before_.control.last + flow.work - flow.removed -
                    flow.drag - energy().total();
  clock_ = before_.clock;
  control_->take_back(before_.control, steps);
  clock_.set_dt(without_resonance(control_->dt()));
  balance_->resume(cloth_, time(), constraint_, flow);
  method_->restart();
  looked_ = sampled_ = time(), drag_power_ = drag_.power(cloth_);
  keep_both();
  guard_->keep(cloth_);
  keep_clock();
  return true;
}

/** Of the guard, at the energy @a e. */
bool Scene::look(const Energies& e) {
  if (!guard_->accept(cloth_, e, flow()))
    return control_ && control_->can_shorten() ? take_back()
                                               : replay(clock_.steps);
  keep_clock();
  return true;
}

bool Scene::run_to(double t_end) {
  while (!done(t_end)) steps_at_once(guard_interval, t_end);
  return check();
}

bool Scene::run_to(double t_end, const std::function<void()>& after) {
  while (!done(t_end)) {
    step(t_end);
    after();
  }
  return check();
}

/** The force whose stiffness bounds the step of @a method. */
ForcePlan Scene::bounding(const MethodEntry& method) const {
  return method.info.multirate ? soft_stiffness(cloth_, *force_, constraint_)
                               : *force_;
}

double Scene::safe_limit(const MethodEntry& method) const {
  if (method.info.multirate)
    return step_limit(
        method, with_hand(omega_safe(cloth_, bounding(method), constraint_)),
        largest_gamma(cloth_, force_->drag()));
  if (safe_omega_ < 0) safe_omega_ = omega_safe(cloth_, *force_, constraint_);
  return step_limit(method, with_hand(safe_omega_),
                    largest_gamma(cloth_, force_->drag()));
}

std::optional<Resonances> Scene::resonances() const {
  if (!entry_.info.multirate) return std::nullopt;
  auto split = split_springs(cloth_, force_->springs(), constraint_);
  if (split.empty()) return std::nullopt;
  const double soft = omega_safe(cloth_, bounding(entry_), constraint_);
  return Resonances(std::move(split), with_hand(soft));
}

/** A step up to @a dt that does not resonate. */
double Scene::without_resonance(double dt) const {
  const auto r = resonances();
  return r ? r->below(dt) : dt;
}

double Scene::sharp_limit(int products) const {
  return step_limit(
      entry_,
      with_hand(sharp_(cloth_, bounding(entry_), constraint_, products)),
      largest_gamma(cloth_, force_->drag()));
}

/** A bound of omega [1/s] with the hand, if it is @a omega without. */
double Scene::with_hand(double omega) const {
  if (!hand_ || !cloth_.node_in_use(hand_->node())) return omega;
  const double m = cloth_.node_values()[hand_->node()].mass;
  return std::sqrt(omega * omega + hand_->stiffness() / m);
}

void Scene::keep_clock() {
  checked_ = clock_;
  flow_ = balance_->flow();
  version_ = cloth_.version();
  watch_paths();
}

/** From here on, if nodes get fast for the obstacles. Speeds are looked at here
 * only, so with room for them to grow. */
void Scene::watch_paths() {
  const double thin = watched_->thinnest();
  if (!std::isfinite(thin)) return;
  const double gain = std::abs(recipe_.gravity) * guard_interval * clock_.dt;
  watched_->watch(cloth_, (max_speed(cloth_) + gain) * clock_.dt > thin / 8);
}

void Scene::choose_step() {
  double dt = safe_share * safe_limit();
  if (step_.rule == StepRule::sharp) {
    // A cloth let go flat stiffens by 40 % within fewer steps than lie between
    // two looks: so never beyond what holds in every configuration.
    dt = std::min(sharp_share * sharp_limit(), safe_limit());
  }
  if (entry_.info.adaptive)
    throw std::invalid_argument(
        std::string(entry_.info.name) +
        " chooses its inner steps by their error: leave --dt away, and say "
        "how exactly by --tolerance");
  if (!(dt > 0 && std::isfinite(dt)))
    throw std::invalid_argument(std::string("nothing bounds the step of ") +
                                entry_.info.name +
                                (dt > 0 ? " here" : ": it has no stable step") +
                                ", so it can't be chosen: give a number");
  clock_.set_dt(without_resonance(dt));
}

/** One step, or up to @a most of dt, the last of which may change the graph; no
 * look at what came out.  @return false if one of them can't be made */
bool Scene::advance(int most) {
  const double dt = clock_.dt;
  const double end = std::min(t_end_, constraint_.next_velocity_jump(time()));
  const double left = (end - time()) / dt;  // in steps
  const bool last = left < 1 + no_step, whole = std::abs(left - 1) < no_step;
  const double h = whole || left > 2 - no_step ? dt
                   : last                      ? end - time()
                                               : (end - time()) / 2;
  const double then = last ? end : time() + h;
  const StepTimes times = {clock_.from, dt, clock_.steps - clock_.from_steps};
  int count = 1;  // steps of dt
  while (count < most && (end - times(count)) / dt > 2 - no_step) ++count;
  error_.clear();
  try {
    if (h == dt && count > 1)
      count = method_->steps(cloth_, times, count, *force_, constraint_);
    else
      method_->step(cloth_, time(), h, *force_, constraint_), count = 1;
  } catch (const StepError& e) {
    error_ = e.what();
    return false;
  }
  clock_.steps += count;
  if (last || h != dt) clock_.set_time(then);
  balance_->follow(cloth_, time(), constraint_);
  return true;
}

/** From the last good state on, step by step, until one fails.
 * @param last the step known to fail  @return false if one did */
bool Scene::replay(long long last) {
  rewind();
  while (clock_.steps < last && time() < t_end_) {
    if (!advance()) return fail("failed (" + error_ + ")");
    if (!guard_->accept(cloth_, flow())) return fail("diverged");
    keep_clock();
  }
  return true;  // what was torn meanwhile is gone, so it may go well now
}

void Scene::rewind() {
  guard_->restore(cloth_);
  clock_ = checked_;
  balance_->resume(cloth_, time(), constraint_, flow_);
  if (follows_drag_ && !control_) start_drag();
  method_->restart();
  watch_paths();
}

/** Say what happened to the step, and go back to before it. */
bool Scene::fail(const std::string& what) {
  using CME212::short_text;
  worst_.emplace(cloth_);
  const std::string where = worst_->text(cloth_);
  rewind();
  failure_ = what + " in step " + std::to_string(clock_.steps + 1) +
             " with dt = " + short_text(clock_.dt) + " s, method " +
             entry_.info.name + ": " + where + "; the last good state is " +
             "that of t = " + short_text(time()) + " s";
  return false;
}

}  // namespace lab
