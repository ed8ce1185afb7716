/** @file Stepper.cpp
 * In the order of the calls: the start of a run, a step, the checks. */
#include "lab/stepping/Stepper.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "CME212/Util.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/scenes/Interrupt.hpp"
#include "lab/stepping/Checkpoint.hpp"

namespace lab {

namespace {
constexpr double no_step = 1e-9;  // of dt: a rest that is skipped
static_assert(TimeStep{}.gain == energy_tolerance);
}  // namespace

// --------------------------------------------------------------------- A run

Stepper::Stepper(System& system, const TimeStep& step,
                 const MethodEntry& method, double t)
    : system_(system), step_(step), entry_(method) {
  restart(t);
}

void Stepper::restart(double t) {
  limits_.forget();
  clock_ = {.dt = step_.dt, .from = t};
  make_method();
  plan();
  evaluations_ = 0, work_ = {};
  start_energy_ = energies(system_.cloth, system_.potential).total();
  if (!step_.fixed() && std::isfinite(start_energy_))
    clock_.set_dt(limits_.chosen(entry_, step_.rule));
  EnergyFlow flow;
  if (system_.overlaps) flow.work = remove_overlaps();
  start(flow);
}

/** Let the constraints act on the initial state.
 * @return their work [J]; 0 if they can't: then the first step fails. */
double Stepper::remove_overlaps() {
  NodeStates before;
  before.keep(system_.cloth);
  try {
    constraint_(system_.cloth, time());
  } catch (const StepError&) {
    before.restore(system_.cloth);
  }
  return energies(system_.cloth, system_.potential).total() - start_energy_;
}

void Stepper::make_method() {
  if (method_) work_ += method_->work();
  method_ = entry_.make();
  if (step_.tolerance > 0) method_->set_tolerance(step_.tolerance);
}

/** Continue from the present state, in which anything may have changed, with
 * the energy @a flow until now. */
void Stepper::start(const EnergyFlow& flow) {
  plan();
  failure_.reset();
  balance_.emplace(system_.cloth, time(), system_.acting, constraint_,
                   system_.potential.gravity);
  go_on(clock_, flow);
  hand_changed();
  guard_.emplace(system_.cloth, system_.potential, clock_.dt, this->flow());
  if (!is_finite())
    failure_ = {Failure::Kind::start, WorstPlace(system_.cloth),
                std::string(entry_.info.name), time(), dt()};
  start_control();
}

/** Make the plans of all forces, with the hand, and of the constraint. */
void Stepper::plan() {
  CombinedForces::List all = system_.acting.parts;
  if (system_.hand)
    all.push_back({std::shared_ptr<void>(), &*system_.hand});  // it moves
  if (force_) evaluations_ += force_->evaluations();
  force_.emplace(CombinedForces(std::move(all)));
  constraint_ = *system_.watched;
}

void Stepper::change_method(const MethodEntry& method, const TimeStep& step) {
  settle();
  const double dt = step.fixed() ? step.dt : limits_.chosen(method, step.rule);
  edit([&] {
    entry_ = method, step_ = step;
    clock_.set_dt(dt);
    make_method();
  });
}

void Stepper::set_hand(std::optional<HandForce> hand) {
  settle();
  system_.hand = std::move(hand);
  hand_changed();
}

void Stepper::hand_changed() {
  plan();
  method_->restart();
  if (const auto& hand = system_.hand;
      hand && arrays(system_.cloth).node_in_use(hand->node()))
    balance_->watch(arrays(system_.cloth).node_with_id(hand->node()), &*hand,
                    time());
  else
    balance_->watch({}, nullptr, time());
}

/** Start to choose steps, unless they are fixed. */
void Stepper::start_control() {
  control_.reset();
  if (failure_) return;
  const bool has_wind = system_.wind != Point();  // it gives energy: Guard
  if (!step_.fixed() || follows_drag_ || has_wind) start_drag();
  if (step_.fixed()) return;
  const double longest = limits_.mild(entry_, drag_, clock_.dt, step_.gain);
  if (longest < clock_.dt) clock_.set_dt(longest);
  const Energies now = energy();
  control_.emplace(
      clock_.dt, now,
      StepControl::Limits{.share = step_.gain,
                          .floor = guard_->floor(),
                          .rest = guard_->round_off() + 1e-10 * now.internal(),
                          .longest = longest,
                          .early = entry_.info.ahead()},
      flow());
  looked_ = time();
  keep_both();
}

void Stepper::start_drag() {
  drag_ = force_->drag(), largest_gamma_ = largest_gamma(system_.cloth, drag_);
  keep_sample();
}

void Stepper::follow_drag() {
  follows_drag_ = true;
  if (!control_) start_drag();
}

bool Stepper::run_to(double t_end, const std::function<void()>& after) {
  while (!done(t_end)) {
    steps_at_once(after ? 1 : guard_interval, t_end);
    if (after) after();
    end_if_interrupted();
  }
  return check();
}

// -------------------------------------------------------------------- A step

/** True if pins, obstacles or the hand do work, which is added up step by step.
 * Symplectic Euler puts held nodes to their places at the start of a step, so
 * after a pin has stopped they move once more. */
static bool works(const System& s, const StepClock& c) {
  return s.hand || !s.watched->inner().is_at_rest(c.time() - c.dt);
}

bool Stepper::steps_at_once(int most, double t_end) {
  t_end_ = t_end;
  while (event_time_ <= time() + no_step * clock_.dt) {
    event_time_ = no_limit;
    std::exchange(event_, nullptr)();
  }
  const bool good = some_steps(most);
  for (SettledReader* r : readers_) r->settle(steps(), settled_steps());
  return good;
}

/** The steps until the next check, at most @a most, and the check. */
bool Stepper::some_steps(int most) {
  if (control_ && control_->lengthen(flow())) clock_.set_dt(control_->dt());
  most = steps_to_check(most);
  const bool moves = works(system_, clock_);
  if (!advance(most)) return not_good(clock_.steps + most);
  const bool now = arrays(system_.cloth).version() != version_ || done(t_end_);
  const bool judged =
      control_ && (now || clock_.steps % StepControl::look_interval == 0);
  const bool guarded = now || clock_.steps - checked_.steps >= guard_interval;
  if (!drag_.none()) sample_drag(now || moves || (guarded && !control_));
  if (!judged && !guarded) return true;
  const Energies e = energy();
  if (judged && !judge(e)) return take_back();
  return !guarded || guard(e);
}

/** The number of steps, up to @a most, until the next check. */
int Stepper::steps_to_check(int most) const {
  if (works(system_, clock_)) return 1;
  const auto up_to_multiple = [&](int interval) {
    most = std::min(most, interval - int(clock_.steps % interval));
  };
  most = std::min(most, guard_interval - int(clock_.steps - checked_.steps));
  for (const SettledReader* r : readers_)
    if (const double left = (r->due() - time()) / clock_.dt; left < most)
      most = int(std::ceil(left - no_step));
  if (control_ || !drag_.none()) up_to_multiple(StepControl::look_interval);
  if (!drag_.none()) up_to_multiple(drag_interval());
  return std::max(most, 1);
}

bool Stepper::advance(int most) {
  const double dt = clock_.dt;
  const double end =
      std::min({t_end_, event_time_, constraint_.next_velocity_jump(time())});
  const double left = (end - time()) / dt;  // in steps
  const bool last = left < 1 + no_step, whole = std::abs(left - 1) < no_step;
  const double h = whole || left > 2 - no_step ? dt
                   : last                      ? end - time()
                                               : (end - time()) / 2;
  const double then = last ? end : time() + h;
  const StepTimes times = clock_.times();
  int count = 1;  // steps of dt
  while (count < most && (end - times(count)) / dt > 2 - no_step) ++count;
  error_.clear();
  try {
    if (h == dt && count > 1)
      count = method_->steps(system_.cloth, times, count, *force_, constraint_);
    else
      method_->step(system_.cloth, time(), h, *force_, constraint_), count = 1;
  } catch (const StepError& e) {
    error_ = e.what();
    return false;
  }
  clock_.steps += count;
  if (last || h != dt) clock_.set_time(then);
  balance_->follow(system_.cloth, time(), constraint_);
  return true;
}

/** Steps between two samples of drag. */
int Stepper::drag_interval() const {
  if (follows_drag_ && !control_) return 1;  // control_ has its own bits
  constexpr double most = 0.005;             // of a velocity
  return int(std::clamp(most / (largest_gamma_ * clock_.dt), 1.,
                        double(StepControl::look_interval)));
}

/** Remember the power of drag now. */
void Stepper::keep_sample() {
  drag_power_ = drag_.power(system_.cloth, system_.wind), sampled_ = time();
}

/** Add what drag took since the last sample, if velocities may have changed
 * since then, or if there is a check @a now: by the trapezoidal rule. */
void Stepper::sample_drag(bool now) {
  if (!now && clock_.steps % drag_interval() != 0 &&
      clock_.steps % StepControl::look_interval != 0)
    return;
  balance_->add_drag(drag_loss() - flow().drag);
  keep_sample();
}

double Stepper::drag_loss() const {
  const double power = drag_.power(system_.cloth, system_.wind);
  return flow().drag + 0.5 * (drag_power_ + power) * (time() - sampled_);
}

double Stepper::drift(const Energies& now) const {
  const EnergyFlow& f = flow();
  return now.total() - start_energy_ - f.work + f.removed + drag_loss();
}

double Stepper::lost() const {
  const EnergyFlow& f = flow();
  return start_energy_ + f.work - f.removed - energy().total();
}

// -------------------------------------------------------------------- Checks

/** StepControl's verdict on the present state, of energy @a e.
 * @return false if it has to be taken back */
bool Stepper::judge(const Energies& e) {
  const double h = time() - looked_;
  looked_ = time();
  using Verdict = StepControl::Verdict;
  const Verdict verdict = control_->look(e, flow(), h, time() / t_end_);
  if (verdict == Verdict::take_back) return false;
  if (arrays(system_.cloth).version() != version_) {
    keep_both();  // removed nodes and edges do not come back
  } else if (verdict == Verdict::keep) {
    std::swap(before_, latest_);
    keep(latest_);
  }
  return true;
}

/** Make the present state the one to go back to. */
void Stepper::keep_both() {
  keep(latest_);
  before_ = latest_;
}
void Stepper::keep(Snapshot& s) const {
  s.nodes.keep(system_.cloth);
  s.clock = clock_, s.flow = flow(), s.control = control_->state();
  s.version = arrays(system_.cloth).version();
}

/** The guard's verdict on the present state, of energy @a e. */
bool Stepper::guard(const Energies& e) {
  if (!guard_->accept(system_.cloth, e, flow())) {
    try {
      if (!std::isfinite(e.total()) || !confirms_ || !confirms_(e))
        return not_good(clock_.steps);
    } catch (const Interrupted&) {  // nobody knows: end before these steps
      back_to_checked();
      return true;
    }
    guard_->allow(system_.cloth, e.internal());
  }
  keep_checked();
  return true;
}

bool Stepper::check() {
  if (failure_) return false;
  return is_finite() || replay(clock_.steps);
}
bool Stepper::is_finite() const { return std::isfinite(energy().total()); }

/** Step @a last or an earlier one is bad.  @return true if the run continues */
bool Stepper::not_good(long long last) {
  return control_ && control_->can_shorten() ? take_back() : replay(last);
}

/** Continue from an earlier state with a shorter step.  @return true */
bool Stepper::take_back() {
  const long long steps = clock_.steps - before_.clock.steps;
  before_.nodes.restore(system_.cloth);
  EnergyFlow flow = before_.flow;
  if (arrays(system_.cloth).version() != before_.version)  // torn meanwhile
    flow.removed += before_.control.last + flow.work - flow.removed -
                    flow.drag - energy().total();
  control_->take_back(before_.control, steps);
  clock_ = before_.clock;
  clock_.set_dt(control_->dt());
  go_on(clock_, flow);
  guard_->keep(system_.cloth);
  looked_ = time();
  keep_both();
  return true;
}

/** Repeat the steps since the last good state until one fails.
 * @param last the step that is known to fail  @return false if one did */
bool Stepper::replay(long long last) {
  back_to_checked();
  while (clock_.steps < last && time() < t_end_) {
    if (!advance()) return fail(Failure::Kind::refused);
    if (!guard_->accept(system_.cloth, flow()))
      return fail(Failure::Kind::diverged);
    keep_checked();
  }
  return true;  // a node that failed and was then removed can't fail again
}

/** Continue from the last state that the guard has accepted. */
void Stepper::back_to_checked() {
  guard_->restore(system_.cloth);
  go_on(checked_, flow_);
}

/** Set failure(), and go back to the state before the step.  @return false */
bool Stepper::fail(Failure::Kind kind) {
  const WorstPlace place(system_.cloth);
  back_to_checked();
  failure_ = {kind,        place, std::string(entry_.info.name), time(), dt(),
              steps() + 1, error_};
  return false;
}

/** Continue from the present state, to which @a clock and @a flow belong. */
void Stepper::go_on(const StepClock& clock, const EnergyFlow& flow) {
  clock_ = clock;
  balance_->resume(system_.cloth, time(), constraint_, flow);
  method_->restart();
  keep_sample();
  keep_checked();
}

/** Record that the present state is good. Until the next call, watch for
 * tunnelling if nodes may become fast for the thinnest obstacle. */
void Stepper::keep_checked() {
  checked_ = clock_;
  flow_ = flow();
  version_ = arrays(system_.cloth).version();
  const double thin = constraint_.thinnest();
  if (!std::isfinite(thin)) return;
  double a = system_.potential.gravity.size();
  if (system_.potential.loads)
    for (Node n : system_.cloth.nodes())
      a = std::max(a, norm(system_.potential.load(n)) / n.value().mass);
  const double gain = a * guard_interval * clock_.dt;
  system_.watched->watch(
      system_.cloth, (max_speed(system_.cloth) + gain) * clock_.dt > thin / 8);
}

// ---------------------------------------------------------------- Checkpoints

Work Stepper::work() const {
  Work all = work_;
  return all += method_->work();
}

void Stepper::archive(Archive& a) {
  archive_cloth(a, system_.cloth);
  a(clock_)(checked_)(flow_)(limits_);
  const auto not_after = [&](const StepClock& c) {
    return c.steps <= clock_.steps && c.time() <= clock_.time();
  };
  a.require(not_after(checked_) &&
            clock_.steps - checked_.steps <= guard_interval);
  system_.watched->archive(a);
  balance_->archive(a);
  guard_->archive(a);
  method_->archive(a, system_.cloth);
  if (a.loads()) version_ = arrays(system_.cloth).version();
  long long evaluated = evaluations();
  Work worked = work();
  a(evaluated)(worked)(sampled_)(drag_power_);
  if (a.loads())
    evaluations_ = evaluated - force_->evaluations(), work_ = worked;
  a.require(clock_.dt == (control_ ? clock_.dt : step_.dt) && evaluated >= 0 &&
            std::min({worked.inner, worked.newton, worked.products,
                      worked.factors}) >= 0 &&
            sampled_ <= time() && std::isfinite(sampled_ + drag_power_));
  if (!control_) return;
  control_->archive(a);
  a(looked_);
  a.require(clock_.dt <= control_->dt() && looked_ <= time() &&
            std::isfinite(looked_));
  for (Snapshot* s : {&before_, &latest_}) {
    bool whole =
        s->version == arrays(system_.cloth).version();  // nothing removed since
    a(s->nodes)(s->clock)(s->flow)(s->control)(whole);
    a.require(not_after(s->clock));
    if (a.loads())
      s->version = whole ? arrays(system_.cloth).version()
                         : ~arrays(system_.cloth).version();
  }
}

}  // namespace lab
