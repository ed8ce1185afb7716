#!/usr/bin/env bash
# Hold the README to the truth: it quotes example_graph.cpp as it is, every
# file that it names is there, and each of its commands runs;
# and so do those of docs/stability.md and docs/scenes.md.
set -euo pipefail
cd "$(dirname "$0")/.."

block() { sed -n "/^\`\`\`$1\$/,/^\`\`\`\$/p" README.md | grep -v '^```'; }

diff <(block cpp) example_graph.cpp ||
  { echo "README.md does not quote example_graph.cpp as it is"; exit 1; }

grep -oE '(\]\(|src=")[^)" ,#]+[)"#]' README.md docs/*.md CONTRIBUTING.md |
  sed -E 's/(\]\(|src=")//; s/[)"#]$//' | while IFS=: read -r page target; do
  case $target in
    http*) ;;
    *) [ -e "$(dirname "$page")/$target" ] ||
      { echo "$page names $target, which is not there"; exit 1; } ;;
  esac
done

# make check is what runs this, and has already run make deps.
block sh | grep -v '^make check$' | while IFS= read -r command; do
  echo "\$ $command"
  env -u DISPLAY -u WAYLAND_DISPLAY bash -c "$command" </dev/null
done
make -s example_graph && ./example_graph
tools/check_commands.sh docs/stability.md
tools/check_commands.sh docs/scenes.md
