#pragma once
/** @file Force.hpp
 * The forces on a cloth. A force is anything that can be called as
 * Point(Node n, double t): the force [N] on node n at time t [s]. It may read
 * all positions, unless it says springs(), and of the velocities that of n. */
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <typeinfo>
#include <utility>
#include <vector>

#include "Cloth.hpp"

/** Section 3.2 and 4.2: gravity and springs in one; corners feel no force,
 * so that they stay where they are when they start at rest. */
class Problem1Force {
 public:
  /** Each spring by its own K and L (section 4.2). */
  Problem1Force() = default;
  explicit Problem1Force(double gravity) : gravity_(gravity) {}
  /** All springs alike (section 3.2).
   * @param K [N/m]   @param L rest length [m]   @param gravity [m/s^2] */
  Problem1Force(double K, double L, double gravity = grav)
      : same_{{Real(K), Real(L)}}, gravity_(gravity) {}

  Point operator()(Node n, double /*t*/) const {
    if (is_corner(n.position())) return Point();
    Point f = n.value().mass * Point(0, 0, -gravity_);
    for (Edge e : n.edges())
      f += spring_force(e.node2().position() - n.position(),
                        same_ ? *same_ : e.value());
    return f;
  }

 private:
  std::optional<EdgeData> same_;
  double gravity_ = grav;
};

/** Called with the ids of two nodes and the stiffness between them. */
using StiffnessVisitor =
    std::function<void(unsigned i, unsigned j, const Stiffness& B)>;

/** A part of a cloth, for a sweep: the nodes with ids in [first, last). */
struct Part {
  const Cloth& g;
  const ClothStencil& stencil;  ///< of g
  unsigned first, last;         ///< first a multiple of ClothStencil::width
};

/** No force, and the base of all forces (section 5.2).
 *
 * A child gives the force on one node. Whatever else it gives makes methods
 * faster or possible that would not be otherwise; the defaults are right for
 * every force. */
class ZeroForce {
 public:
  virtual ~ZeroForce() = default;

  /** The force [N] on node @a n at time @a t [s].  O(n.degree()) */
  virtual Point operator()(Node /*n*/, double /*t*/) const { return Point(); }

  /** Add the force on each node of a part of a cloth to @a f: that on the node
   * of id i to f[i - part.first]. The same as calling the force node by node,
   * to round-off, but faster. What is added at an id not in use is nothing that
   * counts. Several threads may do several parts at once.
   * @pre @a f has room for whole blocks of the stencil
   * Complexity: O(nodes + edges at them) */
  virtual void add_to(const Part& part, double t, std::span<Point> f) const {
    for (unsigned i = part.first; i < part.last; ++i)
      if (part.g.node_in_use(i))
        f[i - part.first] += (*this)(part.g.node_with_id(i), t);
  }

  /** The energy [J] whose negative gradient the force is; 0 if it has none. */
  virtual double energy(const Cloth& /*g*/) const { return 0; }

  /** c [kg/s] if a part -c v of the force is linear drag, else 0. */
  virtual double drag() const { return 0; }

  /** Call @a use(i, j, B) for each pair of nodes between which there is a force
   * that depends on x_j - x_i, at the positions that @a g has now. All B
   * together, and drag(), are how the force on @a g changes with its state.
   * @return false if the force does not know that: then what @a use was called
   * with is to be forgotten. A child that has more than the call must say what
   * it knows; this base itself knows that no force changes.
   * Complexity: O(nodes + edges) */
  virtual bool add_stiffness(const Cloth& /*g*/,
                             const StiffnessVisitor& /*use*/) const {
    return typeid(*this) == typeid(ZeroForce);
  }

  /** How often the springs of all edges are part of this force, if nothing else
   * in it depends on positions: then its stiffness never exceeds that many
   * times K of each edge, and who needs no more can spare add_stiffness(); and
   * the force on a node may be taken as soon as its neighbors are where they
   * shall be. Nothing if that can't be told. */
  virtual std::optional<int> springs() const {
    if (typeid(*this) == typeid(ZeroForce)) return 0;
    return std::nullopt;
  }
};

namespace force_detail {

/** f.z -= m gravity for @a blocks of lanes::width nodes. */
struct Weight {
  template <typename V>
  [[gnu::always_inline]] static inline void apply(const NodeData* node,
                                                  Point* force, unsigned blocks,
                                                  Real gravity) {
    using namespace lanes;
    constexpr int w = count_of<V>;
    for (unsigned i = 0; i < blocks * width; i += w) {
      const Real* row = &node[i].vel.x;
      Real* f = &force[i].x;
      const V r0 = load<V>(row), r1 = load<V>(row + w),
              r2 = load<V>(row + 2 * w), r3 = load<V>(row + 3 * w);
      store(f, load<V>(f) - gravity * masses<0>(r0, r1));
      store(f + w, load<V>(f + w) - gravity * masses<1>(r1, r2));
      store(f + 2 * w, load<V>(f + 2 * w) - gravity * masses<2>(r2, r3));
    }
  }
  /** Part @a part of 0 0 m 0 0 m ... from two rows of v v v m v v v m ... */
  template <int part, typename V>
  [[gnu::always_inline]] static inline V masses(const V& a, const V& b) {
    constexpr int w = lanes::count_of<V>;
    const V m = lanes::shuffle(a, b, [](int k) {
      const int place = part * w + k;
      return place % 3 == 2 ? 4 * (place / 3) + 3 - part * w : 0;
    });
    return lanes::shuffle(
        m, V{}, [](int k) { return (part * w + k) % 3 == 2 ? k : w + k; });
  }
};

}  // namespace force_detail

/** Weight: f = -m gravity along z [N]. */
class GravityForce final : public ZeroForce {
 public:
  /** @param gravity Acceleration of free fall [m/s^2] */
  explicit GravityForce(double gravity = grav) : gravity_(gravity) {}
  Point operator()(Node n, double /*t*/) const override {
    return weight(n.value());
  }
  void add_to(const Part& part, double /*t*/,
              std::span<Point> f) const override {
    const NodeData* node = &part.g.node_values()[part.first];
    const unsigned count = part.last - part.first;
    const unsigned blocks = count / lanes::width;
    lanes::run<force_detail::Weight>(node, f.data(), blocks, Real(gravity_));
    for (unsigned k = blocks * lanes::width; k < count; ++k)
      f[k].z -= node[k].mass * Real(gravity_);
  }
  double energy(const Cloth& g) const override {
    return gravitational_energy(g, gravity_);
  }
  bool add_stiffness(const Cloth&, const StiffnessVisitor&) const override {
    return true;  // the same everywhere
  }
  std::optional<int> springs() const override { return 0; }

 private:
  double gravity_;
  Point weight(const NodeData& n) const {
    return Point(0, 0, -n.mass * gravity_);
  }
};

namespace force_detail {

/** The springs of blocks [first, last) of a stencil, each seen from both of its
 * ends: no two nodes write to the same place, and square roots are cheap when
 * many are taken side by side.
 *
 * It asks for data before it uses them. Rows in line that come upon them first
 * do so in any case: a processor foresees how such a row goes on, but not into
 * the next page.
 * @tparam early Ask for the springs that rows list, which none can foresee:
 *         faster if they come from memory, slower if a cache has them. */
template <bool early>
struct SpringSweep {
  template <typename V>
  [[gnu::always_inline]] static inline void apply(const ClothStencil& stencil,
                                                  const Point* position,
                                                  const EdgeData* spring,
                                                  unsigned first, unsigned last,
                                                  Point* f) {
    using namespace lanes;
    constexpr int w = count_of<V>;
    constexpr unsigned ahead = 4;  // blocks
    const int farthest = int(stencil.reach());
    for (unsigned b = first; b < last; ++b) {
      if (early && b + ahead < stencil.num_blocks())
        for (const auto& row : stencil.rows(b + ahead))
          if (row.offset == 0) ask_for_listed(stencil, row, spring);
      for (int k = 0; k < width; k += w) {  // once, if V is as long
        const Point* here = position + (b * width + k);
        const Points<V> x = stencil.is_full(b)
                                ? load_points<V>(here)
                                : gather<V>(position, stencil.last_block() + k);
        Points<V> sum;
        for (const auto& row : stencil.rows(b)) {
          // The springs and positions that no row met before.
          if (row.offset > 0 && row.first_edge != stencil.none) {
            ask_behind<w>(spring + row.first_edge + k);
            if (row.offset == farthest) ask_behind<w>(here + row.offset);
          }
          const Points<V> y =
              row.offset != 0 ? load_points<V>(here + row.offset)
                              : gather<V>(position, stencil.neighbors(row) + k);
          const Pairs<V> s =
              row.first_edge != stencil.none
                  ? load_pairs<V>(&spring[row.first_edge + k].K)
                  : gather_pairs<V>(&spring->K, stencil.edges(row) + k);
          const V ux = y.x - x.x, uy = y.y - x.y, uz = y.z - x.z;
          const V pull =
              spring_pull<V>(ux * ux + uy * uy + uz * uz, s.first, s.second);
          sum.x += pull * ux;
          sum.y += pull * uy;
          sum.z += pull * uz;
        }
        add(f + ((b - first) * width + k), sum);
      }
    }
  }

 private:
  /** Ask for what lies some blocks behind @a count of these; it may be behind
   * the end, so it is an address and no pointer. */
  template <int count, typename T>
  [[gnu::always_inline]] static inline void ask_behind(const T* these) {
    constexpr std::uintptr_t blocks = 8, line = 64;
    const auto from = reinterpret_cast<std::uintptr_t>(these) +
                      blocks * lanes::width * sizeof(T);
    for (std::uintptr_t at = 0; at < count * sizeof(T); at += line)
      __builtin_prefetch(reinterpret_cast<const void*>(from + at));
  }
  /** The springs of a row that lists them. Not the positions: meshes lie so in
   * memory that neighbors are near. */
  [[gnu::always_inline]] static inline void ask_for_listed(
      const ClothStencil& stencil, const ClothStencil::Row& row,
      const EdgeData* spring) {
    for (int k = 0; k < lanes::width; ++k)
      __builtin_prefetch(spring + stencil.edges(row)[k]);
  }
};

}  // namespace force_detail

/** The springs of all edges, each by its own K and L: see spring_pull(). */
class MassSpringForce : public ZeroForce {
 public:
  /** What of a cache one core can count on [bytes]. Measured: docs/speed.md */
  static constexpr std::size_t cache = 2 << 20;

  Point operator()(Node n, double /*t*/) const override {
    Point f;
    for (Edge e : n.edges())
      f += spring_force(e.node2().position() - n.position(), e.value());
    return f;
  }
  void add_to(const Part& part, double /*t*/,
              std::span<Point> f) const override {
    constexpr unsigned width = ClothStencil::width;
    auto sweep = [&]<bool early>(std::bool_constant<early>) {
      lanes::run<force_detail::SpringSweep<early>>(
          part.stencil, part.g.positions().data(), part.g.edge_values().data(),
          part.first / width, (part.last + width - 1) / width, f.data());
    };
    const bool is_large = part.g.edge_slots() * sizeof(EdgeData) > cache;
    if (is_large && 2 * part.stencil.num_listed() > part.stencil.num_rows())
      sweep(std::true_type());
    else
      sweep(std::false_type());
  }
  double energy(const Cloth& g) const override { return elastic_energy(g); }
  /** One call an edge, in the order of their ids: see spring_stiffness(). */
  bool add_stiffness(const Cloth& g,
                     const StiffnessVisitor& use) const override {
    auto x = g.positions();
    for (unsigned e = 0; e < g.edge_slots(); ++e) {
      if (!g.edge_in_use(e)) continue;
      auto [i, j] = g.edge_ends()[e];
      use(i, j, spring_stiffness(x[j] - x[i], g.edge_values()[e]));
    }
    return true;
  }
  /** A child may have another stiffness. */
  std::optional<int> springs() const override {
    if (typeid(*this) == typeid(MassSpringForce)) return 1;
    return std::nullopt;
  }
};

/** Linear drag: f = -c v [N]. Takes c |v|^2 of power [W] and never gives. */
class DampingForce final : public ZeroForce {
 public:
  /** @param c Drag coefficient [kg/s], usually 1/N.  @pre @a c >= 0 */
  explicit DampingForce(double c = 0) : c_(c) { assert(c >= 0); }
  Point operator()(Node n, double /*t*/) const override {
    return -c_ * n.value().vel;
  }
  void add_to(const Part& part, double /*t*/,
              std::span<Point> f) const override {
    const NodeData* node = &part.g.node_values()[part.first];
    for (unsigned k = 0; k < part.last - part.first; ++k)
      f[k] -= c_ * node[k].vel;
  }
  double drag() const override { return c_; }
  bool add_stiffness(const Cloth&, const StiffnessVisitor&) const override {
    return true;  // it does not depend on positions
  }
  std::optional<int> springs() const override { return 0; }

 private:
  double c_;
};

/** Any function or functor Point(Node, double) as a ZeroForce. */
template <typename F>
class FunctionForce : public ZeroForce {
 public:
  explicit FunctionForce(F f) : f_(std::move(f)) {}
  Point operator()(Node n, double t) const override { return f_(n, t); }
  /** By one thread at a time: a functor of the assignment may keep a state. */
  void add_to(const Part& part, double t, std::span<Point> f) const override {
    const std::lock_guard lock(one_at_a_time);
    ZeroForce::add_to(part, t, f);
  }

 private:
  mutable F f_;  // a functor of the assignment need not be const
  static inline std::mutex one_at_a_time;
};

/** The sum of several forces. Copies share the forces they are made of. */
class CombinedForces final : public ZeroForce {
 public:
  using Forces = std::vector<std::shared_ptr<const ZeroForce>>;
  /** @pre no pointer is null */
  explicit CombinedForces(Forces forces) : forces_(std::move(forces)) {}
  /** How many they are. */
  std::size_t size() const { return forces_.size(); }

  Point operator()(Node n, double t) const override {
    Point f;
    for (const auto& force : forces_) f += (*force)(n, t);
    return f;
  }
  void add_to(const Part& part, double t, std::span<Point> f) const override {
    for (const auto& force : forces_) force->add_to(part, t, f);
  }
  double energy(const Cloth& g) const override {
    double sum = 0;
    for (const auto& force : forces_) sum += force->energy(g);
    return sum;
  }
  double drag() const override {
    double sum = 0;
    for (const auto& force : forces_) sum += force->drag();
    return sum;
  }
  /** Known only if each of them knows its own. */
  bool add_stiffness(const Cloth& g,
                     const StiffnessVisitor& use) const override {
    for (const auto& force : forces_)
      if (!force->add_stiffness(g, use)) return false;
    return true;
  }
  std::optional<int> springs() const override {
    int sum = 0;
    for (const auto& force : forces_) {
      const auto some = force->springs();
      if (!some) return std::nullopt;
      sum += *some;
    }
    return sum;
  }

 private:
  Forces forces_;
};

/** The sum of any number of forces: children of ZeroForce, and functions of
 * their signature. Each is copied, so temporaries are fine. */
template <typename... Fs>
CombinedForces make_combined_force(Fs... forces) {
  return CombinedForces(CombinedForces::Forces{
      cloth_detail::shared_as<ZeroForce, FunctionForce>(std::move(forces))...});
}
