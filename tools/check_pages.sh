#!/usr/bin/env bash
# Run the commands of the laboratory's pages.
set -uo pipefail
cd "$(dirname "$0")/.."

status=0
for page in lab/README.md lab/stability/README.md lab/scenes/README.md; do
  echo "$page"
  tools/check_commands.sh "$page" || status=1
done
exit $status
