#include <algorithm>
#include <cmath>

#include "CME212/BoundingBox.hpp"
#include "CME212/Util.hpp"
#include "lab/advice/Grids.hpp"
#include "lab/fast/Energy.hpp"
#include "lab/scenes/Compose.hpp"

namespace lab {

namespace {
bool has_point_pin(const Model& m) {
  return std::ranges::any_of(points_held(m, mesh_of(m)),
                             [](const auto& held) { return held.size() == 1; });
}
}  // namespace

std::string converging_slowly(const Model& m) {
  if (m.sheets.empty() || !has_point_pin(m)) return "";
  return std::string(
             "; a pin of one node holds a smaller piece of a finer cloth, so "
             "the answer converges slowly: hold a side, for example by --pin "
             "\"x 0\"") +
         (m.measure.quantity == Measure::pin_force && m.measure.pin != Pin()
              ? ", or ask for --measure pin-force, the force on all pins"
              : "");
}

std::string diverging(const Model& m) {
  if (m.measure.quantity != Measure::max_stretch || !has_point_pin(m))
    return "";
  return "the stretch at a pin of one node grows without bound as the grid "
         "gets finer, because ever narrower strips of cloth carry the load: "
         "hold a side, for example by --pin \"x 0\", or ask for --measure "
         "drape-height";
}

std::vector<Answer> all_answers(const Model& m, const Cloth& g) {
  std::vector<Answer> all;
  for (int k = 0; k < Measure::lost_energy; ++k) {
    const Measure what = Measure::Quantity(k);
    all.push_back(can_answer(m, what) ? answer(m, g, what) : Answer());
  }
  return all;
}

std::string offers(const Model& m, const std::vector<Answer>& answers,
                   const std::vector<Answer>& shaken) {
  Cloth g;
  build_model(g, m, mesh_of(m));
  CME212::BoundingBox box;
  for (Node n : g.nodes()) box |= n.position();
  const double size = box.diagonal();
  std::string all;
  for (std::size_t k = 0; k < std::min(answers.size(), shaken.size()); ++k) {
    if (answers[k].empty() || shaken[k].empty()) continue;
    const Measure what = Measure::Quantity(k);
    // Four times the change by one perturbation, as others change it more.
    const double to = std::max(1e-5, 4 * distance(answers[k], shaken[k], what));
    const double scale = what == Measure(Measure::energy)
                             ? total_mass(g) * m.gravity.size() * size
                         : what == Measure(Measure::max_stretch) ? answers[k][0]
                                                                 : size;
    if (what != m.measure && to <= 0.1 * scale)
      all += std::string(all.empty() ? "" : ", ") + "--measure " +
             name_of(what) + " to " + with_unit(to, what);
  }
  return all.empty()
             ? "no other measure is more predictable: ask at an earlier --t-end"
             : "what can be answered: " + all +
                   "; or the same at an earlier --t-end";
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
  std::size_t k = grids().size() - 1;
  while (k > 0 && grids()[k].factor > 0.55 * grids().back().factor) --k;
  const GridReport& run = grids()[k];
  const Measure& what = q_.scene.measure;
  std::vector<Answer> shaken;
  double until = 0;  // so long the answers agree
  if (q_.pilots.affords(run.work, "perturbed starts")) {
    const Trial t = q_.pilots.run(
        run.model, "a perturbed start", run.work, {}, shake_,
        [&](const Cloth& g) { shaken = all_answers(run.model, g); });
    if (!t.ok()) return *t.failure;
    ++q_.advice.perturbed;
    scatter = std::max(scatter, distance_of(run.trial.answer, t.answer));
    const auto &a = run.trial.earlier, &b = t.earlier;
    for (std::size_t k = 0;
         k < std::min(a.size(), b.size()) && a[k].size() == b[k].size() &&
         distance_of(a[k], b[k]) <= tolerance() / 2;
         ++k)
      until = double(k + 1) / Trial::looks * q_.scene.t_end;
  }
  q_.advice.scatter = scatter;
  if (scatter <= tolerance() / 2) {
    find_buckling(run);
    return "";
  }
  std::string text =
      // Less than ten times the shake is not chaos, but the shake itself.
      (scatter > 10 * shake_.size ? "the motion is chaotic: "
                                  : "the tolerance is too small: ") +
      ("runs that should agree, with the start moved by 1e-6 m or with a "
       "slightly shorter step, differ by " +
       with_unit(scatter, what)) +
      ", more than half of the tolerance, so no grid and no step is sure to "
      "meet it; " +
      offers(run.model, run.all, shaken);
  if (until > 0) text += ", of up to " + CME212::short_text(until) + " s";
  return text;
}

/** Tell if a cloth that moves in a plane in @a run would buckle. */
void GridStudy::find_buckling(const GridReport& run) {
  const auto along = std::ranges::find(shake_.along, false);
  if (along == shake_.along.end() ||
      !q_.pilots.affords(run.work, "a start moved out of its plane", 0.3))
    return;
  const Trial t =
      q_.pilots.run(run.model, "out of its plane", run.work, {}, {shake_.size});
  const double off =
      t.ok() ? distance_of(t.answer, run.trial.answer) : infinite;
  if (off > tolerance() / 2)
    q_.advice.buckles = std::string("no node ever leaves its plane along ") +
                        "xyz"[along - shake_.along.begin()] +
                        ", but the cloth buckles: " +
                        (t.ok() ? name_of(q_.scene.measure) + " changes by " +
                                      with_unit(off, q_.scene.measure)
                                : *t.failure) +
                        " if its start is moved out of that plane by 1e-6 m";
}

}  // namespace lab
