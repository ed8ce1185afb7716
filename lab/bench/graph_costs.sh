#!/usr/bin/env bash
# The costs of a Graph beside that of another COMMIT, by default the last one
# before the Graph became plain: the table of docs/graph.md. Both are measured
# in turn, RUNS times; the ratio is that of the least values, and behind it are
# the least and the largest ratio of a turn.
#   lab/bench/graph_costs.sh [COMMIT]
set -euo pipefail
cd "$(dirname "$0")/../.."

tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
git archive "${1:-cf44e04^}" Graph.hpp mass_spring.hpp CME212 | tar x -C "$tmp"
for version in "$tmp" .; do
  ${CXX:-g++} -std=c++20 -O3 -DNDEBUG -fno-math-errno -w -I"$version" \
    lab/bench/bench_graph.cpp -o "$tmp/in_$([ "$version" = . ] && echo new || echo old)"
done
for side in 100 1000; do
  for ((run = 0; run < ${RUNS:-5}; ++run)); do
    for version in old new; do
      "$tmp/in_$version" "$side" | sed "s/^/$side|$version|/"
    done
  done
done >"$tmp/all"
echo '| | 10^4 nodes | 10^6 nodes |'
echo '|---|---|---|'
awk -F'|' '
  { key = $1 "|" $3; turn = ++n[key, $2]; v[key, $2, turn] = $4
    if (!(key in all)) all[key]
    if (!named[$3]++) order[++names] = $3 }
  function cell(key,   t, r, old, new, low, high) {
    for (t = 1; t <= n[key, "new"]; ++t) {
      r = v[key, "new", t] / v[key, "old", t]
      if (t == 1 || r < low) low = r
      if (t == 1 || r > high) high = r
      if (t == 1 || v[key, "old", t] < old) old = v[key, "old", t]
      if (t == 1 || v[key, "new", t] < new) new = v[key, "new", t]
    }
    return sprintf("%.2f (%.2f to %.2f)", new / old, low, high)
  }
  END { for (k = 1; k <= names; ++k)
          printf "| %s | %s | %s |\n", order[k], cell("100|" order[k]),
                 cell("1000|" order[k]) }' "$tmp/all"
