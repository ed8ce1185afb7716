/** @file Breakage.cpp
 * The scenes that fail: those of the gallery in lab/stability/README.md. */
#include "lab/live/Live.hpp"
#include "lab/methods/Methods.hpp"

namespace lab {

namespace {

/** A square of @a side x @a side nodes that hangs by two corners. */
Model hanging(const char* name, unsigned side, bool diagonals = true) {
  Model m;
  m.name = name;
  m.sheets = {
      {.u = Point(1, 0, 0), .v = Point(0, 1, 0), .nodes = {side, side}}};
  m.edges.diagonals = diagonals;
  for (double x : {0, 1}) m.pins.push_back({x, 0, 0, {}});
  m.view = Box{Point(0, -0.4, -1.25), Point(1, 0.6, 0)};
  return m;
}
Model by(Model m, const char* method, double dt) {
  m.method = find_method(method);
  m.step.dt = dt;
  return m;
}

constexpr std::array gallery = {
    Breakage{"step", "the step is beyond the limit",
             [] { return hanging("step", 100); }},
    Breakage{"path", "the step was fine until the springs stretched",
             [] {
               return by(hanging("path", 25, false), "symplectic-euler",
                         0.0034);
             }},
    Breakage{"drag", "drag makes it worse",
             [] {
               Model m = hanging("drag", 25);
               m.damping = 3;
               return m;
             }},
    Breakage{"forward-euler", "it gets livelier and livelier",
             [] {
               return by(hanging("forward-euler", 25, false), "forward-euler",
                         1e-4);
             }},
    Breakage{"midpoint", "an implicit method explodes after all",
             [] {
               return by(hanging("midpoint", 25), "implicit-midpoint", 0.0333);
             }},
    Breakage{"augmented-verlet", "tearing excites what nothing damps",
             [] {
               Model m = by(hanging("augmented-verlet", 25), "augmented-verlet",
                            0.023);
               m.planes = {Wall()};
               m.tears = {Ball()};
               m.view = Box{Point(0, -0.4, -0.75), Point(1, 0.6, 0)};
               return m;
             }},
    Breakage{"xpbd", "too few substeps give energy",
             [] {
               Model m = by(hanging("xpbd", 25), "xpbd", 0.0333);
               m.stiffness = 1e4;
               return m;
             }},
    Breakage{"tunnel", "nodes jump through the ball", [] {
               Model m = by(hanging("tunnel", 5), "symplectic-euler", 0.01);
               m.gravity = 3000;
               m.t_end = 0.1;
               m.planes = {Wall()};
               m.tears = {Ball()};
               m.view = Box{Point(0, -0.4, -0.75), Point(1, 0.6, 0)};
               return m;
             }}};

}  // namespace

std::span<const Breakage> breakages() { return gallery; }

}  // namespace lab
