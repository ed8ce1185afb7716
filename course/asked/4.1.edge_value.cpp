/** @file 4.1.edge_value.cpp
 * Values at random, set and read by each kind of handle. */
#include "asked.hpp"

namespace kit {
template <typename S>
static void ask_for_values(Handle set, const std::vector<double>& values) {
  S s(wheel(6));
  if (!usable(s, set)) return;
  using Edge = decltype(handle(s, Ends(0, 1), set));
  if constexpr (HasValue<Edge> && requires(Edge e) { e.value() = 1.5; }) {
    for (std::size_t k = 0; k < s.m.edges.size(); ++k)
      handle(s, s.m.edges[k], set).value() = values[k];
    for (Handle get : {added, added_again, first_end, second_end, indexed})
      if (usable(s, get))
        for (Ends e : s.m.edges)
          answer(
              words("values set by ", name(set), ", read by ", name(get), "?"),
              static_cast<double>(handle(s, e, get).value()));
  }
}
}  // namespace kit

ASKED("4.1.edge_value", edge_value_asked) {
  for (Handle h : {added, added_again, first_end, second_end, indexed}) {
    std::vector<double> values;
    for (int k = 0; k < 10; ++k) values.push_back(drawn(-1, 1));
    ask_for_values<TestSubject>(h, values);
  }
}
