#!/usr/bin/env bash
# Look up every name that a page quotes in `backticks` (functions, classes,
# tests, files, targets of make, options) and every function() in a comment of
# C++. A name that is nowhere in the code is reported as FILE:LINE. Blocks of
# commands are left to check_commands.sh.
set -euo pipefail
cd "$(dirname "$0")/.."
exec python3 - <<'END'
import re
import subprocess
import sys
from pathlib import Path

EXCEPTIONS = {"Add", "Mul",           # of Google Highway
              "usleep", "SDL_WaitEventTimeout",  # of POSIX, of SDL
              "Sanitizers",           # words of a debugger's message
              "--install", "--args",  # of wsl and xcode-select, of gdb
              "web.html",             # what make web writes
              ".github/workflows/tests.yml"}  # in a class's repository
CODE = "hpp cpp py sh js html mk toml gp txt yml sbatch".split()
CALL = re.compile(r"\w+\(\)")
COMMENT = re.compile(r"/\*.*?\*/|(?<!:)//[^\n]*", re.S)
QUOTED = re.compile(
    rf"(?P<file>(?<!\w)[\w./-]*\w\.(?:{'|'.join(CODE)}|md|csv)(?!\w))|"
    r"(?<![\w-])(?P<option>--[a-z][\w-]+)|\bmake (?P<target>[a-z][\w-]+)|"
    r"(?<![\w./$*-])(?P<name>(?:\w+(?:::|\.))*[A-Za-z]\w+)(?P<call>\(?)")

files = [f for f in map(Path, subprocess.run(
    ["git", "ls-files", "-co", "--exclude-standard"], text=True,
    capture_output=True, check=True).stdout.splitlines()) if f.is_file()]
paths = "".join(f"/{f}\n" for f in files)
words, called, spans = set(), set(), []  # called: not by tests alone
for f in files:
    found, text = {f.stem}, ""
    if f.suffix[1:] in CODE or f.name == "Makefile":
        text = f.read_text()
        if f.suffix in (".hpp", ".cpp", ".js"):
            if f.parts[0] != "tests":
                spans += [(f, text, set(), m) for c in COMMENT.finditer(text)
                          for m in CALL.finditer(text, *c.span())]
            text = COMMENT.sub(" ", text)
        found |= set(re.findall(r"\w+(?:-\w+)*|\"[a-z][\w-]+\"", text) +
                     re.findall(r"--[a-z][\w-]+|\w+", text))
    elif f.suffix == ".md" and f.name != "CHANGELOG.md":
        text, shown = f.read_text(), set()
        for block in re.findall(r"^```.*?^```$", text, flags=re.S | re.M):
            shown |= set(re.findall(r"\w+(?:\.cpp)?", block))
            text = text.replace(block, re.sub(r"[^\n]", " ", block))
        text = re.sub(r"^> .*", "", text, flags=re.M)  # what programs print
        spans += [(f, text, shown, m) for m in re.finditer(r"`[^`]+`", text)]
    words |= found
    called |= found if f.parts[0] != "tests" else set()


def known(token, shown):
    """Is a match of QUOTED in the code, or in @a shown, the page's blocks?"""
    if f := token["file"]:  # or made by a build, or of any NAME
        return (re.match(r"build/|(.*[/_])?[A-Z]+\.\w+$", f) or f in shown or
                "/" + re.sub(r"^(\.\./)+", "", f) + "\n" in paths)
    if option := token["option"]:  # of a program, or a key of a scene
        return option in words or f'"{option[2:]}"' in words
    if token["target"]:
        return token["target"] in words
    special = token["call"] or re.search(r"[A-Z]\w*[a-z]|_|::", token["name"])
    return not special or re.split(r"::|\.", token["name"])[-1] in shown | (
        called if token["call"] else words)


faults = 0
for f, text, shown, span in spans:
    for token in QUOTED.finditer(span[0]):
        name = token[0].rstrip("(")
        if name not in EXCEPTIONS and not known(token, shown):
            line = text.count("\n", 0, span.start()) + 1
            print(f"{f}:{line}: {name} is nowhere in the code")
            faults = 1
sys.exit(faults)
END
