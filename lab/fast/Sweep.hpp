#pragma once
/** @file Sweep.hpp
 * Sweep: a parallel loop over the nodes of a cloth, in parts, with OpenMP
 * (OMP_NUM_THREADS, or --threads). */
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>

#include "lab/fast/ForcePlan.hpp"

namespace lab {

/** Loops over all ids of a cloth, in parts that fit in a cache. The number of
 * threads decides which thread takes a part, but not the order in a part. */
struct Sweep {
  /** The number of processors that this program may use. */
  static int processors();
  /** Let all sweeps have @a n threads from now on. 0, the default: as many as
   * OpenMP has, but one for small cloths. */
  static void set_threads(int n);
  /** The largest number of threads, and the number of the calling one. */
  static std::size_t threads();
  static std::size_t thread();

  static constexpr unsigned part_size = 1024;
  /** By default a cloth of fewer parts has one thread: starting more may take
   * longer than the sweep, if other programs use the processors. */
  static constexpr int many_parts = 32;

  /** Call @a work(thread, threads) in each thread of a sweep over @a slots ids.
   * It must not throw. */
  using Work = std::function<void(int thread, int threads)>;
  static void together(unsigned slots, const Work& work);
  /** Wait until @a count, which other threads raise, is at least @a least. Then
   * all that they wrote before is visible. */
  static void await(const std::atomic<int>& count, int least);
  /** The first exception of several threads, for the one that starts them. */
  class FirstError {
   public:
    void keep();  ///< keep the present exception
    void rethrow() const {
      if (error_) std::rethrow_exception(error_);
    }

   private:
    std::exception_ptr error_;
  };

  /** Called with a part: the ids in [first, last). */
  using IdVisitor = std::function<void(unsigned first, unsigned last)>;
  /** Call @a move and @a use for each part of @a slots ids; @a use when all
   * parts up to @a halo away have been moved. Each thread takes its own parts
   * in order, and moves those of the halo just before it needs them: so data
   * pass through the cache once for both. Throws the first of their exceptions
   * when all threads are done. */
  static void in_turn(unsigned slots, int halo, const IdVisitor& move,
                      const IdVisitor& use);
  /** The halo: the distance in parts up to which @a force reads positions.
   * @param reach the largest difference of two neighbors' ids */
  static int halo_of(const ForcePlan& force, unsigned reach);
};

}  // namespace lab
