// SlotMap.hpp: the arrays and lists that a graph is stored in. Slots are tested
// by the histories of test_graph.
#include "CME212/SlotMap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "CME212/Point.hpp"

namespace {

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

TEST(GrowingArray, GrowsSeldomAndSparesAQuarter) {
  graph_detail::GrowingArray<Point> a;
  const std::size_t many = 1000000;
  int times = 0;
  for (std::size_t size = 1; size <= many; ++size) {
    std::size_t before = a.capacity();
    a.resize(size);
    times += a.capacity() != before;
    std::size_t spare = a.capacity() - size;
    ASSERT_LE(spare * sizeof(Point),
              std::max<std::size_t>(65536, size * sizeof(Point) / 4));
  }
  EXPECT_LE(times, 40);  // log2 of 64 kB, then log1.25 of the rest
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
