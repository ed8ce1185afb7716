#pragma once
/** @file Model.hpp
 * Model: what a scene is and what is asked of it, as plain data: what the
 * options of mass_spring say, and a scene file. docs/scenes.md */
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "CME212/Util.hpp"
#include "lab/scenes/Obstacle.hpp"
#include "lab/scenes/Words.hpp"

namespace lab {

/** Who chooses the step. */
enum class StepRule {
  fixed,  // whoever made the scene
  safe,   // safe_share of the limit in any shape, once
  sharp,  // sharp_share of the limit in the present shape, looked at again
          // every 100 steps; at most the limit in any shape
};

/** What a scene is made from besides its mesh and its parts. */
struct Parameters {
  double dt = 0.001;  ///< step [s], > 0; for StepRule::fixed
  StepRule rule = StepRule::fixed;
  double stiffness = 100;  ///< K of every spring [N/m], >= 0
  double gravity = grav;   ///< [m/s^2]
  double damping = 0;      ///< drag coefficient c of a node [kg/s], >= 0
};

/** Which springs a cloth has besides the sides of its quads. */
struct Edges {
  bool diagonals = true;
  bool bend = false;  ///< across two sides in a line
};

/** A cloth's material by area and length, so that a finer grid is the same
 * cloth; each of them instead of what the assignment gives to each node and
 * edge. */
struct Material {
  std::optional<double> density;  ///< [kg/m^2], > 0
  std::optional<double> modulus;  ///< force per width and strain [N/m], >= 0
  std::optional<double> drag;     ///< [kg/(s m^2)], >= 0
};

/** A grid over a parallelogram. */
struct Sheet {
  Point at;                                      ///< a corner [m]
  Point u = Point(1, 0, 0), v = Point(0, 1, 0);  ///< two sides [m]
  std::array<unsigned, 2> nodes = {20, 20};      ///< along u and v, >= 2
};

/** Nodes held where they start, or moved along a line: those whose start has
 * all of these coordinates [m]. */
struct Pin {
  std::optional<double> x, y, z;
  Motion motion;
  /** Within round-off of a cloth of some meters. */
  bool holds(const Point& p) const {
    auto is = [](const std::optional<double>& wanted, double a) {
      return !wanted || std::abs(*wanted - a) < 1e-9;
    };
    return is(x, p.x) && is(y, p.y) && is(z, p.z);
  }
};

/** A half space that no node enters: below a plane. */
struct Wall {
  Point at = Point(0, 0, -0.75);  ///< on the plane [m]
  Point normal = Point(0, 0, 1);  ///< away from it; of length 1
  Motion motion;
  double friction = 0;  ///< Coulomb's coefficient, >= 0
};

/** A ball that no node enters. */
struct Solid {
  Ball ball;
  Motion motion;
  double friction = 0;
};

/** Nodes without a common edge keep this distance. */
struct Distance {
  double thickness = 0;  ///< [m], > 0
  double friction = 0;
};

/** What is asked of a scene at its end. */
enum class Measure { com, energy, positions, max_stretch, drape_height };

constexpr std::array<const char*, 5> measure_names = {
    "com", "energy", "positions", "max-stretch", "drape-height"};
constexpr const char* name_of(Measure m) {
  return measure_names[static_cast<std::size_t>(m)];
}
constexpr const char* unit_of(Measure m) {
  return m == Measure::energy ? "J" : m == Measure::max_stretch ? "" : "m";
}

/** A scene: a cloth of sheets or from files, its material, and the parts that
 * act on it, each in words; nothing else acts. */
struct Model {
  // The cloth
  std::string nodes, tets;  ///< files; or
  std::vector<std::string> sheets;
  std::string edges = "sides diagonals";
  Material material;
  // What acts on it
  std::vector<std::string> pins, planes, spheres, tears;
  std::optional<double> tear_strain;  ///< [1], > 0
  std::string self_collision;
  // How it is computed, and how long
  Parameters with;
  std::string dt = "0.001";  ///< [s], or auto, or auto:sharp
  std::string method = "symplectic-euler";
  double t_end = 5;  ///< [s]
  // What is asked
  std::string measure = "com";
  double tolerance = 0.01;  ///< in the unit of the measure

  /** Whether it names a part. If not, it is a stage of the assignment. */
  bool is_composed() const {
    return !sheets.empty() || edges != Model().edges || material.density ||
           material.modulus || material.drag || !pins.empty() ||
           !planes.empty() || !spheres.empty() || !tears.empty() ||
           tear_strain || !self_collision.empty();
  }
};

// ------------------------------------------------- What the words of a part
// say

namespace model_detail {

inline Motion motion_of(const Words& w) {
  if (w.has("until")) w.require("velocity");
  return {w.point("velocity", Point()), w.at_least("until", 0, Motion().until)};
}
inline Ball ball_of(const Words& w) {
  Ball ball;
  ball.center = w.point("at", ball.center);
  if (w.has("radius")) ball.radius = w.above("radius", 0);
  return ball;
}
inline unsigned count_of(const Words& w, double n) {
  if (!(n >= 2 && n <= 10000 && n == std::floor(n)))
    w.fail("has nodes " + CME212::short_text(n) + ", expected 2 to 10000");
  return unsigned(n);
}

}  // namespace model_detail

// Each throws SceneError: other words or numbers than it may have.

inline Edges read_edges(const std::string& text) {
  const Words w("edges", text, {{"sides", 0}, {"diagonals", 0}, {"bend", 0}});
  w.require("sides");
  return {w.has("diagonals"), w.has("bend")};
}
inline Sheet read_sheet(const std::string& text) {
  const Words w("sheet", text, {{"at", 3}, {"u", 3}, {"v", 3}, {"nodes", 2}});
  Sheet s;
  s.at = w.point("at", s.at);
  s.u = w.point("u", s.u), s.v = w.point("v", s.v);
  if (w.has("nodes"))
    for (int k : {0, 1})
      s.nodes[k] = model_detail::count_of(w, w.numbers("nodes")[k]);
  if (!(norm(cross(s.u, s.v)) > 0)) w.fail("has sides u and v without an area");
  return s;
}
inline Pin read_pin(const std::string& text) {
  const Words w("pin", text,
                {{"x", 1}, {"y", 1}, {"z", 1}, {"velocity", 3}, {"until", 1}});
  Pin p;
  if (w.has("x")) p.x = w.number("x", 0);
  if (w.has("y")) p.y = w.number("y", 0);
  if (w.has("z")) p.z = w.number("z", 0);
  if (!p.x && !p.y && !p.z) w.fail("has none of x, y, z");
  p.motion = model_detail::motion_of(w);
  return p;
}
inline Wall read_plane(const std::string& text) {
  const Words w("plane", text,
                {{"at", 3},
                 {"normal", 3},
                 {"friction", 1},
                 {"velocity", 3},
                 {"until", 1}});
  Wall p;
  p.at = w.point("at", p.at);
  p.normal = w.point("normal", p.normal);
  if (!(norm(p.normal) > 0)) w.fail("has a normal without a direction");
  p.normal /= norm(p.normal);
  p.friction = w.at_least("friction", 0, 0);
  p.motion = model_detail::motion_of(w);
  return p;
}
inline Solid read_sphere(const std::string& text) {
  const Words w("sphere", text,
                {{"at", 3},
                 {"radius", 1},
                 {"friction", 1},
                 {"velocity", 3},
                 {"until", 1}});
  return {model_detail::ball_of(w), model_detail::motion_of(w),
          w.at_least("friction", 0, 0)};
}
inline Ball read_tear(const std::string& text) {
  return model_detail::ball_of(Words("tear", text, {{"at", 3}, {"radius", 1}}));
}
inline Distance read_self_collision(const std::string& text) {
  const Words w("self-collision", text, {{"thickness", 1}, {"friction", 1}});
  return {w.above("thickness", 0), w.at_least("friction", 0, 0)};
}
inline Measure read_measure(const std::string& text) {
  for (std::size_t k = 0; k < measure_names.size(); ++k)
    if (text == measure_names[k]) return Measure(k);
  std::string names;
  for (const char* name : measure_names)
    names += std::string(names.empty() ? "" : ", ") + name;
  throw SceneError("measure", "is " + text + ", expected one of " + names);
}

/** The words of @a s, as read_sheet() takes them. */
inline std::string to_words(const Sheet& s) {
  using CME212::exact_text;
  auto point = [](const char* name, const Point& p) {
    return std::string(name) + ' ' + exact_text(p.x) + ' ' + exact_text(p.y) +
           ' ' + exact_text(p.z) + ' ';
  };
  return point("at", s.at) + point("u", s.u) + point("v", s.v) + "nodes " +
         std::to_string(s.nodes[0]) + ' ' + std::to_string(s.nodes[1]);
}

}  // namespace lab
