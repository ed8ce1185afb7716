#pragma once
/** @file Compose.hpp
 * Makes the cloth, the forces and the constraints that a Model names. */
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lab/scenes/MeshFile.hpp"
#include "lab/scenes/Model.hpp"

namespace lab {

/** Something that is drawn besides the cloth. */
struct Obstacle {
  enum class Kind { floor, ball, tearing_ball } kind;
  Point at;           ///< on the floor, or the ball's center, at t = 0 [m]
  double radius = 0;  ///< of a ball [m]
  Motion motion = {};
};

/** The mesh that a cloth was built from, the id of each point's node, and the
 * force on it. */
struct BuiltMesh {
  PointsAndQuads mesh;
  std::vector<unsigned> ids;
  std::optional<CombinedForces> force;
};

/** The quads of the mesh whose four nodes and four sides @a g still has, in
 * their order.  @pre @a g was built from it  O(quads) */
std::vector<Quad> quads_left(const Cloth& g, const BuiltMesh& built);

/** What is left of a mesh: points and velocities of the nodes that @a g still
 * has, in the order of the mesh, and the quads that are left. A new cloth of
 * it has all springs of these quads, at rest.  O(points + quads) */
PointsAndQuads mesh_left(const Cloth& g, const BuiltMesh& built);

/** Nodes that a pin holds or moves, by their ids. */
struct HeldNodes {
  struct Held {
    unsigned id;
    Point place;  ///< at t = 0 [m]
  };
  std::vector<Held> nodes;  ///< by ascending id
  Motion motion = {};
};

/** What makes a scene, at its start and at each restart. */
struct Recipe {
  std::string name;
  double gravity = grav;  ///< of the force [m/s^2]
  /** Into an empty cloth. */
  std::function<void(Cloth&)> build;
  /** What build() and force() made, the last time; null if it has no mesh. */
  std::shared_ptr<const BuiltMesh> built;
  std::function<CombinedForces(const Cloth&)> force;
  std::function<CombinedConstraints(const Cloth&)> constraint;
  /** The nodes that pins hold at the start; and constraint() with other nodes
   * held. Null if the pins can't be changed. */
  std::function<std::vector<HeldNodes>(const Cloth&)> held;
  std::function<CombinedConstraints(const Cloth&,
                                    const std::vector<HeldNodes>&)>
      holding;
  std::vector<Obstacle> obstacles;
  std::vector<Point> room;  ///< corners of what to look at; empty: the cloth
};

/** The mesh that @a m names: that of its files, or its sheets in their order,
 * in which the index of a point grows along v first, as in grid_points().
 * Throws InputError */
PointsAndQuads mesh_of(const Model& m);

/** True if a pin of @a m holds or moves the node that starts at @a start. */
bool is_held(const Model& m, const Point& start);

/** The shortest side of a quad where the cloth of @a m starts [m]. */
double shortest_side(const Model& m);

/** Build the cloth of @a m from @a mesh, that of mesh_of(m), into @a g. With a
 * density each node has the mass of a quarter of each quad at it. With a
 * modulus Y each spring stands for the width of cloth beside it: cloth of
 * squares has K = Y, and half of that in the sides at its rim. The factors of
 * the regions come last. Nodes have the velocities of the mesh; those that a
 * pin holds have none.
 * @pre g.size() == 0
 * Throws SceneError: a node without mass, a region that changes nothing
 * Complexity: O(points + quads log quads) */
void build_model(Cloth& g, const Model& m, const PointsAndQuads& mesh);

/** The forces of @a m on @a g, which lies as it was built from @a mesh:
 * springs; and gravity and drag unless they are 0. Drag by area is shared by
 * the nodes as masses by density are, by a quarter of each quad at them: so c/m
 * is the same everywhere if there is a density, too.  O(points + quads) */
CombinedForces force_of(const Model& m, const PointsAndQuads& mesh,
                        const Cloth& g);

/** The constraints of @a m on @a g, which lies as it was built. In this order:
 * tearing, obstacles, pins: at a node the last one wins. Self-collision repeats
 * all of these until none is violated.
 * Throws SceneError: a pin that holds no node, but for those of the assignment;
 * a distance that is too large. */
CombinedConstraints constraint_of(const Model& m, const Cloth& g);

/** The nodes of @a g that the pins of @a m hold.  @pre @a g is as it was built
 * Throws SceneError: a pin that holds no node */
std::vector<HeldNodes> held_of(const Model& m, const Cloth& g);
/** constraint_of() with @a held in place of the pins of @a m; nodes that @a g
 * has no more are skipped. It uses no positions, so it may be called at any
 * time. */
CombinedConstraints constraint_of(const Model& m, const Cloth& g,
                                  const std::vector<HeldNodes>& held);

/** The recipe of @a m.  Throws InputError, SceneError, now or when it is used.
 */
Recipe recipe_of(const Model& m);
/** The same with a mesh that is there already. */
Recipe recipe_of(const Model& m, PointsAndQuads mesh);

}  // namespace lab
