#pragma once
/** @file Sweep.hpp
 * Sweep: the way over all nodes of a cloth, a part at a time, by as many
 * threads as OpenMP has (OMP_NUM_THREADS, or --threads). */
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>

#include "lab/fast/ForcePlan.hpp"

namespace lab {

/** Goes over all ids of a cloth, in parts that fit in a cache. Which thread
 * takes a part depends on their number, the order within a part does not. */
struct Sweep {
  /** How many processors this program may use. */
  static int processors();
  /** Let all sweeps have @a n threads from now on. 0, the default: those that
   * OpenMP gives, and one for small cloths. */
  static void set_threads(int n);
  /** How many threads that is at most, and which one is calling. */
  static std::size_t threads();
  static std::size_t thread();

  static constexpr unsigned part_size = 1024;
  /** By default a cloth of fewer parts has one thread: starting more may take
   * longer than the sweep, if another program has a processor just then. */
  static constexpr int many_parts = 32;

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
   * parts in their order, and moves those in the halo before it needs them: so
   * the data go through the cache once for both. Throws what they throw, the
   * first of it, when all are done. */
  static void in_turn(unsigned slots, int halo, const IdVisitor& move,
                      const IdVisitor& use);
  /** The halo: how many parts away the nodes may be whose positions @a force
   * reads.  @param reach the largest difference of two neighbors' ids */
  static int halo_of(const ForcePlan& force, unsigned reach);
};

}  // namespace lab
