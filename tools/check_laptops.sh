#!/usr/bin/env bash
# What students build, on other laptops: nothing that bash 3.2, make 3.81 or the
# tools of a Mac lack; all tests of the course by clang with libc++, as on a Mac;
# the five stages by an emulated ARM processor, whose energies are those of this
# one. A part whose tools are missing is skipped.
set -euo pipefail
cd "$(dirname "$0")/.."

# What students and teachers run, and what is newer there or not of POSIX.
scripts="tools/deps.sh tools/submit.sh tools/stored_scenes.sh"
makefiles="Makefile CME212/viewer.mk lab/lab.mk lab/page/page.mk course/course.mk
  course/web/web.mk course/starter/Makefile course/starter/tests.mk"
newer='(^|[^(a-z])(mapfile|readarray|coproc|nproc|timeout|flock|realpath) |declare -A'
newer+='|\|&|&>>|\$\{[a-zA-Z_]+(\^|,)|wait -n|readlink -f|sed -i|stat -c'
newer+='|grep -[a-zA-Z]*P|\$\(file |\bONESHELL|\bundefine |^private |[^:]::= |^[a-zA-Z_]+ *!= '
# shellcheck disable=SC2086  # lists of words
if grep -nE "$newer" $scripts $makefiles; then
  echo "FAILED: bash 3.2, make 3.81 or a Mac does not have this"
  exit 1
fi
# A compiler without OpenMP: the laboratory is built without it.
folder=$(mktemp -d)
printf '#!/bin/sh\ncase "$*" in *-fopenmp*) exit 1 ;; esac\nexec g++ "$@"\n' \
  >"$folder/c++"
chmod +x "$folder/c++"
make -pn CXX="$folder/c++" VIEWER=0 help 2>/dev/null | grep '^OPENMP := 0' >/dev/null ||
  { echo "FAILED: OPENMP is not 0 where -fopenmp is refused"; exit 1; }
rm -r "$folder"

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
OUT=$folder/solution python3 course/kit/starter.py solution
cd "$folder/solution"
passed=2 failed=0

clang=$(compgen -G '/usr/bin/clang++-[0-9]*' | sort -V | tail -n 1 || true)
if [ -n "$clang" ] && echo '#include <version>' |
  "$clang" -stdlib=libc++ -x c++ -fsyntax-only - 2>/dev/null; then
  make test VIEWER=0 CXX="$clang" CXXFLAGS=-stdlib=libc++ >log 2>&1 || cat log
  passed=$((passed + $(grep -c ': passed' log || true)))
  failed=$((failed + $(grep -cE ': FAILED|Error' log || true)))
  readelf -d build/tests/7.2 | grep -q 'libc++\.so' || {
    failed=$((failed + 1)) && echo "the tests are not linked with libc++"; }
else
  echo "skipped: libc++: apt-get install clang-19 libc++-19-dev libc++abi-19-dev"
fi

arm=aarch64-linux-gnu-g++
if command -v $arm qemu-aarch64 >/dev/null; then
  for stage in problem1 diagonals forces constraints tear; do
    for one in g++ $arm; do
      $one -std=c++20 -O2 -DNDEBUG -ffp-contract=off -I. -DSTAGE=$stage \
        -static mass_spring.cpp -o "$stage-$one"
    done
    mesh=(data/grid0.nodes data/grid0.tets)
    if "./$stage-g++" "${mesh[@]}" >here && timeout 300 qemu-aarch64 \
      "$stage-$arm" "${mesh[@]}" >there && [ -s here ] &&
      cmp here there; then
      passed=$((passed + 1))
    else
      failed=$((failed + 1)) && echo "ARM: stage $stage differs"
    fi
  done
else
  echo "skipped: ARM: apt-get install g++-aarch64-linux-gnu qemu-user"
fi
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
