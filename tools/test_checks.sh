#!/usr/bin/env bash
# Show that a check can fail: check_tree.sh finds each kind of fault in a scratch
# copy. Also how the Makefile builds a program that somebody adds.
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
copy few 'tools/*.sh' tools/most_lines Makefile Graph.hpp mass_spring.hpp \
  CME212/Point.hpp CME212/Util.hpp course/kit/tasks.py .clang-format .gitignore

end() { wc -l <"$1"; }

# ---- How the Makefile builds a program that somebody adds to the root
cd "$tmp/tree"
printf '#include "own.hpp"\nint main() {}\n' >own.cpp
for makefile in Makefile course/starter/Makefile; do
  [ $makefile = Makefile ] || { cp $makefile .; touch tests/tests.mk; }
  rm -rf "$tmp/own"; touch -d 'now + 2 days' own.hpp
  attempt env -u SPEED timeout 60 make -n own B="$tmp/own"
  expect 0; says ' -g'; not_say NDEBUG; not_say libviewer
  ok "make: $makefile has assertions, and ends though a header is of the future"
done

# ---- The tree. The words are put together here, not to be found here.
cd "$tmp/few"
attempt tools/check_tree.sh; expect 0; same "what it says" "$out" ""; ok "no fault"
echo 'int helper() { return 0; }' >test_stray.cpp
{ echo "// TO""DO: later"; echo "// Of what"" is left, nothing"; } >>Graph.hpp
printf '#%80s\n' x >>course/kit/tasks.py
{ printf '#if %s\n#endif\nint   i;\n// \303\251\n// DOS\r\n' 0
  printf '//%.0s\n' {1..496}; } >mass_spring.hpp
mkdir -p lab/x/results; echo 999 >tools/most_lines
# The head of a PNG, all that the check reads: 801 is 3 * 256 + 041.
printf '\211PNG\r\n\032\n\0\0\0\rIHDR\0\0\03\041' | tee x.png >lab/x/results/x.png
head -c 150001 /dev/zero >x.svg
attempt tools/check_tree.sh; expect 1
while IFS= read -r message; do says "$message"; done <<END
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
ok "its faults"
all_passed
