#include <algorithm>
#include <cmath>

#include "CME212/Util.hpp"
#include "lab/advice/Grids.hpp"
#include "lab/advice/Refusals.hpp"
#include "lab/stepping/Trial.hpp"

namespace lab {

/** The end time, as text, until which perturbed starts stay close enough. Only
 * for measures in meters, which change at most by as much as positions do. */
std::string GridStudy::same_until(const Separation& apart) const {
  const bool in_meters = unit_of(q_.scene.measure) == std::string("m");
  const double horizon = apart.horizon(tolerance() / 2);
  if (!in_meters || !(horizon > 0) || horizon >= q_.scene.t_end) return "";
  return ", of up to " + CME212::short_text(horizon) + " s";
}

/** Let shake_ move no node along an axis along which none has moved until the
 * end, @a g: a motion that is symmetric stays so. */
void GridStudy::find_plane(const Cloth& g) {
  for (unsigned k = 0; k < 3; ++k)
    shake_.along[k] = std::ranges::any_of(g.nodes(), [&, k](Node n) {
      return n.position()[k] != g.node(0).position()[k] ||
             n.value().vel[k] != 0;
    });
}

std::string GridStudy::find_chaos(double scatter) {
  std::size_t k = runs_.size() - 1;
  while (k > 0 && grids()[k].factor > 0.55 * grids().back().factor) --k;
  const Run& run = runs_[k];
  const Answer& unshaken = grids()[k].trial.answer;
  std::vector<Answer> shaken;
  Track track = run.track.beside();
  if (q_.pilots.affords(run.work, "perturbed starts")) {
    const Trial t = q_.pilots.run(
        run.model, "a perturbed start", run.work, {}, shake_,
        [&](const Cloth& g) { shaken = all_answers(run.model, g); },
        [&](Scene& scene) { track.look(scene); });
    if (!t.ok()) return t.failure;
    ++q_.advice.perturbed;
    scatter = std::max(scatter, distance_of(unshaken, t.answer));
  }
  q_.advice.scatter = scatter;
  if (scatter <= tolerance() / 2) {
    find_buckling(run, unshaken);
    return "";
  }
  // Less than ten times the shake is not chaos, but the shake itself.
  return (scatter > 10 * shake_.size
              ? "the motion is chaotic: "
              : std::string("the tolerance is too small: ")) +
         "runs that should agree, with the start moved by 1e-6 m or with a "
         "slightly shorter step, differ by " +
         with_unit(scatter, q_.scene.measure) +
         ", so no grid and no step can meet the tolerance; " +
         offers(run.model, run.all, shaken) +
         same_until(Separation(run.track, track));
}

/** Tell if a cloth that moves in a plane, to the answer @a plane, would buckle.
 */
void GridStudy::find_buckling(const Run& run, const Answer& plane) {
  const auto along = std::ranges::find(shake_.along, false);
  if (along == shake_.along.end() ||
      !q_.pilots.affords(run.work, "a start moved out of its plane", 0.3))
    return;
  const Trial t =
      q_.pilots.run(run.model, "out of its plane", run.work, {}, {shake_.size});
  const double off = t.ok() ? distance_of(t.answer, plane) : infinite;
  if (off > tolerance() / 2)
    q_.advice.buckles = std::string("no node ever leaves its plane along ") +
                        "xyz"[along - shake_.along.begin()] +
                        ", but the cloth buckles: " +
                        (t.ok() ? name_of(q_.scene.measure) + " changes by " +
                                      with_unit(off, q_.scene.measure)
                                : t.failure) +
                        " if its start is moved out of that plane by 1e-6 m";
}

void GridStudy::try_squares() {
  const double f = factor(runs_.back().level);
  Sides s = sides_of(runs_.back().level);
  double longest = 1;
  for (std::size_t k = 0; k < s.size(); ++k) {
    const Sheet& sheet = q_.scene.sheets[k];
    const double ratio = norm(sheet.u) / (sheet.nodes[0] - 1.) /
                         (norm(sheet.v) / (sheet.nodes[1] - 1.));
    s[k] = {f * std::sqrt(ratio), f / std::sqrt(ratio)};
    for (unsigned along : {0, 1})  // a grid has at least 2 cells
      if ((sheet.nodes[along] - 1) * s[k][along] < 1.5) return;
    longest = std::max({longest, ratio, 1 / ratio});
  }
  if (!(longest > 1.2) ||
      !q_.pilots.affords(longest * runs_.back().work, "square cells", 0.5))
    return;
  try {
    const Model m = pilot(on_grid(s), f * std::sqrt(longest));
    const Trial t = q_.pilots.run(m, "on square cells", work_of_run(m));
    const double off =
        t.ok() ? distance_of(t.answer, grids().back().trial.answer) : 0;
    if (off > tolerance() / 2)
      q_.advice.oblong =
          "springs along oblong cells are another material: on square cells " +
          name_of(q_.scene.measure) + " changes by " +
          with_unit(off, q_.scene.measure);
  } catch (const SceneError&) {  // that grid misses a pin
  }
}

}  // namespace lab
