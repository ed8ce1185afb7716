#!/usr/bin/env bash
# Check what can be seen without compiling, in all files that git tracks or
# would add: programs, sizes, layout, words, pictures, and unfinished work.
#   tools/check_tree.sh lines   prints the lines that each room has, too
set -euo pipefail
cd "$(dirname "$0")/.."

longest_graph=630  # lines of Graph.hpp
longest=500        # lines of any other header or program
longest_test=900   # lines of a test
widest=800         # pixels of a picture
largest=150000     # bytes of a chart

faults=$(mktemp)
trap 'rm -f "$faults"' EXIT

# The files of these patterns, one a line; those deleted but not yet
# committed are left out.
files() {
  git ls-files -co --exclude-standard -- "$@" | sort -u |
    while IFS= read -r file; do [ ! -f "$file" ] || echo "$file"; done
}
mapfile -t sources < <(files '*.hpp' '*.cpp')
mapfile -t programs < <(files ':(glob)*.cpp')
mapfile -t scripts < <(files '*.py' '*.js' '*.css' '*.html')
mapfile -t code < <(files ':!course/words/*' '*.hpp' '*.cpp' '*.py' '*.sh' '*.gp' \
  '*.mk' '*.toml' '*.js' '*.css' '*.html' '*.yml' Makefile course/starter/Makefile .ci/run)
mapfile -t texts < <(printf '%s\n' "${code[@]}"; files '*.md')
[ ${#sources[@]} != 0 ] || { echo "no sources here"; exit 1; }

# Lines of FILES that match, as FILE:LINE: WHAT.
lines() {  # WHAT GREP-OPTIONS PATTERN FILES...
  LC_ALL=C grep -Hn "$2" "$3" "${@:4}" /dev/null |
    sed -E "s/^([^:]+:[0-9]+):.*/\1: $1/" >>"$faults" || true
}

is_program='^(int|auto) main *\(|^ *BENCHMARK_MAIN\(|LLVMFuzzerTestOneInput'
is_test='^ *(TEST|TEST_F|TEST_P|TYPED_TEST|TYPED_TEST_P|RC_GTEST_[A-Z_]+)\('
for file in ${programs[@]+"${programs[@]}"}; do
  grep -qE "$is_program" "$file" ||
    { [[ $file == test_* ]] && grep -qE "$is_test" "$file"; } ||
    echo "$file:1: is no program: it has no main() and no test"
done >>"$faults"

for file in "${sources[@]}" ${scripts[@]+"${scripts[@]}"}; do
  limit=$longest
  [ "$file" != Graph.hpp ] || limit=$longest_graph
  [[ $file != *test_* ]] || limit=$longest_test
  count=$(wc -l <"$file")
  [ "$count" -le "$limit" ] ||
    echo "$file:$limit: goes on to line $count; the limit is $limit"
done >>"$faults"

# The tree may not grow: who adds takes away. tools/most_lines has the sum of
# what was landed last; whoever lands fewer lines writes the new sum there.
# A room is a folder of lab/, or another one of the root.
rooms=$(files . | grep -E '\.(cpp|hpp|py|js|md|toml|sh|mk|html|css)$|(^|/)Makefile$' |
  tr '\n' '\0' | xargs -0 grep -c '' /dev/null | sed -E '1d
    s#^([^/]*):#./\1:#; s#^(lab/[^/]*|[^/]*)/.*:#\1 #' |
  awk '{ n[$1] += $2; n["sum"] += $2 } END { for (r in n) print n[r], r }' |
  sort -n)
[ "${1:-}" != lines ] || echo "$rooms"
sum=$(sed -n 's/ sum$//p' <<<"$rooms") most=$(cat tools/most_lines)
[ "$sum" -le "$most" ] ||
  echo "tools/most_lines:1: the tree has $sum lines, more than $most" >>"$faults"

# [O] and the like: so that this file does not find itself.
lines "is left unfinished" -wE 'TOD[O]|FIXM[E]|XX[X]' "${code[@]}"
lines "is never compiled" -E '^[[:space:]]*#[[:space:]]*if +(0|false)\b' \
  "${sources[@]}"
# A sentence is subject, verb, object; many a riddle begins so.
lines "begins a sentence with Of, Who or What" -E \
  '(//|\*|#) ?(O[f]|Wh[o]|Wha[t]) (the|a|what|which|it|is|was|those|no) ' \
  "${code[@]}"
lines "is longer than 80 columns" -E '^.{81}' "${sources[@]}" \
  ${scripts[@]+"${scripts[@]}"}
lines "has a character that is not ASCII" -P '[^\x00-\x7F]' "${code[@]}"
lines "ends in white space" -E '[[:space:]]$' "${texts[@]}"

# Charts are SVG. The width of a PNG is its bytes 16 to 19.
while IFS= read -r file; do
  [[ $file != */results/* ]] || echo "$file:1: is a chart, but no SVG"
  width=$(od -An -tu4 --endian=big -j16 -N4 "$file")
  [ "$width" -le "$widest" ] ||
    echo "$file:1: is wider than $widest pixels: tools/shrink_pictures.sh"
done < <(files '*.png') >>"$faults"

while IFS= read -r file; do
  size=$(stat -c %s "$file")
  [ "$size" -le "$largest" ] ||
    echo "$file:1: has $size bytes; the limit is $largest"
done < <(files '*.svg') >>"$faults"

# The layout is that of clang-format 14; others differ in places.
formatter=$(command -v clang-format-14 || command -v clang-format) ||
  { echo "clang-format is missing: make deps"; exit 1; }
[[ $("$formatter" --version) == *"version 14."* ]] || {
  echo "skipped: layout: clang-format is not version 14"
  formatter=true
}
layout=$("$formatter" --dry-run -Werror "${sources[@]}" 2>&1) || {
  violation='^([^:]+:[0-9]+):.*clang-format-violations.*'
  sed -nE "s/$violation/\1: is not laid out: make format/p" <<<"$layout" |
    sort -u | grep . || echo "clang-format:1: $layout"
} >>"$faults"

sort -t: -k1,1 -k2,2n "$faults"
[ ! -s "$faults" ]
