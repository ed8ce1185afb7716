#!/usr/bin/env bash
# Everything that a commit must pass; `make check` calls it. Each step writes
# build/check/STEP.log; the last line counts the tests.
set -uo pipefail
cd "$(dirname "$0")/.."

jobs=${JOBS:-$(nproc)}
logs=build/check
rm -rf "$logs"
mkdir -p "$logs"
export ASAN_OPTIONS=detect_leaks=1 UBSAN_OPTIONS=print_stacktrace=1
# Line numbers are all that a failing test needs; -g takes a third of the time.
export CXXFLAGS='-Werror -g1'
started=$SECONDS passed=0 failed=0

# Run a step and count what it says it passed; a step that counts nothing is
# one test.
step() {  # NAME COMMAND...
  local name=$1 log=$logs/$1.log from=$SECONDS ok good bad
  shift
  "$@" >"$log" 2>&1 </dev/null && ok=1 || ok=0
  good=$(sed -nE 's/^\[  PASSED  \] ([0-9]+) tests?.*/\1/p; s/^([0-9]+) passed, .*/\1/p' "$log" |
    tail -n 1)
  bad=$(sed -nE 's/^\[  FAILED  \] ([0-9]+) tests?, .*/\1/p; s/.* passed, ([0-9]+) failed.*/\1/p' "$log" |
    tail -n 1)
  if [ "$ok" = 1 ]; then
    good=${good:-1} bad=0
    printf 'ok    %-22s %4d tests %4d s\n' "$name" "$good" $((SECONDS - from))
    sed -n 's/^skipped: /      skipped: /p' "$log"
  else
    good=${good:-0} bad=${bad:-0}
    [ "$bad" != 0 ] || bad=1
    printf 'FAIL  %-22s %4d failed; %s ends:\n' "$name" "$bad" "$log"
    tail -n 40 "$log" | sed 's/^/      /'
  fi
  passed=$((passed + good)) failed=$((failed + bad))
}

# Run lists of steps beside each other; then show and count what each of them
# did.
beside() {  # LIST...
  local list good bad
  for list in "$@"; do
    (
      passed=0 failed=0
      "$list"
      echo "$passed $failed" >"$logs/$list.count"
    ) >"$logs/$list.txt" &
  done
  wait
  for list in "$@"; do
    good=0 bad=1
    cat "$logs/$list.txt"
    read -r good bad <"$logs/$list.count"
    passed=$((passed + good)) failed=$((failed + bad))
  done
}

make_all() { make --no-print-directory -j"$jobs" "$@"; }

# The committed grids are what make_grid makes.
same_grids() {
  mkdir -p build/grids && make -s grids TO=build/grids || return 1
  local file
  for file in data/grid*.nodes data/grid*.tets; do
    [ "${file%.*}" = data/grid4 ] || cmp "$file" "build/grids/${file##*/}" || return 1
  done
}

# What stands beside other libraries compiles, where these are installed.
peers() {
  local program out eigen
  eigen=$(pkg-config --cflags eigen3 | sed 's/-I/-isystem/g')
  for program in peers/*.cpp; do
    # shellcheck disable=SC2086  # a list of words
    if out=$(g++ -std=c++20 -Wall -Wextra -Werror -fopenmp -fsyntax-only -I. \
      -isystem /usr/include/bullet $eigen "$program" 2>&1); then
      echo "ok $program"
    else
      out=$(grep -m 1 'is missing: make peers-deps' <<<"$out" || echo "$out")
      case $out in
        *' missing: make peers-deps'*) echo "skipped: $program ${out##*error }" ;;
        *) echo "$out"; return 1 ;;
      esac
    fi
  done
}

# Threads: Mesa's own are not ours to check.
threads() {
  TSAN_OPTIONS="suppressions=tools/tsan.supp halt_on_error=1" \
    build/tsan/test_viewer --gtest_filter='*Thread*:*Simulation*' &&
    OMP_NUM_THREADS=3 \
      TSAN_OPTIONS="ignore_noninstrumented_modules=1 halt_on_error=1" \
      build/tsan/test_sweep --gtest_filter='*hread*:*Parts*:*OnTheWay*:*MovesWhat*'
}

# Single precision: the sweeps, a run, and how far it ends from double.
single() {
  make_all build/float/test_sweep build/float/mass_spring \
    build/float/work_precision REAL=float VIEWER=0 O=build/float/ &&
    build/float/test_sweep &&
    build/float/mass_spring data/grid1.nodes data/grid1.tets --headless \
      --dt auto &&
    build/float/work_precision --ends --scenes chain --out build/ends.txt &&
    ./work_precision --floor build/ends.txt --out build/float_floor.csv &&
    awk -F, '$1 == "chain" {++n; if ($5 < 1e-8 || $5 > 1e-4) bad = 1}
      END {exit n != 6 || bad}' build/float_floor.csv
}

# Programs that no step runs for long.
quickly="bench% adviser_suite mass_spring_diagonals mass_spring_forces
  mass_spring_constraints mass_spring_tear"
# What counts of clang++ is what it says: no time for optimizing.
clang() {
  make_all all CXX=clang++ O=build/clang/ SANITIZE= CXXFLAGS="-Werror -O0 -g0"
}

of_scripts() {
  step checks      tools/test_checks.sh
  step submit      tools/test_submit.sh
  step deps        tools/test_deps.sh
}
of_variants() {
  step peers       peers
  step build-plain make_all mass_spring VIEWER=0 CHOLMOD=0 O=build/plain/ \
    QUICKLY=mass_spring
  # clang++, whose OpenMP tells ThreadSanitizer what waits for what.
  step build-tsan  make_all build/tsan/test_viewer build/tsan/test_sweep \
    CXX=clang++ O=build/tsan/ SANITIZE=thread
  step threads     threads
  step single      single
}
of_tests() {  # TEST...
  local test
  for test; do
    case $test in
      test_viewer | test_screen) step "$test" env ASAN_OPTIONS=detect_leaks=0 "./$test" ;;
      *) step "$test" "./$test" ;;
    esac
  done
}
# Tests use one core, so one half of them runs beside the other.
tests=$(make -s print-tests)
# shellcheck disable=SC2046  # lists of words
odd_tests() { of_tests $(sed -n 'p;n' <<<"${tests// /$'\n'}"); }
# shellcheck disable=SC2046
even_tests() { of_tests $(sed -n 'n;p' <<<"${tests// /$'\n'}"); }
# A sample of the suite of docs/advice.md; other scenes than the tables.
advice() {
  ./adviser_suite --scenes 24 --first 501 --want-met 85 --want-cheap 75 \
    --out build/adviser.csv
}
of_programs() {
  step nodes-by-clang++ build/clang/test_nodes
  step edges-by-clang++ build/clang/test_edges
  step window      tools/test_window.sh
  step grids       same_grids
  step readme      tools/check_readme.sh
}
of_sweeps() {
  step charts      make -s charts QUICK=1
  step stability   make -s stability QUICK=1
  step sweep       tools/test_sweep.sh
  step fuzz        make -s fuzz RUNS=100000
  step advice      advice
}

step tree          tools/check_tree.sh
step includes      tools/check_includes.sh
step headers       env CXX=clang++ tools/check_headers.sh
step lanes         tools/check_lanes.sh
step build-g++     make_all all CXX=g++ QUICKLY="${quickly//$'\n'/ }"
step build-clang++ clang
beside of_scripts of_variants
beside odd_tests even_tests
beside of_programs of_sweeps

echo "make check took $((SECONDS - started)) s"
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
