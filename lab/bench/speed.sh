#!/usr/bin/env bash
# make speed: what a step costs on this machine. Writes
# lab/bench/results/MACHINE/: the table bench.txt, the same as JSON, lines of
# this commit in history.csv.
#   lab/bench/speed.sh [BENCH]
# On a machine that does nothing else: each figure is a ratio to a loop over
# flat arrays measured at the same time, but memory is shared.
set -euo pipefail
cd "$(dirname "$0")/../.."

# The processor's name, its family (6 is most of Intel's: the model, too) and
# its longest vectors.
machine=$(awk -F': ' '/^model name/ {n = $2; gsub(/\((R|TM)\)/, "", n)} /^cpu family/ {f = "-" $2}
  /^model\t/ {m = $2} /^flags/ && f == "-6" {f = f "-" m}
  /^flags/ {v = / avx512f / ? "-avx512" : / avx2 / ? "-avx2" : ""}
  /^$/ {print n f v; exit}' /proc/cpuinfo | tr 'A-Z ' 'a-z-' | tr -cd 'a-z0-9-')
folder=lab/bench/results/${machine:-unknown}
mkdir -p "$folder"
lab/bench/table.py "${1:-build/native/bench}" --json "$folder/bench.json" |
  tee "$folder/bench.txt"

# A commit that was measured before gets its lines anew.
history=$folder/history.csv
[ -e "$history" ] || echo 'date,commit,nodes,step,ratio' >"$history"
commit=${MEASURED:-unknown} commit=${commit##*commit }
sed -i "/^[^,]*,$commit,/d" "$history"
sed -n 's/.*"group": "\(10*\) nodes[^"]*", "name": "step: \(SymplecticEuler\|SymplecticEuler, mixed\|Verlet\)",.*"ratio": \([0-9.e-]*\).*/\1,\2,\3/p' \
  "$folder/bench.json" | sed 's/, mixed/ mixed/' | while read -r row; do
  echo "$(date +%F),$commit,$row"
done >>"$history"
