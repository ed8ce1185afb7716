#pragma once
/** @file SlotMap.hpp
 * SlotMap: ids that stay and indices that move. Graph.hpp has one for its nodes
 * and one for its edges. */
#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <numeric>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <vector>

namespace graph_detail {

using size_type = unsigned;

/** No id. */
inline constexpr size_type none = std::numeric_limits<size_type>::max();

/** Make @a a long enough to hold an element @a i. Its memory grows by half
 * where std::vector would double it: still O(1) amortized. */
template <typename A>
void grow_to_hold(A& a, std::size_t i) {
  if (a.size() > i) return;
  if constexpr (requires { a.reserve(i); })
    if (i >= a.capacity()) a.reserve(i + i / 2 + 4);
  a.resize(i + 1);
}

/** Ids and indices of elements that are added and removed. The id of an element
 * never changes; the indices of all are 0, 1, ..., size() - 1 at any time.
 *
 * The id is the number of the element's slot; slots of removed elements are
 * used again. Each slot has a @e generation, which grows by 1 when an element
 * takes the slot and when it is removed; so it is odd while the slot is in use.
 * A handle (id, generation) is alive while its slot has that generation. The
 * generation has 32 bits: a handle stays dead until 2^31 more elements were
 * removed from its slot.
 *
 * Until the first removal index == id, and nothing is stored for it. */
class SlotMap {
 public:
  using Generation = std::uint32_t;

  /** Number of elements. */
  size_type size() const { return size_; }
  /** All ids lie below slots(). */
  size_type slots() const { return slots_; }
  /** @pre id < slots() */
  bool in_use(size_type id) const { return generation(id) % 2 == 1; }
  Generation generation(size_type id) const { return generation_[id]; }
  bool alive(size_type id, Generation number) const {
    return id < slots_ && generation(id) == number && number % 2 == 1;
  }
  /** The id at an index, and the index of an id.  @pre it is in use */
  size_type id_at(size_type index) const {
    return ids_.empty() ? index : ids_[index];
  }
  size_type index_of(size_type id) const {
    return ids_.empty() ? id : index_[id];
  }

  /** The id that acquire() will give. */
  size_type next_id() const { return size_ < slots_ ? ids_[size_] : slots_; }
  /** Take a slot into use.  @post index_of(result) == old size()
   * Complexity: O(1) amortized
   * Throws std::length_error, std::bad_alloc: no change. */
  size_type acquire() {
    if (size_ == slots_) add_slot();
    const size_type id = id_at(size_++);
    ++generation_[id];
    return id;
  }
  /** Make the lists that release() needs.
   * Complexity: O(slots()) the first time, and the first time after clear()
   * Throws std::bad_alloc: no change. */
  void make_lists() {
    if (!ids_.empty()) return;
    std::vector<size_type> all(slots_);
    std::iota(all.begin(), all.end(), 0);
    index_ = all;
    ids_.swap(all);
  }
  /** Release a slot.  O(1)   @pre in_use(id); make_lists() was called
   * @post The element of highest index has the index of the released one. */
  void release(size_type id) {
    assert(in_use(id) && !ids_.empty());
    put(ids_[--size_], index_[id]);
    put(id, size_);
    ++generation_[id];
  }
  /** Release all. The next id is 0.  O(size()) */
  void clear() {
    for (size_type k = 0; k < size_; ++k) ++generation_[id_at(k)];
    ids_.clear(), index_.clear();
    size_ = slots_ = 0;
  }
  /** Give the element of id @a ids[i] the index i.  O(slots())
   * @pre @a ids names each element once   Throws std::bad_alloc: no change. */
  void reindex(std::span<const size_type> ids) {
    assert(ids.size() == size_);
    make_lists();
    for (size_type i = 0; i < size_; ++i) {
      assert(ids[i] < slots_ && in_use(ids[i]));
      put(ids[i], i);
    }
    for (size_type i = 0; i < size_; ++i)
      assert(index_of(ids[i]) == i && "an id comes twice");
  }
  void reserve(size_type n) { generation_.reserve(n); }

  /** Throw std::logic_error unless the invariant, below, holds. */
  void check_invariants() const {
    bool ok = size_ <= slots_ && slots_ <= generation_.size() &&
              (ids_.empty() ? size_ == slots_
                            : std::min(ids_.size(), index_.size()) >= slots_);
    for (size_type k = 0; ok && k < slots_; ++k)
      ok = id_at(k) < slots_ && index_of(id_at(k)) == k &&
           in_use(id_at(k)) == (k < size_);
    for (std::size_t id = slots_; ok && id < generation_.size(); ++id)
      ok = !in_use(size_type(id));
    if (!ok) throw std::logic_error("SlotMap: inconsistent");
  }

 private:
  // Invariant: ids_ names each slot once. Those in use come first, by index;
  // then the free ones, the last released first. index_ is its inverse. Both
  // are empty until the first removal: then no slot is free, and index == id.
  // generation_ may be longer than slots_: clear() keeps it.
  std::vector<size_type> ids_;
  std::vector<size_type> index_;        // by id: its place in ids_
  std::vector<Generation> generation_;  // by id
  size_type size_ = 0, slots_ = 0;

  void put(size_type id, size_type place) {
    ids_[place] = id;
    index_[id] = place;
  }
  void add_slot() {
    if (slots_ >= 1u << 31) throw std::length_error("Graph: too many elements");
    grow_to_hold(generation_, slots_);
    if (!ids_.empty()) {
      grow_to_hold(ids_, slots_), grow_to_hold(index_, slots_);
      put(slots_, slots_);
    }
    ++slots_;
  }
};

/** An array of @a T, by id. It is a std::vector, except for bool: that of the
 * standard library packs eight into a byte, so none has a bool& of its own. */
template <typename T>
using Array =
    std::conditional_t<std::is_same_v<T, bool>, std::deque<T>, std::vector<T>>;

/** Set @a value to T(), for a slot that is no longer in use. If T() throws, the
 * value stays, as a removal must not fail. */
template <typename T>
void reset(T& value) noexcept {
  try {
    value = T();
  } catch (...) {
  }
}

/** The value of nodes and edges that need none. */
struct NoValue {
  bool operator==(const NoValue&) const = default;
};

/** A number that changes with a graph; no two graphs have the same. */
struct Version {
  std::uint64_t number = next.fetch_add(std::uint64_t(1) << 36);
  Version() = default;
  Version(const Version&) : Version() {}
  void operator++() { ++number; }
  static inline std::atomic<std::uint64_t> next = 0;
};

}  // namespace graph_detail
