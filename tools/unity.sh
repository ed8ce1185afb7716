#!/usr/bin/env bash
# One source of several:  tools/unity.sh FILE... >UNIT.cpp
# Headers and macros are read once, which halves the time to compile. Each
# test stands in a namespace of its own, so that their helpers may share names.
set -euo pipefail

echo "// Made by tools/unity.sh"
sed -nE '/^#(include|define [A-Z_]+ .*[^\\]$)/p' "$@" | awk '!seen[$0]++'
for file in "$@"; do
  name=${file##*/}
  case $file in
    tests/*) printf 'namespace %s {\n#include "%s"\n}\n' "${name%.*}" "$file" ;;
    *)       printf '#include "%s"\n' "$file" ;;
  esac
done
