#pragma once
/** @file Splitting.hpp
 * Splitting methods: Verlet, Yoshida4, Pefrl, Srkn are their schemes. */
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "lab/methods/Flow.hpp"
#include "lab/methods/Method.hpp"

namespace lab {

/** A splitting method: A moves the positions (and lets drag slow the nodes
 * down, exactly), B kicks the velocities, in turn, by fractions of dt. Time
 * runs in A. Symmetric and symplectic (without drag), so energy is bounded and
 * a run can be taken back.
 *
 * @tparam Scheme has the fractions, `constexpr std::array steps`, kicks_first
 *         (whether they begin and end with B) and info. One that begins with B
 *         needs one sweep less: the last kick's force is the next first one's.
 */
template <typename Scheme>
class Splitting : public Method {
 public:
  static constexpr MethodInfo info = Scheme::info;

  double step(Cloth& g, double t, double dt, const ForcePlan& force,
              const ConstraintPlan& constraint) override {
    constexpr auto& steps = Scheme::steps;
    constexpr std::size_t first_drift = Scheme::kicks_first ? 1 : 0;
    const double c = force.drag();
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
      stop_held(g, constraint);
    }
    double now = t;
    for (std::size_t k = first_drift; k < steps.size(); k += 2) {
      const double h = steps[k] * dt;
      const auto move = [&](const Part& part) { drift(g, part, h, c); };
      const bool is_last = k + 2 >= steps.size();
      now = is_last ? t + dt : now + h;
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
      stop_held(g, constraint);
    }
    if (Scheme::kicks_first)
      kept_for_ = &g, kept_version_ = g.version(), kept_time_ = t + dt;
    return t + dt;
  }
  void restart() override { kept_for_ = nullptr; }

 private:
  Sweep sweep_;
  std::vector<Point> force_;         // [N], by node id, without drag
  const Cloth* kept_for_ = nullptr;  // the cloth at whose state force_ is
  std::uint64_t kept_version_ = 0;
  double kept_time_ = 0;

  bool kept(const Cloth& g, double t, double dt) const {
    // A caller may add up its times or multiply them: that is the same time.
    return kept_for_ == &g && kept_version_ == g.version() &&
           std::abs(t - kept_time_) < 1e-6 * dt;
  }
};

}  // namespace lab
