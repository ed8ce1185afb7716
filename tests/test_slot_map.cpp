/** @file test_slot_map.cpp
 * SlotMap: long random histories against a plain model. */
#include "CME212/SlotMap.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace {

// RapidCheck reads this once, before its first check.
[[maybe_unused]] const int same_in_every_run =
    setenv("RC_PARAMS", "seed=212 max_success=1000 max_size=1000", 0);

/** What to do, and with which element. */
using Command = std::pair<unsigned, unsigned>;

/** A SlotMap, and what it ought to be. */
class CheckedSlots {
  using Slots = graph_detail::SlotMap;
  using Handle = std::pair<unsigned, Slots::Generation>;

 public:
  void apply(const Command& c) {
    const auto [what, which] = c;
    if (what < 45 || (at.empty() && what < 90)) {
      const auto expected = slots.next_id();
      const auto id = slots.acquire();
      RC_ASSERT(id == expected);
      RC_ASSERT(slots.index_of(id) == at.size());
      if (!released.empty()) {
        RC_ASSERT(id == released.back());  // the last released comes first
        released.pop_back();
      }
      at.push_back({id, slots.generation(id)});
      RC_ASSERT(ever.insert(at.back()).second);  // no handle is given twice
    } else if (what < 97 && !at.empty()) {
      auto& hole = at[which % at.size()];
      slots.make_lists();
      slots.release(hole.first);
      RC_ASSERT(!slots.alive(hole.first, hole.second));
      released.push_back(hole.first);
      hole = at.back();
      at.pop_back();
    } else if (what < 98) {
      slots.clear();
      at.clear(), released.clear();
      RC_ASSERT(slots.slots() == 0u && slots.next_id() == 0u);
    } else {
      std::shuffle(at.begin(), at.end(), std::mt19937(which));
      std::vector<unsigned> ids;
      for (auto [id, generation] : at) ids.push_back(id);
      slots.reindex(ids);
    }
  }
  void check() const {
    slots.check_invariants();
    RC_ASSERT(slots.size() == at.size());
    RC_ASSERT(slots.slots() == at.size() + released.size());
    for (unsigned i = 0; i < at.size(); ++i) {
      auto [id, generation] = at[i];
      RC_ASSERT(slots.alive(id, generation) && slots.in_use(id));
      RC_ASSERT(slots.id_at(i) == id && slots.index_of(id) == i);
    }
    std::size_t alive = 0;
    for (auto [id, generation] : ever) alive += slots.alive(id, generation);
    RC_ASSERT(alive == at.size());  // and all others ever given are dead
  }

 private:
  Slots slots;
  std::vector<Handle> at;          // by index
  std::vector<unsigned> released;  // free slots
  std::set<Handle> ever;
};

TEST(SlotMap, DoesWhatTheModelDoes) {
  EXPECT_TRUE(rc::check([] {
    const auto number = rc::gen::inRange(0u, 100u);
    const auto history = *rc::gen::container<std::vector<Command>>(
        rc::gen::pair(number, number));
    CheckedSlots slots;
    for (const Command& c : history) {
      slots.apply(c);
      slots.check();
    }
  }));
}

}  // namespace
