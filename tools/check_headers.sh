#!/usr/bin/env bash
# Compile each header alone, and twice over to hold its include guard, by $CXX:
#   tools/check_headers.sh [HEADER...]
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
# Headers that name SDL or OpenGL need the flags of packages; all others compile
# without, and with them if they draw only under MASS_SPRING_VIEWER. All may use
# Eigen.
drawing='^CME212/viewer/(GL|SDL(Window|Settings))'
system() { pkg-config --cflags "$@" | sed 's/-I/-isystem/g'; }
plain=$(system eigen3)
draw="$plain -DMASS_SPRING_VIEWER $(system sdl2 libpng gl)"
python="$plain $(make -s --no-print-directory python-flags)"

compile() {  # HEADER FLAGS
  # shellcheck disable=SC2086  # a list of words
  printf '#include "%s"\n' "$1" "$1" |
    ${CXX:-g++} -std=c++20 -Wall -Wextra -Werror -fsyntax-only -I. $2 -x c++ - ||
    { echo "$1:1: does not compile alone by ${CXX:-g++}"; failed=1; }
}
failed=0
for header; do
  if [[ $header =~ ^lab/python/ ]]; then
    [ -f /usr/include/pybind11/numpy.h ] ||
      { echo "skipped: $header: make python-deps"; continue; }
    compile "$header" "$python"
    continue
  fi
  [[ $header =~ $drawing ]] || compile "$header" "$plain"
  [[ ! $header =~ $drawing ]] && ! grep -q MASS_SPRING_VIEWER "$header" ||
    compile "$header" "$draw"
done
[ "$failed" = 0 ]
