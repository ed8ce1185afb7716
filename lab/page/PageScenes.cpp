#include "lab/page/PageScenes.hpp"

#include <array>

#include "lab/methods/Methods.hpp"

namespace lab {

std::span<const StoredScene* const> page_scenes() {
  static const std::array all = {
      &stored_scene("problem1"), &stored_scene("diagonals"),
      &stored_scene("forces"),   &stored_scene("constraints"),
      &stored_scene("tear"),     &stored_scene("curtain"),
      &stored_scene("drape"),    &stored_scene("membrane"),
      &stored_scene("rip")};
  return all;
}

Model page_model(const StoredScene& s, unsigned side) {
  Model m = s.model();
  if (m.sheets.empty()) m.sheets = {Sheet()};  // a stage leaves its mesh open
  m.sheets[0].nodes = {side, side};
  m.method = find_method("verlet");
  m.step = {};
  m.t_end = no_limit;
  return m;
}

}  // namespace lab
