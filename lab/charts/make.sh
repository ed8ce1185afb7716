#!/usr/bin/env bash
# Measure and draw the charts: make charts. All of them go to results/; a quick
# run, or one of some scenes or methods only, to build/charts. BUILD: where the
# programs are.
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

csv=$to/work_precision.csv
"$build/work_precision" ${options[@]+"${options[@]}"} --out "$csv" \
  ${SCENE:+--scenes "$SCENE"}
draw work_precision decision
[ -z "$SCENE" ] || exit 0
[ -z "$METHODS" ] || exit 0
"$build/work_precision" ${options[@]+"${options[@]}"} --grid-refinement \
  --out "$to/grid_refinement.csv"
draw grid_refinement
