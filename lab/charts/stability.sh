#!/usr/bin/env bash
# The end of make stability: join the cells of a sweep to maps and draw them.
#   stability.sh EFFORT DIR          full: to results/, else to build/charts
#   stability.sh EFFORT DIR MAP...   to the standard output
# DIR/list is what stability_map --list printed when the sweep began. BUILD:
# where the program is.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${BUILD:-build}

effort=$1 dir=$2
to=$build/charts options=("--$effort")
[ "$effort" != full ] || to=lab/charts/results options=()

# The head of MAP and the rows of its cells, in the order of the list.
join() {  # MAP
  local head columns cell file
  head=$("$build/stability_map" --map "$1")
  columns=${head##*$'\n'}
  echo "$head"
  "$build/stability_map" --list ${options[@]+"${options[@]}"} |
    while read -r cell _; do
      [ "${cell%%-*}" = "$1" ] || continue
      file=$dir/$cell.csv
      [ "$(head -n 1 "$file")" = "$columns" ] || {
        echo "$file:1: is no whole cell, expected '$columns'; --cell $cell" \
          "makes it" >&2
        exit 2
      }
      tail -n +2 "$file"
    done
}
if [ $# -gt 2 ]; then
  for map in "${@:3}"; do join "$map"; done
  exit
fi
mkdir -p "$to"
maps=(limits growth)
for map in "${maps[@]}"; do
  join "$map" >"$to/stability_$map.csv.part"
  mv "$to/stability_$map.csv.part" "$to/stability_$map.csv"
done
python3 lab/charts/draw.py "${maps[@]/#/stability_}" --folder "$to"
