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
  double gravity, h;    ///< [m/s^2], [s]
};

/** a = (springs + others - c v)/m - gravity, v += h a, for the tiles of nodes
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
    const V h = V{} + task.h, gravity = V{} + task.gravity;
    Row row[FlatCloth::most_rows];
    for (unsigned begin = first; begin < last; begin += tile) {
      // As far as there are nodes: a small cloth has less than a tile.
      const unsigned left = (last - begin + w - 1) / w * w;
      const unsigned end = left < tile ? left : tile;
      double* const xs = nodes[FlatCloth::X] + begin;
      for (std::size_t r = 0; r < num_rings; ++r) {
        row[r] = Row(task.rings[r], xs, begin);
        if (!row[r].wide)
          Near::template apply<V>(nodes[FlatCloth::X], s, task.rings[r], begin,
                                  end);
      }
      for (unsigned k = 0; k < end; k += w) {
        const unsigned i = begin + k;
        const double* at = xs + k;
        const Points<V> x = {load<V>(at), load<V>(at + s), load<V>(at + 2 * s)};
        Points<V> f;
        for (std::size_t r = 0; r < num_rings; ++r) {
          const Row& to = row[r];
          double* const near = to.near + k;
          const double* const far = to.far + k;
          Points<V> g;
          if (to.wide) {
            g = Near::template pull<V>(x, to.x + k, s, to.K + k, to.L + k);
            store(near, g.x), store(near + next, g.y);
            store(near + 2 * next, g.z);
          } else {
            g = {load<V>(near), load<V>(near + next), load<V>(near + 2 * next)};
          }
          f.x += g.x - load<V>(far);
          f.y += g.y - load<V>(far + next);
          f.z += g.z - load<V>(far + 2 * next);
        }
        if (rest && i / width < rest->num_blocks())
          add_rest<V>(task.cloth, *rest, i, x, f);
        if (task.others) {
          const Points<V> other = load_points<V>(task.others + (i - first));
          f.x += other.x, f.y += other.y, f.z += other.z;
        }
        double* v = nodes[FlatCloth::VX] + i;
        V vx = load<V>(v), vy = load<V>(v + s), vz = load<V>(v + 2 * s);
        if (task.drag) {
          const V c = load<V>(nodes[FlatCloth::DragC] + i);
          f.x -= c * vx, f.y -= c * vy, f.z -= c * vz;
        }
        const V per_mass = load<V>(nodes[FlatCloth::PerMass] + i);
        f.x *= per_mass, f.y *= per_mass;
        f.z = f.z * per_mass - gravity;
        if (task.kept) {
          double* a = task.kept + i;
          store(a, f.x), store(a + s, f.y), store(a + 2 * s, f.z);
        }
        store(v, vx + h * f.x), store(v + s, vy + h * f.y);
        store(v + 2 * s, vz + h * f.z);
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
    Row() {}
    Row(const RowRing& ring, const double* xs, unsigned begin)
        : x(xs + ring.offset),
          K(ring.K + begin),
          L(ring.L + begin),
          near(ring.kept + ring.at),
          far(ring.far()),
          wide(ring.offset >= FlatCloth::tile) {}
  };

  /** The springs of the first @a end nodes of a tile alone: into its ring. */
  struct Near {
    template <typename V>
    [[gnu::always_inline]] static inline Points<V> pull(const Points<V>& x,
                                                        const double* far,
                                                        std::size_t s,
                                                        const double* K,
                                                        const double* L) {
      using namespace lanes;
      const V ux = load<V>(far) - x.x, uy = load<V>(far + s) - x.y,
              uz = load<V>(far + 2 * s) - x.z;
      const V p =
          spring_pull<V>(ux * ux + uy * uy + uz * uz, load<V>(K), load<V>(L));
      return {p * ux, p * uy, p * uz};
    }
    template <typename V>
    [[gnu::always_inline]] static inline void apply(const double* x,
                                                    std::size_t s,
                                                    const RowRing& ring,
                                                    unsigned begin,
                                                    unsigned end) {
      using namespace lanes;
      const std::size_t next = ring.stride;
      for (unsigned k = 0; k < end; k += count_of<V>) {
        const double* at = x + begin + k;
        const Points<V> here = {load<V>(at), load<V>(at + s),
                                load<V>(at + 2 * s)};
        const Points<V> g = pull<V>(here, at + ring.offset, s,
                                    ring.K + begin + k, ring.L + begin + k);
        double* kept = ring.kept + ring.at + k;
        store(kept, g.x), store(kept + next, g.y);
        store(kept + 2 * next, g.z);
      }
      if (ring.at == 0) repeat_first_tile(ring);
    }
  };

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
        const double* at = all + i + offset;
        y = {load<V>(at), load<V>(at + s), load<V>(at + 2 * s)};
      } else {
        const unsigned* id = rest.neighbors(row) + k;
        y = {gather<V>(all, id), gather<V>(all + s, id),
             gather<V>(all + 2 * s, id)};
      }
      const std::size_t number = cloth.rest_first() + row * width + k;
      const V ux = y.x - x.x, uy = y.y - x.y, uz = y.z - x.z;
      const V p = spring_pull<V>(ux * ux + uy * uy + uz * uz,
                                 load<V>(cloth.K() + number),
                                 load<V>(cloth.L() + number));
      f.x += p * ux, f.y += p * uy, f.z += p * uz;
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
      KickTiles::Near::template apply<V>(cloth->nodes()[FlatCloth::X],
                                         cloth->nodes().stride(), *ring, i,
                                         FlatCloth::tile);
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
    for (int c = 0; c < 3; ++c) {
      double *x = nodes[FlatCloth::X + c], *v = nodes[FlatCloth::VX + c];
      const double* a = nodes[FlatCloth::AX + c];
      unsigned i = first;
      for (; i + w <= last; i += w) {
        V velocity = load<V>(v + i);
        if (kick != 0) velocity += kick * load<V>(a + i);
        store(x + i, load<V>(x + i) + way * velocity);
        if (decay != 1) velocity *= decay;
        if (decay != 1 || kick != 0) store(v + i, velocity);
      }
      for (; i < last; ++i) {
        if (kick != 0) v[i] += kick * a[i];
        x[i] += way * v[i];
        if (decay != 1) v[i] *= decay;
      }
    }
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
    unsigned i = first;
    for (; i + w <= last; i += w) {
      double *at = (*to)[FlatCloth::X] + i, *v = (*to)[FlatCloth::VX] + i;
      const Points<V> p = load_points<V>(x + i);
      store(at, p.x), store(at + s, p.y), store(at + 2 * s, p.z);
      const double* row = &node[i].vel.x;
      const Pairs<V> a = load_pairs<V>(row), b = load_pairs<V>(row + 2 * w);
      const Pairs<V> xz = unzip(a.first, b.first);
      const Pairs<V> ym = unzip(a.second, b.second);
      store(v, xz.first), store(v + s, ym.first), store(v + 2 * s, xz.second);
      store((*to)[FlatCloth::PerMass] + i, 1 / ym.second);
    }
    for (; i < last; ++i) {
      double *at = (*to)[FlatCloth::X] + i, *v = (*to)[FlatCloth::VX] + i;
      at[0] = x[i].x, at[s] = x[i].y, at[2 * s] = x[i].z;
      const Point& u = node[i].vel;
      v[0] = u.x, v[s] = u.y, v[2 * s] = u.z;
      (*to)[FlatCloth::PerMass][i] = 1 / node[i].mass;
    }
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
    unsigned i = first;
    for (; i + w <= last; i += w) {
      const double *at = (*from)[FlatCloth::X] + i,
                   *v = (*from)[FlatCloth::VX] + i;
      const Points<V> p = {load<V>(at), load<V>(at + s), load<V>(at + 2 * s)};
      double *to = &x[i].x, *row = &node[i].vel.x;
      store(to, merged<0>(p)), store(to + w, merged<1>(p));
      store(to + 2 * w, merged<2>(p));
      const V a = load_pairs<V>(row).second,
              b = load_pairs<V>(row + 2 * w).second;
      const Pairs<V> xz = zip(load<V>(v), load<V>(v + 2 * s));
      const Pairs<V> ym = zip(load<V>(v + s), unzip(a, b).second);
      const Pairs<V> low = zip(xz.first, ym.first);
      const Pairs<V> high = zip(xz.second, ym.second);
      store(row, low.first), store(row + w, low.second);
      store(row + 2 * w, high.first), store(row + 3 * w, high.second);
    }
    for (; i < last; ++i) {
      const double *at = (*from)[FlatCloth::X] + i,
                   *v = (*from)[FlatCloth::VX] + i;
      x[i] = Point(at[0], at[s], at[2 * s]);
      node[i].vel = Point(v[0], v[s], v[2 * s]);
    }
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
