#pragma once
/** @file SlotMap.hpp
 * What Graph.hpp stores its elements with: a SlotMap gives each element an id
 * that never changes; a ListPool keeps many short lists in one array. */
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

namespace graph_detail {

using size_type = unsigned;

/** An array that grows like a std::vector, with two differences that save time
 * and memory when a large graph is built: from 64 kB on it grows by an eighth
 * instead of doubling; and it grows by realloc(), which moves the pages of a
 * large block instead of copying them. */
template <typename T>
class GrowingArray {
 public:
  static_assert(std::is_trivially_copyable_v<T> &&
                alignof(T) <= alignof(std::max_align_t));

  GrowingArray() = default;
  GrowingArray(const GrowingArray& o) {
    reserve(o.size_);
    std::uninitialized_copy(o.begin(), o.end(), data_);
    size_ = o.size_;
  }
  GrowingArray& operator=(const GrowingArray&) = delete;
  ~GrowingArray() { std::free(data_); }

  std::size_t size() const { return size_; }
  std::size_t capacity() const { return capacity_; }
  T* data() { return data_; }
  const T* data() const { return data_; }
  T* begin() { return data_; }
  const T* begin() const { return data_; }
  T* end() { return data_ + size_; }
  const T* end() const { return data_ + size_; }
  T& operator[](std::size_t i) { return assert(i < size_), data_[i]; }
  const T& operator[](std::size_t i) const {
    return assert(i < size_), data_[i];
  }

  /** New elements are T().  Complexity: O(1) amortized for each of them.
   * Throws std::bad_alloc: no change. */
  void resize(std::size_t n) {
    if (n > capacity_) grow(n);
    while (size_ < n) new (data_ + size_++) T();
    size_ = n;
  }
  void clear() { size_ = 0; }
  void swap(GrowingArray& o) noexcept {
    std::swap(data_, o.data_);
    std::swap(size_, o.size_);
    std::swap(capacity_, o.capacity_);
  }
  /** Have room for @a n elements.  Throws std::bad_alloc: no change. */
  void reserve(std::size_t n) {
    if (n <= capacity_) return;
    void* block = std::realloc(static_cast<void*>(data_), n * sizeof(T));
    if (!block) throw std::bad_alloc();
    data_ = static_cast<T*>(block);
    capacity_ = n;
  }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0, capacity_ = 0;

  // Not inlined, as it is rare: so the code that adds an element stays short.
  [[gnu::noinline]] void grow(std::size_t n) {
    const bool small = capacity_ * sizeof(T) < 65536;
    reserve(std::max(n, capacity_ + (small ? capacity_ : capacity_ / 8)));
  }
};

/** Make @a a long enough to hold an element @a i. */
template <typename A>
void grow_to_hold(A& a, std::size_t i) {
  if (a.size() <= i) a.resize(i + 1);
}

/** Set @a value to T(), for a slot that is no longer in use. If T() throws, the
 * value stays, as a removal must not fail. */
template <typename T>
void reset(T& value) noexcept {
  try {
    value = T();
  } catch (...) {
  }
}

/** No slot or block. */
inline constexpr size_type none = std::numeric_limits<size_type>::max();

/** Ids and indices of things that are added and removed. The id of a thing
 * never changes; the indices of all things are 0, 1, ..., size() - 1 at any
 * time.
 *
 * The id is the number of the thing's slot; the slots of removed things are
 * used again. Each slot has a @e generation, which grows by 1 when the slot is
 * taken and when it is released; so it is odd while the slot is in use. A
 * handle (id, generation) is alive while its slot has that generation. A slot
 * that runs out of generations is worn out and never used again: a dead handle
 * stays dead.
 *
 * Memory: none until the first release(): all slots are in use, their
 * generation is the same, and index == id. From then on 8 bytes and
 * sizeof(Generation) a slot.
 * @tparam Generation an unsigned integer; tests take a short one */
template <typename Generation = std::uint32_t>
class SlotMap {
 public:
  /** Number of things. */
  size_type size() const { return size_; }
  /** All ids in use lie below slots(). */
  size_type slots() const { return slots_; }
  /** @pre id < slots() */
  bool in_use(size_type id) const { return generation(id) % 2 == 1; }
  Generation generation(size_type id) const {
    return id < generation_.size() ? generation_[id] : common_;
  }
  bool alive(size_type id, Generation number) const {
    return id < slots_ && generation(id) == number && number % 2 == 1;
  }

  /** The id at an index, and the index of an id.  O(1)
   * They are equal, and need no lists, until something is released. */
  size_type id_at(size_type index) const {
    return identity_ ? index : id_at_[index];
  }
  size_type index_of(size_type id) const {
    return identity_ ? id : index_of_[id];
  }

  /** Make room for one more.
   * @return the id that acquire() will give
   * Complexity: O(1) amortized
   * Throws std::length_error, std::bad_alloc: no change. */
  size_type reserve_one() {
    size_type id = free_ == none ? slots_ : free_;
    if (id >= max_slots || (!identity_ && id >= index_of_.size())) grow(id);
    return id;
  }
  /** Take a slot into use.  O(1)   @post index_of(result) == old size()
   * @pre reserve_one() came before */
  size_type acquire() {
    size_type id = free_ == none ? slots_++ : free_;
    if (free_ != none) free_ = index_of_[id];
    if (!identity_) index_of_[id] = size_, id_at_[size_] = id;
    if (id < generation_.size()) ++generation_[id];
    ++size_;
    return id;
  }

  /** Make all lists that release() needs.
   * Complexity: O(slots()) the first time, and the first time after clear() or
   *       reindex(), which may drop the lists of indices; else O(1) for each
   *       slot taken since the last time
   * Throws std::bad_alloc: no change. */
  void make_lists() {
    make_generations();
    make_indices();
  }
  /** Release a slot.  O(1)
   * @pre in_use(id), and make_lists() came after the slot was taken
   * @post The thing of highest index has the index of the released one. */
  void release(size_type id) {
    size_type hole = index_of_[id];
    size_type last = id_at_[--size_];
    id_at_[hole] = last;
    index_of_[last] = hole;
    retire(id);
  }

  /** Release all. The next slot is 0, unless a slot is worn out.
   * Complexity: O(size()); plus make_lists() if one is worn out.
   * Throws std::bad_alloc, only if one is worn out: no change. */
  void clear() {
    size_type used_up = used_up_;
    for (size_type index = 0; index < size_; ++index)
      used_up += generation(id_at(index)) >= last_generation - 1;
    if (used_up > 0) make_lists();
    for (size_type index = 0; index < size_; ++index)
      if (const size_type id = id_at(index); used_up > 0)
        retire(id);
      else if (id < generation_.size())
        ++generation_[id];
    if (slots_ > generation_.size()) ++common_, ++common_;
    if (used_up == 0) forget_lists(), free_ = none, slots_ = 0;
    size_ = 0;
  }

  /** Number the things in the order of their ids.  O(slots()) */
  void reindex() {
    if (identity_) return;
    size_type index = 0;
    for (size_type id = 0; id < slots_; ++id)
      if (in_use(id)) {
        id_at_[index] = id;
        index_of_[id] = index++;
      }
    if (size_ == slots_) forget_lists();
  }

  /** Give the thing of id @a ids[i] the index i.  O(slots())
   * @pre @a ids names each thing once   Throws std::bad_alloc: no change. */
  void reindex(std::span<const size_type> ids) {
    assert(ids.size() == size_);
    make_indices();
    for (size_type index = 0; index < size_; ++index) {
      assert(ids[index] < slots_ && in_use(ids[index]));
      id_at_[index] = ids[index];
      index_of_[ids[index]] = index;
    }
    for (size_type index = 0; index < size_; ++index)
      assert(index_of_[ids[index]] == index);  // else an id comes twice
  }

  /** Throw std::logic_error unless the representation is consistent. */
  void check_invariants() const {
    auto require = [](bool ok) {
      if (!ok) throw std::logic_error("SlotMap: inconsistent");
    };
    require(identity_ ? id_at_.size() == 0 : id_at_.size() >= size_);
    require(identity_ ? index_of_.size() == 0 : index_of_.size() >= slots_);
    require(!identity_ || (size_ == slots_ && free_ == none));
    std::vector<bool> is_free(slots_);
    size_type used = 0, unused = used_up_;
    for (size_type id = free_; id != none; id = index_of_[id], ++unused) {
      require(id < slots_ && !in_use(id) && reusable(id) && !is_free[id]);
      is_free[id] = true;
    }
    const auto ever = std::max<std::size_t>(generation_.size(), slots_);
    for (size_type id = 0; id < ever; ++id) {
      if (in_use(id)) {
        ++used;
        require(id < slots_ && index_of(id) < size_);
        require(id_at(index_of(id)) == id);
      } else {
        require(id >= slots_ || is_free[id] || !reusable(id));
      }
    }
    require(used == size_ && used + unused == slots_);
  }

 private:
  // Each edge has two entries in a ListPool, which counts in 32 bits.
  static constexpr size_type max_slots = 1u << 31;

  // That of a slot that is worn out.
  static constexpr auto last_generation =
      std::numeric_limits<Generation>::max() - 1;

  GrowingArray<Generation> generation_;  // by slot; odd: in use
  Generation common_{1};  // of all slots from generation_.size() on, in use
  // While not identity_:
  GrowingArray<size_type> id_at_;  // by index
  GrowingArray<size_type>
      index_of_;           // by slot; of a free one the next free one
  size_type free_ = none;  // the first free slot
  size_type size_ = 0;
  size_type slots_ = 0;
  size_type used_up_ = 0;  // the number of worn-out slots
  bool identity_ = true;   // index == id for all, and all slots are in use

  /** Give each slot a generation of its own. */
  void make_generations() {
    const std::size_t old = generation_.size();
    if (old >= slots_) return;
    generation_.resize(slots_);
    for (std::size_t id = old; id < slots_; ++id) generation_[id] = common_;
  }
  void make_indices() {
    if (!identity_) return;
    id_at_.reserve(slots_);
    index_of_.reserve(slots_);  // the last that may throw
    id_at_.resize(slots_);
    index_of_.resize(slots_);
    for (size_type id = 0; id < slots_; ++id) id_at_[id] = index_of_[id] = id;
    identity_ = false;
  }
  // Not inlined: as GrowingArray::grow().
  [[gnu::noinline]] void grow(size_type id) {
    if (id >= max_slots) throw std::length_error("Graph: too many elements");
    grow_to_hold(id_at_, id), grow_to_hold(index_of_, id);
  }
  bool reusable(size_type id) const { return generation(id) < last_generation; }
  /** End the use of slot @a id; it is the next to be used again. */
  void retire(size_type id) {
    ++generation_[id];
    if (reusable(id))
      index_of_[id] = std::exchange(free_, id);
    else
      ++used_up_;
  }
  void forget_lists() {
    id_at_.clear();
    index_of_.clear();
    identity_ = true;
  }
};

/** Many lists of T in one array, each in a block whose capacity is a power of
 * two. A list that outgrows its block moves to a larger one; the old block is
 * free for the next list that needs its size.
 * Memory: at most about 4 sizeof(T) an element, 12 bytes a list. */
template <typename T>
class ListPool {
 public:
  static_assert(sizeof(T) >= sizeof(size_type));  // see free_
  struct List {
    size_type begin = 0;  // of the block, in the pool
    size_type size = 0;
    size_type capacity = 0;  // 0 or a power of two
  };

  const T& operator[](std::size_t at) const { return pool_[at]; }
  T& operator[](std::size_t at) { return pool_[at]; }
  std::span<const T> items(const List& l) const {
    return {pool_.data() + l.begin, l.size};
  }

  /** Allocate memory for @a lists with a total of @a items. From now on the
   * first block of a list holds the average number of items. */
  void reserve(std::size_t lists, std::size_t items) {
    if (lists == 0) return;
    const auto first = std::bit_ceil(
        size_type(std::clamp<std::size_t>((items + lists - 1) / lists, 4, 64)));
    pool_.reserve(lists * first);
    first_capacity_ = first;
  }
  /** Make room for one more element in @a l.  O(1) amortized
   * Throws std::length_error, std::bad_alloc: no change. */
  void reserve_one(List& l) {
    if (l.size == l.capacity) move_to_longer(l);
  }
  /** Append.  @pre reserve_one(l) came before */
  void push_back(List& l, const T& item) {
    assert(l.size < l.capacity);
    pool_[l.begin + l.size++] = item;
  }
  /** Remove the element at @a k: the last one takes its place.  O(1) */
  void erase(List& l, size_type k) {
    pool_[l.begin + k] = pool_[l.begin + l.size - 1];
    --l.size;
  }
  /** Empty the list and free its block. */
  void free(List& l) {
    if (l.capacity > 0)
      set_next(l.begin, std::exchange(free_of(l.capacity), l.begin));
    l = {};
  }
  void clear() {
    pool_.clear();
    free_ = no_blocks();
  }
  /** Move all lists to a smaller array, one after the other, in blocks that
   * just hold them; but only if that frees a quarter of the array or more.
   * @param lists all lists of the pool
   * Throws std::bad_alloc: no change.  Complexity: O(lists + items) */
  void compact(std::span<List> lists) {
    const auto needed = [](const List& l) {
      return l.size == 0 ? 0 : std::bit_ceil(l.size);
    };
    std::size_t all = 0;
    for (const List& l : lists) all += needed(l);
    if (4 * all >= 3 * pool_.size()) return;
    GrowingArray<T> smaller;
    smaller.reserve(all);
    smaller.resize(all);
    size_type begin = 0;
    for (List& l : lists) {
      std::copy_n(pool_.data() + l.begin, l.size, smaller.data() + begin);
      l = {begin, l.size, needed(l)};
      begin += l.capacity;
    }
    pool_.swap(smaller);
    free_ = no_blocks();
  }
  std::size_t pool_size() const { return pool_.size(); }
  /** True if the blocks of @a lists and the free blocks make up the whole pool,
   * without a gap or an overlap. */
  bool is_filled_by(std::span<const List> lists) const {
    std::vector<std::array<std::size_t, 2>> blocks;  // begin, capacity
    for (const List& l : lists)
      if (l.capacity > 0) blocks.push_back({l.begin, l.capacity});
    for (std::size_t k = 0; k < free_.size(); ++k)
      for (size_type begin = free_[k]; begin != none; begin = next(begin)) {
        if (begin >= pool_.size() || blocks.size() > pool_.size()) return false;
        blocks.push_back({begin, std::size_t(1) << k});
      }
    std::sort(blocks.begin(), blocks.end());
    std::size_t end = 0;
    for (auto [begin, capacity] : blocks) {
      if (begin != end) return false;
      end += capacity;
    }
    return end == pool_.size();
  }

 private:
  // Not inlined: as GrowingArray::grow().
  [[gnu::noinline]] void move_to_longer(List& l) {
    size_type capacity = l.capacity == 0 ? first_capacity_ : 2 * l.capacity;
    size_type begin = free_of(capacity);
    if (begin != none) {
      free_of(capacity) = next(begin);
    } else {
      if (pool_.size() + capacity > std::numeric_limits<size_type>::max())
        throw std::length_error("Graph: too many edges");
      begin = static_cast<size_type>(pool_.size());
      pool_.resize(pool_.size() + capacity);
    }
    List longer{begin, l.size, capacity};
    std::copy_n(pool_.data() + l.begin, l.size, pool_.data() + begin);
    free(l);
    l = longer;
  }
  size_type first_capacity_ = 4;  // of a list
  GrowingArray<T> pool_;
  // The first free block of each size, by log2 of its capacity. A free block
  // holds where the next one begins, so freeing a block needs no memory.
  using Blocks = std::array<size_type, 32>;
  Blocks free_ = no_blocks();

  static constexpr Blocks no_blocks() {
    Blocks b;
    b.fill(none);
    return b;
  }
  size_type& free_of(size_type capacity) {
    return free_[std::size_t(std::countr_zero(capacity))];
  }
  size_type next(size_type begin) const {
    size_type b;
    std::memcpy(&b, pool_.data() + begin, sizeof b);
    return b;
  }
  void set_next(size_type begin, size_type b) {
    std::memcpy(static_cast<void*>(pool_.data() + begin), &b, sizeof b);
  }
};

/** The value of nodes and edges that need none. */
struct NoValue {
  bool operator==(const NoValue&) const = default;
};

/** The array for a T: a GrowingArray if a T may be copied as bytes. (A bool
 * may, so this is never a std::vector<bool>.) */
template <typename T>
using Array = std::conditional_t<std::is_trivially_copyable_v<T> &&
                                     alignof(T) <= alignof(std::max_align_t),
                                 GrowingArray<T>, std::vector<T>>;

/** Counts the changes of a graph. Each graph and each copy has its own range.
 */
struct Version {
  std::uint64_t number = next.fetch_add(std::uint64_t(1) << 36);
  Version() = default;
  Version(const Version&) : Version() {}
  void operator++() { ++number; }
  static inline std::atomic<std::uint64_t> next = 0;
};

}  // namespace graph_detail
