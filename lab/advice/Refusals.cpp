#include "lab/advice/Refusals.hpp"

#include <algorithm>

#include "CME212/BoundingBox.hpp"
#include "CME212/Util.hpp"
#include "lab/advice/Advice.hpp"
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
  return "; a pin of one node holds a smaller piece of a finer cloth, so the "
         "answer converges slowly: hold a side, for example by --pin \"x 0\"";
}

std::string diverging(const Model& m) {
  if (m.measure.quantity != Measure::max_stretch || !has_point_pin(m))
    return "";
  return "the stretch at a pin of one node grows without bound as the grid "
         "gets finer, because ever narrower strips of cloth carry the load: "
         "hold a side, for example by --pin \"x 0\", or ask for --measure "
         "drape-height";
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
                             ? total_mass(g) * m.gravity * size
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

}  // namespace lab
