#pragma once
/** @file Pending.hpp
 * Pending: output that waits until its step is settled. */
#include <cstdint>
#include <deque>
#include <utility>

#include "lab/fast/Archive.hpp"

namespace lab {

/** Holds what a run writes about its states, in the order of the steps. A step
 * is settled once the run can no longer continue from before it; until then its
 * output waits here. So files only ever grow. */
template <typename T>
class Pending {
 public:
  /** @pre @a step > last() */
  void add(long long step, T what) {
    waiting_.push_back({step, std::move(what)});
    last_ = step;
  }
  /** The step of the last output, waiting or written; -1: there is none. */
  long long last() const { return last_; }
  /** The last output that waits, or nullptr. */
  const T* back() const {
    return waiting_.empty() ? nullptr : &waiting_.back().what;
  }
  /** Drop the output of steps beyond @a now, which will come again; then call
   * @a write, in order, with that of the first @a settled steps.
   * @pre what was written is not beyond @a now */
  template <typename Write>
  void settle(long long now, long long settled, const Write& write) {
    while (!waiting_.empty() && waiting_.back().step > now) waiting_.pop_back();
    for (; !waiting_.empty() && waiting_.front().step <= settled;
         waiting_.pop_front()) {
      write(waiting_.front().what);
      written_ = waiting_.front().step;
    }
    last_ = waiting_.empty() ? written_ : waiting_.back().step;
  }
  void archive(Archive& a) {
    std::uint64_t count = waiting_.size();
    a(last_)(written_)(count);
    a.require(last_ >= -1 && written_ >= -1);
    if (a.loads()) waiting_.clear();
    for (std::uint64_t k = 0; k < count; ++k) {
      if (a.loads()) waiting_.emplace_back();
      a(waiting_[k].step)(waiting_[k].what);
    }
  }

 private:
  struct Output {
    long long step;
    T what;
  };
  std::deque<Output> waiting_;
  long long last_ = -1, written_ = -1;  // steps
};

}  // namespace lab
