#!/usr/bin/env bash
# Run the commands of the laboratory's pages, and of the teaching kit's: those
# of the course's pages in a starter (page 0) or a solution, on the programs that
# the pages show. EVERY=N takes one page in N, from number FIRST on.
set -uo pipefail
cd "$(dirname "$0")/.." || exit

status=0 place=0
# Is it this page's turn?
turn() { [ $((place++ % ${EVERY:-1})) = "${FIRST:-0}" ] && echo "$1"; }
for page in lab/README.md lab/stability/README.md lab/scenes/README.md \
  data/README.md docs/examples/README.md course/README.md course/teaching.md; do
  turn "$page" || continue
  tools/check_commands.sh "$page" || status=1
done

starter=$(mktemp -d)
trap 'rm -rf "$starter"' EXIT
in_copy() {  # starter|solution PAGE [LEVEL]; its program begins with its name
  local name
  name=$(sed -n 's|^// \([a-z]*\.cpp\).*|\1|p' "course/$2.md")
  local folder=$starter/$1${3:-}
  [ -d "$folder" ] || make -s "$1" LEVEL="${3:-}" OUT="$folder" || return
  cd "$folder" && cp "$OLDPWD/tools/check_commands.sh" tools &&
    sed -n '/^```cpp$/,/^```$/p' "pages/$2.md" | grep -v '^```' >"$name" &&
    env -u CXXFLAGS tools/check_commands.sh "pages/$2.md"  # -g1 hides variables
}
for page in 3.2 5.1 6.2; do
  turn "course/$page.md" || continue
  (in_copy solution "$page") || status=1
done
for level in open guided; do
  turn "course/0.md, $level" || continue
  if command -v gdb >/dev/null; then
    (in_copy starter 0 "$level") || status=1
  else
    echo "skipped: course/0.md: gdb is missing"
  fi
done
exit $status
