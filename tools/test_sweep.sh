#!/usr/bin/env bash
# Test that a sweep of stability_map gives the same bytes by one job, by two,
# and when it is interrupted and continued; and that bad input is refused.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${BUILD:-build}
stability_map=$build/stability_map
make -s stability_map B="$build"

tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
passed=0 failed=0 why=""
ok() {  # ends a case
  if [ -z "$why" ]; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1)) && echo "FAIL $1:$why"
  fi
  why=""
}
maps=$("$stability_map" --map none 2>&1 | sed -n 's/.*there are: //p' || true)
join() {  # all maps of the cells in DIR, as DIR.joined
  # shellcheck disable=SC2086  # a list of words
  BUILD=$build lab/charts/stability.sh tiny "$1" $maps >"$1.joined"
}
cells() {  # by make: DIR OPTION...
  mkdir -p "$1"
  "$stability_map" --tiny --list >"$1/list"
  make --no-print-directory "${@:2}" cells B="$build" EFFORT=tiny \
    SWEEP="$1" >"$1.log"
}
same() {  # the joined maps of DIR are those of one job
  join "$1" && cmp "$tmp/one.joined" "$1.joined" || why+=" $1 has other bytes;"
}

cells "$tmp/one" -j1
total=$(wc -l <"$tmp/one/list")
join "$tmp/one" || why+=" can't be joined;"
grep -q "^$total/$total cells\$" "$tmp/one.log" || why+=" no progress is shown;"
for map in $maps; do
  grep -q "^# map $map: " "$tmp/one.joined" || why+=" no map $map;"
done
ok "one job"

cells "$tmp/two" -j2
same "$tmp/two"
ok "two jobs"

# Interrupted: some cells are there, one is half a file that was not committed.
mkdir "$tmp/half"
head -n $((total / 2)) "$tmp/one/list" | cut -d' ' -f1 | while read -r cell; do
  cp "$tmp/one/$cell.csv" "$tmp/half"
done
last=$(tail -n 1 "$tmp/one/list" | cut -d' ' -f1)
echo "method" >"$tmp/half/$last.csv.1-1.part"
touch "$tmp/interrupted"
cells "$tmp/half" -j2
same "$tmp/half"
anew=$(find "$tmp/half" -name '*.csv' -newer "$tmp/interrupted" | wc -l)
[ "$anew" = $((total - total / 2)) ] || why+=" $anew cells were run anew;"
ok "interrupted and continued"

refuses() {  # MESSAGE ARGUMENT...
  local status=0
  "$stability_map" "${@:2}" >"$tmp/said" 2>&1 || status=$?
  [ "$status" = 2 ] || why+=" '${*:2}' ends with $status;"
  grep -qF -- "$1" "$tmp/said" ||
    why+=" '${*:2}' does not say '$1' but '$(cat "$tmp/said")';"
}
refuses "--cell: there is no 'limits-6-plain-verlet'; --list prints all" \
  --cell limits-6-plain-verlet
refuses "can't be written (a directory)" --tiny --cell "$last" --out "$tmp"
refuses "--quick excludes --tiny" --list --quick --tiny
refuses "--map" --list --map growth
refuses "--list"  # none of the three
ok "bad options"

for bad in 'method,growth' ''; do  # no whole cell; none
  echo "$bad" >"$tmp/two/$last.csv"
  [ -n "$bad" ] || rm "$tmp/two/$last.csv"
  if join "$tmp/two" 2>"$tmp/said"; then why+=" a bad cell is joined;"; fi
  grep -q "$last.csv:1: is no whole cell, expected '" "$tmp/said" ||
    why+=" says $(cat "$tmp/said");"
done
ok "a bad cell"

echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
