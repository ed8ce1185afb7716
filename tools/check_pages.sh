#!/usr/bin/env bash
# Run the commands of the laboratory's pages, and of the teaching kit's: those
# of course/0.md in a starter, on the program that the page shows.
set -uo pipefail
cd "$(dirname "$0")/.." || exit

status=0
for page in lab/README.md lab/stability/README.md lab/scenes/README.md \
  docs/examples/README.md course/README.md; do
  echo "$page"
  tools/check_commands.sh "$page" || status=1
done

starter=$(mktemp -d)
trap 'rm -rf "$starter"' EXIT
in_starter() {
  make -s starter OUT="$starter/it" && cd "$starter/it" &&
    cp "$OLDPWD/tools/check_commands.sh" tools &&
    sed -n '/^```cpp$/,/^```$/p' pages/0.md | grep -v '^```' >lost.cpp &&
    env -u CXXFLAGS tools/check_commands.sh pages/0.md  # -g1 hides variables
}
echo course/0.md
if command -v gdb >/dev/null; then
  (in_starter) || status=1
else
  echo "skipped: course/0.md: gdb is missing"
fi
exit $status
