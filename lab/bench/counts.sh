#!/usr/bin/env bash
# How many instructions a figure of bench takes for a node, of 10,000: a table
# of Markdown. Counted by callgrind, which must be installed (apt-get install
# valgrind), and does not know AVX-512.
#   make bench && lab/bench/counts.sh
set -euo pipefail
cd "$(dirname "$0")/../.."

counted() {  # CALLS FIGURE KERNELS
  valgrind --tool=callgrind --callgrind-out-file=/dev/null \
    "${BUILD:-build}/bench" --calls "$@" 2>&1 |
    sed -n 's/.*Collected : //p'
}
row() {  # NAME FIGURE KERNELS: 10 calls after the first one
  local steps=1  # a call of a method takes as many as a scene at once
  case $2 in 'step: SymplecticEuler'* | 'step: Rk4') steps=32 ;; esac
  echo "$1 $(counted 1 "${@:2}") $(counted 11 "${@:2}")" |
    awk -v steps=$steps '{n = ($NF - $(NF - 1)) / 1e5 / steps; NF -= 2
                          printf "| %s | %.1f |\n", $0, n}'
}

echo '| 10,000 nodes with diagonals | instructions a node |'
echo '|---|---|'
for figure in 'step: flat arrays' 'step: symp_euler_step(), functor' \
  'step: symp_euler_step(), forces' 'springs: flat arrays' \
  'springs: Node and Edge' 'springs: virtual call a node' \
  'springs: adjacency alone' 'springs: edge values alone'; do
  row "$figure" "$figure" 0
done
for figure in 'step: SymplecticEuler' 'step: SymplecticEuler, mixed' \
  'step: Rk4' 'springs: sweep' 'part: drift' 'part: read and write'; do
  row "$figure, plain" "$figure" 0
  row "$figure, AVX2" "$figure" 1
done
