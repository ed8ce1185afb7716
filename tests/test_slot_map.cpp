// SlotMap.hpp: the arrays and lists that a graph is stored in. Slots are tested
// by the histories of test_graph; here is counted what they cost.
#include "CME212/SlotMap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "CME212/Point.hpp"

namespace {

/** A generation that counts how often one of its kind is read or changed. */
struct CountedGeneration {
  static inline std::size_t uses = 0;
  std::uint8_t number = 0;
  operator int() const { return ++uses, number; }
  CountedGeneration& operator++() { return ++uses, ++number, *this; }
};

}  // namespace

template <>
struct std::numeric_limits<CountedGeneration>
    : std::numeric_limits<std::uint8_t> {};

namespace {

// -------------------------------------------------------------------- SlotMap

/** Uses of generations in a clear() of @a left things, when @a many have been
 * there at once, and slots wore out or not. */
std::size_t cost_of_clear(unsigned many, unsigned left, bool worn_out) {
  graph_detail::SlotMap<CountedGeneration> slots;
  const auto add = [&] { return slots.reserve_one(), slots.acquire(); };
  for (unsigned i = 0; i < many; ++i) add();
  for (unsigned life = 0, id = 0; life < (worn_out ? 200 : 1); ++life)
    slots.make_lists(), slots.release(id), id = add();
  slots.make_lists();
  while (slots.size() > left) slots.release(slots.id_at(slots.size() - 1));
  slots.check_invariants();
  CountedGeneration::uses = 0;
  slots.clear();
  const std::size_t uses = CountedGeneration::uses;
  slots.check_invariants();
  EXPECT_EQ(slots.size(), 0u);
  EXPECT_EQ(slots.slots() == 0, !worn_out);
  return uses;
}

TEST(SlotMap, ClearCostsWhatIsThereNow) {
  for (bool worn_out : {false, true}) {
    EXPECT_EQ(cost_of_clear(1000, 0, worn_out), 0u);
    EXPECT_EQ(cost_of_clear(100, 10, worn_out),
              cost_of_clear(10000, 10, worn_out));
    EXPECT_LE(cost_of_clear(10000, 10, worn_out), 3 * 10u);
  }
}

// --------------------------------------------------------------- GrowingArray

TEST(GrowingArray, HoldsWhatAVectorHolds) {
  graph_detail::GrowingArray<Point> a;
  std::vector<Point> v;
  auto expect_equal = [&v](const auto& array) {
    ASSERT_EQ(array.size(), v.size());
    EXPECT_TRUE(std::equal(v.begin(), v.end(), array.begin(), array.end()));
  };
  for (std::size_t size : {1, 2, 3, 10, 7, 7, 5000, 30, 100000, 0, 4}) {
    a.resize(size);
    v.resize(size);
    expect_equal(a);
    for (std::size_t i = 0; i < size; ++i) a[i] = v[i] = Point(double(i));
    expect_equal(a);
    expect_equal(graph_detail::GrowingArray<Point>(a));
  }
  a.clear();
  v.clear();
  expect_equal(a);
}

TEST(GrowingArray, GrowsSeldomAndSparesAnEighth) {
  graph_detail::GrowingArray<Point> a;
  const std::size_t many = 1000000;
  int times = 0;
  for (std::size_t size = 1; size <= many; ++size) {
    std::size_t before = a.capacity();
    a.resize(size);
    times += a.capacity() != before;
    std::size_t spare = a.capacity() - size;
    ASSERT_LE(spare * sizeof(Point),
              std::max<std::size_t>(65536, size * sizeof(Point) / 8));
  }
  EXPECT_LE(times, 66);  // log2 of 64 kB, then log1.125 of the rest
  EXPECT_EQ(graph_detail::GrowingArray<Point>(a).capacity(), many);
}

// ------------------------------------------------------------------- ListPool

TEST(ListPool, GivesBlocksOfEachSizeBack) {
  graph_detail::ListPool<int> pool;
  std::vector<graph_detail::ListPool<int>::List> lists(20);
  auto fill = [&] {
    for (int k = 0; k < 50; ++k)
      for (auto& l : lists) {
        pool.reserve_one(l);
        pool.push_back(l, k);
      }
  };
  fill();
  for (auto& l : lists)
    for (int k = 0; k < 50; ++k) ASSERT_EQ(pool.items(l)[k], k);
  std::size_t grown = pool.pool_size();
  for (int round = 0; round < 10; ++round) {
    for (auto& l : lists) pool.free(l);
    EXPECT_TRUE(pool.is_filled_by({}));
    fill();
  }
  EXPECT_EQ(pool.pool_size(), grown);
}

// 16 lists of 8 items make up a pool of 128, of which 96 are three quarters: 97
// are too many, 89 are not.
TEST(ListPool, CompactsWhatNeedsLessThanThreeQuarters) {
  using Pool = graph_detail::ListPool<int>;
  for (const unsigned kept : {13u, 12u}) {
    Pool pool;
    std::vector<Pool::List> lists(16);
    pool.reserve(16, 128);
    for (unsigned i = 0; i < 16; ++i)
      for (int k = 0; k < 8; ++k) {
        pool.reserve_one(lists[i]);
        pool.push_back(lists[i], int(10 * i) + k);
      }
    ASSERT_EQ(pool.pool_size(), 128u);
    for (unsigned i = kept; i < 16; ++i) pool.free(lists[i]);
    while (lists[1].size > 1) pool.erase(lists[1], 1);
    while (lists[2].size > 5) pool.erase(lists[2], lists[2].size - 1);
    pool.compact(lists);
    // A block of 1 is enough for list 1, but not one of 4 for list 2.
    EXPECT_EQ(pool.pool_size(), kept == 13 ? 128u : 89u);
    EXPECT_EQ(lists[1].capacity, kept == 13 ? 8u : 1u);
    EXPECT_TRUE(pool.is_filled_by(lists));
    for (unsigned i = 0; i < kept; ++i) {
      ASSERT_EQ(lists[i].size, i == 1 ? 1u : i == 2 ? 5u : 8u);
      for (unsigned k = 0; k < lists[i].size; ++k)
        EXPECT_EQ(pool.items(lists[i])[k], int(10 * i + k));
    }
    for (int k = 0; k < 4; ++k) {  // what is full moves to a longer block
      pool.reserve_one(lists[0]);
      pool.push_back(lists[0], 8 + k);
    }
    for (unsigned k = 0; k < 12; ++k)
      EXPECT_EQ(pool.items(lists[0])[k], int(k));
    EXPECT_TRUE(pool.is_filled_by(lists));
  }
}

TEST(ListPool, BeginsWithABlockForTheAverageThatWasReserved) {
  for (auto [items, capacity] :
       {std::pair(0, 4), {40, 4}, {41, 8}, {80, 8}, {81, 16}, {10000, 64}}) {
    graph_detail::ListPool<int> pool;
    pool.reserve(10, std::size_t(items));
    graph_detail::ListPool<int>::List l;
    pool.reserve_one(l);
    EXPECT_EQ(l.capacity, unsigned(capacity)) << items;
  }
}

}  // namespace
