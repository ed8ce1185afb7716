#include "lab/page/PageScenes.hpp"

#include <algorithm>
#include <vector>

#include "lab/methods/Methods.hpp"

namespace lab {

std::span<const StoredScene* const> page_scenes() {
  static const auto all = [] {
    std::vector<const StoredScene*> list;
    for (const char* name : {"problem1", "diagonals", "forces", "constraints",
                             "tear", "curtain", "drape", "membrane", "rip"})
      list.push_back(&stored_scene(name));
    for (const StoredScene& s : failing_scenes()) list.push_back(&s);
    return list;
  }();
  return all;
}
bool always_fails(const StoredScene& s) {
  return std::ranges::any_of(failing_scenes(),
                             [&](const auto& f) { return &f == &s; });
}

Model page_model(const StoredScene& s, unsigned side) {
  Model m = s.model();
  m.t_end = no_limit;
  if (always_fails(s)) return m;
  if (m.sheets.empty()) m.sheets = {Sheet()};  // a stage leaves its mesh open
  m.sheets[0].nodes = {side, side};
  m.method = &table::verlet;
  m.step = {};
  return m;
}

}  // namespace lab
