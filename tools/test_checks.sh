#!/usr/bin/env bash
# How the Makefile builds a program that somebody adds, in a scratch copy.
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=tools/cases.sh
. tools/cases.sh

mkdir "$tmp/tree"
git ls-files -co --exclude-standard | while IFS= read -r file; do
  [ ! -f "$file" ] || echo "$file"
done | tar cf - -T - | tar xf - -C "$tmp/tree"

cd "$tmp/tree"
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

all_passed
