#pragma once
/** @file Lanes.hpp
 * Lanes: as many numbers as one register of the processor holds, computed with
 * side by side. A kernel is written once and compiled for three kinds of x86-64
 * processor, of which the program takes the best that it runs on; on any other
 * processor it is plain code.
 *
 * A kernel is a struct with
 *   [[gnu::always_inline]] static inline void apply(...),
 * which calls only functions that are always inlined: code that is not, is
 * compiled for the plain processor. run<Kernel>(...) calls it. */
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>

#include "CME212/Point.hpp"

// No Lanes are passed to code of another kind: all is inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace lanes {

/** Numbers in a vector: 8 doubles, or 16 floats. A processor with shorter
 * registers takes several for it. Aligned by hand, as vectors are elsewhere:
 * what a compiler takes for granted depends on the processor it compiles for.
 */
inline constexpr int width = 64 / sizeof(Real);
typedef Real Lanes __attribute__((vector_size(64), aligned(64)));

// -------------------------------------------------------------- Which machine

enum class Cpu { plain, avx2, avx512 };

/** The best that this processor can do. */
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
/** What kernels run on; tests and benchmarks set it to less. */
inline Cpu cpu = best_cpu();

template <typename Kernel, typename... Args>
void on_plain(const Args&... args) {
  Kernel::apply(args...);
}
#ifdef __x86_64__
template <typename Kernel, typename... Args>
[[gnu::target("avx2,fma")]] void on_avx2(const Args&... args) {
  Kernel::apply(args...);
}
template <typename Kernel, typename... Args>
[[gnu::target("avx512f,avx512vl,avx512dq,fma")]] void on_avx512(
    const Args&... args) {
  Kernel::apply(args...);
}
#endif

/** Kernel::apply(args...), compiled for this processor. Each lane does what
 * plain code does, in the same order: with -ffp-contract=off, as the Makefile
 * has it, the results are the same on all of them, bit by bit. */
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

[[gnu::always_inline]] inline Lanes sqrt(const Lanes& a) {
  Lanes root;
  for (int k = 0; k < width; ++k) root[k] = std::sqrt(a[k]);
  return root;
}

// ------------------------------------------------------------ Loads and moves

[[gnu::always_inline]] inline Lanes load(const Real* from) {
  Lanes a;
  std::memcpy(&a, from, sizeof a);
  return a;
}
[[gnu::always_inline]] inline void store(Real* to, const Lanes& a) {
  std::memcpy(to, &a, sizeof a);
}

/** Lane k of the result is lane pick(k) of @a a and @a b one after the other.
 * @param pick a lambda without captures */
template <typename Pick, std::size_t... k>
[[gnu::always_inline]] inline Lanes shuffle(const Lanes& a, const Lanes& b,
                                            Pick pick,
                                            std::index_sequence<k...>) {
  return __builtin_shufflevector(a, b, pick(int(k))...);
}
template <typename Pick>
[[gnu::always_inline]] inline Lanes shuffle(const Lanes& a, const Lanes& b,
                                            Pick pick) {
  return shuffle(a, b, pick, std::make_index_sequence<width>());
}

/** The first half of @a a, and then that of @a b; and the second halves. */
[[gnu::always_inline]] inline Lanes first_halves(const Lanes& a,
                                                 const Lanes& b) {
  return shuffle(a, b, [](int k) { return k < width / 2 ? k : k + width / 2; });
}
[[gnu::always_inline]] inline Lanes second_halves(const Lanes& a,
                                                  const Lanes& b) {
  return shuffle(
      a, b, [](int k) { return k < width / 2 ? k + width / 2 : k + width; });
}

/** Of every two numbers of @a a the first one, and then that of @a b; and the
 * second ones. */
[[gnu::always_inline]] inline Lanes even_numbers(const Lanes& a,
                                                 const Lanes& b) {
  return shuffle(a, b, [](int k) { return k % 2 == 0 ? k : width + k - 1; });
}
[[gnu::always_inline]] inline Lanes odd_numbers(const Lanes& a,
                                                const Lanes& b) {
  return shuffle(a, b, [](int k) { return k % 2 == 0 ? k + 1 : width + k; });
}

/** A vector twice as long: @a a and then @a b. */
template <typename A, std::size_t... k>
[[gnu::always_inline]] inline auto join(const A& a, const A& b,
                                        std::index_sequence<k...>) {
  return __builtin_shufflevector(a, b, int(k)...);
}
template <typename A>
[[gnu::always_inline]] inline auto join(const A& a, const A& b) {
  return join(a, b, std::make_index_sequence<2 * sizeof(A) / sizeof(Real)>());
}

/** A vector of @a parts pieces of @a count numbers each: piece k lies at
 * @a from + stride at[every k]. */
template <int count, int stride, int every, int parts>
[[gnu::always_inline]] inline auto collect(const Real* from,
                                           const unsigned* at) {
  if constexpr (parts == 1) {
    constexpr int size = count * sizeof(Real);
    typedef Real Piece __attribute__((vector_size(size), aligned(size)));
    Piece a;
    std::memcpy(&a, from + std::size_t(stride) * at[0], sizeof a);
    return a;
  } else {
    constexpr int half = parts / 2;
    return join(collect<count, stride, every, half>(from, at),
                collect<count, stride, every, half>(from, at + every * half));
  }
}

// ------------------------------------------------------------- Points, pairs

/** Points side by side. */
struct Points {
  Lanes x = {}, y = {}, z = {};
};

/** Coordinate c of the points that a, b, c hold one after the other. */
template <int coordinate>
[[gnu::always_inline]] inline Lanes split(const Lanes& a, const Lanes& b,
                                          const Lanes& c) {
  const Lanes from_ab = shuffle(a, b, [](int k) {
    const int place = 3 * k + coordinate;
    return place < 2 * width ? place : 0;
  });
  return shuffle(from_ab, c, [](int k) {
    const int place = 3 * k + coordinate;
    return place < 2 * width ? k : place - width;
  });
}

/** The points at from[0], ..., from[width - 1]. */
[[gnu::always_inline]] inline Points load(const Point* from) {
  const Real* first = &from->x;
  const Lanes a = load(first), b = load(first + width),
              c = load(first + 2 * width);
  return {split<0>(a, b, c), split<1>(a, b, c), split<2>(a, b, c)};
}

/** Part @a part of x0 y0 z0 x1 ... */
template <int part>
[[gnu::always_inline]] inline Lanes merged(const Points& p) {
  const Lanes xy = shuffle(p.x, p.y, [](int k) {
    const int place = part * width + k;
    return place % 3 == 1 ? width + place / 3 : place / 3;
  });
  return shuffle(xy, p.z, [](int k) {
    const int place = part * width + k;
    return place % 3 == 2 ? width + place / 3 : k;
  });
}

/** Add to to[0], ..., to[width - 1]. */
[[gnu::always_inline]] inline void add(Point* to, const Points& p) {
  Real* first = &to->x;
  store(first, load(first) + merged<0>(p));
  store(first + width, load(first + width) + merged<1>(p));
  store(first + 2 * width, load(first + 2 * width) + merged<2>(p));
}

/** The points at from[at[0]], ..., from[at[width - 1]].
 * @pre there is one more number behind each of them: it is read, too */
[[gnu::always_inline]] inline Points gather(const Point* from,
                                            const unsigned* at) {
  // Four numbers a point, and every fourth point in a vector: what moves within
  // a quarter of a register is cheap to move.
  const Real* first = &from->x;
  const Lanes a = collect<4, 3, 4, width / 4>(first, at);
  const Lanes b = collect<4, 3, 4, width / 4>(first, at + 1);
  const Lanes c = collect<4, 3, 4, width / 4>(first, at + 2);
  const Lanes d = collect<4, 3, 4, width / 4>(first, at + 3);
  // x and z of two points, of which there are four: x x z z x x z z ...
  const Lanes xz_ab = even_numbers(a, b), xz_cd = even_numbers(c, d);
  const Lanes y_ab = odd_numbers(a, b), y_cd = odd_numbers(c, d);
  auto first_two = [](int k) { return k % 4 < 2 ? k : width + k - 2; };
  auto last_two = [](int k) { return k % 4 < 2 ? k + 2 : width + k; };
  return {shuffle(xz_ab, xz_cd, first_two), shuffle(y_ab, y_cd, first_two),
          shuffle(xz_ab, xz_cd, last_two)};
}

/** Part @a part of the points a, b, c, with a number of no meaning after each:
 * four numbers a point. */
template <int part>
[[gnu::always_inline]] inline Lanes with_fourth(const Lanes& a, const Lanes& b,
                                                const Lanes& c) {
  constexpr int skip = part < 2 ? 0 : width;
  return shuffle(part < 2 ? a : b, part < 2 ? b : c, [](int k) {
    const int four = part * width + k;
    return 3 * (four / 4) + std::min(four % 4, 2) - skip;
  });
}
/** Part @a part of points, a row of three numbers each, from @a a and @a b:
 * parts @a part and @a part + 1 of rows of four. */
template <int part>
[[gnu::always_inline]] inline Lanes without_fourth(const Lanes& a,
                                                   const Lanes& b) {
  return shuffle(a, b, [](int k) {
    const int three = part * width + k;
    return 4 * (three / 3) + three % 3 - part * width;
  });
}

/** Pairs of numbers side by side: all first ones, and all second ones. */
struct Pairs {
  Lanes first, second;
};
[[gnu::always_inline]] inline Pairs split(const Lanes& a, const Lanes& b) {
  return {shuffle(a, b, [](int k) { return 2 * k; }),
          shuffle(a, b, [](int k) { return 2 * k + 1; })};
}
[[gnu::always_inline]] inline Pairs load_pairs(const Real* from) {
  return split(load(from), load(from + width));
}
/** The pairs at from + 2 at[0], ... */
[[gnu::always_inline]] inline Pairs gather_pairs(const Real* from,
                                                 const unsigned* at) {
  const Lanes a = collect<2, 2, 2, width / 2>(from, at);
  const Lanes b = collect<2, 2, 2, width / 2>(from, at + 1);
  return {even_numbers(a, b), odd_numbers(a, b)};
}

}  // namespace lanes
