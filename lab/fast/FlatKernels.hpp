#pragma once
/** @file FlatKernels.hpp
 * The loops in which a step by component spends its time, written once for
 * registers of any length (Lanes.hpp). Explained in README.md. */
#include <cmath>
#include <cstring>
#include <limits>
#include <span>

#include "lab/fast/ConstraintPlan.hpp"
#include "lab/fast/FlatCloth.hpp"

namespace lab::kernels {

using lanes::Points;

/** Force per length of a spring, K (l - L)/l [N/m]: the force on node i is that
 * times x_j - x_i. Finite at l = 0, where no direction is defined: no force.
 * @param lengthSq l^2 [m^2]   @param K [N/m]   @param L rest length [m]
 * @tparam T double, or Lanes of many springs */
template <typename T>
[[gnu::always_inline]] inline T spring_pull(const T& lengthSq, const T& K,
                                            const T& L) {
  using lanes::sqrt, std::sqrt;
  const T l = sqrt(lengthSq + std::numeric_limits<double>::min());
  return K * (l - L) / l;
}

/** A ring buffer of the forces of a row's springs on their near ends, kept
 * until the far ends are reached. The first tile is repeated after the end, so
 * that any tile can be read without wrapping around. */
struct RowRing {
  unsigned offset, size;  // size: without the tile behind it
  unsigned at;            // where the next tile goes
  const double *K, *L;    // of node 0
  double* kept;           // x; y and z at the next multiples of stride, which
  std::size_t stride;     // is the same for all rows, at least size + tile
  /** The forces of the springs whose far ends are the next tile. */
  const double* far() const {
    return kept + (at >= offset ? at - offset : at + size - offset);
  }
  void advance() {
    at = at + FlatCloth::tile == size ? 0 : at + FlatCloth::tile;
  }
};

/** The arguments of KickTiles. */
struct KickTask {
  FlatCloth& cloth;
  RowRing* rings;  ///< of the rows, at tile first
  std::size_t num_rings;
  const Point* others;  ///< other forces on node first and on, for whole tiles
  bool drag;            ///< whether drag acts
  double* kept;         ///< x of node 0 where a is stored; or null
  Point gravity;        ///< [m/s^2]
  double h;             ///< [s]
};

/** a = (springs + others - c v)/m + gravity, v += h a, for the tiles of nodes
 * [first, last). Each spring of a row is evaluated at its near end. */
struct KickTiles {
  template <typename V>
  [[gnu::always_inline]] static inline void apply(const KickTask& task,
                                                  unsigned first,
                                                  unsigned last) {
    using namespace lanes;
    constexpr unsigned w = count_of<V>, tile = FlatCloth::tile;
    Columns& nodes = task.cloth.nodes();
    const std::size_t s = nodes.stride(), num_rings = task.num_rings;
    const std::size_t next = num_rings > 0 ? task.rings[0].stride : 0;
    const FlatCloth::Rest* rest = task.cloth.rest();
    const V h = V{} + task.h;
    const V gx = V{} + task.gravity.x, gy = V{} + task.gravity.y,
            gz = V{} + task.gravity.z;
    const bool tilted = task.gravity.x != 0 || task.gravity.y != 0;
    Row row[FlatCloth::most_rows];
    for (unsigned begin = first; begin < last; begin += tile) {
      // As far as there are nodes: a small cloth has less than a tile.
      const unsigned left = (last - begin + w - 1) / w * w;
      const unsigned end = left < tile ? left : tile;
      double* const xs = nodes[FlatCloth::X] + begin;
      for (std::size_t r = 0; r < num_rings; ++r) {
        const RowRing& ring = task.rings[r];
        row[r] = {xs + ring.offset,    ring.K + begin, ring.L + begin,
                  ring.kept + ring.at, ring.far(),     ring.offset >= tile};
        if (!row[r].wide) fill<V>(task.cloth, ring, begin, end);
      }
      for (unsigned k = 0; k < end; k += w) {
        const unsigned i = begin + k;
        const auto x = load_columns<V>(xs + k, s);
        Points<V> f;
        for (std::size_t r = 0; r < num_rings; ++r) {
          const Row& to = row[r];
          Points<V> g;
          if (to.wide) {
            const auto y = load_columns<V>(to.x + k, s);
            g = force(x, y, to.K + k, to.L + k);
            store_columns(to.near + k, next, g);
          } else {
            g = load_columns<V>(to.near + k, next);
          }
          f += g - load_columns<V>(to.far + k, next);
        }
        if (rest && i / width < rest->num_blocks())
          add_rest<V>(task.cloth, *rest, i, x, f);
        if (task.others) f += load_points<V>(task.others + (i - first));
        double* const to_v = nodes[FlatCloth::VX] + i;
        const auto v = load_columns<V>(to_v, s);
        if (task.drag) f = f - load<V>(nodes[FlatCloth::DragC] + i) * v;
        Points<V> a = load<V>(nodes[FlatCloth::PerMass] + i) * f;
        a.z += gz;
        if (tilted) a.x += gx, a.y += gy;
        if (task.kept) store_columns(task.kept + i, s, a);
        store_columns(to_v, s, v + h * a);
      }
      for (std::size_t r = 0; r < num_rings; ++r) finish(task.rings[r]);
    }
  }

  /** The numbers of a row at the first node of a tile. */
  struct Row {
    const double *x, *K, *L;  ///< x: of the far end
    double* near;             ///< the forces of its springs, x
    const double* far;        ///< those of the springs that end at the tile
    bool wide;                ///< far ends in later tiles
  };

  /** The forces of springs from nodes at @a x to nodes at @a y. */
  template <typename V>
  [[gnu::always_inline]] static inline Points<V> force(const Points<V>& x,
                                                       const Points<V>& y,
                                                       const double* K,
                                                       const double* L) {
    const Points<V> u = y - x;
    return spring_pull<V>(u.x * u.x + u.y * u.y + u.z * u.z, lanes::load<V>(K),
                          lanes::load<V>(L)) *
           u;
  }

  /** The springs of the first @a end nodes of a tile alone: into its ring. */
  template <typename V>
  [[gnu::always_inline]] static inline void fill(const FlatCloth& cloth,
                                                 const RowRing& ring,
                                                 unsigned begin, unsigned end) {
    using namespace lanes;
    const std::size_t s = cloth.nodes().stride();
    for (unsigned i = begin; i < begin + end; i += count_of<V>) {
      const double* at = cloth.nodes()[FlatCloth::X] + i;
      store_columns(
          ring.kept + ring.at + (i - begin), ring.stride,
          force(load_columns<V>(at, s), load_columns<V>(at + ring.offset, s),
                ring.K + i, ring.L + i));
    }
    if (ring.at == 0) repeat_first_tile(ring);
  }

  [[gnu::always_inline]] static inline void repeat_first_tile(
      const RowRing& ring) {
    for (int c = 0; c < 3; ++c) {
      double* from = ring.kept + c * ring.stride;
      std::memcpy(from + ring.size, from, FlatCloth::tile * sizeof(double));
    }
  }
  [[gnu::always_inline]] static inline void finish(RowRing& ring) {
    if (ring.at == 0 && ring.offset >= FlatCloth::tile) repeat_first_tile(ring);
    ring.advance();
  }

  /** Add the springs in no row at the nodes from @a i on. */
  template <typename V>
  [[gnu::always_inline]] static inline void add_rest(
      const FlatCloth& cloth, const FlatCloth::Rest& rest, unsigned i,
      const Points<V>& x, Points<V>& f) {
    using namespace lanes;
    const unsigned block = i / width, k = i % width;
    const std::size_t s = cloth.nodes().stride();
    const double* all = cloth.nodes()[FlatCloth::X];
    const std::size_t end = rest.row_begin(block + 1);
    for (std::size_t row = rest.row_begin(block); row < end; ++row) {
      Points<V> y;
      if (const int offset = rest.offset(row)) {
        y = load_columns<V>(all + i + offset, s);
      } else {
        const unsigned* id = rest.neighbors(row) + k;
        y = {gather<V>(all, id), gather<V>(all + s, id),
             gather<V>(all + 2 * s, id)};
      }
      const std::size_t number = cloth.rest_first() + row * width + k;
      f += force(x, y, cloth.K() + number, cloth.L() + number);
    }
  }
};

/** Put the forces of the springs of tiles [first, last) into the ring. */
struct NearTiles {
  template <typename V>
  [[gnu::always_inline]] static inline void apply(const FlatCloth* cloth,
                                                  RowRing* ring, unsigned first,
                                                  unsigned last) {
    for (unsigned i = first; i < last; i += FlatCloth::tile) {
      KickTiles::fill<V>(*cloth, *ring, i, FlatCloth::tile);
      ring->advance();
    }
  }
};

/** v += kick a; x += way v; v *= decay: for the nodes [first, last). */
struct DriftNodes {
  template <typename V>
  [[gnu::always_inline]] static inline void apply(FlatCloth* cloth,
                                                  unsigned first, unsigned last,
                                                  double kick, double way,
                                                  double decay) {
    using namespace lanes;
    Columns& nodes = cloth->nodes();
    constexpr unsigned w = count_of<V>;
    const unsigned whole = last - (last - first) % w;
    for (int c = 0; c < 3; ++c) {
      double *x = nodes[FlatCloth::X + c], *v = nodes[FlatCloth::VX + c];
      const double* a = nodes[FlatCloth::AX + c];
      for (unsigned i = first; i < whole; i += w) {
        V velocity = load<V>(v + i);
        if (kick != 0) velocity += kick * load<V>(a + i);
        store(x + i, load<V>(x + i) + way * velocity);
        if (decay != 1) velocity *= decay;
        if (decay != 1 || kick != 0) store(v + i, velocity);
      }
    }
    if constexpr (w > 1) apply<Lanes<1>>(cloth, whole, last, kick, way, decay);
  }
};

/** Whether any of the nodes [first, last) is inside a zone. */
struct AnyInside {
  template <typename T>
  [[gnu::always_inline]] static inline auto is_inside(const T& x, const T& y,
                                                      const T& z,
                                                      const Zone& r) {
    const T ux = x - r.at.x, uy = y - r.at.y, uz = z - r.at.z;
    return r.is_ball
               ? ux * ux + uy * uy + uz * uz < r.limit
               : ux * r.normal.x + uy * r.normal.y + uz * r.normal.z < r.limit;
  }
  template <typename V>
  [[gnu::always_inline]] static inline void apply(const Columns* nodes,
                                                  const Zone* zone,
                                                  unsigned first, unsigned last,
                                                  bool* found) {
    using namespace lanes;
    constexpr unsigned w = count_of<V>;
    const double *x = (*nodes)[FlatCloth::X], *y = (*nodes)[FlatCloth::Y],
                 *z = (*nodes)[FlatCloth::Z];
    std::size_t i = first;
    auto inside = V{} < V{};  // none
    for (; i + w <= last; i += w)
      inside |=
          is_inside(load<V>(x + i), load<V>(y + i), load<V>(z + i), *zone);
    bool any = false;
    for (unsigned k = 0; k < w; ++k) any |= inside[k] != 0;
    for (; i < last; ++i) any |= is_inside(x[i], y[i], z[i], *zone);
    *found = any;
  }
};

/** Positions, velocities and 1/m of the nodes [first, last) of a graph, by
 * component. */
struct ReadNodes {
  template <typename V>
  [[gnu::always_inline]] static inline void apply(Columns* to, const Point* x,
                                                  const NodeData* node,
                                                  unsigned first,
                                                  unsigned last) {
    using namespace lanes;
    constexpr unsigned w = count_of<V>;
    const std::size_t s = to->stride();
    const unsigned whole = last - (last - first) % w;
    for (unsigned i = first; i < whole; i += w) {
      store_columns((*to)[FlatCloth::X] + i, s, load_points<V>(x + i));
      const double* row = &node[i].vel.x;
      const Pairs<V> a = load_pairs<V>(row), b = load_pairs<V>(row + 2 * w);
      const Pairs<V> xz = unzip(a.first, b.first);
      const Pairs<V> ym = unzip(a.second, b.second);
      store_columns((*to)[FlatCloth::VX] + i, s,
                    Points<V>{xz.first, ym.first, xz.second});
      store((*to)[FlatCloth::PerMass] + i, 1 / ym.second);
    }
    if constexpr (w > 1) apply<Lanes<1>>(to, x, node, whole, last);
  }
};

/** Positions and velocities of the nodes [first, last) back to their graph. */
struct WriteNodes {
  template <typename V>
  [[gnu::always_inline]] static inline void apply(const Columns* from, Point* x,
                                                  NodeData* node,
                                                  unsigned first,
                                                  unsigned last) {
    using namespace lanes;
    constexpr unsigned w = count_of<V>;
    const std::size_t s = from->stride();
    const unsigned whole = last - (last - first) % w;
    for (unsigned i = first; i < whole; i += w) {
      const auto p = load_columns<V>((*from)[FlatCloth::X] + i, s);
      const auto v = load_columns<V>((*from)[FlatCloth::VX] + i, s);
      double *to = &x[i].x, *row = &node[i].vel.x;
      store(to, merged<0>(p)), store(to + w, merged<1>(p));
      store(to + 2 * w, merged<2>(p));
      const V a = load_pairs<V>(row).second,
              b = load_pairs<V>(row + 2 * w).second;
      const Pairs<V> xz = zip(v.x, v.z);
      const Pairs<V> ym = zip(v.y, unzip(a, b).second);
      const Pairs<V> low = zip(xz.first, ym.first);
      const Pairs<V> high = zip(xz.second, ym.second);
      store(row, low.first), store(row + w, low.second);
      store(row + 2 * w, high.first), store(row + 3 * w, high.second);
    }
    if constexpr (w > 1) apply<Lanes<1>>(from, x, node, whole, last);
  }
};

/** K and L of springs by component, with @a times K instead of K. */
struct ReadSprings {
  template <typename V>
  [[gnu::always_inline]] static inline void apply(
      std::span<const FlatCloth::Run> runs, const EdgeData* edge, double times,
      double* K, double* L) {
    using namespace lanes;
    constexpr unsigned w = count_of<V>;
    for (const FlatCloth::Run& run : runs) {
      const EdgeData* from = edge + run.edge;
      double *k = K + run.number, *l = L + run.number;
      unsigned i = 0;
      for (; i + w <= run.count; i += w) {
        const Pairs<V> p = load_pairs<V>(&from[i].K);
        store(k + i, times * p.first), store(l + i, p.second);
      }
      for (; i < run.count; ++i) k[i] = times * from[i].K, l[i] = from[i].L;
    }
  }
};

/** A state as a sum of one at the start of a step and of accelerations. */
struct StageSum {
  static constexpr std::size_t most = 12;
  struct Term {
    unsigned column;    ///< x of the accelerations
    double to_x, to_v;  ///< [s^2], [s]
  };
  unsigned start;  ///< column of x; y, z and the velocities behind it
  double way;      ///< [s]
  Term term[most];
  unsigned count;    ///< of terms
  double decay = 1;  ///< of v
};

/** x = x_0 + (way v_0 + sum of to_x a); v = decay (v_0 + sum of to_v a): for
 * the nodes [first, last). */
struct SumTiles {
  template <typename V>
  [[gnu::always_inline]] static inline void apply(FlatCloth* cloth,
                                                  const StageSum* sum,
                                                  unsigned first,
                                                  unsigned last) {
    using namespace lanes;
    Columns& nodes = cloth->nodes();
    constexpr unsigned w = count_of<V>;
    const unsigned end = first + (last - first + w - 1) / w * w;
    for (unsigned c = 0; c < 3; ++c) {
      const double *x0 = nodes[sum->start + c], *v0 = nodes[sum->start + 3 + c];
      for (unsigned i = first; i < end; i += w) {
        const V v = load<V>(v0 + i);
        V dx = sum->way * v, dv = {};
        for (unsigned k = 0; k < sum->count; ++k) {
          const StageSum::Term& term = sum->term[k];
          const V a = load<V>(nodes[term.column + c] + i);
          dx += term.to_x * a, dv += term.to_v * a;
        }
        store(nodes[FlatCloth::X + c] + i, load<V>(x0 + i) + dx);
        store(nodes[FlatCloth::VX + c] + i, sum->decay * (v + dv));
      }
    }
  }
};

}  // namespace lab::kernels
