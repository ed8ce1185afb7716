#include "lab/methods/Splitting.hpp"

#include <array>
#include <cmath>
#include <span>

#include "lab/methods/Flow.hpp"
#include "lab/methods/Pefrl.hpp"
#include "lab/methods/Srkn.hpp"
#include "lab/methods/Verlet.hpp"
#include "lab/methods/Yoshida4.hpp"

namespace lab {

template <typename Scheme>
double Splitting<Scheme>::step(Cloth& g, double t, double dt,
                               const ForcePlan& force,
                               const ConstraintPlan& constraint) {
  constexpr auto& steps = Scheme::steps;
  constexpr std::size_t first_drift = Scheme::kicks_first ? 1 : 0;
  const Drag& c = force.drag();
  if (Scheme::kicks_first) {
    const auto first_kick = [&](const Part& part, std::span<const Point> f) {
      kick(g, part, steps[0] * dt, f);
    };
    if (kept(g, t, dt))
      sweep_.parts(g, [&](const Part& part) {
        first_kick(part, std::span(force_).subspan(part.first));
      });
    else
      sweep_(g, t, force, force_, [&](const Part& part, std::span<Point> f) {
        without_drag(part, force, f);
        first_kick(part, f);
      });
  }
  double now = t;
  for (std::size_t k = first_drift; k < steps.size(); k += 2) {
    const double h = steps[k] * dt;
    const auto move = [&](const Part& part) { drift(g, part, h, c); };
    const bool is_last = k + 2 >= steps.size();
    now = is_last ? t + dt : now + h;
    constraint.place_held_at_rest(g, now);
    const ConstraintPlan none;  // but after the last drift
    const ConstraintPlan& now_holds = is_last ? constraint : none;
    if (k + 1 == steps.size()) {
      sweep_.parts(g, move);
      now_holds(g, now);
      break;
    }
    move_and_sweep(
        sweep_, g, now, force, now_holds, move,
        [&](const Part& part, std::span<Point> f) {
          without_drag(part, force, f);
          kick(g, part, steps[k + 1] * dt, f);
        },
        force_);
  }
  constraint.set_held_velocities(g, t + dt);
  if (Scheme::kicks_first)
    kept_for_ = &g, kept_version_ = g.version(), kept_time_ = t + dt;
  return t + dt;
}

template <typename Scheme>
bool Splitting<Scheme>::kept(const Cloth& g, double t, double dt) const {
  // A caller may add up its times or multiply them: that is the same time.
  return kept_for_ == &g && kept_version_ == g.version() &&
         std::abs(t - kept_time_) < 1e-6 * dt;
}

template <typename Scheme>
void Splitting<Scheme>::archive(CME212::Archive& a, const Cloth& g) {
  bool has = kept_for_ == &g && kept_version_ == g.version();
  a(has);
  if (!has) return restart();
  a(force_)(kept_time_);
  kept_for_ = &g, kept_version_ = g.version();
}

template class Splitting<VerletScheme>;
template class Splitting<Yoshida4Scheme>;
template class Splitting<PefrlScheme>;
template class Splitting<Srkn6bScheme>;
template class Splitting<Srkn11bScheme>;

}  // namespace lab
