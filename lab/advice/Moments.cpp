#include <algorithm>
#include <cmath>

#include "CME212/Util.hpp"
#include "lab/advice/Constants.hpp"
#include "lab/advice/Grids.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/stepping/Checkpoint.hpp"
#include "lab/stepping/RestReport.hpp"

namespace lab {

/** A number of [0, 1), number @a k that the words of the question draw. */
double GridStudy::drawn(unsigned k) const {
  return double(crc64(as_options(q_.scene)) >> 8 * k & 0xff) / 0x100;
}

/** Has the finest pilot come to rest by look @a k, of 1 to 64? */
bool GridStudy::is_still(std::size_t k) const {
  const std::vector<double>& kinetic = grids().back().trial.kinetic;
  return kinetic[k - 1] <= constant.still * std::ranges::max(kinetic);
}

std::array<std::size_t, 3> GridStudy::moments() const {
  std::size_t moving = Trial::looks;
  while (moving > 4 && is_still(moving)) --moving;
  std::size_t far = moving / 4;
  const Trial& finest = grids().back().trial;
  auto off = [&](std::size_t k) {
    return apart(finest.earlier[k - 1], finest.answer, k);
  };
  for (std::size_t k = far; k < moving; ++k)
    if (off(k) > off(far)) far = k;
  return {std::size_t(double(moving) * (1 + drawn(0)) / 4),
          std::size_t(double(moving) * (1 + 0.9 * drawn(1)) / 2), far};
}

double GridStudy::apart(const Answer& a, const Answer& b, std::size_t k) const {
  const Measure& what = q_.scene.measure;
  if (a.size() == b.size()) return distance_of(a, b);
  return what.is_time() && what.over != Measure::period
             ? std::abs((a.empty() ? b : a)[0] - time_of(k))
             : infinite;
}

bool GridStudy::follows(const Trial& t, double t_end) const {
  return std::ranges::all_of(moments(), [&](std::size_t k) {
    // A run that ends earlier is read between two of its looks.
    const double look = double(k) * q_.scene.t_end / t_end;
    const auto j = std::size_t(look);
    if (j >= Trial::looks - 1 && t_end < q_.scene.t_end)
      return follows(t.answer, k);
    Answer there = t.earlier[j - 1];
    const Answer& next = t.earlier[std::min<std::size_t>(j, Trial::looks - 2)];
    for (std::size_t n = 0; n < there.size() && n < next.size(); ++n)
      there[n] = std::lerp(there[n], next[n], look - double(j));
    return follows(there, k);
  });
}

bool GridStudy::follows(const Answer& a, std::size_t k) const {
  Refinement then(q_.scene.measure, grids().slow());
  const Answer& finest = grids().back().trial.earlier[k - 1];
  for (std::size_t j = 0; j < grids().size(); ++j)
    if (const Trial& t = grids()[j].trial;
        t.earlier[k - 1].size() == finest.size()) {
      GridReport g;
      g.factor = grids()[j].factor, g.trial.answer = t.earlier[k - 1];
      then.add(std::move(g));
    }
  const double u = then.size() < 3 ? tolerance() : then.uncertainty(),
               off = std::min(apart(a, finest, k), apart(a, then.limit(), k));
  return off <= tolerance() + std::min(u, tolerance());
}

std::optional<AdvisedRun> GridStudy::at_rest() {
  const Model& m = q_.scene;
  const std::array late = {std::size_t(Trial::looks * (6 + drawn(2)) / 8),
                           std::size_t(Trial::looks * (7 + drawn(3)) / 8)};
  if (q_.from_files() || q_.rules.keeps_method || q_.rules.keeps_step ||
      m.measure.over_time() || !is_still(late[0]) || !is_still(late[1]) ||
      !is_still(Trial::looks))
    return {};
  std::optional<AdvisedRun> found;
  double factor = 0;
  try {
    check_has_rest(m);
    // On the coarsest grid that holds, and on those up to twice its cells.
    for (std::size_t k = 0; k < grids().size(); ++k) {
      if (found && grids()[k].factor > 2.1 * factor) break;
      AdvisedRun r;
      r.model = on_level(grids()[k].level);
      r.model.from_rest = true, r.model.t_end = 0, r.model.step = {};
      r.model.method = default_method();
      const double work = work_at_rest(r.model);
      if (!q_.pilots.affords(work, "the cloth at rest", 0.5)) return {};
      const Trial t = q_.pilots.run(r.model, "the cloth at rest", work);
      r.error = error_of(t), r.uncertainty = grids().uncertainty();
      r.answer = t.answer, r.work = t.work, r.seconds = t.seconds;
      if (!t.ok() || !accepts(r.error) || !follows(r.answer, late[0]) ||
          !follows(r.answer, late[1]))
        found.reset();
      else if (!found)
        found = r, factor = grids()[k].factor;
      else
        found->finer_grid = r.error;
    }
    if (!found) return {};
    Scene scene(found->model);
    const RestReport report(scene);
    if (!report.stable() || report.modes.empty()) return {};
    using CME212::short_text;
    std::size_t since = late[0];
    while (since > 1 && is_still(since - 1)) --since;
    q_.advice.at_rest =
        short_text(report.residual) + " N are left of " +
        short_text(report.load) + " N; stable: the smallest eigenvalue is " +
        short_text(report.modes[0].square) +
        " 1/s^2; the drag of this scene brings it there by " +
        short_text(time_of(since)) + " s; a drag over mass of " +
        short_text(2 * std::sqrt(report.modes[0].square)) +
        " 1/s would do it fastest";
    return found;
  } catch (const SceneError&) {  // it has no rest
    return {};
  }
}

}  // namespace lab
