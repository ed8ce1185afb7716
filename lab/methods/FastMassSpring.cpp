#include "lab/methods/FastMassSpring.hpp"

namespace lab {

double FastMassSpring::step(Cloth& g, double t, double dt,
                            const ForcePlan& force,
                            const ConstraintPlan& constraint) {
  auto& stage = stage_.begin(info.name, t, dt, g, force, constraint);
  factor_.find(info.name, g, {dt, dt * dt}, force, constraint);
  for (int k = 0; k < rounds_; ++k, ++solves_) {
    auto& f = stage.residual(t + dt, dt);
    factor_.solve(f);
    change_ = f;
    if (accelerated_ && k > 0) accelerate(f, stage.w);
    last_f_ = f, last_w_ = stage.w;
    for (unsigned i = 0; i < f.size(); ++i) stage.w[i] += change_[i];
  }
  stage.move(dt);
  return stage.finish();
}

/** With a that minimizes |f - a (f - last f)|: change = f - a ((f - last f) +
 * (w - last w)). Nothing if |f| has grown to twice the last one. */
void FastMassSpring::accelerate(const std::vector<Point>& f,
                                const std::vector<Point>& w) {
  double ff = 0, of_last = 0, along = 0, whole = 0;
  for (unsigned i = 0; i < f.size(); ++i) {
    const Point d = f[i] - last_f_[i];
    ff += normSq(f[i]), of_last += normSq(last_f_[i]);
    along += dot(d, f[i]), whole += normSq(d);
  }
  if (whole == 0 || ff > 4 * of_last) return;
  const double a = along / whole;
  for (unsigned i = 0; i < f.size(); ++i)
    change_[i] -= a * (f[i] - last_f_[i] + w[i] - last_w_[i]);
}

}  // namespace lab
