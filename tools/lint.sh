#!/usr/bin/env bash
# What shellcheck, pyflakes and mypy find in scripts, and public functions of
# Python without type hints. Modules of a folder import each other by name, so
# mypy takes the folders one by one.
set -uo pipefail
cd "$(dirname "$0")/.." || exit

for tool in shellcheck pyflakes3 mypy; do
  command -v $tool >/dev/null ||
    { echo "skipped: lint: $tool is missing: make deps"; exit 0; }
done
mapfile -t python < <(git ls-files '*.py')
mapfile -t shell < <(git ls-files '*.sh' .ci/run)
status=0
shellcheck -x -S warning "${shell[@]}" || status=1
pyflakes3 "${python[@]}" || status=1
while read -r folder; do
  mypy --no-error-summary --cache-dir build/mypy --ignore-missing-imports \
    --check-untyped-defs --disallow-incomplete-defs "$folder"/*.py || status=1
done < <(printf './%s\n' "${python[@]}" | sed 's|/[^/]*$||' | sort -u)

python3 - "${python[@]}" <<'END' || status=1
import ast
import pathlib
import sys

bare = []
for name in sys.argv[1:]:
    if pathlib.Path(name).name.startswith("test_"):
        continue
    for holder in ast.walk(ast.parse(pathlib.Path(name).read_text())):
        if isinstance(holder, (ast.Module, ast.ClassDef)):
            bare += [f"{name}:{f.lineno}: {f.name}() has no type hints"
                     for f in holder.body if isinstance(f, ast.FunctionDef) and
                     f.name[0] != "_" and not f.returns]
print("\n".join(bare))
sys.exit(bool(bare))
END
exit $status
