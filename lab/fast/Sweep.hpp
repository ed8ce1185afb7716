#pragma once
/** @file Sweep.hpp
 * Sweep: the forces on all nodes of a cloth, a part at a time, by as many
 * threads as OpenMP has (OMP_NUM_THREADS, or --threads). */
#include <array>
#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "lab/fast/ForcePlan.hpp"

namespace lab {

/** Goes over all nodes of a cloth, in parts that fit in a cache. It keeps a
 * stencil of the cloth, and makes it anew when nodes or edges came or went.
 *
 * One thread computes all of a node's force, in an order that does not depend
 * on the number of threads. So the results are the same, bit by bit. */
class Sweep {
 public:
  /** How many processors this program may use. */
  static int processors();
  /** Let all sweeps have @a n threads from now on. 0, the default: those that
   * OpenMP gives, and one for small cloths. */
  static void set_threads(int n);

  static constexpr unsigned part_size = 1024;
  /** By default a cloth of fewer parts has one thread: starting more may take
   * longer than the sweep, if another program has a processor just then. */
  static constexpr int many_parts = 32;
  static_assert(part_size % ClothStencil::width == 0);

  /** Call @a work(thread, threads) in each of as many threads as a cloth of
   * @a slots ids has. It must not throw. */
  using Work = std::function<void(int thread, int threads)>;
  static void together(unsigned slots, const Work& work);
  /** Wait until other threads have made @a count at least @a least. What they
   * wrote before is seen then. */
  static void await(const std::atomic<int>& count, int least);
  /** The first exception of several threads, for the one that called them. */
  class FirstError {
   public:
    void keep();  ///< the one that is being handled
    void rethrow() const {
      if (error_) std::rethrow_exception(error_);
    }

   private:
    std::exception_ptr error_;
  };

  /** Called with the first id of a part, and the one behind its last. */
  using IdVisitor = std::function<void(unsigned first, unsigned last)>;
  /** Call @a move and @a use for each part of @a slots ids, @a use when all
   * parts up to @a halo away have been moved. Each thread goes through its own
   * parts in their order, and moves those in the halo before it needs them.
   * Throws as parts(). */
  static void in_turn(unsigned slots, int halo, const IdVisitor& move,
                      const IdVisitor& use);
  /** The halo: how many parts away the nodes may be whose positions @a force
   * reads.  @param reach the largest difference of two neighbors' ids */
  static int halo_of(const ForcePlan& force, unsigned reach);
  /** How many threads that is at most, and which one is calling. */
  static std::size_t threads();
  static std::size_t thread();

  /** Call @a use(part) for parts that make up the cloth, several at once.
   * Throws what @a use throws, the first of it, when all are done. */
  template <typename Use>
  void parts(const Cloth& g, Use use) {
    each_part(g, std::ref(use));
  }

  /** All forces on @a g into @a f, by node id; removed nodes feel none. Then
   * @a use(part, forces on it) while they are at hand. */
  template <typename Use>
  void operator()(const Cloth& g, double t, const ForcePlan& force,
                  std::vector<Point>& f, Use use) {
    after(nothing, g, t, force, f, use);
  }
  void operator()(const Cloth& g, double t, const ForcePlan& force,
                  std::vector<Point>& f) {
    (*this)(g, t, force, f, [](const Part&, std::span<Point>) {});
  }
  /** The same, if nobody needs the forces afterwards. */
  template <typename Use>
  void operator()(const Cloth& g, double t, const ForcePlan& force, Use use) {
    after(nothing, g, t, force, use);
  }

  /** The same, but @a move(part) is called for each part before any force that
   * depends on the positions of its nodes. So the data go through the cache
   * once for both. @a move may change positions and velocities of its part, and
   * @a use its velocities; the graph stays as it is. Several threads do several
   * parts at once. Throws as parts(). */
  template <typename Move, typename Use>
  void after(Move move, const Cloth& g, double t, const ForcePlan& force,
             std::vector<Point>& f, Use use) {
    add_up(std::ref(move), g, t, force, &f, std::ref(use));
  }
  template <typename Move, typename Use>
  void after(Move move, const Cloth& g, double t, const ForcePlan& force,
             Use use) {
    add_up(std::ref(move), g, t, force, nullptr, std::ref(use));
  }

 private:
  // Made of std::ref(), so that none of them is copied to the heap.
  using PartVisitor = std::function<void(const Part&)>;
  using ForceVisitor = std::function<void(const Part&, std::span<Point>)>;
  using Buffer = std::array<Point, part_size>;
  static constexpr auto nothing = [](const Part&) {};

  std::optional<ClothStencil> stencil_;
  std::uint64_t version_ = 0;   // of the cloth, when it was made
  std::vector<Buffer> buffer_;  // by thread

  void update(const Cloth& g);
  void each_part(const Cloth& g, const PartVisitor& use);
  void add_up(const PartVisitor& move, const Cloth& g, double t,
              const ForcePlan& force, std::vector<Point>* f,
              const ForceVisitor& use);
};

}  // namespace lab
