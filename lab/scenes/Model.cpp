#include "lab/scenes/Model.hpp"

#include <algorithm>

#include "lab/methods/Methods.hpp"
#include "lab/scenes/StoredScenes.hpp"

namespace lab {

bool Box::holds(const Point& p) const {
  auto within = [](double a, double b, double x) {
    return std::min(a, b) - Pin::near < x && x < std::max(a, b) + Pin::near;
  };
  return within(from.x, to.x, p.x) && within(from.y, to.y, p.y) &&
         within(from.z, to.z, p.z);
}

double Pin::distance(unsigned i, const Point& p) const {
  double d = node && *node != i ? no_limit : 0;
  const std::optional<double> wanted[] = {x, y, z};
  for (int k : {0, 1, 2})
    if (wanted[k]) d = std::max(d, std::abs(*wanted[k] - p[k]));
  return d;
}

const MethodEntry* default_method() { return &table::symplectic_euler; }

bool Model::starts_inside(const Point& p) const {
  const auto holds = [&p](const auto& part) { return part.depth(p) > 1e-9; };
  return std::ranges::any_of(planes, holds) ||
         std::ranges::any_of(spheres, holds);
}

bool Model::conserves_energy() const {
  const bool moves = std::ranges::any_of(
      pins, [](const Pin& pin) { return pin.motion.moves(); });
  return !has_contact() && !moves && material.drag.value_or(damping) == 0;
}

bool Model::is_assignment() const {
  const Model scene = assignment_scene();
  return pins == scene.pins && planes == scene.planes;
}

Model assignment_scene() {
  static const Model tear = stored_scene("tear").model();
  return tear;
}

Model or_assignment(Model m) {
  if (m.names_parts() || !m.net.empty()) return m;
  const Model scene = assignment_scene();
  if (m.name == Model().name) m.name = scene.name;
  m.pins = scene.pins, m.planes = scene.planes, m.tears = scene.tears;
  if (!m.view) m.view = scene.view;
  return m;
}

}  // namespace lab
