#pragma once
/** @file Sweep.hpp
 * Sweep: the forces on all nodes of a cloth, a part at a time, by as many
 * threads as OpenMP has (OMP_NUM_THREADS, or --threads). */
#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#ifdef _OPENMP
#include <omp.h>
#endif

#include "lab/fast/ForcePlan.hpp"

namespace lab {

/** What goes over all nodes of a cloth, in parts that fit in a cache. It keeps
 * a stencil of the cloth, and makes it anew when nodes or edges came or went.
 *
 * Each node's force is computed by one thread, in the same order whatever the
 * number of threads: so the results are the same, bit by bit. */
class Sweep {
 public:
  /** How many processors this program may use. */
  static int processors() {
#ifdef _OPENMP
    return omp_get_num_procs();
#else
    return 1;
#endif
  }
  /** Let all sweeps have @a n threads from now on. If 0, as it is at first:
   * those that OpenMP gives, for cloths that are worth it. */
  static void set_threads([[maybe_unused]] int n) {
    threads_ = n;
#ifdef _OPENMP
    omp_set_num_threads(n == 0 ? processors() : n);
#endif
  }

  static constexpr unsigned part_size = 1024;
  /** A cloth of fewer parts is done before threads have come together, if
   * another program has a processor just then. */
  static constexpr int many_parts = 32;
  static_assert(part_size % ClothStencil::width == 0);

  /** Call @a use(part) for parts that make up the cloth, several at once.
   * Throws what @a use throws, the first of it, when all are done. */
  template <typename Use>
  void parts(const Cloth& g, Use use) {
    update(g);
    in_turn(
        g, 0, [](const Part&) {}, use);
  }

  /** All forces on @a g into @a f, by node id; removed nodes feel none. Then
   * @a use(part, forces on it) while they are at hand. */
  template <typename Use>
  void operator()(const Cloth& g, double t, const ForcePlan& force,
                  std::vector<Point>& f, Use use) {
    after([](const Part&) {}, g, t, force, f, use);
  }
  void operator()(const Cloth& g, double t, const ForcePlan& force,
                  std::vector<Point>& f) {
    (*this)(g, t, force, f, [](const Part&, std::span<Point>) {});
  }
  /** The same for who needs no list of all forces. */
  template <typename Use>
  void operator()(const Cloth& g, double t, const ForcePlan& force, Use use) {
    after([](const Part&) {}, g, t, force, use);
  }

  /** The same, but @a move(part) is called for each part before any force that
   * depends on the positions of its nodes: so one way through memory does for
   * both. @a move may change positions and velocities of its part, and @a use
   * its velocities; the graph stays as it is. Several threads do several parts
   * at once. Throws as parts(). */
  template <typename Move, typename Use>
  void after(Move move, const Cloth& g, double t, const ForcePlan& force,
             std::vector<Point>& f, Use use) {
    f.resize(whole_blocks(g.node_slots()));
    add_up(
        move, g, t, force, [&](const Part& part) { return &f[part.first]; },
        use);
  }
  template <typename Move, typename Use>
  void after(Move move, const Cloth& g, double t, const ForcePlan& force,
             Use use) {
    add_up(
        move, g, t, force,
        [&](const Part&) { return buffer_[thread()].data(); }, use);
  }

 private:
  using Buffer = std::array<Point, part_size>;
  std::optional<ClothStencil> stencil_;
  std::uint64_t version_ = 0;      // of the cloth, when it was made
  std::vector<Buffer> buffer_;     // by thread
  static inline int threads_ = 0;  // that somebody asked for

  static std::size_t whole_blocks(unsigned nodes) {
    constexpr unsigned w = ClothStencil::width;
    return (std::size_t(nodes) + w - 1) / w * w;
  }
  static std::size_t thread() {
#ifdef _OPENMP
    return std::size_t(omp_get_thread_num());
#else
    return 0;
#endif
  }

  void update(const Cloth& g) {
#ifdef _OPENMP
    const auto threads = std::size_t(omp_get_max_threads());
#else
    const std::size_t threads = 1;
#endif
    if (buffer_.size() < threads) buffer_.resize(threads);
    if (stencil_ && version_ == g.version()) return;
    stencil_.emplace(g);
    version_ = g.version();
  }

  /** How many parts away the nodes may be whose positions @a force asks for. */
  int parts_away(const ForcePlan& force) const {
    if (!force.spring_multiplicity()) return std::numeric_limits<int>::max();
    // A gather reads one number behind the node, which may be of the next part.
    return int(stencil_->reach() / part_size) + 1;
  }

  /** Call @a move(part) and @a use(part) for each part, this one when all parts
   * up to @a lead away have been moved. Each thread goes through its own parts
   * in their order, and moves those ahead which it comes to need.
   * @pre the stencil is that of @a g */
  template <typename Move, typename Use>
  void in_turn(const Cloth& g, int lead, Move move, Use use) {
    const unsigned slots = g.node_slots();
    const int count = int((slots + part_size - 1) / part_size);
    lead = std::min(lead, count);
    std::exception_ptr error;
    const auto call = [&](auto& what, int k) {
      const unsigned first = unsigned(k) * part_size;
      const Part part{g, *stencil_, first, std::min(first + part_size, slots)};
      try {
        what(part);
      } catch (...) {  // no exception may leave a thread
#ifdef _OPENMP
#pragma omp critical(sweep_error)
#endif
        if (!error) error = std::current_exception();
      }
    };
    const auto share = [&](int number, int threads) {
      const int first = int(std::int64_t(count) * number / threads);
      const int last = int(std::int64_t(count) * (number + 1) / threads);
      // Other threads wait for the parts at the borders. So these move first:
      // [first, moved), which grows, and [inner_last, last).
      const int inner_last = std::max(last - lead, first);
      int moved = std::min(first + lead, inner_last);
      for (int k = first; k < moved; ++k) call(move, k);
      for (int k = inner_last; k < last; ++k) call(move, k);
      if (threads > 1 && lead > 0) {
#ifdef _OPENMP
#pragma omp barrier
#endif
      }
      for (int k = first; k < last; ++k) {
        for (; moved < inner_last && moved <= k + lead; ++moved)
          call(move, moved);
        call(use, k);
      }
    };
    bool alone = true;
#ifdef _OPENMP
    // Calling a team takes longer than a step of 100 nodes.
    alone = count <= 1 || (threads_ == 0 && count < many_parts);
    if (!alone) {
#pragma omp parallel
      share(omp_get_thread_num(), omp_get_num_threads());
    }
#endif
    if (alone) share(0, 1);
    if (error) std::rethrow_exception(error);
  }

  /** As after(), the forces on a part at @a place(part). */
  template <typename Move, typename Place, typename Use>
  void add_up(Move move, const Cloth& g, double t, const ForcePlan& force,
              Place place, Use use) {
    update(g);
    in_turn(g, parts_away(force), move, [&](const Part& part) {
      std::span<Point> f(place(part), whole_blocks(part.last - part.first));
      add_up(part, t, force, f);
      use(part, f);
    });
  }
  static void add_up(const Part& part, double t, const ForcePlan& force,
                     std::span<Point> f) {
    std::fill(f.begin(), f.end(), Point());
    force.add_to(part, t, f);
    if (part.g.node_slots() == part.g.num_nodes()) return;
    for (unsigned i = part.first; i < part.last; ++i)
      if (!part.g.node_in_use(i)) f[i - part.first] = Point();
  }
};

}  // namespace lab
