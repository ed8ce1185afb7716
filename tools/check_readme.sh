#!/usr/bin/env bash
# Hold the README to the truth: each of its commands runs, and every file that
# it and the other pages name is there; docs/examples/README.md names its
# programs, lab/methods/README.md the plain steps, lab/fast/README.md the table
# of make speed; numbers are those of the CSVs.
set -euo pipefail
cd "$(dirname "$0")/.."

for program in docs/examples/*.cpp; do
  [[ $(<docs/examples/README.md) == *"(${program##*/})"* ]] ||
    { echo "docs/examples/README.md does not name $program"; exit 1; }
done

for step in $(sed -nE 's/^double (\w+_step)\(.*/\1/p' methods.hpp); do
  grep -qF "\`$step\`" lab/methods/README.md ||
    { echo "lab/methods/README.md does not name $step() of methods.hpp"; exit 1; }
done

results=lab/bench/results/amd-epyc-26-avx512
diff <(lab/charts/speed_table.py "$results") \
  <(sed -n '/^| ns a node =/,/^$/p' lab/fast/README.md | grep .) ||
  { echo "lab/fast/README.md does not quote $results as it is"; exit 1; }
python3 lab/charts/figures.py

# course/starter/README.md lies elsewhere: course/kit/test_markers.py looks.
mapfile -t pages < <(git ls-files '*.md' ':!course/starter/*')
grep -oE '(\]\(|src=")[^)" ,#]+[)"#]' "${pages[@]}" |
  sed -E 's/(\]\(|src=")//; s/[)"#]$//' | while IFS=: read -r page target; do
  case $target in
    http* | ../../deployments/github-pages | *../../releases/latest) ;;
    *) [ -e "$(dirname "$page")/$target" ] ||
      { echo "$page names $target, which is not there"; exit 1; } ;;
  esac
done
tools/check_commands.sh README.md
