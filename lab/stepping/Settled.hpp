#pragma once
/** @file Settled.hpp
 * Settled: what is noted about states of a run, read once they are settled. */
#include <cstdint>
#include <deque>
#include <functional>
#include <utility>

#include "lab/fast/Archive.hpp"
#include "lab/stepping/Stepper.hpp"

namespace lab {

/** Notes on the states of a run, one each. A state is settled once the run can
 * no longer continue from before it; then its note is read. Notes on states
 * that the run takes back are dropped. So a file of what is read only grows. */
template <typename T>
class Settled final : public SettledReader {
 public:
  using Read = std::function<void(const T&)>;
  /** @param read called with the notes in their order, by the steps of
   * @a stepper, which must live longer */
  Settled(Stepper& stepper, Read read)
      : stepper_(stepper), read_(std::move(read)) {
    stepper_.tell(this);
  }
  ~Settled() { stepper_.tell_no_more(this); }
  Settled(const Settled&) = delete;
  Settled& operator=(const Settled&) = delete;

  /** Is there a note on the present state? */
  bool has_present() const { return last() == stepper_.steps(); }
  /** Note @a what about the present state, unless there is a note. */
  void add(T what) {
    if (has_present()) return;
    settle(stepper_.steps(), read_steps_);  // check() may have gone back
    waiting_.push_back({stepper_.steps(), std::move(what)});
  }
  /** The last note that waits, or nullptr. */
  const T* back() const {
    return waiting_.empty() ? nullptr : &waiting_.back().what;
  }
  /** Call @a use with the notes that wait, in their order. */
  void each_waiting(const Read& use) const {
    for (const Note& n : waiting_)
      if (n.step <= stepper_.steps()) use(n.what);  // others went back
  }
  /** There is no note, read or waiting. */
  bool empty() const { return last() < 0; }
  /** The run is over: read the notes that wait. */
  void finish() { settle(stepper_.steps(), stepper_.steps()); }
  /** Forget all notes: the run begins anew. */
  void clear() { waiting_.clear(), read_steps_ = -1; }

  void settle(long long now, long long settled) override {
    while (!waiting_.empty() && waiting_.back().step > now) waiting_.pop_back();
    for (; !waiting_.empty() && waiting_.front().step <= settled;
         waiting_.pop_front()) {
      read_steps_ = waiting_.front().step;
      read_(waiting_.front().what);
    }
  }
  void archive(Archive& a) {
    std::uint64_t count = waiting_.size();
    a(read_steps_)(count);
    a.require(read_steps_ >= -1);
    if (a.loads()) waiting_.clear();
    for (std::uint64_t k = 0; k < count; ++k) {
      if (a.loads()) waiting_.emplace_back();
      a(waiting_[k].step)(waiting_[k].what);
    }
  }

 private:
  struct Note {
    long long step;
    T what;
  };
  Stepper& stepper_;
  Read read_;
  std::deque<Note> waiting_;
  long long read_steps_ = -1;  // the step of the last note that was read

  long long last() const {
    return waiting_.empty() ? read_steps_ : waiting_.back().step;
  }
};

}  // namespace lab
