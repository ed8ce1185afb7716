#include "lab/stepping/Trial.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "CME212/Util.hpp"
#include "lab/fast/Energy.hpp"

namespace lab {

Answer answer(const Scene& scene, const Measure& what) {
  return quantities[what.quantity].read(
      {scene.model(), scene.cloth(), scene.time(), &scene.held(),
       &scene.force(),
       what.quantity == Measure::lost_energy ? scene.stepper().lost() : 0,
       scene.stepper().pulls()},
      what);
}

void TimeSeries::add(const Measure& what, double t, double x) {
  const auto [t0, x0] = last_[1];
  const bool start = n_++ == 0;
  best_ = start ? x : std::max(best_, x);
  worst_ = start ? x : std::min(worst_, x);
  if (!start && what.over == Measure::mean && t > what.from) {
    const double from = std::max(t0, what.from),
                 there = std::lerp(x0, x, (from - t0) / (t - t0));
    sum_ += (t - from) * (there + x) / 2;
    span_ += t - from;
  }
  if (what.above || what.below) {
    const double level = what.above ? *what.above : *what.below;
    const auto is_past = [&](double a) {
      return what.above ? a > level : a < level;
    };
    const double passed = start ? t : std::lerp(t0, t, (level - x0) / (x - x0));
    if (is_past(x) && first_ < 0) first_ = passed;
    if (!start && is_past(x0) && !is_past(x)) left_ = passed;
  }
  if (what.over == Measure::period && n_ > 2) {
    // The parabola through the last three values, if that between is extreme.
    const auto [ta, xa] = last_[0];
    const double before = (x0 - xa) / (t0 - ta), after = (x - x0) / (t - t0);
    if ((before > 0) != (after > 0)) {
      const double share = before / (before - after);
      extrema_.push_back({std::lerp((ta + t0) / 2, (t0 + t) / 2, share), x0});
    }
  }
  last_[0] = last_[1];
  last_[1] = {t, x};
}

Answer TimeSeries::answer(const Measure& what) const {
  const auto [t, x] = last_[1];
  const bool past =
      what.above ? x > *what.above : what.below && x < *what.below;
  switch (what.over) {
    case Measure::at_end:  // a time that is infinite until it has come
    case Measure::smallest:
      return std::isfinite(worst_) ? Answer{worst_} : Answer{};
    case Measure::largest:
      return {best_};
    case Measure::mean:
      return {span_ > 0 ? sum_ / span_ : x};
    case Measure::first:
      return first_ < 0 ? Answer{} : Answer{first_};
    case Measure::last:
      return past ? Answer{} : Answer{left_};
    case Measure::period:
      break;
  }
  const double enough = (best_ - worst_) / 2;
  double first = 0, last = 0;
  int maxima = 0;
  // The highest since the number last rose enough, and the lowest since then.
  Sample high = {0, -std::numeric_limits<double>::infinity()},
         low = {0, std::numeric_limits<double>::infinity()};
  bool falls = true;  // the start is no maximum
  for (const Sample& e : extrema_) {
    if (falls) {
      if (e.x < low.x) low = e;
      if (e.x - low.x >= enough) falls = false, high = e;
    } else {
      if (e.x > high.x) high = e;
      if (high.x - e.x >= enough) {
        falls = true, low = e, last = high.t;
        if (maxima++ == 0) first = last;
      }
    }
  }
  return maxima < 2 ? Answer{} : Answer{(last - first) / (maxima - 1)};
}

void TimeSeries::archive(Archive& a) {
  a(n_)(last_[0])(last_[1])(best_)(worst_)(sum_)(span_)(first_)(left_);
  a(extrema_);
  a.require(n_ >= 0 && best_ == best_ && worst_ == worst_ &&
            std::isfinite(sum_ + span_ + first_ + left_));
}

Observer::Observer(Scene& scene, const Measure& what)
    : scene_(scene),
      what_(what),
      looks_(scene.stepper(),
             [this](const Look& l) { settled_.add(what_, l.time, l.value); }) {
  restart();
}

void Observer::restart() {
  settled_ = {}, looks_.clear();
  if (what_.quantity == Measure::positions) return;
  Model asked = scene_.model();
  asked.measure = what_;
  check_question(asked);
  look();
}

void Observer::look() {
  const Answer now = lab::answer(scene_, what_);
  if (looks()) looks_.add({scene_.time(), now[0]});
}

Answer Observer::answer() const {
  if (!looks()) return lab::answer(scene_, what_);
  TimeSeries all = settled_;
  looks_.each_waiting([&](const Look& l) { all.add(what_, l.time, l.value); });
  return all.answer(what_);
}

double step_of(const Model& m) {
  double dt = m.step.dt;
  if (!m.step.fixed()) {
    const Scene scene(m);
    const double limit = scene.least_limit().limit;
    dt = scene.dt() *
         (limit < scene.safe_limit() ? limit / scene.safe_limit() : 1);
  }
  return m.t_end > 0 ? m.t_end / std::ceil(m.t_end / dt * (1 - 1e-12)) : dt;
}

Trial try_out(const Model& m, const Shake& shake,
              const std::function<void(const Cloth&)>& look,
              const std::function<void(Scene&)>& after) {
  const CME212::Clock clock;
  Trial result;
  result.dt = step_of(m);
  Scene scene(m, mesh_of(m), {.dt = result.dt}, *m.method);
  std::mt19937 random(shake.seed);
  std::uniform_real_distribution<double> off(-shake.size, shake.size);
  if (shake.size > 0) {
    for (Node n : scene.cloth().nodes())
      for (unsigned k = 0; k < 3; ++k)
        if (const double by = off(random); shake.along[k])
          n.position()[k] += by;
    // The guard starts anew: it would take these strains for a divergence.
    scene.change_method(*m.method, {.dt = result.dt});
  }
  Observer observer(scene);
  const double springs = double(scene.cloth().num_edges()),
               factor = factor_sweeps(scene.cloth());
  struct State {
    double time;  // [s]
    Answer answer;
  };
  std::vector<State> last = {{0, observer.answer()}};  // three, in turn
  const auto due = [&](double time) {
    return std::min(std::size_t(time / m.t_end * Trial::looks),
                    std::size_t(Trial::looks - 1));
  };
  auto& earlier = result.earlier;
  const bool ok = scene.run_to(m.t_end, [&] {
    after(scene);
    if (observer.looks()) observer.look();
    const double time = scene.time();
    if (earlier.size() >= due(time + 2.1 * result.dt)) return;
    last.push_back({time, observer.answer()});
    if (last.size() > 3) last.erase(last.begin());
    while (earlier.size() < due(time)) {
      const double t = m.t_end / Trial::looks * double(earlier.size() + 1);
      Answer& there = earlier.emplace_back(last.back().answer);
      result.kinetic.push_back(kinetic_energy(scene.cloth()));
      const auto other = [&](const State& s) {
        return s.answer.size() != there.size();
      };
      if (observer.looks() || std::ranges::any_of(last, other)) continue;
      std::ranges::fill(there, 0);  // Lagrange's interpolation
      for (const State& s : last) {
        double share = 1;
        for (const State& r : last)
          if (&r != &s) share *= (t - r.time) / (s.time - r.time);
        for (std::size_t k = 0; k < there.size(); ++k)
          there[k] += share * s.answer[k];
      }
    }
  });
  if (scene.failure()) result.failure = text_of(scene.failure());
  if (ok) {
    result.answer = observer.answer();
    result.kinetic.push_back(kinetic_energy(scene.cloth()));
    if (result.answer.empty())
      result.failure = (m.measure.quantity == Measure::tear_time
                            ? "nothing tears"
                            : name_of(m.measure) + " has no answer") +
                       " until t = " + CME212::short_text(m.t_end) + " s";
    look(scene.cloth());
  }
  result.steps = scene.steps();
  const Work w = scene.stepper().work();
  const double factors =
      double(w.factors) + (scene.rest() ? scene.rest()->factors : 0);
  result.work =
      springs * (double(scene.evaluations() + w.products) + factor * factors);
  result.seconds = clock.seconds();
  return result;
}

}  // namespace lab
