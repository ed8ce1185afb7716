#pragma once
/** @file Compose.hpp
 * Builds the cloth, the forces and the constraints that a Model describes. */
#include <vector>

#include "lab/scenes/MeshFile.hpp"
#include "lab/scenes/Model.hpp"

namespace lab {

/** An obstacle, for drawing. */
struct Obstacle {
  enum class Kind { floor, ball, tearing_ball } kind;
  Point at;           ///< on the floor, or the ball's center, at t = 0 [m]
  double radius = 0;  ///< of a ball [m]
  Motion motion = {};
};

/** The mesh that a cloth was built from, and the ids of the nodes of its
 * points. */
struct BuiltMesh {
  Net mesh;
  std::vector<unsigned> ids;
};

/** The ids of the nodes of @a g, by index.  O(N) */
std::vector<unsigned> ids_of(const Cloth& g);

/** How the springs of @a g act, by edge id, as @a net lists them; empty if all
 * pull and push.  @param ids of its nodes   O(springs) */
std::vector<Acts> ways_of(const Net& net, const std::vector<unsigned>& ids,
                          const Cloth& g);

/** The quads of the mesh whose four nodes and four sides @a g still has, in
 * the order of the mesh.  @pre @a g was built from @a built  O(quads) */
std::vector<Quad> quads_left(const Cloth& g, const BuiltMesh& built);

/** The mesh that is left: points and velocities of the nodes that @a g still
 * has, in the order of the mesh, and quads_left(). A cloth built from it has
 * all springs of these quads, at their rest lengths.  O(points + quads) */
Net mesh_left(const Cloth& g, const BuiltMesh& built);

/** The nodes that one pin holds or moves, by their ids. */
struct HeldNodes {
  struct Held {
    unsigned id;
    Point place;  ///< at t = 0 [m]
  };
  std::vector<Held> nodes;  ///< by ascending id
  Motion motion = {};
};

/** mesh_left() with the masses, all springs, each with its K and L, and the
 * nodes of @a held: a cloth built from it is @a g.  O(points + springs) */
Net net_left(const Cloth& g, const BuiltMesh& built,
             const std::vector<HeldNodes>& held);

/** The mesh of @a m: from its files, or of its sheets in their order. On a
 * sheet the index of the points grows along v first, as in grid_points().
 * Throws InputError */
Net mesh_of(const Model& m);

/** The nodes of @a net that each pin of @a m holds or moves, by index, then
 * those that the net holds itself. If no node is where a pin says, it holds the
 * nearest ones within 1e-6 of the size of the net: its numbers were rounded.
 * O(points pins) */
std::vector<std::vector<unsigned>> points_held(const Model& m, const Net& net);
/** For each node of @a net, whether points_held() has it. */
std::vector<char> is_held(const Model& m, const Net& net);

/** The shortest side of a face in the initial cloth of @a m [m]. */
double shortest_side(const Model& m);

/** Build the cloth of @a m in @a g.  @param mesh mesh_of(m)
 * With a density, a node has a quarter of the mass of each quad at it, a third
 * of each triangle. With a modulus Y, a spring stands for the strip of cloth
 * beside it: in a grid of squares K = Y, and Y/2 in the sides along its
 * boundary. The factors of the regions are applied last. Nodes have the
 * velocities of the mesh, but held nodes are at rest.
 * @pre g.size() == 0
 * Throws SceneError: a node without mass, a spring without K, a region that
 * changes nothing
 * Complexity: O(points + quads log quads + springs) */
void build_model(Cloth& g, const Model& m, const Net& mesh);

/** The forces of @a m on @a g: springs, gravity and drag unless they are 0, and
 * wind.
 * Drag by area is distributed over the nodes like mass by density: a quarter of
 * that of each quad at the node. So with both, c/m is the same at all nodes.
 * @pre @a g was just built from @a mesh  O(points + quads) */
CombinedForces force_of(const Model& m, const Net& mesh, const Cloth& g);

/** The constraints of @a m on the cloth @a g of @a net, in this order: tearing,
 * obstacles, pins. At a node the last one wins. Self-collision repeats all
 * until none is violated.
 * @pre @a g was just built
 * Throws SceneError: a pin that holds no node, except the assignment's; a
 * thickness above the initial distance of two unconnected nodes. */
CombinedConstraints constraint_of(const Model& m, const Net& net,
                                  const Cloth& g);

/** The nodes of points_held(), by the pins of @a m, then those of the net.
 * @pre @a g was just built
 * Throws SceneError: a pin that holds no node */
std::vector<HeldNodes> held_of(const Model& m, const Net& net, const Cloth& g);
/** constraint_of() with @a held instead of the pins of @a m. Removed nodes are
 * skipped. No positions of @a g are used, so it may be called at any time. */
CombinedConstraints constraint_of(const Model& m, const Cloth& g,
                                  const std::vector<HeldNodes>& held);

/** What of @a m is drawn: balls, and floors that are level. An inclined plane
 * would hide what lies on it. */
std::vector<Obstacle> obstacles_of(const Model& m);

}  // namespace lab
