#!/usr/bin/env bash
# Hold the arrows between rooms: who may include whom. These tables are their one
# home; a new room or a new arrow is a change of the design, made there first.
#   ROOM : A B   may include itself, A, B and all that these may include, and
#                does include a header of A and one of B
set -euo pipefail
cd "$(dirname "$0")/.."

arrows='
CME212        :
CME212/viewer : CME212
Graph         : CME212
mass_spring   : Graph CME212/viewer
methods       : CME212
course        : mass_spring
lab/fast      : mass_spring
lab/methods   : lab/fast methods
lab/stability : lab/methods
lab/scenes    : lab/methods
lab/rest      : lab/scenes
lab/stepping  : lab/rest lab/stability
lab/advice    : lab/stepping
lab/charts    : lab/stability lab/scenes
lab/try       : mass_spring
lab/bench     : lab/fast
lab/live      : lab/stepping
lab/viewer    : lab/stepping
lab/run       : lab/viewer
lab/python    : lab/advice
lab/page      : lab/live
'
# Python, JavaScript, CSS and HTML reach another room by the name of its folder
# or of a file in it: so these may name, and do.
scripts='
tools      :
course     : tools
lab/advice :
lab/bench  :
lab/scenes :
lab/methods :
lab/charts : lab/advice lab/methods
lab/try    : course lab/charts
lab/page   : course tools
tests      : course lab/try
tests/crossings : lab/scenes lab/methods
docs/site  : course tools
'
# A program in the root may draw, and a test; of all else only these:
drawing='CME212/viewer/* CME212/SDLViewer.hpp CME212/SFML_Viewer.hpp
         CME212/Color.hpp'
drawers='CME212/* lab/viewer/* lab/run/* tests/* course/*'
# And only these name SDL and OpenGL:
gl_headers='^(SDL2/)?SDL[A-Za-z0-9_]*\.h$|^(GL|GLES[23]?|EGL|KHR|OpenGL)/'
gl_users='CME212/viewer/GL* CME212/viewer/SDL*'

mapfile -t files < <(git ls-files -co --exclude-standard -- '*.hpp' '*.cpp' |
  sort -u | while IFS= read -r file; do [ ! -f "$file" ] || echo "$file"; done)
set -f  # from here on * is a character of the table
faults=0
fault() { echo "$1"; faults=$((faults + 1)); }

declare -A may drawn used there
table() {  # PREFIX ROWS: of the names of rooms
  local room below b
  while read -r room _ below; do
    [ -n "$room" ] || continue
    may[$1$room]=" $room $below" drawn[$1$room]=$below
    for b in $below; do may[$1$room]+=" ${may[$1$b]}"; done
  done <<<"$2"
}
table "" "$arrows"
table "script " "$scripts"

one_of() {  # is $1 one of the words (or patterns) that follow?
  local word
  # shellcheck disable=SC2053  # a pattern
  for word in "${@:2}"; do [[ $1 == $word ]] && return; done
  return 1
}
programs=$(grep -lE '^int main|^ *BENCHMARK_MAIN' "${files[@]}" || true)
is_program() { [[ $'\n'$programs$'\n' == *$'\n'$1$'\n'* ]]; }

set_room() {  # of FILE, in $room: that of a program in the root is .
  case $1 in
    Graph.hpp | methods.hpp) room=${1%.hpp} ;;
    CME212/*Viewer.hpp) room=CME212/viewer ;;
    mass_spring.hpp | mass_spring.cpp) room=mass_spring ;;
    course/* | course) room=course ;;
    tools/* | tools) room=tools ;;
    lab/*/*) room=${1#lab/} room=lab/${room%%/*} ;;
    */*) room=${1%/*} ;;
    *) room=. ;;
  esac
}
set_header() {  # the file of this tree that FILE includes as TARGET; or none
  header=$2
  [[ $header != *./* ]] || header=$(realpath -m --relative-to=. "$header")
  [ -f "$header" ] || header=${1%/*}/$2
  [ -f "$header" ] || header=""
}

arrow() {  # PREFIX WHAT: what $file does in $line is an arrow, $room to $of
  used[$1$room:$of]=1 there[$1$room]=1
  if [ -z "${may[$1$room]+there}" ]; then
    fault "$file:1: its room has no line in the table of $0"
  else
    # shellcheck disable=SC2086
    one_of "$of" ${may[$1$room]} || fault "$file:$line: $2, which is not below it"
  fi
}

include='^[[:space:]]*#[[:space:]]*include[[:space:]]*[<"]([^>"]+)[>"]'
while IFS=: read -r file line text; do
  [[ $text =~ $include ]] || continue
  target=${BASH_REMATCH[1]}
  # shellcheck disable=SC2086  # lists of words, here and below
  if [[ $target =~ $gl_headers ]]; then
    one_of "$file" $gl_users ||
      fault "$file:$line: includes $target, which only $gl_users may name"
    continue
  fi
  set_header "$file" "$target"
  [ -n "$header" ] || continue
  # shellcheck disable=SC2086
  if one_of "$header" $drawing && ! one_of "$file" $drawers &&
    [[ $file == */* || $file == *.hpp ]]; then
    fault "$file:$line: includes $header, which draws"
  fi
  # Programs and tests of the laboratory may include anything else.
  case $file in
    lab/*.cpp) ! is_program "$file" || continue ;;
    */*) [[ $file == lab/* || $file == CME212/* || $file == course/* ]] || continue ;;
  esac
  set_room "$header"; of=$room
  set_room "$file"
  if [ "$room" = . ]; then  # a program of the course
    [[ $header != lab/* && $header != course/* ]] ||
      fault "$file:$line: includes $header, which is not below it"
  else
    arrow "" "includes $header"
  fi
done < <(grep -nE "$include" /dev/null "${files[@]}")

# Names of rooms and of what is in them, no pages, pictures and results; comments
# do not count.
named='^\s*(?:#|//|\*).*(*SKIP)(*F)|(?<=["\'"\'"'])(?:course|tools)(?=["\'"\'"'])
  |(?<![\w.-])(?:\.\./)*(?:course|tools|docs/site|lab/[a-z]+)/[\w./*{}-]*
  |(?<=["\'"\'"'])(?:\.\./)*lab/[a-z]+(?=["\'"\'"'])'
while IFS=: read -r file line target; do
  target=${target##*../} target=${target%.}
  case $target in *.md | *.svg | */results/*) continue ;; esac
  set_room "$target/"; of=$room
  [ -d "$of" ] || continue
  set_room "$file"
  arrow "script " "names $target"
done < <(git ls-files -co --exclude-standard -- '*.py' '*.js' '*.css' '*.html' |
  xargs grep -noP "${named//$'\n  '/}" /dev/null)

for room in "${!there[@]}"; do
  for b in ${drawn[$room]-}; do
    [ -n "${used[$room:$b]-}" ] ||
      fault "$0: the arrow from $room to $b is not used"
  done
done

[ "$faults" = 0 ]
