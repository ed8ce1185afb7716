#pragma once
/** @file Lanes.hpp
 * Lanes: a SIMD register of numbers. A kernel is written once and compiled for
 * three kinds of x86-64 processor; the program runs the version that is fastest
 * on its processor: fastest_cpu(). On any other processor a kernel is plain
 * code.
 *
 * A kernel is a struct with
 *   template <typename V> [[gnu::always_inline]] static inline void apply(...),
 * where V is the Lanes type of that processor. It may call only functions that
 * are always inlined: other code is compiled for the plain processor.
 * run<Kernel>(...) calls it. */
#include <cmath>
#include <cstddef>
#include <cstring>
#include <span>
#include <utility>

#include "CME212/Point.hpp"

namespace lab {

// All functions are inlined, so the ABI of vector arguments does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace lanes {

/** Nodes a block: as many as the longest register has doubles. With shorter
 * registers a block takes several. */
inline constexpr int width = 64 / sizeof(double);

namespace detail {
template <int count>
struct Vector {
  static constexpr int bytes = count * sizeof(double);
  typedef double type __attribute__((vector_size(bytes), aligned(bytes)));
};
}  // namespace detail

/** @a count numbers in a register. The alignment is explicit, because a
 * compiler's default depends on the processor. Types longer than a register
 * give right results, but are moved through memory, number by number. */
template <int count>
using Lanes = typename detail::Vector<count>::type;

/** The number of numbers in a vector. */
template <typename V>
inline constexpr int count_of = int(sizeof(V) / sizeof(double));

// ------------------------------------------------------------------ Processor

enum class Cpu { plain, avx2, avx512 };

/** That with the longest registers that this processor has. */
inline Cpu best_cpu() {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq"))
    return Cpu::avx512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    return Cpu::avx2;
#endif
  return Cpu::plain;
}
inline const char* name_of(Cpu cpu) {
  return cpu == Cpu::avx512 ? "AVX-512" : cpu == Cpu::avx2 ? "AVX2" : "plain";
}
/** The kind that kernels use; a program sets it to fastest_cpu(). */
inline Cpu cpu = best_cpu();

/** Choose by the @a times of the kinds, from the shortest registers on.
 * @return the first kind, or the last later one that takes less than 0.9 of
 *         the time of the choice before: noise does not decide. */
Cpu clearly_fastest(std::span<const double> times);
/** Time steps of a small cloth with each kind of kernel in turn, by the
 * processor time of this thread, and
 * @return the clearly_fastest() kind. The longest registers are not always
 * the fastest: a root and a division of 512 bits may take longer than two of
 * 256 bits. All kinds give the same bits, so the choice changes no result.
 * @post cpu is as before.   About 1 ms where there is a choice, else 0 */
Cpu fastest_cpu();

template <typename Kernel, typename... Args>
void on_plain(const Args&... args) {
  Kernel::template apply<Lanes<width / 4>>(args...);
}
#ifdef __x86_64__
template <typename Kernel, typename... Args>
[[gnu::target("avx2,fma")]] void on_avx2(const Args&... args) {
  Kernel::template apply<Lanes<width / 2>>(args...);
}
template <typename Kernel, typename... Args>
[[gnu::target("avx512f,avx512vl,avx512dq,fma")]] void on_avx512(
    const Args&... args) {
  Kernel::template apply<Lanes<width>>(args...);
}
#endif

/** Kernel::apply<V>(args...), compiled for this processor. Each lane computes
 * as plain code does, in the same order. With -ffp-contract=off, as in the
 * Makefile, the results are bitwise the same on all processors. */
template <typename Kernel, typename... Args>
void run(const Args&... args) {
#ifdef __x86_64__
  if (cpu == Cpu::avx512) return on_avx512<Kernel>(args...);
  if (cpu == Cpu::avx2) return on_avx2<Kernel>(args...);
#endif
  on_plain<Kernel>(args...);
}

// ----------------------------------------------------------------- Arithmetic
// + - * / and comparisons of Lanes are the compiler's.

template <typename V>
[[gnu::always_inline]] inline V sqrt(const V& a) {
  V root = a;
  for (int k = 0; k < count_of<V>; ++k) root[k] = std::sqrt(root[k]);
  return root;
}

// ------------------------------------------------------------ Loads and moves

template <typename V>
[[gnu::always_inline]] inline V load(const double* from) {
  V a;
  std::memcpy(&a, from, sizeof a);
  return a;
}
template <typename V>
[[gnu::always_inline]] inline void store(double* to, const V& a) {
  std::memcpy(to, &a, sizeof a);
}

/** Number k of the result is number pick(k) of @a a followed by @a b.
 * @param pick a lambda without captures */
template <typename V, typename Pick, std::size_t... k>
[[gnu::always_inline]] inline V shuffle(const V& a, const V& b, Pick pick,
                                        std::index_sequence<k...>) {
  return __builtin_shufflevector(a, b, pick(int(k))...);
}
template <typename V, typename Pick>
[[gnu::always_inline]] inline V shuffle(const V& a, const V& b, Pick pick) {
  return shuffle(a, b, pick, std::make_index_sequence<count_of<V>>());
}

/** from[at[0]], from[at[1]], ... */
template <typename V, std::size_t... k>
[[gnu::always_inline]] inline V gather(const double* from, const unsigned* at,
                                       std::index_sequence<k...>) {
  return V{from[at[k]]...};
}
template <typename V>
[[gnu::always_inline]] inline V gather(const double* from, const unsigned* at) {
  return gather<V>(from, at, std::make_index_sequence<count_of<V>>());
}

/** Several Points, by component. */
template <typename V>
struct Points {
  V x = {}, y = {}, z = {};
  [[gnu::always_inline]] Points& operator+=(const Points& b) {
    return x += b.x, y += b.y, z += b.z, *this;
  }
  [[gnu::always_inline]] friend Points operator+(const Points& a,
                                                 const Points& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  [[gnu::always_inline]] friend Points operator-(const Points& a,
                                                 const Points& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  [[gnu::always_inline]] friend Points operator*(const V& s, const Points& a) {
    return {s * a.x, s * a.y, s * a.z};
  }
};

/** Coordinates in three arrays, of which the first is at @a x and each other
 * one @a stride numbers behind the one before. */
template <typename V>
[[gnu::always_inline]] inline Points<V> load_columns(const double* x,
                                                     std::size_t stride) {
  return {load<V>(x), load<V>(x + stride), load<V>(x + 2 * stride)};
}
template <typename V>
[[gnu::always_inline]] inline void store_columns(double* x, std::size_t stride,
                                                 const Points<V>& p) {
  store(x, p.x), store(x + stride, p.y), store(x + 2 * stride, p.z);
}

/** Coordinate c of the points that a, b, c hold one after the other. */
template <int coordinate, typename V>
[[gnu::always_inline]] inline V split(const V& a, const V& b, const V& c) {
  constexpr int w = count_of<V>;
  const V from_ab = shuffle(a, b, [](int k) {
    const int place = 3 * k + coordinate;
    return place < 2 * w ? place : 0;
  });
  return shuffle(from_ab, c, [](int k) {
    const int place = 3 * k + coordinate;
    return place < 2 * w ? k : place - w;
  });
}

/** The points at from[0], from[1], ... */
template <typename V>
[[gnu::always_inline]] inline Points<V> load_points(const Point* from) {
  constexpr int w = count_of<V>;
  const double* first = &from->x;
  const V a = load<V>(first), b = load<V>(first + w),
          c = load<V>(first + 2 * w);
  return {split<0>(a, b, c), split<1>(a, b, c), split<2>(a, b, c)};
}

/** Part @a part of x0 y0 z0 x1 ... */
template <int part, typename V>
[[gnu::always_inline]] inline V merged(const Points<V>& p) {
  constexpr int w = count_of<V>;
  const V xy = shuffle(p.x, p.y, [](int k) {
    const int place = part * w + k;
    return place % 3 == 1 ? w + place / 3 : place / 3;
  });
  return shuffle(xy, p.z, [](int k) {
    const int place = part * w + k;
    return place % 3 == 2 ? w + place / 3 : k;
  });
}

/** Pairs of numbers side by side: all first ones, and all second ones. */
template <typename V>
struct Pairs {
  V first, second;
};
/** Split the pairs in a and b into first and second members; and back: the
 * first half of the pairs, and the second one. */
template <typename V>
[[gnu::always_inline]] inline Pairs<V> unzip(const V& a, const V& b) {
  return {shuffle(a, b, [](int k) { return 2 * k; }),
          shuffle(a, b, [](int k) { return 2 * k + 1; })};
}
template <typename V>
[[gnu::always_inline]] inline Pairs<V> zip(const V& a, const V& b) {
  constexpr int w = count_of<V>;
  return {shuffle(a, b, [](int k) { return k / 2 + k % 2 * w; }),
          shuffle(a, b, [](int k) { return (w + k) / 2 + (w + k) % 2 * w; })};
}
template <typename V>
[[gnu::always_inline]] inline Pairs<V> load_pairs(const double* from) {
  return unzip(load<V>(from), load<V>(from + count_of<V>));
}
}  // namespace lanes
}  // namespace lab
