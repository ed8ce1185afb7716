#!/usr/bin/env bash
# Hold the include arrows: who may include whom. This table is their one home;
# a new header or a new arrow is a change of the design, made there first.
#   NAME : A B   may include A, B and all that these may include
#   NAME = A B   may include A and B, and nothing else; * stands for any text
set -euo pipefail
cd "$(dirname "$0")/.."

arrows='
CME212/Point       = CME212/Util
CME212/Util        = CME212/Point
CME212/OutputFile  =
CME212/Allocations =
CME212/TestFolder  =
CME212/BoundingBox = CME212/Point
CME212/Color       = CME212/Point
CME212/GLCamera    = CME212/*
CME212/GLTools     = CME212/*
CME212/GLScene     = CME212/*
CME212/GLOverlay   = CME212/*
CME212/Image       = CME212/*
CME212/SceneBuilder = CME212/*
CME212/SDLWindow   = CME212/*
CME212/SDLViewer   = CME212/*
SlotMap            =
Graph              : SlotMap CME212/Point CME212/Util
Lanes              : CME212/Point
Stencil            : Graph
Mesh               : CME212/Point CME212/Util
Order              : Mesh
Cloth              : Graph Order Lanes Stencil CME212/BoundingBox
Force              : Cloth
Sweep              : Force
Constraint         : Cloth
Obstacle           : Constraint
SelfCollision      : Constraint
Integrator         : Sweep Constraint
RungeKutta         : Integrator
Cholesky           : Lanes
ImplicitStage      : Integrator
Implicit           : ImplicitStage Cholesky
Xpbd               : ImplicitStage
Methods            : RungeKutta Implicit Xpbd
Spectrum           : Force Constraint
Stability          : Spectrum Integrator CME212/Util CME212/BoundingBox
Words              : CME212/Point
Model              : Obstacle Words CME212/Util
Compose            : Model SelfCollision Force
Scene              : Compose Integrator Stability
Measure            : Scene Methods
Refinement         : Measure
Advice             : Refinement
Variation          : Measure
Advise             : Variation Advice
SceneFile          : Model Methods
Run                : Scene CME212/OutputFile
Problem            : Methods Stability
Limits             : Problem
Failure            : Problem
Growth             : Limits
peers/contenders   : Integrator
Report             : CME212/Util
Precision          : Problem Report
Bench              : Report Sweep CME212/OutputFile
Screen             : Scene CME212/Image CME212/SDLViewer
mass_spring        = Cloth Force Constraint Integrator
'
# A program may include anything, but these headers draw, and only these
# programs may include them.
drawing='CME212/Color CME212/GL* CME212/SDL* CME212/SceneBuilder CME212/Image
         Screen'
drivers='mass_spring.cpp test_viewer.cpp test_screen.cpp
         test_course_interface.cpp'
# SDL's and OpenGL's own headers, and who alone may name them.
gl_headers='^(SDL2/)?SDL[A-Za-z0-9_]*\.h$|^(GL|GLES[23]?|EGL|KHR|OpenGL)/'
gl_users='CME212/GLTools.hpp CME212/GLScene.hpp CME212/GLOverlay.hpp
          CME212/SDLWindow.hpp CME212/SDLViewer.hpp'

shopt -s nullglob
files=(*.hpp *.cpp CME212/*.hpp CME212/*.cpp peers/*.hpp peers/*.cpp)
set -f  # from here on * is a character of the table
faults=0

declare -A may
while read -r name kind below; do
  [ -n "$name" ] || continue
  may[$name]=" $below"
  [ "$kind" = "=" ] || for b in $below; do may[$name]+=" ${may[$b]}"; done
done <<<"$arrows"

fault() { echo "$1"; faults=$((faults + 1)); }
one_of() {  # is $1 one of the words (or patterns) that follow?
  local word
  # shellcheck disable=SC2053  # a pattern
  for word in "${@:2}"; do [[ $1 == $word ]] && return; done
  return 1
}

# The file of this tree that FILE includes as TARGET; nothing if it is none.
in_tree() {
  local file
  for file in "$(dirname "$1")/$2" "$2"; do
    file=${file#./}
    [[ $file != *./* ]] || file=$(realpath -m --relative-to=. "$file")
    if one_of "$file" "${files[@]}"; then echo "$file"; return; fi
  done
}

for file in "${files[@]}"; do
  [[ $file == *.cpp || -n ${may[${file%.hpp}]+there} ]] ||
    fault "$file:1: has no line in the table of tools/check_includes.sh"
done

include='^[[:space:]]*#[[:space:]]*include[[:space:]]*[<"]([^>"]+)[>"]'
while IFS=: read -r file line text; do
  [[ $text =~ $include ]] || continue
  target=${BASH_REMATCH[1]}
  if [[ $target =~ $gl_headers ]]; then
    # shellcheck disable=SC2086  # lists of words, here and below
    one_of "$file" $gl_users ||
      fault "$file:$line: includes $target, which only $gl_users may name"
    continue
  fi
  header=$(in_tree "$file" "$target")
  [ -n "$header" ] || continue
  name=${header%.hpp}
  if [[ $file == *.cpp ]]; then
    # shellcheck disable=SC2086
    ! one_of "$name" $drawing || one_of "$file" $drivers ||
      fault "$file:$line: includes $header, which is not below it"
  elif [ -n "${may[${file%.hpp}]+there}" ]; then
    # shellcheck disable=SC2086
    one_of "$name" ${may[${file%.hpp}]} ||
      fault "$file:$line: includes $header, which is not below it"
  fi
done < <(grep -nE "$include" /dev/null "${files[@]}")

[ "$faults" = 0 ]
