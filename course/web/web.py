#!/usr/bin/env python3
"""The cloth as a web page.

    web.py page OUT.html STAGE   make web [DIR=DIR]: of the Graph.hpp and
                                 mass_spring.hpp of DIR, or the folder in which
                                 it runs; it shows this stage first
    web.py figures OUT [NAME...] make web-figures: figure.js, and NAME.js for
                                 the solution (right) and each mistake of
                                 course/pictures/draw.py

A folder may be a stranger's: its files are compiled in the grader's jail, and
include nothing but each other and what the course hands out. Needs clang++ and
a C++ library for WebAssembly: make web-deps. Exit status: 0 done, 1 the code
does not compile, 2 something is missing or refused."""
import base64
import concurrent.futures
import difflib
import gzip
import hashlib
import itertools
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Mapping

ROOM = pathlib.Path(__file__).resolve().parent
KIT = ROOM.parents[1] / "course/kit"    # a starter has none, and no jail
HEADERS = (KIT.parents[1] if KIT.is_dir() else ROOM.parent) / "CME212"
sys.path.append(str(KIT))
BadInput: type[Exception] = OSError
if KIT.is_dir():
    import once
    import submission
    import units
    BadInput = submission.BadInput
SOURCES = ("cloth.cpp", "thrown.cpp")
# Newer versions of clang want another name of the target, older ones this one.
FLAGS = """--target=wasm32-wasi -Wno-deprecated -std=c++20 -O2 -g0 -Wall -Wextra
  -ffp-contract=off -fno-math-errno -fno-finite-loops
  -D_LIBCPP_HARDENING_MODE=_LIBCPP_HARDENING_MODE_DEBUG
  -mexec-model=reactor -Wl,--no-entry -Wl,--stack-first
  -Wl,-z,stack-size=1048576 -Wl,--max-memory=1073741824
  -Wl,--export=__stack_pointer""".split()
# Names that stage forces and those after it need.
FROM_5_ON = ("GravityForce MassSpringForce make_combined_force PinConstraint "
             "PlaneConstraint SphereConstraint TearConstraint "
             "make_combined_constraints").split()
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)


def compiler() -> str:
    """The newest clang++ that has what WebAssembly needs at run time."""
    if os.environ.get("WASM_CXX"):
        return os.environ["WASM_CXX"]
    found = sorted(pathlib.Path("/usr/lib").glob(
        "llvm-*/lib/clang/*/lib/wasi"), key=lambda path: [
            int(a) for a in re.findall(r"\d+", str(path))])
    if not found:
        print("make web: clang++ for WebAssembly is missing; this installs it: "
              "make web-deps", file=sys.stderr)
        sys.exit(2)
    return str(found[-1].parents[3].with_name("bin") / "clang++")


def command(out: pathlib.Path, folders: Iterable[str | pathlib.Path],
            shim: pathlib.Path, *more: str) -> list:
    """Compiles the sources in the folders into the module `out`."""
    names = set(re.findall(r"\bpage_\w+", "".join(
        (ROOM / name).read_text() for name in SOURCES)))
    return [compiler(), *FLAGS, *more, *(f"-I{f}" for f in folders),
            *(f"-Wl,--export={name}" for name in sorted(names)), "-include",
            ROOM / "wasi.hpp", "-o", out, shim, ROOM / "thrown.cpp"]


def compiled(files: dict[str, bytes], *more: str) -> bytes | None:
    """The module of a stranger's files: its bytes; None if they do not compile,
    which the compiler has said then.  Throws BadInput."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        source, made = folder / "room/source", folder / "room/built"
        out, include = made / "cloth.wasm", folder / "include"
        include.mkdir()
        (include / "CME212").symlink_to(HEADERS)
        words = command(out, [source, include], ROOM / "cloth.cpp", *more)
        if KIT.is_dir():
            home = pathlib.Path(
                os.path.realpath(shutil.which(words[0]) or "/usr/bin/")).parent
            try:
                unit = units.Sources(  # type: ignore[attr-defined]
                    once.Kit.only_jail(), folder / "room", files,
                    [ROOM, HEADERS, include, home], ()).compiled(words)
            except once.KitError as error:
                raise BadInput(str(error)) from None
            said, right, refused = unit.output, unit.right, unit.refused
        else:
            made.mkdir(parents=True)
            for name, text in files.items():
                (source / name).parent.mkdir(parents=True, exist_ok=True)
                (source / name).write_bytes(text)
            done = subprocess.run(words, cwd=source, text=True,
                                  stderr=subprocess.PIPE)
            said, right, refused = (
                done.stderr.replace(f"{source}/", ""), out.exists(), "")
        if refused:
            raise BadInput(refused)
        print(said, end="", file=sys.stderr)
        return out.read_bytes() if right else None


def packed(wasm: bytes) -> str:
    return base64.b64encode(gzip.compress(wasm, 9, mtime=0)).decode()


def module_of(text: str) -> bytes:
    """What a file of write_figures() holds."""
    return gzip.decompress(base64.b64decode(
        re.findall(r"', '(.*)'", text)[0]))


def changed(wasm: bytes, base: bytes) -> bytes:
    """A module as JSON: parts that it has from its base, as [start, end], and
    parts of its own, in base64. A part ends where WebAssembly has its `end`."""
    old, new = (re.findall(rb"[^\x0b]*\x0b|[^\x0b]+$", code)
                for code in (base, wasm))
    starts = [0, *itertools.accumulate(map(len, old))]
    parts: list[list[int] | str] = []
    for kind, i, j, k, l in difflib.SequenceMatcher(
            None, old, new, autojunk=False).get_opcodes():
        if kind == "equal":
            parts.append([starts[i], starts[j]])
        elif k < l:
            parts.append(base64.b64encode(b"".join(new[k:l])).decode())
    return json.dumps(parts, separators=(",", ":")).encode()


def script() -> str:
    """figure.js: all of a figure but its modules."""
    def text(*names):
        return "\n".join((ROOM / name).read_text() for name in names)

    return ("(() => {\n"
            f"const look = {json.dumps(text('look.css'))};\n"
            f"const workerSource = {json.dumps(text('wasm.js', 'worker.js'))};"
            "\n" + text("view.js", "plot.js", "hand.js", "picture.js",
                        "figure.js") + "\n})();\n")


def inlined(page: pathlib.Path, made: Mapping[str, str]) -> str:
    """A page with the text of each style and script that it names by href or
    src (of scripts, several): of `made`, else of its folder. So it needs no
    server: a browser lets a page that is opened as a file load no other."""
    def text(names):
        return "\n".join(made.get(name) or (page.parent / name).read_text()
                         for name in names.split())
    html = re.sub(r'<link rel="stylesheet" href="([^"]+)">',
                  lambda found: f"<style>\n{text(found[1])}</style>",
                  page.read_text())
    return re.sub(r'<script([^>]*?)\s+src="([^"]+)"></script>', lambda found:
                  f"<script{found[1]}>{text(found[2])}</script>", html)


def write_page(out: str, stage: str) -> int:
    here = pathlib.Path(os.environ.get("DIR") or ".")
    if KIT.is_dir():
        taken = submission.take_file(here / "mass_spring.hpp", "Graph.hpp")
        files, flags = taken.files, submission.to_look_at(taken.flags)
    else:
        files, flags = {path.relative_to(here).as_posix(): path.read_bytes()
                        for path in here.glob("*.hpp")}, []
    words = set(re.findall(r"\w+", "".join(
        COMMENT.sub(" ", text.decode("utf-8", "replace"))
        for text in files.values())))
    stages = 5 if words.issuperset(FROM_5_ON) else 2
    wasm = compiled(files, f"-DWEB_STAGES={stages}")
    if wasm is None:
        return 1
    html = inlined(ROOM / "page.html", {
        "figure.js": script(), "cloth.js":
        f"figure.add('cloth', '{packed(wasm)}')"}).replace(
        'data-stage="STAGE"', f'data-stage="{stage}"', 1)
    pathlib.Path(out).write_text(html)
    print(f"{out}: {len(html)} bytes; open it in a browser, or send it")
    print("\n".join(flags), end="\n" * bool(flags))
    return 0


# ------------------------------------------------------------------- Figures

def slug(mistake: str) -> str:
    """The name of the module with a picture's mistake, or with none."""
    return mistake.replace(" ", "-").replace("+-", "plus-").replace(
        "=-", "") or "right"


def write_figures(folder_name: str, names: list[str]) -> bool:
    root = ROOM.parents[1]
    import markers
    import mistakes
    known = {slug(name): name for name in ["", *mistakes.pictured()]}
    if unknown := set(names) - set(known):
        sys.exit(f"there is no {', '.join(sorted(unknown))}; there are "
                 + ", ".join(known))
    out = pathlib.Path(folder_name)
    out.mkdir(parents=True, exist_ok=True)
    (out / "figure.js").write_text(script())
    common = "".join(path.read_text() for path in sorted(
        [*ROOM.glob("*.?pp"), *root.glob("CME212/*.hpp"),
         root / "CME212/viewer/Faces.hpp", ROOM / "web.py"])) + compiler()

    def write(name):
        texts = {file: mistakes.with_picture(
            markers.solution(markers.path_of(file).read_text(), file), file,
            known[name]) for file in markers.SOURCES}
        texts["cloth.cpp"] = mistakes.with_picture(
            (ROOM / "cloth.cpp").read_text(), "mass_spring.cpp", known[name])
        mark = "// " + hashlib.sha256(
            (common + "".join(texts.values())).encode()).hexdigest() + "\n"
        file = out / f"{name}.js"
        if file.exists() and file.read_text().startswith(mark):
            return True
        with tempfile.TemporaryDirectory() as folder:
            for path, text in texts.items():
                pathlib.Path(folder, path).write_text(text)
            wasm = pathlib.Path(folder, "cloth.wasm")
            if subprocess.run(command(
                    wasm, [folder, root], pathlib.Path(folder, "cloth.cpp"),
                    "-Wl,--strip-all")).returncode:
                return False
            content = packed(wasm.read_bytes())
        file.write_text(f"{mark}figure.add('{name}', '{content}');\n")
        print(f"{file}: {file.stat().st_size} bytes", flush=True)
        return True

    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        return not all(pool.map(write, names or known))


def main(arguments: list[str]) -> int:
    if arguments[:1] == ["page"] and len(arguments) == 3:
        try:
            return write_page(*arguments[1:])
        except BadInput as error:
            print(f"make web: {error}", file=sys.stderr)
            return 2
    if arguments[:1] == ["figures"] and len(arguments) > 1:
        return write_figures(arguments[1], arguments[2:])
    sys.exit("usage: web.py page OUT.html STAGE | figures OUT [NAME...]")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
