#pragma once
/** @file SceneBuilder.hpp
 * SceneData: what a viewer shows, as plain data. SceneBuilder: the part of a
 * viewer that collects it from a graph, in any thread. */
#include <algorithm>
#include <any>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "CME212/BoundingBox.hpp"
#include "CME212/Color.hpp"
#include "CME212/Point.hpp"
#include "CME212/viewer/Faces.hpp"

namespace CME212 {

/** Which parts of a cloth are drawn. */
struct Look {
  bool faces = true, wires = true;
  bool nodes = false;  ///< also those in a face; all others always are
};

/** A line [m] drawn on top of everything else; a ring if both ends coincide. */
struct Mark {
  Point from, to;
};

/** The scale of strain, which colors by Color::make_strain. */
struct StrainScale {
  double limit = 1;  ///< [%]; its ends are +limit (taut) and -limit (slack)
  bool above = false, below = false;  ///< some values are beyond that end
  bool operator==(const StrainScale&) const = default;
};

/** A scene to draw. */
struct SceneData {
  /** A node as a vertex buffer holds it: 16 bytes. */
  struct Vertex {
    float x, y, z;
    std::array<std::uint8_t, 4> rgba;
    Vertex(const Point& p, const Color& c)
        : x(float(p.x)),
          y(float(p.y)),
          z(float(p.z)),
          rgba{byte(c.r), byte(c.g), byte(c.b), 255} {}
    static std::uint8_t byte(float c) { return std::uint8_t(255 * c + 0.5f); }
  };
  using Ends = CME212::Ends;
  struct Sphere {
    Point center;
    double radius;
  };
  /** The part of a horizontal plane within @a half of its center. */
  struct Plane {
    Point center;
    double half;
  };

  std::vector<Vertex> nodes;
  std::vector<Ends> edges;
  std::vector<Quad> faces;  // of indices into nodes
  std::vector<Sphere> spheres;
  std::vector<Plane> planes;

  /** The box of all nodes and spheres. */
  BoundingBox box() const {
    BoundingBox b;
    for (const Vertex& v : nodes) b |= Point(v.x, v.y, v.z);
    for (const Sphere& s : spheres)
      (b |= s.center - s.radius) |= s.center + s.radius;
    return b;
  }
};

/** Collects a scene from the nodes and edges of a graph. After clear() the
 * viewer shows the previous scene until nodes were added; in a program that
 * draws edges, until edges were added. So no half built scene is shown.
 *
 * Threads: all members may be called by any thread at any time. The functors
 * run on the thread that calls, and must not call the builder. */
class SceneBuilder {
 public:
  SceneBuilder() = default;
  SceneBuilder(const SceneBuilder&) = delete;
  SceneBuilder& operator=(const SceneBuilder&) = delete;

  /** An empty map from the nodes of @a g to their indices in the scene. The
   * caller keeps it and passes it to add_nodes() and add_edges(); only they
   * change it. Clear it with every clear(). Any map with find(), end() and
   * try_emplace(hint, ...) works, as those of the standard library. */
  template <typename G>
  std::map<typename G::node_type, unsigned> empty_node_map(const G&) const {
    return {};
  }

  /** Add the nodes in [first, last), or change color and place of those that
   * are in @a node_map already.
   * @param color    color(Node) -> Color; white if left out
   * @param position position(Node) -> Point [m]; its position() if left out
   * @post @a node_map contains all of them.
   * Complexity: O(nodes) if they come in the order of the map, as those of a
   *       graph do; else O(nodes log nodes).
   * If a functor throws, the nodes before that one are added. */
  template <typename It, typename ColorFn, typename PositionFn, typename Map>
  void add_nodes(It first, It last, ColorFn color, PositionFn position,
                 Map& node_map) {
    std::lock_guard lock(build_mutex_);
    auto& nodes = building_.nodes;
    auto hint = node_map.end();
    for (; first != last; ++first) {
      const auto n = *first;
      const SceneData::Vertex v(position(n), color(n));
      auto at = node_map.try_emplace(hint, n, unsigned(nodes.size()));
      if (at->second < nodes.size()) {
        nodes[at->second] = v;
      } else {  // new, or the map was not cleared when the scene was
        at->second = unsigned(nodes.size());
        nodes.push_back(v);
        incomplete_ = has_edges_;
      }
      hint = std::next(at);
    }
    if (!incomplete_) publish();
  }
  template <typename It, typename ColorFn, typename Map>
  void add_nodes(It first, It last, ColorFn color, Map& node_map) {
    const auto position = [](const auto& n) { return n.position(); };
    add_nodes(first, last, color, position, node_map);
  }
  template <typename It, typename Map>
  void add_nodes(It first, It last, Map& node_map) {
    add_nodes(
        first, last, [](const auto&) { return Color(1); }, node_map);
  }

  /** Add the edges in [first, last) that have both ends in @a node_map; skip
   * the others. An edge that is in the scene already is not added again. It
   * stays in the scene until clear(), even if the graph removes it.
   * @post The scene is complete and shown.
   * Complexity: O(edges log nodes) with a std::map; from the second call after
   *       clear() on also O(E log E), for all E edges in the scene. */
  template <typename It, typename Map>
  void add_edges(It first, It last, const Map& node_map) {
    std::lock_guard lock(build_mutex_);
    auto& edges = building_.edges;
    const bool merge = !edges.empty();
    auto one = node_map.end();
    for (; first != last; ++first) {
      const auto e = *first;
      const auto n = e.node1();  // often the same as for the last edge
      if (one == node_map.end() || !(one->first == n)) one = node_map.find(n);
      const auto two = node_map.find(e.node2());
      if (one == node_map.end() || two == node_map.end()) continue;
      const auto [low, high] = std::minmax({one->second, two->second});
      if (high < building_.nodes.size()) edges.push_back({low, high});
    }
    if (merge) {
      std::sort(edges.begin(), edges.end());
      edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    }
    has_edges_ = edges_changed_ = true;
    publish();
  }

  /** Add the faces in [first, last), each an array of four nodes in the order
   * of a Quad. A face is shown if all its nodes are in @a node_map and all four
   * sides are among the edges, which are added after it.
   * Complexity: O(faces log nodes) with a std::map. */
  template <typename It, typename Map>
  void add_faces(It first, It last, const Map& node_map) {
    std::lock_guard lock(build_mutex_);
    place_faces(first, last, node_map);
  }

  /** From now on draw_graph(@a g) shows these quads as cloth, lit and with a
   * shadow. A quad that loses a node or a side becomes a hole. Uses num_nodes()
   * and node(i) of @a g.
   * @param quads a range of Quad, of present indices of nodes
   * @pre these are below num_nodes()
   * Complexity: O(quads) */
  template <typename G, typename Quads>
  void add_faces(const G& g, const Quads& quads) {
    FacesOf<G> faces;
    for (const Quad& q : quads)
      faces.push_back({g.node(q[0]), g.node(q[1]), g.node(q[2]), g.node(q[3])});
    std::lock_guard lock(build_mutex_);
    faces_ = std::move(faces);
  }

  /** Replace the scene by @a g: its nodes in white, its edges, and the faces of
   * add_faces(). Spheres and planes stay. Uses num_nodes() and node(i); for the
   * edges iterators or, with a graph of homework 0, num_edges() and edge(i).
   * @post The scene is shown.
   * Complexity: O((nodes + edges + faces) log nodes). */
  template <typename G>
  void draw_graph(const G& g) {
    auto node_map = start_with_nodes_of(g, true);
    {
      std::lock_guard lock(build_mutex_);
      if (const auto* faces = std::any_cast<FacesOf<G>>(&faces_))
        place_faces(faces->begin(), faces->end(), node_map);
    }
    if constexpr (requires { g.edge_begin(); }) {
      add_edges(g.edge_begin(), g.edge_end(), node_map);
    } else {
      std::vector<typename G::edge_type> edges;
      for (decltype(g.num_edges()) i = 0; i < g.num_edges(); ++i)
        edges.push_back(g.edge(i));
      add_edges(edges.begin(), edges.end(), node_map);
    }
  }
  /** As draw_graph(), but without edges.  O(nodes log nodes) */
  template <typename G>
  void draw_graph_nodes(const G& g) {
    start_with_nodes_of(g, false);
  }

  /** Begin a new scene without nodes and edges. Spheres and planes stay. */
  void clear() {
    std::lock_guard lock(build_mutex_);
    if (incomplete_ && !building_.nodes.empty()) {
      has_edges_ = false;  // none were added
      publish();
    }
    start(has_edges_);
  }

  /** Add a ball that stays until clear_shapes().  @pre radius > 0 [m] */
  void add_sphere(const Point& center, double radius) {
    change_shapes([&] { shown_.spheres.push_back({center, radius}); });
  }
  /** Add the plane z = @a z [m] until clear_shapes(). It is drawn as a mesh of
   * lines around @a center that fades at distance @a half [m], with 10 lines
   * on that distance.  @pre half > 0 */
  void add_plane(double z, double half = 1.5,
                 Point center = Point(0.5, 0.5, 0)) {
    center.z = z;
    change_shapes([&] { shown_.planes.push_back({center, half}); });
  }
  /** Remove all spheres and planes. */
  void clear_shapes() {
    change_shapes([&] { shown_.spheres.clear(), shown_.planes.clear(); });
  }

  /** True if the latest complete scene was taken by take(). If a simulation
   * builds a scene only then, each scene is drawn. Costs one atomic read. */
  bool wants_frame() const { return wants_frame_; }

  /** Show the scene as it is, although no edges were added since clear(). */
  void complete() {
    std::lock_guard lock(build_mutex_);
    if (incomplete_ || edges_changed_) publish();
  }

  /** If the complete scene changed since the last call, call
   * @a use(const SceneData&, bool edges_or_faces_changed) under a lock.
   * @post wants_frame() */
  template <typename F>
  void take(F use) {
    std::lock_guard lock(shown_mutex_);
    if (has_new_) use(std::as_const(shown_), new_edges_);
    has_new_ = new_edges_ = false;
    wants_frame_ = true;
  }
  /** Let the next take() return the whole scene, as if it were the first. */
  void take_again() {
    std::lock_guard lock(shown_mutex_);
    has_new_ = new_edges_ = true;
  }
  /** True if take() would find something new. */
  bool has_new() const { return has_new_; }

 private:
  /** Nodes, not indices, which change by removals. */
  template <typename G>
  using FacesOf = std::vector<std::array<typename G::node_type, 4>>;

  std::mutex build_mutex_;      // locked before shown_mutex_
  SceneData building_;          // its nodes, edges and faces
  std::any faces_;              // of draw_graph(): a FacesOf<G>
  bool incomplete_ = false;     // edges are still to come
  bool edges_changed_ = false;  // building_ has other edges than shown_
  bool has_edges_ = false;      // the program draws edges

  std::mutex shown_mutex_;
  SceneData shown_;
  bool new_edges_ = false;
  std::atomic<bool> has_new_ = false, wants_frame_ = true;

  // With build_mutex_ locked:
  void start(bool edges_follow) {
    building_.nodes.clear();
    building_.edges.clear();
    building_.faces.clear();
    has_edges_ = incomplete_ = edges_follow;
    edges_changed_ = true;
  }
  template <typename It, typename Map>
  void place_faces(It first, It last, const Map& node_map) {
    for (; first != last; ++first) {
      Quad face;
      unsigned found = 0;
      for (const auto& n : *first) {
        const auto at = node_map.find(n);
        if (at == node_map.end() || at->second >= building_.nodes.size()) break;
        face[found++] = at->second;
      }
      if (found == 4) building_.faces.push_back(face);
    }
    edges_changed_ = true;
    incomplete_ = incomplete_ || has_edges_;
  }
  void publish() {
    std::vector<Quad> left;
    if (edges_changed_)
      left =
          faces_left(building_.faces, building_.edges, building_.nodes.size());
    std::lock_guard lock(shown_mutex_);
    shown_.nodes = building_.nodes;
    if (edges_changed_) {
      shown_.edges = building_.edges;
      shown_.faces = std::move(left);
    }
    new_edges_ |= edges_changed_;
    incomplete_ = edges_changed_ = false;
    has_new_ = true;
    wants_frame_ = false;
  }

  /** Clear, and add the nodes of @a g.  @return where they are */
  template <typename G>
  auto start_with_nodes_of(const G& g, bool edges_follow) {
    {
      std::lock_guard lock(build_mutex_);
      start(edges_follow);
    }
    auto node_map = empty_node_map(g);
    std::vector<typename G::node_type> nodes;
    for (decltype(g.num_nodes()) i = 0; i < g.num_nodes(); ++i)
      nodes.push_back(g.node(i));
    add_nodes(nodes.begin(), nodes.end(), node_map);
    return node_map;
  }

  template <typename F>
  void change_shapes(F change) {
    std::lock_guard lock(shown_mutex_);
    change();
    has_new_ = true;
  }
};

}  // namespace CME212
