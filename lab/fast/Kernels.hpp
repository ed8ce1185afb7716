#pragma once
/** @file Kernels.hpp
 * The loops that a step spends its time in, written once for registers of any
 * length (Lanes.hpp): springs, weight, drift and kick. README.md of this room
 * walks through them. */
#include <cstddef>
#include <cstdint>
#include <limits>

#include "lab/fast/ForcePlan.hpp"
#include "mass_spring.hpp"

namespace lab {

// Kernels read them as rows of numbers.
static_assert(sizeof(NodeData) == 4 * sizeof(Real) &&
              sizeof(EdgeData) == 2 * sizeof(Real));

namespace kernels {

/** The share of a cache that one core can count on [bytes]: README.md. */
inline constexpr std::size_t cache = 2 << 20;

/** Force per length of a spring, K (l - L)/l [N/m]: the force on node i is that
 * times x_j - x_i. Finite at l = 0, where no direction is defined: no force.
 * @param lengthSq l^2 [m^2]   @param K [N/m]   @param L rest length [m]
 * @tparam T Real, or Lanes of many springs */
template <typename T>
[[gnu::always_inline]] inline T spring_pull(const T& lengthSq, const T& K,
                                            const T& L) {
  using lanes::sqrt, std::sqrt;
  const T l = sqrt(lengthSq + std::numeric_limits<Real>::min());
  return K * (l - L) / l;
}

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

/** The springs of blocks [first, last) of a stencil. Each is evaluated from
 * both ends: so no two nodes write to the same place, and square roots are
 * cheap when many are taken side by side.
 *
 * Software prefetch. Unit-stride rows always prefetch: hardware prefetchers
 * stop at 4 KiB pages.
 * @tparam prefetch_gathered Prefetch the springs of gathered rows, too: faster
 *         if they come from memory, slower if a cache has them. */
template <bool prefetch_gathered>
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
      if (prefetch_gathered && b + ahead < stencil.num_blocks())
        for (const auto& row : stencil.rows(b + ahead))
          if (row.offset == 0) prefetch_springs(stencil, row, spring);
      for (int k = 0; k < width; k += w) {  // once, if V is as long
        const Point* here = position + (b * width + k);
        const Points<V> x = stencil.is_full(b)
                                ? load_points<V>(here)
                                : gather<V>(position, stencil.last_block() + k);
        Points<V> sum;
        for (const auto& row : stencil.rows(b)) {
          // Springs and positions that no row has read before.
          if (row.offset > 0 && row.first_edge != stencil.none) {
            prefetch_behind<w>(spring + row.first_edge + k);
            if (row.offset == farthest) prefetch_behind<w>(here + row.offset);
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
  /** Prefetch what lies some blocks behind @a count of these. It may be behind
   * the end, so it is an address and no pointer. */
  template <int count, typename T>
  [[gnu::always_inline]] static inline void prefetch_behind(const T* these) {
    constexpr std::uintptr_t blocks = 8, line = 64;
    const auto from = reinterpret_cast<std::uintptr_t>(these) +
                      blocks * lanes::width * sizeof(T);
    for (std::uintptr_t at = 0; at < count * sizeof(T); at += line)
      __builtin_prefetch(reinterpret_cast<const void*>(from + at));
  }
  /** Prefetch the springs of a gathered row. Not the positions: neighbors are
   * near each other in memory. */
  [[gnu::always_inline]] static inline void prefetch_springs(
      const ClothStencil& stencil, const ClothStencil::Row& row,
      const EdgeData* spring) {
    for (int k = 0; k < lanes::width; ++k)
      __builtin_prefetch(spring + stencil.edges(row)[k]);
  }
};

/** x += h v for @a blocks of lanes::width nodes. */
struct DriftBlocks {
  template <typename V>
  [[gnu::always_inline]] static inline void apply(Point* position,
                                                  const NodeData* node,
                                                  unsigned blocks, Real h) {
    using namespace lanes;
    constexpr int w = count_of<V>;
    for (unsigned i = 0; i < blocks * width; i += w) {
      Real* x = &position[i].x;
      const Real* v = &node[i].vel.x;
      const V v0 = load<V>(v), v1 = load<V>(v + w), v2 = load<V>(v + 2 * w),
              v3 = load<V>(v + 3 * w);
      store(x, load<V>(x) + h * without_fourth<0>(v0, v1));
      store(x + w, load<V>(x + w) + h * without_fourth<1>(v1, v2));
      store(x + 2 * w, load<V>(x + 2 * w) + h * without_fourth<2>(v2, v3));
    }
  }
};

/** v += h f/m for @a blocks of lanes::width nodes. */
struct KickBlocks {
  template <typename V>
  [[gnu::always_inline]] static inline void apply(NodeData* node,
                                                  const Point* force,
                                                  unsigned blocks, Real h) {
    using namespace lanes;
    constexpr int w = count_of<V>;
    for (unsigned i = 0; i < blocks * width; i += w) {
      Real* row = &node[i].vel.x;
      const Real* f = &force[i].x;
      const V f0 = load<V>(f), f1 = load<V>(f + w), f2 = load<V>(f + 2 * w);
      const V v0 = load<V>(row), v1 = load<V>(row + w),
              v2 = load<V>(row + 2 * w), v3 = load<V>(row + 3 * w);
      const V per_f = h / first_halves(masses(v0, v1), masses(v2, v3));
      store(row, v0 + spread<0>(per_f) * with_fourth<0>(f0, f1, f2));
      store(row + w, v1 + spread<1>(per_f) * with_fourth<1>(f0, f1, f2));
      store(row + 2 * w, v2 + spread<2>(per_f) * with_fourth<2>(f0, f1, f2));
      store(row + 3 * w, v3 + spread<3>(per_f) * with_fourth<3>(f0, f1, f2));
    }
  }

 private:
  /** The masses in two rows of v v v m v v v m ..., in the first half. */
  template <typename V>
  [[gnu::always_inline]] static inline V masses(const V& a, const V& b) {
    constexpr int w = lanes::count_of<V>;
    return lanes::shuffle(a, b,
                          [](int k) { return k < w / 2 ? 4 * k + 3 : 0; });
  }
  /** Part @a part of a0 a0 a0 0 a1 a1 a1 0 ... */
  template <int part, typename V>
  [[gnu::always_inline]] static inline V spread(const V& a) {
    constexpr int w = lanes::count_of<V>;
    return lanes::shuffle(a, V{}, [](int k) {
      const int place = part * w + k;
      return place % 4 < 3 ? place / 4 : w;
    });
  }
};

}  // namespace kernels
}  // namespace lab
