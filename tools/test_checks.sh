#!/usr/bin/env bash
# Show that each check of check_includes.sh, check_headers.sh, check_tree.sh,
# check_names.sh, check_commands.sh and figures.py can fail, on a scratch copy
# of the tree, one fault at a time; and how the Makefile builds a program that somebody adds.
set -euo pipefail
cd "$(dirname "$0")/.."

tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
passed=0 failed=0
unset GIT_DIR GIT_WORK_TREE GIT_INDEX_FILE
export GIT_CONFIG_GLOBAL=/dev/null GIT_CONFIG_NOSYSTEM=1
export GIT_AUTHOR_NAME=T GIT_AUTHOR_EMAIL=t@example.org
export GIT_COMMITTER_NAME=T GIT_COMMITTER_EMAIL=t@example.org

# tree/ is the whole tree; small/ and few/ some of its files, which no check
# blames whatever else goes on in the tree: all headers of small/ are compiled.
copy() {  # FOLDER PATTERN...
  mkdir "$tmp/$1"
  git ls-files -co --exclude-standard -- "${@:2}" | sort -u |
    while IFS= read -r file; do [ ! -f "$file" ] || echo "$file"; done |
    tar cf - -T - | tar xf - -C "$tmp/$1"
  [ -z "${CHECKS:-}" ] || cp "$CHECKS"/check_*.sh "$tmp/$1/tools/"
  (cd "$tmp/$1"; git init -q; git add -Af; git commit -qm scratch)
}
copy tree .
copy small 'tools/*.sh' CME212/Point.hpp CME212/Util.hpp CME212/SlotMap.hpp .clang-format .gitignore
copy few 'tools/*.sh' Makefile Graph.hpp mass_spring.hpp CME212/SlotMap.hpp \
  course/kit/tasks.py .clang-format .gitignore

ok() {
  if [ -z "$why" ]; then
    echo "ok    $1"; passed=$((passed + 1))
  else
    printf 'FAIL  %s:%s\n%s\n' "$1" "$why" "$out"; failed=$((failed + 1))
  fi
}
check() {  # in FOLDER, run the check; sets out, status
  cd "$tmp/$1"
  status=0
  out=$("${@:2}" 2>&1) || status=$?
  git reset -q --hard; git clean -fdqx
}
clean() {  # NAME FOLDER CHECK...: passes there
  check "${@:2}"; why=""
  [ "$status" = 0 ] && [ -z "$out" ] || why=" status is $status;"
  ok "$1"
}
caught() {  # NAME MESSAGE FOLDER CHECK...: the fault that was just made
  check "${@:3}"; why=""
  [ "$status" = 1 ] || why=" status is $status, not 1;"
  grep -qF -- "$2" <<<"$out" || why+=" does not say '$2';"
  ! grep -qF -- "$2" "$tmp/before" || why+=" says so without the fault, too;"
  ok "$1"
}
# What a check says of FOLDER without any fault of ours.
before() { check "$@"; echo "$out" >"$tmp/before"; }
comment_lines() { printf '//%.0s\n' $(seq "$1"); }
again() { cd "$tmp/${1:-tree}"; }

# ---- Include arrows
inc=tools/check_includes.sh
clean "includes: nothing to blame" small $inc
before tree $inc
arrow() {  # FILE TARGET: as first line of FILE, which is made if need be
  again; mkdir -p "$(dirname "$1")"; touch "$1"
  { echo "#include \"$2\""; cat "$1"; } >x && mv x "$1"
  caught "includes: $1 -> $2" \
    "$1:1: includes ${3:-$2}, which is not below it" tree $inc
}
arrow CME212/Point.hpp Graph.hpp
arrow CME212/SlotMap.hpp Graph.hpp
arrow CME212/SDLViewer.hpp mass_spring.hpp
arrow Graph.hpp mass_spring.hpp
arrow Graph.hpp ./CME212/../mass_spring.hpp mass_spring.hpp
arrow mass_spring.hpp lab/fast/Lanes.hpp
arrow mass_spring.cpp lab/methods/Verlet.hpp
arrow test_nodes.cpp lab/fast/Sweep.hpp
arrow another.cpp lab/fast/Sweep.hpp
arrow course/tests/3.1.position.cpp lab/fast/Sweep.hpp
arrow mass_spring.hpp course/tests/check.hpp
arrow another.cpp course/tests/check.hpp
arrow lab/fast/Sweep.hpp course/tests/check.hpp
arrow lab/fast/Energy.hpp lab/methods/Verlet.hpp
arrow lab/methods/Verlet.hpp lab/stability/Guard.hpp
arrow lab/stability/Guard.hpp lab/scenes/Scene.hpp
arrow lab/stability/Guard.hpp lab/charts/Problem.hpp
arrow lab/scenes/Scene.hpp lab/advice/Advise.hpp
arrow lab/scenes/Scene.hpp lab/charts/Problem.hpp
arrow lab/charts/Problem.hpp lab/scenes/Scene.hpp
arrow lab/charts/Problem.hpp lab/bench/Cloths.hpp
arrow lab/advice/Advise.hpp lab/viewer/Screen.hpp
arrow lab/viewer/Screen.hpp lab/advice/Advise.hpp
arrow lab/viewer/Screen.hpp lab/run/Run.hpp
arrow lab/page/Page.hpp lab/viewer/Screen.hpp
again; sed -i 's#^lab/page .*#& lab/advice#' $inc
caught "includes: an arrow that nobody uses" \
  "the arrow from lab/page to lab/advice is not used" tree $inc
draws() {  # FILE HEADER
  again; sed -i "1i #include \"$2\"" "$1"
  caught "includes: $1 draws" "$1:1: includes $2, which draws" tree $inc
}
draws lab/scenes/Scene.hpp CME212/Color.hpp
draws lab/bench/bench.cpp CME212/SDLViewer.hpp
draws mass_spring.hpp CME212/SFML_Viewer.hpp

again; echo '  #  include <mass_spring.hpp>' >>Graph.hpp
caught "includes: in pointed brackets, with blanks" \
  "Graph.hpp:$(wc -l <Graph.hpp): includes mass_spring.hpp, which" tree $inc
again; sed -i '1i #include <SDL2/SDL.h>' mass_spring.cpp
caught "includes: mass_spring.cpp names SDL" \
  "mass_spring.cpp:1: includes SDL2/SDL.h, which only" tree $inc
again; sed -i '1i #include <GL/gl.h>' CME212/Color.hpp
caught "includes: CME212/Color.hpp names OpenGL" \
  "CME212/Color.hpp:1: includes GL/gl.h, which only" tree $inc
again; mkdir lab/attic; echo '#include "Graph.hpp"' >lab/attic/Stranger.hpp
caught "includes: a room that the table does not know" \
  "lab/attic/Stranger.hpp:1: its room has no line in the table" tree $inc

# ---- Headers alone: in small/, since each compilation takes a second
head=tools/check_headers.sh
: >"$tmp/before"
clean "headers: nothing to blame" small $head
header() {  # NAME COMPILER [FOLDER]: Bad.hpp is read from standard input
  again small; cat >"${3:-.}/Bad.hpp"  # in FOLDER all headers are compiled
  caught "headers: $1" "Bad.hpp:1: does not compile alone by $2" small $head \
    $([ $# = 3 ] || echo Bad.hpp)
}
header "uses what it does not include" g++ <<<'#pragma once
inline std::string s;'
header "a warning" g++ <<<'#pragma once
inline int f(int unused) { return 0; }'
header "no include guard" clang++ <<<'struct Bad {};'
header "in CME212/" g++ CME212 <<<'#pragma once
nonsense'
header "only g++ refuses" g++ <<<'#pragma once
#ifndef __clang__
#error
#endif'
header "only clang++ refuses" clang++ <<<'#pragma once
#ifdef __clang__
#error
#endif'
header "only with the viewer" g++ <<<'#pragma once
#ifdef MASS_SPRING_VIEWER
#error
#endif'
header "only without the viewer" g++ <<<'#pragma once
#ifndef MASS_SPRING_VIEWER
#error
#endif'

# ---- The tree. The words are put together here, not to be found here.
tree=tools/check_tree.sh
clean "tree: nothing to blame" few $tree
before few $tree
again few; echo 'int not_main() { return 0; }' >stray.cpp
caught "tree: a .cpp without a program" "stray.cpp:1: is no program" few $tree
again few; echo 'int helper() { return 0; }' >test_stray.cpp
caught "tree: a test_*.cpp without a test" "test_stray.cpp:1: is no program" \
  few $tree
for word in TO+DO FIX+ME X+XX; do
  word=${word/+/}; again few; echo "// $word: later" >>Graph.hpp
  caught "tree: $word" "Graph.hpp:$(wc -l <Graph.hpp): is left unfinished" \
    few $tree
done
again few; echo "# $word" >>Makefile
caught "tree: an unfinished Makefile" \
  "Makefile:$(wc -l <Makefile): is left unfinished" few $tree
again few; printf '#if %s\n#endif\n' 0 >>mass_spring.hpp
caught "tree: a branch that is never compiled" \
  "mass_spring.hpp:$(($(wc -l <mass_spring.hpp) - 1)): is never compiled" few $tree
again few; printf '//%79s\n' x >>mass_spring.hpp
caught "tree: 81 columns" \
  "mass_spring.hpp:$(wc -l <mass_spring.hpp): is longer than 80 columns" few $tree
again few; printf '//%78s\n' x >>CME212/SlotMap.hpp
clean "tree: 80 columns are none too many" few $tree
again few; comment_lines 761 >Graph.hpp
caught "tree: 761 lines of Graph.hpp" \
  "Graph.hpp:760: goes on to line 761; the limit is 760" few $tree
again few; comment_lines 501 >mass_spring.hpp
caught "tree: 501 lines of another" \
  "mass_spring.hpp:500: goes on to line 501; the limit is 500" few $tree
again few; printf '#%80s\n' x >>course/kit/tasks.py
caught "tree: 81 columns of Python" \
  "course/kit/tasks.py:$(wc -l <course/kit/tasks.py): is longer than 80" few $tree
again few; comment_lines 500 >CME212/SlotMap.hpp; cp CME212/SlotMap.hpp Graph.hpp
comment_lines 260 >>Graph.hpp
clean "tree: 500 and 760 lines are none too many" few $tree
again few; sed -i '1i int   i;' mass_spring.hpp
caught "tree: not laid out" "mass_spring.hpp:1: is not laid out" few $tree
again few; printf '// \303\251\n' >>mass_spring.hpp
caught "tree: a letter that is not ASCII" \
  "mass_spring.hpp:$(wc -l <mass_spring.hpp): has a character" few $tree
again few; echo '# words ' >>Makefile
caught "tree: white space at the end of a line" \
  "Makefile:$(wc -l <Makefile): ends in white space" few $tree
again few; printf '// DOS\r\n' >>mass_spring.hpp
caught "tree: DOS line ends" \
  "mass_spring.hpp:$(wc -l <mass_spring.hpp): ends in white space" few $tree
again few; echo '*.cpp' >>.git/info/exclude; echo 'int x() {}' >stray.cpp
check few $tree; why=""; ! grep -q stray <<<"$out" || why=" blames it;"
sed -i '$d' "$tmp/few/.git/info/exclude"
ok "tree: an ignored file is not held"
# The head of a PNG, all that the check reads: 800 is 3 * 256 + 040.
png() { printf '\211PNG\r\n\032\n\0\0\0\rIHDR\0\0%b' "$1"; }
again few; mkdir -p lab/x/results; png '\03\040' >lab/x/results/x.png
caught "tree: a chart that is no SVG" "lab/x/results/x.png:1: is a chart, but no SVG" \
  few $tree
again few; png '\03\041' >x.png
caught "tree: a picture of 801 pixels" "x.png:1: is wider than 800 pixels" \
  few $tree
again few; head -c 150001 /dev/zero >x.svg
caught "tree: a chart of 150,001 bytes" "x.svg:1: has 150001 bytes" few $tree
again few; png '\03\040' >x.png
clean "tree: 800 pixels are none too many" few $tree
again few; rm mass_spring.hpp
check few $tree; why=""
! grep -q 'No such file' <<<"$out" || why=" looks for it;"
ok "tree: a deleted file is not looked for"

# ---- Names of the text; '' keeps them out of the code that is searched
names=tools/check_names.sh
before tree $names
quoted() {  # WHAT NAME TEXT: of a page
  again; printf '\nSee `%s`.\n' "$3" >>lab/fast/README.md
  caught "names: $1" "$(wc -l <lab/fast/README.md): $2 is nowhere" tree $names
}
quoted "a function that is gone" 'is_g''one' 'is_g''one(x)'
quoted "a function of tests alone" 'load_c''loth' 'load_c''loth()'
quoted "a member that is gone" 'Graph::is_g''one' 'Graph::is_g''one'
quoted "a header that is gone" 'fast/G''one.hpp' 'fast/G''one.hpp'
quoted "a target that is gone" 'make g''one-chart' 'make g''one-chart'
quoted "an option that is gone" '--g''one-option' './cloth --g''one-option'
again; sed -i '1s/^/\/\/ As is_g''one() does.\n/' lab/Nearest.hpp
caught "names: a comment" "Nearest.hpp:1: is_g""one is nowhere" tree $names

# ---- Numbers of the text
figures='python3 lab/charts/figures.py'
before tree $figures
again; sed -i 's/is 46 times/is 47 times/' README.md
caught "figures: a number that is not the CSV's" \
  "README.md:$(grep -n 'is 47 times' README.md | cut -d: -f1): 47, expected 46" \
  tree $figures
again; sed -i 's/times as accurate as Verlet/as accurate as Verlet/' lab/charts/README.md
caught "figures: a rule whose text is gone" \
  "lab/charts/README.md does not have this text" tree $figures

# ---- How the Makefile builds a program that somebody adds to the root
build_says() {  # NAME WORD NOT-WORD MAKE-ARGUMENT...
  again; printf '%s\n' "$program" >own.cpp
  check tree env -u SPEED make -n own B="$tmp/own" "${@:4}"; why=""
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
  'own.cpp [^ ]*libviewer.a -l' 'NDEBUG|gtest'
program='#include <gtest/gtest.h>'
build_says "and with GoogleTest, under the sanitizers" \
  '-fsanitize=address,undefined.*' 'NDEBUG|libviewer'
for makefile in Makefile course/starter/Makefile; do
  for file in own.cpp own.hpp; do  # one that is dated in the future
    again; printf '#include "own.hpp"\nint main() {}\n' >own.cpp; touch own.hpp
    touch -d 'now + 2 days' "$file"
    [ $makefile = Makefile ] || { cp $makefile Makefile; touch tests/tests.mk; }
    check tree env -u SPEED timeout 60 make -n own B="$tmp/own"; why=""
    [ "$status" = 0 ] || why=" status is $status;"
    ok "make: $makefile ends, $file is dated in the future"; rm -rf "$tmp/own"
  done
done

# ---- Steps that do not end
steps() {  # LIMIT COMMAND: the only step of check.sh quick in small/
  again small
  { sed "/^case .tier in/,\$d; s/^limit=600/limit=$1/" tools/check.sh
    echo "of_files() { :; }; of_stages() { step slow hangs; }; hangs() { $2; }"
    sed -n '/^case .tier in/,$p' tools/check.sh; } >"$tmp/check.sh"
  cp "$tmp/check.sh" tools; rm -f "$tmp/pid"
}
ended() { ! grep -q '^State:.[^Z]' "/proc/$(cat "$tmp/pid")/status"; } 2>/dev/null
: >"$tmp/before"
steps 1 'sleep 1000'
caught "check: a step that does not end" "slow: ended after 1 s, its time limit" \
  small tools/check.sh quick
steps 100 "sleep 1000 & echo \$! >$tmp/pid"
check small tools/check.sh quick; why=""
[ "$status" = 0 ] || why=" status is $status;"
ended || why+=" it is there;"
ok "check: a step leaves nothing running"
for name in INT TERM HUP; do
  steps 100 "sleep 1000 & echo \$! >$tmp/pid; wait"
  env --default-signal tools/check.sh quick >"$tmp/said" 2>&1 &
  until [ -s "$tmp/pid" ] || ! kill -0 $! 2>/dev/null; do sleep 0.1; done
  kill -$name $!
  status=0; wait $! || status=$?
  why=""; [ "$status" = $((128 + $(kill -l $name))) ] || why=" status is $status;"
  ended || why+=" a step is left;"
  out=$(cat "$tmp/said"); ok "check: SIG$name ends all steps"
  check small true
done

# ---- What clangd reads
again
check tree bash -c 'make -s compdb && python3 - <<EOF
import json, os
flags = {e["file"]: e["command"] for e in json.load(open("compile_commands.json"))}
assert all(map(os.path.isfile, flags)), "no file"
assert "-DSTAGE=tear -DMASS_SPRING_VIEWER" in flags["mass_spring.cpp"]
assert "-isystem /usr/include/eigen3" in flags["lab/scenes/Scene.cpp"]
assert "MASS_SPRING_VIEWER" not in flags["tests/test_scene.cpp"]
assert "-DMASS_SPRING_VIEWER" in flags["lab/viewer/Panel.cpp"]
EOF'; why=""; [ "$status" = 0 ] || why=" status is $status;"
ok "make compdb: how each source is compiled"

# ---- Pages whose commands are run
run=tools/check_commands.sh
page() { again small; printf '%s\n' '```sh' "$@" >page.md; }
page 'echo one two' 'exit 3  # status 3' '```' '> one ... two'
check small $run page.md; why=""; [ "$status" = 0 ] || why=" status is $status;"
ok "commands: status and words as they stand there"
page 'exit 3' '```'
caught "commands: a status that does not stand there" "FAIL  exit 3" small $run page.md
page 'true  # status 3' '```'
caught "commands: a failure that works by now" "FAIL  true" small $run page.md
page 'echo one' '```' '> one' '> and two'
caught "commands: words that are not said" "not said: one and two" small $run page.md

echo
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
