#include "lab/page/PageScenes.hpp"

#include <array>

#include "lab/methods/Methods.hpp"

namespace lab {

namespace {

/** A square of @a side x @a side nodes, by Verlet and without an end. */
Model square(const char* name, unsigned side) {
  Model m;
  m.name = name;
  m.sheets = {
      {.u = Point(1, 0, 0), .v = Point(0, 1, 0), .nodes = {side, side}}};
  m.method = find_method("verlet");
  m.t_end = no_limit;
  return m;
}

/** A stage of the assignment: its two corners are held. */
Model stage(const char* name, unsigned side, double depth = 1.25) {
  Model m = square(name, side);
  for (double x : {0, 1}) m.pins.push_back({x, 0, 0, {}});
  m.view = Box{Point(0, -0.4, -depth), Point(1, 0.6, 0)};
  return m;
}

/** A stage that has a floor. */
Model stage_with_floor(const char* name, unsigned side) {
  Model m = stage(name, side, 0.75);
  m.planes = {Wall()};
  return m;
}

/** Material by area: a finer grid is the same cloth. */
Model cloth(const char* name, unsigned side, double modulus, double drag) {
  Model m = square(name, side);
  m.material = {.density = 1, .modulus = modulus, .drag = drag};
  return m;
}

constexpr std::array scenes = {
    PageScene{"problem1", "3.2 no diagonals",
              [](unsigned side) {
                Model m = stage("problem1", side);
                m.edges.diagonals = false;
                return m;
              }},
    PageScene{"diagonals", "4.2 diagonals",
              [](unsigned side) { return stage("diagonals", side); }},
    PageScene{"forces", "5.2 combined forces",
              [](unsigned side) { return stage("forces", side); }},
    PageScene{"constraints", "6.2 a floor and a ball",
              [](unsigned side) {
                Model m = stage_with_floor("constraints", side);
                m.spheres = {{.ball = {}, .motion = {}}};
                return m;
              }},
    PageScene{"tear", "7.2 a ball that tears",
              [](unsigned side) {
                Model m = stage_with_floor("tear", side);
                m.tears = {Ball()};
                return m;
              }},
    PageScene{"curtain", "a curtain, drawn aside",
              [](unsigned side) {
                Model m = cloth("curtain", side, 100, 1);
                m.sheets[0].v = Point(0, 0, -1);
                Pin corner = {1, {}, -1, {}};
                corner.motion = {Point(-0.8, 0.4, 0.1), 0.5};
                m.pins = {{{}, {}, 0, {}}, corner};
                return m;
              }},
    PageScene{
        "drape", "a cloth falls on a ball",
        [](unsigned side) {
          Model m = cloth("drape", side, 100, 4);
          m.spheres = {{.ball = {Point(0.5, 0.5, -0.31), 0.3}, .motion = {}}};
          return m;
        }},
    PageScene{"membrane", "a membrane, held at its rim",
              [](unsigned side) {
                Model m = cloth("membrane", side, 100, 0);
                m.material.drag.reset();
                for (double x : {0, 1}) m.pins.push_back({x, {}, {}, {}});
                for (double y : {0, 1}) m.pins.push_back({{}, y, {}, {}});
                return m;
              }},
    PageScene{"rip", "pulled apart until it rips", [](unsigned side) {
                Model m = cloth("rip", side, 100, 10);
                Pin pulled = {1, {}, {}, {}};
                pulled.motion.velocity = Point(1, 0, 0.5);
                m.pins = {{0, {}, {}, {}}, pulled};
                m.tear_strain = 0.2;
                return m;
              }}};

}  // namespace

std::span<const PageScene> page_scenes() { return scenes; }

}  // namespace lab
