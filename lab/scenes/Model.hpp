#pragma once
/** @file Model.hpp
 * Model: a scene as plain data: a cloth, what acts on it, how it is computed,
 * and what is asked of it. SI units; z points up. See README.md. */
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "lab/fast/Gravity.hpp"
#include "lab/fast/Motion.hpp"
#include "mass_spring.hpp"

namespace lab {

struct MethodEntry;  // lab/methods/Method.hpp

/** An error in a scene. what() begins with the option that is wrong. */
struct SceneError : std::runtime_error {
  SceneError(const std::string& option, const std::string& what)
      : std::runtime_error("--" + option + " " + what) {}
  SceneError(const std::string& option, const std::string& value,
             const std::string& expected)
      : SceneError(option, "is " + value + ", expected " + expected) {}
};

/** How the step is chosen. */
enum class StepRule {
  fixed,  ///< the scene gives dt
  safe,   ///< StepControl chooses it, starting at safe_share of the limit of
          ///< small oscillations in every configuration
  sharp,  ///< the same, starting at sharp_share of the limit in the present
          ///< configuration, but not above the limit in all configurations
};

/** How long a step is. */
struct TimeStep {
  double dt = 0.001;  ///< [s], > 0; of StepRule::fixed
  StepRule rule = StepRule::fixed;
  double gain = 0.1;  ///< tolerated gain of energy by chosen steps, as a share
                      ///< of the internal energy, in (0, 1]
  /** Tolerated error of an inner step of an adaptive method [m]; 0: the
   * method's default. */
  double tolerance = 0;
  bool fixed() const { return rule == StepRule::fixed; }
};

/** The springs of one kind: there or not, and their K. */
struct SpringKind {
  bool there = true;
  std::optional<double> K = {};  ///< [N/m]; none: as Model gives it
  SpringKind(bool is_there) : there(is_there) {}  // NOLINT: as a bool
  operator bool() const { return there; }         // NOLINT
  bool operator==(const SpringKind&) const = default;
};

/** Which springs a cloth has: the sides of its faces, and others. */
struct Edges {
  SpringKind sides = true, diagonals = true;
  SpringKind bend = false;  ///< between nodes two sides apart in a line
  bool operator==(const Edges&) const = default;
};

/** Material per area and length, so that a finer grid is the same cloth. A
 * member that is set replaces the assignment's values of nodes or edges. */
struct Material {
  std::optional<double> density;  ///< [kg/m^2], > 0
  std::optional<double> modulus;  ///< force per width and strain [N/m], >= 0
  std::optional<double> drag;     ///< [kg/(s m^2)], >= 0
};

/** A grid over a parallelogram. */
struct Sheet {
  Point at = Point();                            ///< a corner [m]
  Point u = Point(1, 0, 0), v = Point(0, 1, 0);  ///< two sides [m]
  std::array<unsigned, 2> nodes = {20, 20};      ///< along u and v, >= 1
  Point velocity = Point();  ///< of all nodes, at t = 0 [m/s]
  bool operator==(const Sheet&) const = default;
};

/** Opposite corners of a box. */
struct Box {
  Point from, to;  ///< [m], in any order
  /** True inside and on the boundary, to 1e-9 m. */
  bool holds(const Point& p) const;
  bool operator==(const Box&) const = default;
};

/** Another material in a part of the cloth: factors of the mass of the nodes
 * that start in a box, and of K of the edges that have both ends there. Where
 * regions overlap, their factors multiply. */
struct Region {
  Box box;
  double mass = 1;       ///< factor [1], > 0
  double stiffness = 1;  ///< factor [1], >= 0
  bool operator==(const Region&) const = default;
};

/** Holds or moves the nodes whose initial positions have the given coordinates
 * [m], or one node by its index; at least one of these is given. */
struct Pin {
  std::optional<double> x = {}, y = {}, z = {}, node = {};
  Motion motion = {};
  static constexpr double near = 1e-9;  ///< [m]
  /** How far the start @a p of node @a i is from what it holds: the largest
   * difference of a given coordinate [m]; infinity for another index. */
  double distance(unsigned i, const Point& p) const;
  bool operator==(const Pin&) const = default;
};

/** Air that moves. Drag acts by the velocity relative to it. */
struct Wind {
  Point velocity;  ///< [m/s]
};

/** The half space below a plane, which no node enters. */
struct Wall {
  Point at = Point(0, 0, -0.75);  ///< on the plane [m]
  Point normal = Point(0, 0, 1);  ///< out of the wall, of any length > 0
  double friction = 0;            ///< Coulomb's coefficient, >= 0
  Motion motion;
  /** The normal, of length 1. */
  Point out() const { return normal / norm(normal); }
  /** How far below it @a p lies at t = 0 [m]; negative above it. */
  double depth(const Point& p) const { return dot(at - p, out()); }
  bool operator==(const Wall&) const = default;
};

/** A ball that no node enters. */
struct Solid {
  Ball ball;
  double friction = 0;
  Motion motion;
  /** How far from its surface @a p lies inside at t = 0 [m]; else negative. */
  double depth(const Point& p) const {
    return ball.radius - norm(p - ball.center);
  }
};

/** Nodes without a common edge keep this distance. */
struct Distance {
  double thickness = 0;  ///< [m], > 0
  double friction = 0;
};

/** A place on a sheet: its share of both sides, 0 to 1; the sheet's number. */
struct SheetPlace {
  double u = 0.5, v = 0.5, sheet = 1;
  bool operator==(const SheetPlace&) const = default;
};

/** The question about a scene: a quantity at its end, or what it did over time.
 * Measure.hpp has the table of quantities. */
struct Measure {
  enum Quantity {
    com,
    energy,
    positions,
    max_stretch,
    drape_height,
    kinetic_energy,
    elastic_energy,
    lost_energy,
    pin_force,
    contact_force,
    tension,
    max_tension,
    torn_edges,
    torn_nodes,
    tear_time,
    point,
    distance,
    stretch_at
  };
  /** Over time: a value, or the time when it first or last passed a level, or
   * the mean time between maxima. */
  enum Over { at_end, largest, smallest, mean, first, last, period };
  Quantity quantity;
  Over over = at_end;
  std::array<bool, 3> only = {};  ///< of com, point: one component, x, y or z
  Pin pin = {};  ///< of pin-force: where its nodes start; empty: all pins
  std::array<unsigned, 2> between = {0, 1};  ///< of tension: nodes, by index
  SheetPlace place = {}, to = {.u = 1, .v = 1};  ///< to: of distance
  double from = 0;                            ///< of mean: its first time [s]
  std::optional<double> above, below;         ///< of first and last: the level
  Measure(Quantity q = com) : quantity(q) {}  // NOLINT: a quantity at the end
  /** True if it depends on all states of a run, not on the last one alone. */
  bool over_time() const { return over != at_end || quantity == tear_time; }
  /** True if the answer is a time [s]. */
  bool is_time() const { return over >= first || quantity == tear_time; }
  /** True if it names a place on a sheet. */
  bool has_place() const { return quantity >= point; }
  /** True if it counts parts of the mesh, whose number depends on the grid. */
  bool counts() const {
    return quantity == torn_edges || quantity == torn_nodes;
  }
  /** True if component k, 0 to 2, is asked for: by name, or as all are. */
  bool has(std::size_t k) const { return only[k] || only == Measure().only; }
  bool operator==(const Measure&) const = default;
};

/** symplectic-euler, the method of the assignment. */
const MethodEntry* default_method();

/** A scene. Parts that it does not name do not act. */
struct Model {
  std::string name = "scene";  ///< of its output files
  // The cloth
  std::string nodes, tets;  ///< files, or else net or sheets
  std::string net;          ///< one file
  std::vector<Sheet> sheets;
  Edges edges;
  double stiffness = 100;  ///< K of every spring [N/m], >= 0
  double rest_length = 1;  ///< factor of the rest length of every spring, >= 0
  Material material;
  std::vector<Region> regions;
  // What acts on it
  Gravity gravity;
  double damping = 0;  ///< drag coefficient c of a node [kg/s], >= 0
  std::optional<Wind> wind;
  std::vector<Pin> pins;
  std::vector<Wall> planes;
  std::vector<Solid> spheres;
  std::vector<Ball> tears;
  std::optional<double> tear_strain;  ///< [1], > 0
  std::optional<Distance> self_collision;
  bool from_rest = false;  ///< begin at rest: lab/rest/Equilibrium.hpp
  // How it is computed, and how long
  TimeStep step;
  const MethodEntry* method = default_method();  ///< never null
  double t_end = 5;                              ///< [s], >= 0
  std::vector<std::string> at;  ///< changes meanwhile: read_changes()
  // The question
  Measure measure = Measure::com;
  double tolerance = 0.01;  ///< in the unit of the measure
  bool percent = false;     ///< tolerance is in percent: Advice::asked
  // How it is shown
  std::optional<Box> view;  ///< the box to look at

  /** True if nodes may touch something or edges break: not smooth motion. */
  bool has_contact() const;
  /** Does an obstacle hold @a p at t = 0, by more than 1e-9 m? */
  bool starts_inside(const Point& p) const;
  /** True if nothing changes its energy: no drag, no contact, no moving pin. */
  bool conserves_energy() const;
  /** True if it has the pins and the floor of assignment_scene(). These pins
   * may hold no node, as they go with any mesh. */
  bool is_assignment() const;
  /** True if it names a part, from `sheet` to `self-collision` in README.md. */
  bool names_parts() const;
};

/** The last scene of the assignment, data/scenes/tear.toml: two corners held, a
 * floor, and a ball that tears. It has no mesh. */
Model assignment_scene();

/** @a m; or, if it names no part and no net, @a m with the parts of
 * assignment_scene(): what the command line gets without a scene file. */
Model or_assignment(Model m);

}  // namespace lab
