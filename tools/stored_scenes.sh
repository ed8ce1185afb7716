#!/usr/bin/env bash
# Print the scenes of data/scenes as C++: lab/scenes/StoredScenes.hpp
set -euo pipefail
cd "$(dirname "$0")/.."

list() {  # FUNCTION FILE...: it returns the files as a list
  echo "static const StoredScene list_of_$1[] = {"
  for file in "${@:2}"; do
    printf '{"%s", R"toml(%s)toml", R"toml(%s\n)toml"},\n' \
      "$(basename "$file" .toml)" "$(sed -n '1s/^# //p' "$file")" "$(<"$file")"
  done
  echo "};"
  echo "std::span<const StoredScene> $1() { return list_of_$1; }"
}
echo '#include "lab/scenes/StoredScenes.hpp"'
echo 'namespace lab {'
list stored_scenes data/scenes/*.toml
list failing_scenes data/scenes/failures/*.toml
echo '}  // namespace lab'
