#!/usr/bin/env bash
# The end of make stability: join the cells of a sweep to maps and draw them.
#   stability.sh EFFORT DIR          full: to results/, else to build/charts
#   stability.sh EFFORT DIR MAP...   to the standard output
#   stability.sh progress DIR        how far the sweep in DIR is
# DIR/list is what stability_map --list printed when the sweep began. BUILD:
# where the program is.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${BUILD:-build}

# Cells that are there, and the time left: that so far, as cost is to cost.
progress() {  # DIR
  local bar=0 elapsed
  [ ! -t 1 ] || bar=1
  elapsed=$(($(date +%s) - $(stat -c %Y "$1/list")))
  {
    find "$1" -name '*.csv' -newer "$build/stability_map" -printf 'there %f\n'
    find "$1" -name '*.csv' -newer "$1/list" -printf 'new %f\n'
    sed 's/^/cell /' "$1/list"
  } | awk -v bar="$bar" -v elapsed="$elapsed" '
    $1 == "there" {there[$2] = 1}
    $1 == "new" {new[$2] = 1}
    $1 == "cell" {
      ++cells
      file = $2 ".csv"
      if (file in new) run += $3
      if (file in there) ++done; else left += $3
    }
    END {
      text = sprintf("%d/%d cells", done, cells)
      if (run > 0 && left > 0)
        text = text sprintf(", %d s left", elapsed * left / run + 1)
      share = int(30 * done / cells)
      filled = sprintf("%30s", "")
      for (k = 0; k < share; ++k) filled = "#" substr(filled, 1, 29)
      if (bar) printf "\r[%s] %s      %s", filled, text, left ? "" : "\n"
      else if (done % int(cells / 10 + 1) == 0 || !left) print text
    }'
}

if [ "$1" = progress ]; then
  progress "$2"
  exit
fi

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
