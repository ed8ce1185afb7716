#include "lab/stepping/Trial.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "CME212/Util.hpp"
#include "lab/scenes/Interrupt.hpp"

namespace lab {

Answer answer(const Model& m, const Scene& scene, const Measure& what) {
  const auto& built = scene.recipe().built;
  return quantities[what.quantity].read(
      {m, scene.cloth(), scene.time(), &scene.held(),
       built && built->force ? &*built->force : nullptr},
      what);
}

double Observer::better(const Measure& what, double a, double b) {
  return what.over == Measure::largest ? std::max(a, b) : std::min(a, b);
}

Observer::Observer(const Model& m, const Scene& scene)
    : best_(std::numeric_limits<double>::infinity()) {
  if (m.measure.over == Measure::largest) best_ = -best_;
  if (m.measure.quantity == Measure::positions) return;
  check_question(m);
  look(m, scene);
}

void Observer::look(const Model& m, const Scene& scene) {
  const Answer now = lab::answer(m, scene, m.measure);
  if (!m.measure.over_time()) return;
  std::erase_if(recent_, [&](const Look& l) {
    if (l.step <= scene.settled_steps())
      best_ = better(m.measure, best_, l.value);
    return l.step <= scene.settled_steps() || l.step > scene.steps();
  });
  recent_.push_back({scene.steps(), now[0]});
}

Answer Observer::answer(const Model& m, const Scene& scene) const {
  if (!m.measure.over_time()) return lab::answer(m, scene, m.measure);
  double best = best_;
  for (const Look& l : recent_)
    if (l.step <= scene.steps()) best = better(m.measure, best, l.value);
  return std::isfinite(best) ? Answer{best} : Answer{};
}

void Observer::archive(Archive& a) {
  a(best_)(recent_);
  a.require(best_ == best_);  // no NaN
  for (const Look& l : recent_) a.require(l.value == l.value);
}

double step_of(const Model& m) {
  const double dt = m.step.fixed() ? m.step.dt : Scene(m).dt();
  return m.t_end > 0 ? m.t_end / std::ceil(m.t_end / dt * (1 - 1e-12)) : dt;
}

Trial try_out(const Model& m, const Shake& shake,
              const std::function<void(const Cloth&)>& look,
              const std::function<void(Scene&)>& after) {
  const CME212::Clock clock;
  Trial result;
  result.dt = step_of(m);
  Scene scene(recipe_of(m), {.dt = result.dt}, *m.method);
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
  Observer observer(m, scene);
  const double springs = double(scene.cloth().num_edges()),
               factor = 10 * std::sqrt(double(scene.cloth().num_nodes()));
  const bool ok = scene.run_to(m.t_end, [&] {
    end_if_interrupted();
    after(scene);
    if (m.measure.over_time()) observer.look(m, scene);
  });
  result.failure = text_of(scene.failure());
  if (ok) {
    result.answer = observer.answer(m, scene);
    if (result.answer.empty())
      result.failure =
          "nothing tears until t = " + CME212::short_text(m.t_end) + " s";
    look(scene.cloth());
  }
  result.steps = scene.steps();
  const Work w = scene.stepper().work();
  result.work = springs * (double(scene.evaluations() + w.products) +
                           factor * double(w.factors));
  result.seconds = clock.seconds();
  return result;
}

}  // namespace lab
