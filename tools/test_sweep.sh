#!/usr/bin/env bash
# Test that a sweep of stability_map that was interrupted goes on to the bytes
# of one that was not; and that bad input is refused.
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=tools/cases.sh
. tools/cases.sh
build=${BUILD:-build}
make -s stability_map B="$build"
sweep() { "$build/stability_map" "$tmp/$1" --effort tiny; }

attempt sweep whole; expect 0
cells=$(find "$tmp/whole" -name '*-*.csv' | wc -l)
same rows "$(cat "$tmp"/whole/stability_*.csv | grep -vc '^#')" $((2 + 6 + 24))
ok "all cells"

# Half of the cells are there, and a part of a file.
mkdir "$tmp/half"
find "$tmp/whole" -name '*-*.csv' | head -n $((cells / 2)) |
  xargs cp -t "$tmp/half"
echo method >"$tmp/half/limits-5-plain-rk4.csv.1-1.part"
touch "$tmp/interrupted"
attempt sweep half; expect 0
for map in limits growth; do
  same "map $map" "$(cat "$tmp/half/stability_$map.csv")" \
    "$(cat "$tmp/whole/stability_$map.csv")"
done
same "cells run anew" \
  "$(find "$tmp/half" -name '*-*.csv' -newer "$tmp/interrupted" | wc -l)" \
  $((cells - cells / 2))
ok "interrupted, and continued"

echo mine >"$tmp/file"
attempt sweep file; expect 2; says "stability_map: "; ok "no folder"
attempt "$build/stability_map" "$tmp/new" --effort huge; expect 2
says "--effort: "; ok "no such effort"
all_passed
