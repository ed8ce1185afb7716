#!/usr/bin/env bash
# Show that our own checks can fail: each finds faults in a scratch copy of the
# tree. Also how the Makefile builds a program that somebody adds.
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=tools/cases.sh
. tools/cases.sh

# tree/ is the whole tree; few/ has few files, so that a check of it is fast.
copy() {  # FOLDER PATTERN...
  mkdir "$tmp/$1"
  git ls-files -co --exclude-standard -- "${@:2}" | sort -u |
    while IFS= read -r file; do [ ! -f "$file" ] || echo "$file"; done |
    tar cf - -T - | tar xf - -C "$tmp/$1"
  (cd "$tmp/$1"; git init -q; git add -Af; git commit -qm scratch)
}
copy tree .
copy few 'tools/*.sh' tools/most_lines Makefile Graph.hpp mass_spring.hpp CME212/Point.hpp \
  CME212/Util.hpp lab/README.md course/kit/tasks.py .clang-format .gitignore

clean() { attempt "$@"; expect 0; same "what it says" "$out" ""; ok "$*: no fault"; }
# The faults that the case has made are found, and the tree is as it was.
caught() {  # CHECK; on the standard input a message a line
  attempt "$@"; expect 1
  while IFS= read -r message; do says "$message"; done
  git reset -q --hard; git clean -fdqx
  ok "$*: its faults"
}
end() { wc -l <"$1"; }

# ---- Include arrows
cd "$tmp/tree"
clean tools/check_includes.sh
arrow() {  # FILE TARGET WHAT: as first line of FILE, which is made if need be
  mkdir -p "$(dirname "$1")"; touch "$1"
  sed -i "1i #include \"$2\"" "$1" && [ -s "$1" ] || echo "#include \"$2\"" >"$1"
  echo "$1:1: includes $2, which $3" >>"$tmp/messages"
}
arrow CME212/Point.hpp Graph.hpp 'is not below it'
arrow Graph.hpp mass_spring.hpp 'is not below it'
arrow mass_spring.hpp lab/fast/Lanes.hpp 'is not below it'
arrow lab/fast/Energy.hpp lab/methods/Splitting.hpp 'is not below it'
arrow mass_spring.cpp SDL2/SDL.h 'only'
arrow lab/stepping/Scene.hpp CME212/Color.hpp 'draws'
mkdir lab/attic; echo '#include "Graph.hpp"' >lab/attic/Stranger.hpp
echo 'sys.path += [str(ROOT / "lab/page")]' >course/kit/reach.py
echo 'import {run} from "../../lab/page/page.js";' >course/web/reach.js
sed -i 's#^lab/page  *: lab/live#& lab/advice#; s#^lab/bench  *:$#& course#' \
  tools/check_includes.sh
caught tools/check_includes.sh < <(cat "$tmp/messages" - <<'END'
lab/attic/Stranger.hpp:1: its room has no line in the table
the arrow from lab/page to lab/advice is not used
course/kit/reach.py:1: names lab/page, which is not below it
course/web/reach.js:1: names lab/page/page.js, which is not below it
the arrow from script lab/bench to course is not used
END
)

# ---- Names and numbers of the text; '' keeps them out of what is searched
for quoted in 'is_g''one(x)' 'fast/G''one.hpp' 'make g''one-chart' \
  './cloth --g''one-option'; do
  printf '\nSee `%s`.\n' "$quoted" >>lab/fast/README.md
done
caught tools/check_names.sh <<END
$(end lab/fast/README.md): --g${x-}one-option is nowhere
is_g${x-}one is nowhere
fast/G${x-}one.hpp is nowhere
make g${x-}one-chart is nowhere
END
sed -i 's/is 46 times/is 47 times/' README.md
caught python3 lab/charts/figures.py <<END
README.md:$(sed -n '/is 47 times/=' README.md): 47, expected 46
END

# ---- How the Makefile builds a program that somebody adds to the root
own() { attempt env -u SPEED timeout 60 make -n own B="$tmp/own"; expect 0; }
printf '#include "CME212/SFML_Viewer.hpp"\n#include <gtest/gtest.h>\n' >own.cpp
own; says libviewer.a; says -fsanitize=address,undefined
ok "make: a program is linked with what it includes"
attempt timeout 60 make grade-tests FILE=none.cpp
expect 2; says 'none.cpp: No such file'; ok "make: FILE reaches the grader"
printf '#include "own.hpp"\nint main() {}\n' >own.cpp
for makefile in Makefile course/starter/Makefile; do
  [ $makefile = Makefile ] || { cp $makefile .; touch tests/tests.mk; }
  rm -rf "$tmp/own"; touch -d 'now + 2 days' own.hpp
  own; says ' -g'; not_say NDEBUG; not_say libviewer
  ok "make: $makefile has assertions, and ends though a header is of the future"
done

# ---- The tree. The words are put together here, not to be found here.
cd "$tmp/few"
clean tools/check_tree.sh
echo 'int helper() { return 0; }' >test_stray.cpp
{ echo "// TO""DO: later"; echo "// Of what"" is left, nothing"; } >>Graph.hpp
printf '#%80s\n' x >>course/kit/tasks.py
{ printf '#if %s\n#endif\nint   i;\n// \303\251\n// DOS\r\n' 0
  printf '//%.0s\n' {1..496}; } >mass_spring.hpp
mkdir -p lab/x/results; echo 999 >tools/most_lines
# The head of a PNG, all that the check reads: 801 is 3 * 256 + 041.
printf '\211PNG\r\n\032\n\0\0\0\rIHDR\0\0\03\041' | tee x.png >lab/x/results/x.png
head -c 150001 /dev/zero >x.svg
caught tools/check_tree.sh <<END
test_stray.cpp:1: is no program
Graph.hpp:$(($(end Graph.hpp) - 1)): is left unfinished
Graph.hpp:$(end Graph.hpp): begins a sentence with
course/kit/tasks.py:$(end course/kit/tasks.py): is longer than 80
mass_spring.hpp:1: is never compiled
mass_spring.hpp:3: is not laid out
mass_spring.hpp:4: has a character
mass_spring.hpp:5: ends in white space
mass_spring.hpp:500: goes on to line 501; the limit is 500
tools/most_lines:1: the tree has
lab/x/results/x.png:1: is a chart, but no SVG
x.png:1: is wider than 800 pixels
x.svg:1: has 150001 bytes
END

# ---- Headers that do not compile alone
printf '#pragma once\ninline std::string s;\n' >Bad.hpp
printf 'struct Bad {};\n' >Twice.hpp
caught tools/check_headers.sh Bad.hpp Twice.hpp <<'END'
Bad.hpp:1: does not compile alone by g++
Twice.hpp:1: does not compile alone by clang++
END

# ---- Pages whose commands are run
page() { printf '%s\n' '```sh' "$@" >page.md; attempt tools/check_commands.sh page.md; }
page 'echo one two' 'exit 3  # status 3' '```' '> one ... two'
expect 0; ok "commands: status and words as they stand there"
page 'exit 3' 'echo one' '```' '> one' '> and two'
expect 1; says "FAIL  exit 3"; says "not said: one and two"; ok "commands: caught"
all_passed
