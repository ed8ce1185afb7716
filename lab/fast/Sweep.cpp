#include "lab/fast/Sweep.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <thread>

#ifdef _OPENMP
#include <omp.h>
#endif

namespace lab {

namespace {
int threads_asked_for = 0;
#ifndef _OPENMP  // the same for one thread
int omp_get_num_procs() { return 1; }
int omp_get_max_threads() { return 1; }
int omp_get_thread_num() { return 0; }
void omp_set_num_threads(int) {}
#endif
}  // namespace

int Sweep::processors() { return omp_get_num_procs(); }
std::size_t Sweep::threads() { return std::size_t(omp_get_max_threads()); }
std::size_t Sweep::thread() { return std::size_t(omp_get_thread_num()); }

void Sweep::set_threads(int n) {
  threads_asked_for = n;
  omp_set_num_threads(n == 0 ? processors() : n);
}

int Sweep::halo_of(const ForcePlan& force, unsigned reach) {
  if (!force.spring_multiplicity()) return std::numeric_limits<int>::max();
  return int((reach + part_size - 1) / part_size);
}

void Sweep::in_turn(unsigned slots, int halo, const IdVisitor& move,
                    const IdVisitor& use) {
  const int count = int((slots + part_size - 1) / part_size);
  halo = std::min(halo, count);
  FirstError error;
  const auto call = [&](const IdVisitor& what, int k) {
    const unsigned first = unsigned(k) * part_size;
    try {
      what(first, std::min(first + part_size, slots));
    } catch (...) {  // no exception may leave a thread
      error.keep();
    }
  };
  const auto share = [&](int number, int threads) {
    const int first = int(std::int64_t(count) * number / threads);
    const int last = int(std::int64_t(count) * (number + 1) / threads);
    // Other threads wait for the parts at the borders. So these move first:
    // [first, moved), which grows, and [inner_last, last).
    const int inner_last = std::max(last - halo, first);
    int moved = std::min(first + halo, inner_last);
    for (int k = first; k < moved; ++k) call(move, k);
    for (int k = inner_last; k < last; ++k) call(move, k);
    if (threads > 1 && halo > 0) {
#ifdef _OPENMP
#pragma omp barrier
#endif
    }
    for (int k = first; k < last; ++k) {
      for (; moved < inner_last && moved <= k + halo; ++moved)
        call(move, moved);
      call(use, k);
    }
  };
  together(slots, std::ref(share));  // nothing on the heap
  error.rethrow();
}

void Sweep::together([[maybe_unused]] unsigned slots, const Work& work) {
  bool alone = true;
#ifdef _OPENMP
  // Calling a team takes longer than a step of 100 nodes.
  const unsigned count = (slots + part_size - 1) / part_size;
  alone = count <= 1 || threads_asked_for == 1 ||
          (threads_asked_for == 0 && count < many_parts);
  if (!alone) {
#pragma omp parallel
    work(omp_get_thread_num(), omp_get_num_threads());
  }
#endif
  if (alone) work(0, 1);
}

void Sweep::FirstError::keep() {
#ifdef _OPENMP
#pragma omp critical(sweep_error)
#endif
  if (!error_) error_ = std::current_exception();
}

void Sweep::await(const std::atomic<int>& count, int least) {
  while (count.load(std::memory_order_acquire) < least) {
#ifdef _OPENMP
    std::this_thread::yield();
#endif
  }
}

}  // namespace lab
