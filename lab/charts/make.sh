#!/usr/bin/env bash
# Measure and draw the charts: make charts. All of them go to results/; a quick
# run, or one of some scenes or methods only, to build/charts. BUILD: where the
# programs are; MEASURED: machine, compiler and commit.
set -euo pipefail
cd "$(dirname "$0")/../.."

build=${BUILD:-build}
QUICK=${QUICK:-} SCENE=${SCENE:-} METHODS=${METHODS:-}
options=()
[ -z "$QUICK" ] || options+=(--quick)
[ -z "$METHODS" ] || options+=(--methods "$METHODS")
to=lab/charts/results
[ -z "$QUICK$SCENE$METHODS" ] || to=$build/charts
mkdir -p "$to"

draw() { python3 lab/charts/draw.py "$@" --folder "$to"; }

measure() {  # NAME OPTION...
  "$build/work_precision" ${options[@]+"${options[@]}"} "${@:2}" --out "$to/$1.csv"
  sed -i "1i # ${MEASURED:-}" "$to/$1.csv"
}
measure work_precision ${SCENE:+--scenes "$SCENE"}
draw work_precision decision
[ -z "$SCENE$METHODS" ] || exit 0
measure grid_refinement --grid-refinement
draw grid_refinement
