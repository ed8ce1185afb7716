#!/usr/bin/env bash
# Gradescope runs this once, when it builds the image of an assignment:
# setup.sh [ROOT], where ROOT/source is what the zip held.
set -euo pipefail
root=${1:-/autograder}
cd "$root/source"

tools/deps.sh grade
python3 course/kit/once.py

# A submission runs as nobody: of all this it reads the data of the tests.
chmod -R go-r .
chmod -R go+rX course/tests/data
