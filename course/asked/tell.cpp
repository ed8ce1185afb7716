/** @file tell.cpp
 * The content of a graph, as answers. Compiled once, without a submission. */
#include "../tests/model.hpp"

namespace kit {
namespace {

using Numbers = std::vector<long long>;

/** A number that stands for these, whatever their order. */
double digest(Numbers all) {
  std::sort(all.begin(), all.end());
  std::uint64_t hash = all.size();
  for (long long x : all) {
    hash = (hash ^ std::uint64_t(x)) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 29;
  }
  return double(hash >> 20);
}
long long number(const Seen& e, bool values) {
  const long long ends = (e.ends.a + 1) * 10000ll + e.ends.b;
  return values ? ends * 1000000 + std::llround(2 * e.value.value_or(0)) : ends;
}
Numbers numbers(const std::vector<Seen>& seen, bool values) {
  Numbers all;
  for (const Seen& e : seen) all.push_back(number(e, values));
  return all;
}

}  // namespace

void tell(View& g, unsigned works) {
  const std::size_t limit = 1000;
  const auto size = std::min(std::size_t(g.num_nodes()), limit);
  const auto edges = std::min(std::size_t(g.num_edges()), limit);
  Numbers indices, values, ends, edge_values_seen, at, at_values, counts, pairs;
  for (std::size_t i = 0; i < size; ++i) {
    const long long v = node_named(g.position(i));
    indices.push_back(2 * v + (g.index(i) == View::Number(i)));
    if (works & node_values)
      values.push_back(v * 10000 + std::llround(g.node_value(i).value_or(0)));
    if (works & degrees) counts.push_back(v * 10000 + g.degree(i).value_or(0));
    if (works & adjacency)
      for (std::size_t j = 0; j < size; ++j)
        if (i != j && g.has_edge(i, j))
          pairs.push_back(v * 10000 + node_named(g.position(j)));
    std::vector<Seen> seen;
    if (works & incident_loop) g.edges_at(i, limit, seen);
    for (long long x : numbers(seen, false)) at.push_back(2 * x);
    if (works & seen_from)
      for (const Seen& e : seen) at.push_back(2 * (v * 10000 + e.first) + 1);
    if (works & incident_values)
      for (long long x : numbers(seen, true)) at_values.push_back(x);
  }
  if (works & (edge_indices | edge_values))
    for (std::size_t i = 0; i < edges; ++i)
      if (const auto e = g.edge(i)) {
        ends.push_back(number(*e, false));
        edge_values_seen.push_back(number(*e, true));
      }
  auto tell_if = [works](unsigned aspects, const char* what,
                         const Numbers& all) {
    if ((works & aspects) == aspects) answer(what, digest(all));
  };
  tell_if(by_index, "nodes by index?", indices);
  tell_if(node_values, "nodes with values?", values);
  if (works & node_loop) {
    std::vector<int> seen;
    g.nodes(limit, seen);
    answer("nodes in a loop?", digest(Numbers(seen.begin(), seen.end())));
  }
  if (works & edge_count) answer("edges in number?", double(g.num_edges()));
  tell_if(edge_indices, "edges by index?", ends);
  tell_if(edge_values, "edges with values?", edge_values_seen);
  if (works & edge_loop && g.num_edges() != 0) {
    std::vector<Seen> seen;
    g.edges(limit, seen);
    answer("edges in a loop?", digest(numbers(seen, false)));
  }
  tell_if(incident_loop | seen_from, "edges at nodes?", at);
  tell_if(incident_values, "edges with values at nodes?", at_values);
  tell_if(degrees, "edges counted at nodes?", counts);
  tell_if(adjacency, "edges by has_edge?", pairs);
}

}  // namespace kit
