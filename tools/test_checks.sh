#!/usr/bin/env bash
# Show that our own checks can fail: each finds one fault in a scratch copy of
# the tree. Also how the Makefile builds a program that somebody adds.
set -euo pipefail
cd "$(dirname "$0")/.."

tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
passed=0 failed=0
unset GIT_DIR GIT_WORK_TREE GIT_INDEX_FILE
export GIT_CONFIG_GLOBAL=/dev/null GIT_CONFIG_NOSYSTEM=1
export GIT_AUTHOR_NAME=T GIT_AUTHOR_EMAIL=t@example.org
export GIT_COMMITTER_NAME=T GIT_COMMITTER_EMAIL=t@example.org

# tree/ is the whole tree; few/ has few files, so that a check of it is fast.
copy() {  # FOLDER PATTERN...
  mkdir "$tmp/$1"
  git ls-files -co --exclude-standard -- "${@:2}" | sort -u |
    while IFS= read -r file; do [ ! -f "$file" ] || echo "$file"; done |
    tar cf - -T - | tar xf - -C "$tmp/$1"
  (cd "$tmp/$1"; git init -q; git add -Af; git commit -qm scratch)
}
copy tree .
copy few 'tools/*.sh' Makefile Graph.hpp mass_spring.hpp CME212/Point.hpp \
  CME212/Util.hpp lab/README.md course/kit/tasks.py .clang-format .gitignore

ok() {
  if [ -z "$why" ]; then
    echo "ok    $1"; passed=$((passed + 1))
  else
    printf 'FAIL  %s:%s\n%s\n' "$1" "$why" "$out"; failed=$((failed + 1))
  fi
}
check() {  # run it in the present copy; sets out, status
  status=0
  out=$("$@" 2>&1) || status=$?
  git reset -q --hard; git clean -fdqx
}
clean() {  # NAME CHECK...: finds nothing
  check "${@:2}"; why=""
  [ "$status" = 0 ] && [ -z "$out" ] || why=" status is $status;"
  ok "$1"
}
caught() {  # MESSAGE CHECK...: finds the fault that was just made
  check "${@:2}"; why=""
  [ "$status" = 1 ] || why=" status is $status, not 1;"
  grep -qF -- "$1" <<<"$out" || why+=" does not say so;"
  ok "$2: $1"
}

# ---- Include arrows
cd "$tmp/tree"
inc=tools/check_includes.sh
clean "includes: nothing to blame" $inc
arrow() {  # FILE TARGET: as first line of FILE, which is made if need be
  mkdir -p "$(dirname "$1")"; touch "$1"
  { echo "#include \"$2\""; cat "$1"; } >x && mv x "$1"
  caught "$1:1: includes $2, which $3" $inc
}
arrow CME212/Point.hpp Graph.hpp 'is not below it'
arrow Graph.hpp mass_spring.hpp 'is not below it'
arrow mass_spring.hpp lab/fast/Lanes.hpp 'is not below it'
arrow another.cpp lab/fast/Sweep.hpp 'is not below it'
arrow lab/fast/Energy.hpp lab/methods/Verlet.hpp 'is not below it'
arrow lab/charts/Problem.hpp lab/stepping/Scene.hpp 'is not below it'
arrow mass_spring.cpp SDL2/SDL.h 'only'
arrow lab/stepping/Scene.hpp CME212/Color.hpp 'draws'
mkdir lab/attic; echo '#include "Graph.hpp"' >lab/attic/Stranger.hpp
caught "lab/attic/Stranger.hpp:1: its room has no line in the table" $inc
sed -i 's#^lab/page .*#& lab/advice#' $inc
caught "the arrow from lab/page to lab/advice is not used" $inc

# ---- Names and numbers of the text; '' keeps them out of what is searched
names=tools/check_names.sh
for quoted in 'is_g''one(x)' 'fast/G''one.hpp' 'make g''one-chart' \
  './cloth --g''one-option'; do
  printf '\nSee `%s`.\n' "$quoted" >>lab/fast/README.md
  name=${quoted#./cloth }
  caught "$(wc -l <lab/fast/README.md): ${name%(*} is nowhere" $names
done
sed -i 's/is 46 times/is 47 times/' README.md
caught "README.md:$(grep -n 'is 47 times' README.md | cut -d: -f1): 47, expected 46" \
  python3 lab/charts/figures.py

# ---- How the Makefile builds a program that somebody adds to the root
build_says() {  # NAME WORD NOT-WORD MAKE-ARGUMENT...
  printf '%s\n' "$program" >own.cpp
  check env -u SPEED make -n own B="$tmp/own" "${@:4}"; why=""
  [ "$status" = 0 ] || why=" status is $status;"
  grep -qE -- "$2" <<<"$out" || why+=" no $2;"
  ! grep -qE -- "$3" <<<"$out" || why+=" there is $3;"
  ok "make: $1"; rm -rf "$tmp/own"
}
program='int main() {}'
build_says "its own program has assertions" '-Og' 'NDEBUG|libviewer|gtest'
build_says "unless it asks for speed" '-O3 -DNDEBUG' '-Og' FAST=1
program='#include "CME212/SFML_Viewer.hpp"
int main() {}'
build_says "it is linked with the viewer that it includes" \
  'own.cpp [^ ]*libviewer.a -' 'NDEBUG|gtest'
program='#include <gtest/gtest.h>'
build_says "and with GoogleTest, under the sanitizers" \
  '-fsanitize=address,undefined.*' 'NDEBUG|libviewer'
for makefile in Makefile course/starter/Makefile; do
  printf '#include "own.hpp"\nint main() {}\n' >own.cpp
  touch -d 'now + 2 days' own.hpp
  [ $makefile = Makefile ] || { cp $makefile Makefile; touch tests/tests.mk; }
  check env -u SPEED timeout 60 make -n own B="$tmp/own"; why=""
  [ "$status" = 0 ] || why=" status is $status;"
  ok "make: $makefile ends, a header is dated in the future"; rm -rf "$tmp/own"
done

# ---- The tree. The words are put together here, not to be found here.
cd "$tmp/few"
tree=tools/check_tree.sh
lines() { wc -l <"$1"; }
clean "tree: nothing to blame" $tree
echo 'int helper() { return 0; }' >test_stray.cpp
caught "test_stray.cpp:1: is no program" $tree
echo "// TO""DO: later" >>Graph.hpp
caught "Graph.hpp:$(lines Graph.hpp): is left unfinished" $tree
printf '#if %s\n#endif\n' 0 >>mass_spring.hpp
caught "mass_spring.hpp:$(($(lines mass_spring.hpp) - 1)): is never compiled" $tree
printf '#%80s\n' x >>course/kit/tasks.py
caught "course/kit/tasks.py:$(lines course/kit/tasks.py): is longer than 80" $tree
printf '//%.0s\n' $(seq 501) >mass_spring.hpp
caught "mass_spring.hpp:500: goes on to line 501; the limit is 500" $tree
sed -i '1i int   i;' mass_spring.hpp
caught "mass_spring.hpp:1: is not laid out" $tree
printf '// \303\251\n' >>mass_spring.hpp
caught "mass_spring.hpp:$(lines mass_spring.hpp): has a character" $tree
printf '// DOS\r\n' >>mass_spring.hpp
caught "mass_spring.hpp:$(lines mass_spring.hpp): ends in white space" $tree
echo "// Of what"" is left, nothing" >>Graph.hpp
caught "Graph.hpp:$(lines Graph.hpp): begins a sentence with" $tree
mkdir -p lab/fast; printf '%.0s\n' $(seq 5001) >lab/fast/long.toml
caught "lab/fast has 5001 lines; its budget is" $tree
# The head of a PNG, all that the check reads: 801 is 3 * 256 + 041.
mkdir -p lab/x/results
printf '\211PNG\r\n\032\n\0\0\0\rIHDR\0\0\03\041' >lab/x/results/x.png
cp lab/x/results/x.png .
caught "lab/x/results/x.png:1: is a chart, but no SVG" $tree
printf '\211PNG\r\n\032\n\0\0\0\rIHDR\0\0\03\041' >x.png
caught "x.png:1: is wider than 800 pixels" $tree
head -c 150001 /dev/zero >x.svg
caught "x.svg:1: has 150001 bytes" $tree

# ---- Headers that do not compile alone
head=tools/check_headers.sh
printf '#pragma once\ninline std::string s;\n' >Bad.hpp
caught "Bad.hpp:1: does not compile alone by g++" $head Bad.hpp
printf 'struct Bad {};\n' >Bad.hpp
caught "Bad.hpp:1: does not compile alone by clang++" $head Bad.hpp

# ---- Steps that do not end
steps() {  # LIMIT COMMAND: the only step of check.sh quick
  { sed "/^case .tier in/,\$d; s/^limit=600/limit=$1/" tools/check.sh
    echo "of_files() { :; }; of_stages() { step slow hangs; }; hangs() { $2; }"
    sed -n '/^case .tier in/,$p' tools/check.sh; } >"$tmp/check.sh"
  cp "$tmp/check.sh" tools; rm -f "$tmp/pid"
}
ended() { ! grep -q '^State:.[^Z]' "/proc/$(cat "$tmp/pid")/status"; } 2>/dev/null
steps 1 'sleep 1000'
caught "slow: ended after 1 s, its time limit" tools/check.sh quick
steps 100 "sleep 1000 & echo \$! >$tmp/pid"
check tools/check.sh quick; why=""
[ "$status" = 0 ] || why=" status is $status;"
ended || why+=" it is there;"
ok "check: a step leaves nothing running"
steps 100 "sleep 1000 & echo \$! >$tmp/pid; wait"
env --default-signal tools/check.sh quick >"$tmp/said" 2>&1 &
until [ -s "$tmp/pid" ] || ! kill -0 $! 2>/dev/null; do sleep 0.1; done
kill -TERM $!
status=0; wait $! || status=$?
why=""; [ "$status" = 143 ] || why=" status is $status;"
ended || why+=" a step is left;"
out=$(cat "$tmp/said"); ok "check: SIGTERM ends all steps"
check true

# ---- Pages whose commands are run
run=tools/check_commands.sh
page() { printf '%s\n' '```sh' "$@" >page.md; }
page 'echo one two' 'exit 3  # status 3' '```' '> one ... two'
check $run page.md; why=""; [ "$status" = 0 ] || why=" status is $status;"
ok "commands: status and words as they stand there"
page 'exit 3' '```'
caught "FAIL  exit 3" $run page.md
page 'echo one' '```' '> one' '> and two'
caught "not said: one and two" $run page.md

echo
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
