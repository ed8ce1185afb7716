#!/usr/bin/env bash
# Compile each header alone, and twice over to hold its include guard, by
# both compilers:  [CXX='g++ clang++'] tools/check_headers.sh [HEADER...]
# EVERY=N FIRST=K takes one in N of all headers, from number K on.
set -euo pipefail
cd "$(dirname "$0")/.."

shopt -s nullglob
if [ $# = 0 ]; then
  all=(*.hpp CME212/*.hpp CME212/*/*.hpp lab/*/*.hpp)
  for ((k = ${FIRST:-0}; k < ${#all[@]}; k += ${EVERY:-1})); do
    set -- "$@" "${all[k]}"
  done
fi
# Headers that name SDL or OpenGL, and the packages whose flags these need; all
# others compile without. A header that draws only under MASS_SPRING_VIEWER is
# compiled with it and without it.
drawing='^CME212/viewer/(GL|SDL(Window|Settings))'
packages="sdl2 libpng gl"
# Headers of the module for Python.
python='^lab/python/'

compile() {  # COMPILER HEADER; one report, even when others write too
  local flags="" out ways=plain way
  if [[ $2 =~ $drawing ]]; then ways=draw
  elif grep -q 'MASS_SPRING_VIEWER' "$2"; then ways="plain draw"
  fi
  if [[ $2 =~ $python ]]; then
    flags=" $(make -s --no-print-directory python-flags)"
    # shellcheck disable=SC2086  # a list of words
    echo '#include <pybind11/numpy.h>' |
      $1 -std=c++20 -fsyntax-only $flags -x c++ - 2>/dev/null ||
      { echo "skipped: $2: make python-deps"; return 0; }
  fi
  for way in $ways; do
    if [ "$way" = draw ]; then
      # shellcheck disable=SC2086  # a list of words
      flags=$(pkg-config --cflags $packages) ||
        { echo "$2:1: draws, but one is missing of: $packages"; return 1; }
      flags=" $flags -DMASS_SPRING_VIEWER"
      flags=${flags// -I/ -isystem}
    fi
    # shellcheck disable=SC2086
    out=$(printf '#include "%s"\n' "$2" "$2" |
      $1 -std=c++20 -Wall -Wextra -Werror -fsyntax-only -I. $flags \
         ${CPPFLAGS:-} -x c++ - 2>&1) ||
      { printf '%s\n' "$2:1: does not compile alone by $1" "$out"; return 1; }
  done
}

# All may use Eigen.
eigen=$(pkg-config --cflags eigen3 | sed 's/-I/-isystem/g')
CPPFLAGS="${CPPFLAGS:-} $eigen"

export drawing packages python CPPFLAGS
export -f compile
for cxx in ${CXX:-g++ clang++}; do
  command -v "$cxx" >/dev/null || { echo "$cxx is missing: make deps"; exit 1; }
  printf '%s\n' "$@" | sed "s/^/$cxx /"
done | xargs -r -P "${JOBS:-2}" -L 1 bash -c 'compile "$@"' compile || exit 1
