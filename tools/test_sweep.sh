#!/usr/bin/env bash
# Test that a sweep of stability_map that was interrupted goes on to the bytes
# of one that was not; and that bad input is refused.
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=tools/cases.sh
. tools/cases.sh
build=${BUILD:-build}
make -s stability_map B="$build"
stability_map() { "$build/stability_map" "$@"; }
maps=$(stability_map --map none 2>&1 | sed -n 's/.*there are: //p' || true)

join() {  # all maps of the cells in DIR
  # shellcheck disable=SC2086  # a list of words
  BUILD=$build lab/charts/stability.sh tiny "$1" $maps
}
cells() {  # JOBS DIR, which has the list of cells
  make --no-print-directory "-j$1" cells B="$build" EFFORT=tiny SWEEP="$2"
}

mkdir "$tmp/whole" "$tmp/half"
stability_map --tiny --list | tee "$tmp/whole/list" >"$tmp/half/list"
mapfile -t all < <(cut -d' ' -f1 "$tmp/whole/list")
attempt cells 1 "$tmp/whole"; says "${#all[@]}/${#all[@]} cells"
attempt join "$tmp/whole"; expect 0
for map in $maps; do says "# map $map: "; done
ok "one job"
whole=$out

# Half of the cells are there, and a part of a file.
half=("${all[@]:0:${#all[@]}/2}") last=${all[-1]}
for cell in "${half[@]}"; do cp "$tmp/whole/$cell.csv" "$tmp/half"; done
echo "method" >"$tmp/half/$last.csv.1-1.part"
touch "$tmp/interrupted"
cells 2 "$tmp/half" >"$tmp/said"
attempt join "$tmp/half"; same "what is joined" "$out" "$whole"
same "cells run anew" \
  "$(find "$tmp/half" -name '*.csv' -newer "$tmp/interrupted" | wc -l)" \
  $((${#all[@]} - ${#half[@]}))
ok "interrupted, and continued by two jobs"

attempt stability_map --cell limits-6-plain; expect 2
says "there is no 'limits-6-plain'; --list prints all"; ok "no such cell"
echo 'method,growth' >"$tmp/half/$last.csv"
attempt join "$tmp/half"; expect 2
says "$last.csv:1: is no whole cell, expected '"; ok "a bad cell"
all_passed
