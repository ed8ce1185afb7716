#!/usr/bin/env bash
# The checks that a commit must pass:  tools/check.sh quick | check | check-full
#   quick       in seconds after an edit: the course's door
#   check       quick, every test under the sanitizers, the README's commands
#   check-full  all else: clang++, threads, charts, windows ...
# Everything is built in build/check; each step writes build/check/STEP.log; the
# last line counts the tests.
set -uo pipefail
cd "$(dirname "$0")/.." || exit

# What git tracks are the project's files; an unpacked archive has no such list.
git rev-parse --is-inside-work-tree >/dev/null 2>&1 || {
  echo "check: no git checkout: expected a clone, or git init && git add -A" >&2
  exit 2
}
tier=${1:-check}
jobs=${JOBS:-$(nproc)}
logs=build/check
mkdir -p "$logs"
# The sanitizer's fake stack misaligns AVX-512's vectors by g++ 13: a crash.
export ASAN_OPTIONS=detect_leaks=1:detect_stack_use_after_return=0 UBSAN_OPTIONS=print_stacktrace=1
# Where tests look for programs.
export BUILD=build/check
# Line numbers are all that a failing test needs; -g takes a third of the time.
# A warning is an error by the compilers of .github: g++ 12 and 14, clang++ 14.
strict() { case $($1 -dumpversion) in 12* | 14*) echo -Werror ;; esac; }
[ "$tier" = run ] || { CXXFLAGS="$(strict "${CXX:-g++}") -g1" && export CXXFLAGS; }
# Where much is compiled: below 1 GB g++ collects no garbage, which would take a
# tenth of the time.
[[ $tier =~ quick|run || ${CXX:-} =~ clang ]] || CXXFLAGS+=' --param ggc-min-heapsize=1000000'
# Nothing here is timed.
export SPEED=-O1
# Sources are compiled several at once: lab/units.mk.
export UNITY=1
# Two checks of one tree would end each other's programs.
if [ "$tier" != run ]; then
  exec 8>"$logs/lock"
  flock -n 8 || { echo "check: another one runs in this tree" >&2; exit 2; }
fi
started=$SECONDS passed=0 failed=0
# Seconds that a step may take: three times what a slow machine needs.
limit=600 long=1800

# A signal ends this, and all that it started.
end() {  # STATUS
  local all
  trap '' INT TERM HUP
  mapfile -t all < <(jobs -p)
  kill "${all[@]}"
  wait
  kill -KILL -- "${all[@]/#/-}"
  exit "$1"
} 2>/dev/null
end_in_order() { trap 'end 130' INT; trap 'end 143' TERM; trap 'end 129' HUP; }
end_in_order

# Run a step and count what it says it passed; a step that counts nothing is
# one test. It is a process group of its own, with default signals; a function
# runs in a copy of this script.
step() {  # NAME COMMAND...
  local name=$1 log=$logs/$1.log from=$SECONDS ok=0 good bad
  shift
  [ "$(type -t "$1")" != function ] || set -- tools/check.sh run "$@"
  env --default-signal timeout -k 10 "$limit" "$@" >"$log" 2>&1 </dev/null 8>&- &
  wait $! && ok=1
  kill -KILL -- -$! 2>/dev/null  # what it left running
  [ "$ok" = 1 ] || [ $((SECONDS - from)) -lt "$limit" ] ||
    echo "$name: ended after $limit s, its time limit" >>"$log"
  good=$(sed -nE 's/^\[  PASSED  \] ([0-9]+) tests?.*/\1/p; s/^([0-9]+) passed, .*/\1/p' "$log" |
    tail -n 1)
  bad=$(sed -nE 's/^\[  FAILED  \] ([0-9]+) tests?, .*/\1/p; s/.* passed, ([0-9]+) failed.*/\1/p' "$log" |
    tail -n 1)
  if [ "$ok" = 1 ]; then
    good=${good:-$(sed -nE 's/^Ran ([0-9]+) tests? in .*/\1/p' "$log" | tail -n 1)}
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

# Run lists of steps beside each other; then show and count what each did.
beside() {  # LIST...
  local list good bad
  for list in "$@"; do
    (
      end_in_order
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

# make in build/check/FOLDER; `in . TARGET` in build/check itself.
in_folder() {  # FOLDER TARGET... VARIABLE=VALUE...
  local folder=build/check/$1
  folder=${folder%/.}
  make --no-print-directory -j"$jobs" O="$folder/" B="$folder" "${@:2}"
}

# ---- quick

# Each stage runs on the smallest grid, and the window is built.
stages() {
  local stage
  for stage in problem1 diagonals forces constraints tear; do
    in_folder . "build/check/mass_spring_$stage" VIEWER=0 || return 1
    build/check/mass_spring_$stage data/grid0.nodes data/grid0.tets || return 1
  done
}
# Markers and tasks of the teaching kit, what splits them; pages.
kit_source() {
  python3 course/kit/markers.py && python3 course/kit/pages.py &&
    python3 course/kit/constants.py --check &&
    python3 course/kit/test_markers.py
}
course_test() { in_folder . "build/check/$1" && "build/check/$1"; }
of_files() {
  step tree        tools/check_tree.sh
  step names       tools/check_names.sh
  step includes    tools/check_includes.sh
  step kit_source  kit_source
  step test_nodes  course_test test_nodes
  step test_edges  course_test test_edges
}
of_stages() {
  step stages      stages
  step driver      in_folder . build/check/mass_spring
}

# ---- check

# Two workers, as most steps use one core: each takes what the other has not.
worker() {
  local test
  for test in $(make -s list-units); do
    mkdir "$logs/taken/$test" 2>/dev/null || continue
    case $test in
      test_viewer | test_faces | test_image | test_screen)
        step "$test" env ASAN_OPTIONS="$ASAN_OPTIONS:detect_leaks=0" "build/check/$test" ;;
      # 100,000 operations in random histories; by itself it makes more.
      test_graph)
        step "$test" env RC_PARAMS=max_success=40 "build/check/$test" ;;
      *) step "$test" "build/check/$test" ;;
    esac
  done
}
# Has each test of each program run?
all_ran() {
  local test listed ran status=0
  for test in $(make -s list-units); do
    listed=$("build/check/$test" --gtest_list_tests | grep -c '^  ')
    ran=$(sed -nE 's/^\[==========\] ([0-9]+) tests? from .* ran\..*/\1/p' \
      "$logs/$test.log")
    [ "$ran" = "$listed" ] ||
      { echo "$test: ${ran:-none} of $listed tests ran"; status=1; }
  done
  return $status
}
one_worker() { worker; }
other_worker() { worker; }
# Every chart, from the CSV files as they are.
drawn() {
  local file
  rm -rf build/check/drawn
  python3 lab/charts/draw.py --to build/check/drawn || return 1
  for file in $(git ls-files '*/results/*.svg'); do
    [ -s "build/check/drawn/${file##*/}" ] ||
      { echo "$file:1: is no chart that draw.py draws"; return 1; }
  done
}
# Where not all cases are taken, the commit says which.
turn_of=$((0x$(git rev-parse --short=6 HEAD 2>/dev/null || echo 0)))
of_charts() {
  step lint        tools/lint.sh
  step chart_rule  python3 lab/charts/test_charts.py
  step drawn       drawn
  step crossings   crossings 20
}
of_readme() {
  step readme      tools/check_readme.sh
}
build_tests() { in_folder . units work_precision; }

# Scenes drawn by the commit keep what a run promises.
crossings() {  # SCENES
  /usr/bin/python3 -c 'import numpy, scipy' 2>/dev/null ||
    { echo "skipped: crossings: make python-deps"; return 0; }
  /usr/bin/python3 tests/crossings/crossings.py build/check/cloth \
    --scenes "$1" --seed "$turn_of"
}

# ---- check-full

# The committed grids are what make_grid.py makes.
same_grids() {
  mkdir -p build/check/grids && in_folder . grids TO=build/check/grids || return 1
  local file
  for file in data/grid*.nodes data/grid*.tets; do
    [ "${file%.*}" = data/grid4 ] ||
      cmp "$file" "build/check/grids/${file##*/}" || return 1
  done
}
# What stands beside other libraries compiles, where these are installed.
peers() {
  local program out eigen
  eigen=$(pkg-config --cflags eigen3 | sed 's/-I/-isystem/g')
  for program in lab/bench/peers/*.cpp; do
    # shellcheck disable=SC2046,SC2086  # a list of words
    if out=$(g++ -std=c++20 -Wall -Wextra $(strict g++) -fopenmp -fsyntax-only -I. \
      $eigen "$program" 2>&1); then
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
# Programs and tests have no warning of clang++, which compiles what threads()
# runs, and only reads the rest; nor, in another folder, by other VARIABLES.
clang() {  # FOLDER VARIABLE=VALUE...
  in_folder "$1" objects UNITS=2 CXX=clang++ SANITIZE= \
    CXXFLAGS="$(strict clang++) -fsyntax-only" "${@:2}"
}
# Tests under the ThreadSanitizer of clang++, whose OpenMP tells what waits for
# what. Mesa's own threads are not ours to check.
threads() {
  local suppress="suppressions=tools/tsan.supp halt_on_error=1"
  local three=(env OMP_NUM_THREADS=3
    TSAN_OPTIONS="ignore_noninstrumented_modules=1 halt_on_error=1")
  in_folder clang mass_spring test_nodes test_edges test_viewer test_sweep \
    test_flat_flow \
    CXX=clang++ SANITIZE=thread CXXFLAGS="$(strict clang++) -O0 -g1" &&
    build/check/clang/test_nodes && build/check/clang/test_edges &&
    TSAN_OPTIONS=$suppress build/check/clang/test_viewer \
    --gtest_filter='*Thread*:*Simulation*' &&
    "${three[@]}" build/check/clang/test_sweep \
      --gtest_filter='*hread*:*OnTheWay*:*MovesWhat*' &&
    "${three[@]}" build/check/clang/test_flat_flow --gtest_filter='*Parts*'
}
programs() {
  in_folder . cloth work_precision stability_map bench examples
}
# Does advice still do what it did? How often it is right is in
# lab/advice/README.md, from more scenes.
advice() {
  rm -f build/check/adviser.csv && lab/advice/suite.py \
    --cloth build/check/cloth --out build/check/adviser.csv \
    --first 5002 --scenes 3 --ask '--advise-work 1e8' \
    --goals met=99,robust=99,advised=75
}
# Is anything missing that a page needs, to be built and to be tested?
skips_page() {
  command -v ffmpeg >/dev/null ||
    { echo "skipped: the page: ffmpeg is missing: make page-deps"; return; }
  command -v chromedriver >/dev/null || {
    echo "skipped: the page: chromedriver is missing: tools/deps.sh browser"; return; }
  compgen -G '/usr/lib/llvm-*/lib/clang/*/lib/wasi' >/dev/null ||
    { echo "skipped: the page: clang for wasm32: make page-deps"; return; }
  ! /usr/bin/python3 -c 'import selenium' 2>/dev/null ||
    return 1
  echo "skipped: the page: selenium is missing: tools/deps.sh browser"
}
# The cloth of a starter and a solution as a page, and figures of mistakes.
web() {
  ! skips_page || return 0
  /usr/bin/python3 course/web/test_web.py build/check
}
# The web page in a headless browser, where it can be built: its size, bits,
# controls; pictures of it are in build/check.
page() {
  ! skips_page || return 0
  one_builds page page_positions &&
    EVERY=8 FIRST=$((turn_of % 8)) lab/page/test_page.py build/check
}
# The module for Python, and the examples of its page.
python_module() {
  local python
  python=$(make -s --no-print-directory python-is)
  "$python" -c 'import numpy, scipy, matplotlib, pytest' 2>/dev/null &&
    [ -f /usr/include/pybind11/pybind11.h ] ||
    { echo "skipped: the module for Python: make python-deps"; return 0; }
  export PYTHONPATH=build/check/python MYPYPATH=build/check/python
  in_folder . python && "$python" -m pytest -q -p no:cacheprovider lab/python &&
    { ! command -v stubtest >/dev/null || "$python" -m mypy.stubtest mass_spring; }
}
# The site: its size, links, width on a phone, figures that move.
site() {
  ! skips_page || return 0
  command -v pandoc >/dev/null ||
    { echo "skipped: the site: pandoc is missing: make page-deps"; return 0; }
  one_builds site && docs/site/test_site.py build/check/site
}
# The page is a part of the site: of two builds the second waits.
one_builds() {  # TARGET...
  (flock 9 && in_folder . "$@") 9>build/check/page.lock
}
# The same bits by an ARM processor, in an emulator.
arm() {
  local name
  for name in aarch64-linux-gnu-g++ qemu-aarch64; do
    command -v $name >/dev/null ||
      { echo "skipped: ARM: apt-get install g++-aarch64-linux-gnu qemu-user"; return 0; }
  done
  tools/check_arm.sh
}
# A step, unless the other worker has taken it.
turn() {  # NAME LIMIT COMMAND...
  mkdir "$logs/taken/$1" 2>/dev/null || return 0
  limit=$2 step "$1" "${@:3}"
}
# One of the lists is taken by the commit, or all: make check-full ALL=1.
in_turn() {  # LIST...
  local list place=0
  for list; do
    [ -z "${ALL:-}" ] && [ $((turn_of % $#)) != $((place++)) ] || "$list"
  done
}
of_site() { turn site "$long" site; }
of_web() { turn web "$long" web; }
of_advice() { turn advice "$limit" advice; }
of_clang() { turn clang "$long" clang read; }
of_bare() { turn bare "$long" clang bare VIEWER=0 OPENMP=0; }
of_threads() { turn threads "$long" threads; }
of_figures() {
  turn charts    "$limit" in_folder . -s charts QUICK=1
  turn stability "$limit" in_folder . -s stability QUICK=1
}
# All that needs nothing of each other; the longest first.
turns() {
  turn kit       "$long"  make --no-print-directory kit-check EVERY=64 \
    FIRST=$((turn_of % 64))
  turn page      "$long"  page
  in_turn of_site of_web
  in_turn of_clang of_bare of_threads
  turn python    "$limit" python_module
  turn pages     "$long"  env EVERY=2 FIRST=$((turn_of % 2)) tools/check_pages.sh
  in_turn of_advice of_figures
  turn arm       "$long"  arm
  turn laptops   "$long"  tools/check_laptops.sh
  turn try       "$limit" env EVERY=16 FIRST=$((turn_of % 16)) \
    python3 lab/try/test_try.py build/check/try
  turn door      "$limit" python3 tests/test_door.py
  turn checks    "$long"  tools/test_checks.sh
  turn window    "$limit" tools/test_window.sh
  turn mistakes  "$limit" python3 course/pictures/test_mistakes.py
  turn headers   "$limit" env CXX=clang++ EVERY=8 FIRST=$((turn_of % 8)) \
    tools/check_headers.sh
  turn lanes     "$limit" tools/check_lanes.sh
  turn peers     "$limit" peers
  turn fuzz      "$limit" in_folder . -s fuzz RUNS=100000
  turn submit    "$limit" tools/test_submit.sh
  turn grids     "$limit" same_grids
}
one_half() { turns; }
other_half() { turns; }

[ "$tier" = run ] || { rm -rf "$logs/taken"; mkdir "$logs/taken"; }
case $tier in
  run) "${@:2}"; exit ;;
  quick | check)
    rm -f "$logs"/*.log
    beside of_files of_stages ;;&
  check)
    limit=$long step build build_tests
    beside one_worker other_worker
    step all_ran all_ran
    beside of_charts of_readme ;;
  check-full)
    limit=$long step programs programs
    beside one_half other_half ;;
  quick) ;;
  *) echo "usage: tools/check.sh quick | check | check-full" >&2; exit 2 ;;
esac

echo "make $tier took $((SECONDS - started)) s"
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
