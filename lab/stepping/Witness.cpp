#include "lab/stepping/Witness.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "CME212/Util.hpp"
#include "lab/fast/Energy.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/scenes/Interrupt.hpp"
#include "lab/stepping/Scene.hpp"
#include "lab/stepping/Trial.hpp"

namespace lab {

namespace {

constexpr int looks = 64, windows = 8;         // of a run
constexpr int window_looks = looks / windows;  // of a window
constexpr double endless = 5;                  // a run without an end [s]

double median(std::vector<double> all) {
  std::ranges::sort(all);
  const std::size_t n = all.size();
  return n == 0 ? 0 : (all[(n - 1) / 2] + all[n / 2]) / 2;
}

/** The error of a run by its difference from one with half of the step. At
 * contacts every method is of order 1. */
double error_factor(const Model& scene, const MethodInfo& m) {
  const int order = scene.has_contact() ? 1 : m.order;
  return m.adaptive ? 1 : 1 / (1 - std::pow(2., -order));
}

/** What @a s did so far, in force sweeps. */
double sweeps_of(const Scene& s) {
  const Work w = s.stepper().work();
  return double(s.evaluations() + w.products) +
         factor_sweeps(s.cloth()) * double(w.factors);
}

/** The side of a square sheet with so many nodes and such springs [m]. */
double side_of(const Cloth& g) {
  double length = 0;
  for (Edge e : g.edges()) length += e.length();
  return g.num_edges() == 0
             ? 0
             : length / g.num_edges() * std::sqrt(double(g.num_nodes()));
}

/** The largest distance of a node of @a a from where it is in @a b, by @a size
 * [m]; infinite if the node was removed there. */
double distance(const Cloth& a, const Cloth& b, double size) {
  double most = 0;
  for (Node n : a.nodes()) {
    if (!arrays(b).node_in_use(n.id())) return no_limit;
    const Point there = arrays(b).node_with_id(n.id()).position();
    most = std::max(most, double(norm(n.position() - there)));
  }
  return size > 0 ? most / size : most;
}

/** The change from @a b to @a a as a share: of lengths by the size of the
 * cloth, of energies by the largest one, else by the larger of both, but no
 * less than a strain of 1e-7 or the force of a spring with it. */
double changed_by(const Answer& a, const Answer& b, const Measure& what,
                  const Cloth& g, double size, double energy) {
  if (a.size() != b.size()) return no_limit;
  const double far = a.empty() ? 0 : distance(a, b, what);
  if (!(far > 0)) return 0;
  const Answer none(a.size());
  double whole = std::max(distance(a, none, what), distance(b, none, what));
  const std::string unit = unit_of(what);
  if (unit == "m" && !what.is_time()) whole = std::max(whole, size);
  if (unit == "J" && !what.is_time()) whole = std::max(whole, energy);
  constexpr double strain = 1e-7;
  if (unit.empty()) whole = std::max(whole, strain);
  if (unit == "N")
    for (Edge e : g.edges())
      whole = std::max(whole, strain * e.value().K * e.value().L);
  return far / whole;
}

/** A change of energy is a share of this, or more [J]. */
double least_energy(const Verdict& v) {
  return std::max(v.scale, 20 * v.slack);
}

}  // namespace

// -------------------------------------------------------------------- Verdict

std::string Verdict::text() const {
  using CME212::percent;
  if (failed) return "half of dt fails";
  std::string all = "half of dt: ";
  if (scale > 0 && std::max(gain, loss) > slack)
    all += "energy " + percent(std::abs(off) / scale) + ", ";
  all += "positions " + (apart == no_limit ? "of other nodes" : percent(apart));
  if (!asked.empty())
    all +=
        ", " + asked + ' ' + (answer == no_limit ? "missing" : percent(answer));
  return all + "; compared " +
         (whole ? "the whole run" : "8 windows of the run") + ", " +
         percent(cost) + " of its force sweeps";
}

std::string Verdict::difference() const {
  using CME212::percent;
  if (failed) return "half of dt fails";
  std::string all = "half of dt gives ";
  const char* separator = "";
  const auto add = [&](const std::string& what) {
    all += separator + what;
    separator = ", and ";
  };
  if (is_off())
    add("another " + std::string(loose ? "internal " : "") + "energy, by " +
        CME212::two_digits(std::abs(off)) + " J" +
        (scale > 0 ? ", " + percent(std::abs(off) / scale) + " of the largest"
                   : ""));
  if (apart == no_limit)
    add("other nodes that are removed");
  else if (!has_place())
    add("positions that differ by up to " + percent(apart) +
        " of the size of the cloth");
  if (!has_answer() && !(asked == "energy" && is_off()))
    add("another " + asked +
        (answer == no_limit ? ", or none" : ", by " + percent(answer)));
  return all;
}

std::string Verdict::wrong_text() const {
  if (!gains())
    return asked + " is not known: " + difference() +
           ", while all positions are the same";
  return "an error of the method has added " + CME212::two_digits(gain) +
         " J of energy, which half of dt does not: this is not the motion of "
         "the scene";
}

// -------------------------------------------------------------------- Witness

Witness::Look::Look(const Scene& s)
    : step(s.steps()), time(s.time()), loose(s.flow().loose) {
  const Energies e = s.energy();
  total = e.total(), internal = e.internal(), kinetic = e.kinetic;
}

Witness::Witness(Scene& scene, double t_end, bool whole)
    : scene_(scene), t_end_(t_end), asked_whole_(whole) {
  scene_.stepper().tell(this);
  restart();
}
Witness::~Witness() { scene_.stepper().tell_no_more(this); }

void Witness::restart() {
  looks_.clear(), kept_.reset(), drifts_.clear();
  windows_ = Verdict(), windows_.whole = false;
  sweeps_ = 0, said_.reset(), said_at_ = -1;
  begin_ = scene_.time();
  const Cloth& g = scene_.cloth();
  from_ = center_of_mass(g), edges_ = g.num_edges();
  const double steps = 2 * (t_end_ - begin_) / scene_.dt();
  whole_ = std::isfinite(t_end_) &&
           (asked_whole_ || scene_.work_of(steps) < Scene::trial_work);
  if (whole_ && scene_.was_changed()) kept_ = scene_.branch(0.5);
  each_ = scene_.dt(), look_due_ = begin_ + each_;
  begin_windows();
}

void Witness::change() {
  said_.reset();
  if (scene_.steps() == 0) return restart();
  look_due_ = no_limit;
  if (!whole_ || !kept_) kept_.reset(), looks_.clear(), window_looks_.clear();
  if (std::exchange(whole_, false)) begin_windows();
}

void Witness::begin_windows() {
  next_ = 0;
  window_due_ = no_limit;
  if (!whole_) next_in_window();
}

/** Find when to look at a window next: 9 times in each. */
void Witness::next_in_window() {
  const double whole = std::isfinite(t_end_) ? t_end_ - begin_ : endless;
  window_due_ = no_limit;
  if (!(whole > 0)) return;
  do {
    constexpr int each = window_looks + 1;
    const int in_512ths =
        looks * (next_ / each + 1) - window_looks + next_ % each;
    window_due_ = begin_ + whole * in_512ths / (looks * window_looks);
    ++next_;
  } while (window_due_ <= scene_.time());
}

/** Look at the state; of 64 looks, keep each second one. */
void Witness::look() {
  looks_.emplace_back(scene_);
  if (looks_.size() >= looks) {
    for (std::size_t k = 0; k < looks / 2; ++k) looks_[k] = looks_[2 * k + 1];
    looks_.resize(looks / 2);
    each_ *= 2;
  }
  look_due_ = begin_ + each_ * double(looks_.size() + 1);
}

void Witness::settle(long long now, long long /*settled*/) {
  for (std::vector<Look>* of : {&looks_, &window_looks_})
    while (!of->empty() && of->back().step > now) of->pop_back();
  if (scene_.failure()) return;
  const double time = scene_.time() + 1e-9 * scene_.dt();
  if (time >= look_due_) look();
  if (time < window_due_) return;
  window();
  next_in_window();
}

/** One look at a window, number next_ - 1. */
void Witness::window() {
  const int look = (next_ - 1) % (window_looks + 1);
  try {
    if (look == 0) {
      window_looks_.clear();
      kept_ = scene_.branch(0.5);
      return;
    }
    if (!kept_ || kept_->time() >= scene_.time()) return;
    window_looks_.emplace_back(scene_);
    if (look < window_looks) return;
    double slack = 0;
    Verdict& v = windows_;
    const auto finer = kept_->branch(1);
    std::vector<double> d = repeat(*finer, window_looks_, v, slack);
    sweeps_ += sweeps_of(*finer);
    if (v.failed) return;
    v.slack = std::max(v.slack, slack);
    v.apart =
        std::max(v.apart, distance(scene_.cloth(), finer->cloth(), size()));
    const auto half = d.begin() + std::ptrdiff_t(d.size() / 2);
    drifts_.push_back(2 *
                      (median({half, d.end()}) - median({d.begin(), half})));
    const Measure& what = scene_.model().measure;
    if (what.over_time() || what.quantity == Measure::positions ||
        what.quantity == Measure::lost_energy)
      return;
    v.asked = name_of(what);
    v.answer =
        std::max(v.answer, changed_by(answer(scene_), answer(*finer), what,
                                      scene_.cloth(), size(), least_energy(v)));
  } catch (const Interrupted&) {  // the run ends, too
    kept_.reset();
  }
}

/** The size of the cloth or, if it is longer, its way since the start [m]. */
double Witness::size() const {
  const Cloth& g = scene_.cloth();
  return std::max(side_of(g), double(norm(center_of_mass(g) - from_)));
}

/** Run @a finer through all @a looks, with @a after as of run_to().
 * @return what the run has more of energy at each, as an error [J] */
std::vector<double> Witness::repeat(Scene& finer,
                                    const std::vector<Look>& looks, Verdict& v,
                                    double& slack,
                                    const std::function<void()>& after) const {
  const double factor = error_factor(scene_.model(), scene_.method());
  std::vector<double> d;
  const Look* before = nullptr;
  for (const Look& run : looks) {
    if (!finer.run_to(run.time, after)) {
      v.failed = true;
      return d;
    }
    const Look other(finer);
    const bool internal = run.loose + other.loose > 0;
    v.loose |= internal;
    d.push_back(factor * (internal ? run.internal - other.internal
                                   : run.total - other.total));
    v.scale = std::max(v.scale, other.internal);
    v.mine = std::max(v.mine, run.internal);
    slack = std::max(slack, finer.energy().round_off());
    if (before && run.step > before->step && scene_.method().ahead())
      // Velocities are a step early: that is no error of the motion.
      slack = std::max(slack, std::abs(run.kinetic - before->kinetic) /
                                  double(run.step - before->step));
    before = &run;
  }
  slack += scene_.stepper().floor() / 2;
  return d;
}

void Witness::archive(Archive& a, Witness* w) {
  std::vector<Look> looks;
  double each = 0, due = no_limit;
  if (w) looks = w->looks_, each = w->each_, due = w->look_due_;
  a(looks)(each)(due).require(each >= 0 && due >= 0);
  for (const Look& l : looks)
    a.require(std::isfinite(l.time + l.total + l.internal + l.kinetic) &&
              l.step >= 0);
  if (!a.loads() || !w) return;
  w->looks_ = std::move(looks), w->each_ = each, w->look_due_ = due;
  if (due == no_limit) w->whole_ = false, w->kept_.reset();  // was changed
  w->begin_windows();
}

const Verdict& Witness::verdict(const Observer* asked) const {
  if (!said_ || said_at_ != scene_.steps()) {
    said_ = whole_ ? judge_whole(asked) : judge_windows();
    said_at_ = scene_.steps();
  }
  return *said_;
}

Verdict Witness::judge_whole(const Observer* asked) const {
  Verdict v;
  const Model& m = scene_.model();
  v.sudden = scene_.cloth().num_edges() != edges_;
  try {
    const auto finer = kept_ ? kept_->branch(1) : scene_.finer();
    std::optional<Observer> observer;
    if (asked && m.measure.quantity != Measure::positions)
      observer.emplace(*finer);
    const std::function<void()> look =
        observer ? observer->after_steps() : nullptr;
    const std::vector<double> d = repeat(*finer, looks_, v, v.slack, look);
    if (!v.failed) v.failed = !finer->run_to(scene_.time(), look);
    v.cost = sweeps_of(*finer) / std::max(1., sweeps_of(scene_));
    if (v.failed) return v;
    const std::size_t round = std::max<std::size_t>(1, d.size() / windows);
    for (std::size_t k = 0; k + round <= d.size(); k += round) {
      const std::size_t end = k + 2 * round <= d.size() ? k + round : d.size();
      v.off = median(
          {d.begin() + std::ptrdiff_t(k), d.begin() + std::ptrdiff_t(end)});
      v.gain = std::max(v.gain, v.off), v.loss = std::max(v.loss, -v.off);
    }
    v.apart = distance(scene_.cloth(), finer->cloth(), size());
    if (observer) {
      v.asked = name_of(m.measure);
      v.answer = changed_by(asked->answer(), observer->answer(), m.measure,
                            scene_.cloth(), size(), least_energy(v));
    }
  } catch (const std::invalid_argument&) {  // no such step
    v.failed = true;
  }
  return v;
}

Verdict Witness::judge_windows() const {
  Verdict v = windows_;
  v.sudden = scene_.cloth().num_edges() != edges_;
  const double n = double(drifts_.size());
  double sum = 0, squares = 0;
  for (double d : drifts_) {
    sum += d, squares += d * d;
    v.gain = std::max(v.gain, d), v.loss = std::max(v.loss, -d);
    if (std::abs(d) > std::abs(v.off)) v.off = d;
  }
  // The drift of the rest of the run, unless the windows contradict each other.
  const double spread = std::sqrt(std::max(0., squares - sum * sum / n));
  if (n > 1 && std::abs(sum) > spread) v.off = windows * sum;
  v.gain = std::max(v.gain, v.off), v.loss = std::max(v.loss, -v.off);
  v.cost = sweeps_ / std::max(1., sweeps_of(scene_));
  return v;
}

}  // namespace lab
