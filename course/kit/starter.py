"""Make what a student starts from, or the same tree solved:

    OUT=DIR [LEVEL=guided] python3 course/kit/starter.py starter|solution

OUT must be new or empty; it appears whole or not at all. The same sources give
the same bytes. At the level open, the usual one, students design what the level
guided gives them: the graph's storage, the contracts of removal, the base
classes of forces and constraints, and the classes that own several of them.
"""
import json
import os
import pathlib
import re
import shutil
import sys
import tempfile
from collections.abc import Collection

import markers
import pages
import tasks

# Globs in the repository -> the folder of the starter, and what stays out.
COPIED = [
    ("LICENSE", ".", ""),
    ("CME212/*.hpp CME212/*.mk", "CME212", ""),
    ("test_nodes.cpp test_edges.cpp", ".", ""),
    ("CME212/viewer/*.hpp CME212/viewer/*.cpp", "CME212/viewer", ""),
    ("data/grid*.nodes data/grid*.tets", "data", "grid4.nodes grid4.tets"),
    ("data/README.md", "data", ""),
    ("docs/graph.md", "docs", ""),
    ("course/*.md", "pages", "README.md elsewhere.md teaching.md"),
    ("course/pictures/*.png course/pictures/*.svg", "pages/pictures", ""),
    ("course/starter/Makefile course/starter/README.md", ".", ""),
    ("course/starter/tests.mk", "tests", ""),
    ("tools/submit.sh tools/deps.sh", "tools", ""),
    ("course/web/*.?pp course/web/*.js course/web/*.css course/web/*.html "
     "course/web/web.*", "web", "positions.cpp"),
]
TESTS = "course/tests"
# Left out at the level open.
GUIDED = ("CME212/SlotMap.hpp", "docs/graph.md")
WORKFLOW = "course/starter/tests.yml"
# In code: a comment, unless it has the numbers already, and text of a figure.
SAID = re.compile(r"^ *(?:// |/?\*|#)(?!.*(?:YOUR CODE|TASK\(|@file)).*"
                  r"|'[^'\n]*'", re.MULTILINE)
Files = dict[str, tuple[bytes, bool]]   # path: content, is it a program?


class StarterError(Exception):
    pass


def tree(kind: str, level: str = "guided") -> Files:
    """The files of a starter or a solution."""
    root = tasks.ROOT
    texts, course = markers.load()
    if wrong := pages.check(course):
        raise StarterError("\n".join(wrong))
    files: Files = {}

    def add(path, content, program=False):
        if isinstance(content, str):
            content = content.encode()
        files[path] = (content, program)

    for file, text in texts.items():
        add(file, markers.starter(text, course, file, level)
            if kind == "starter" else markers.solution(text, file))
    for globs, folder, but in COPIED:
        for glob in globs.split():
            for path in sorted(root.glob(glob)):
                if path.name not in but.split():
                    add(os.path.normpath(f"{folder}/{path.name}"),
                        path.read_bytes(), path.suffix == ".sh")
    for path in sorted((root / TESTS).rglob("*")):
        name = path.relative_to(root / TESTS).as_posix()
        if path.is_file() and not is_unasked(name, course):
            text = path.read_text(encoding="utf-8")
            for task in course.tasks.values():
                for before in ('TASK("', "@file "):
                    text = text.replace(before + task.id, before + task.shown)
            add(tasks.numbered(f"tests/{name}", course.numbers), text)
    add("tests/tasks.inc", table_of(course))
    add("tests/hints", "".join(f"{task.shown}\t{hint}\n" for task in
                               course.tasks.values() for hint in task.hints))
    add(".starter", f"{course.starter}\n")
    add(".gitignore", (root / "course/starter/gitignore").read_bytes())
    add(".github/workflows/tests.yml", (root / WORKFLOW).read_bytes())
    if level == "open":
        for name in GUIDED:
            del files[name]
        add("Graph.hpp", markers.starter(markers.open_graph(course), course))
    for name, (content, program) in files.items():
        if name.endswith((".hpp", ".cpp", ".js", ".mk", "Makefile")):
            add(name, SAID.sub(lambda said: tasks.numbered(
                said[0], course.numbers), content.decode()), program)
            content = files[name][0]
        if name.endswith((".md", ".sh", "Makefile")):
            text = pages.named(pages.translated(pathlib.Path(name).name,
                                                content.decode(), course),
                               course)
            if name.endswith(".md"):
                text = pages.filled(pages.of_level(text, level), course)
                text = without_dead_links(text, name, files)
            if name == "README.md":
                text = re.sub("^# .*", lambda _: f"# {course.title}", text)
            add(name, text, program)
    return files


def without_dead_links(text: str, path: str, files: Collection[str]) -> str:
    """The page `text` with the words alone of each link into this repository
    that leads to nothing in a starter."""
    def words_or_link(match):
        target = os.path.normpath(
            os.path.join(os.path.dirname(path), match[2].split("#")[0]))
        there = target == path or target in files or any(
            name.startswith(target + "/") for name in files)
        outside = match[2].startswith(("http:", "https:", "#"))
        return match[0] if there or outside else match[1]

    return re.sub(r"(?<!!)\[([^][]*)\]\(([^()\s]+)\)", words_or_link, text)


def is_unasked(test: str, course: tasks.Course) -> bool:
    """Does a test serve only tasks that were dropped?"""
    name = test.removesuffix(".cpp")
    return name in course.dropped and not any(
        name in task.tests for task in course.tasks.values())


def table_of(course: tasks.Course) -> str:
    """The tasks as a C++ program reads them."""
    lines = ["// X(id, title, points, says): the tasks, as the course has "
             "them."]
    for task in course.tasks.values():
        texts = [json.dumps(text) for text in (
            task.shown, task.title, task.says)]
        lines.append(f"X({texts[0]}, {texts[1]}, {task.points},\n  {texts[2]})")
    return "\n".join(lines) + "\n"


def place(out: str) -> pathlib.Path:
    """The folder to write.  Throws StarterError unless it is new or empty."""
    if not out:
        raise StarterError("OUT is missing: make starter OUT=DIR, a folder "
                           "that is new or empty")
    path = pathlib.Path(os.path.realpath(out))
    if path.exists() and not path.is_dir():
        raise StarterError(f"OUT is '{out}', which is a file, expected a "
                           "folder that is new or empty")
    if path.is_dir() and any(path.iterdir()):
        raise StarterError(f"OUT is '{out}', which is not empty, expected a "
                           "folder that is new or empty; nothing was written")
    return path


def write(files: Files, path: pathlib.Path) -> None:
    """All of `files` in the folder `path`, or nothing."""
    path.parent.mkdir(parents=True, exist_ok=True)
    beside = pathlib.Path(tempfile.mkdtemp(prefix=f".{path.name}-",
                                           dir=path.parent))
    try:
        for name, (content, program) in files.items():
            file = beside / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(content)
            file.chmod(0o755 if program else 0o644)
        beside.chmod(0o755)
        beside.rename(path)
    except BaseException:
        shutil.rmtree(beside, ignore_errors=True)
        raise


def main(arguments: list[str]) -> None:
    if len(arguments) != 1 or arguments[0] not in ("starter", "solution"):
        sys.exit("usage: OUT=DIR starter.py starter|solution")
    kind, level = arguments[0], os.environ.get("LEVEL") or "open"
    try:
        path = place(os.environ.get("OUT", ""))
        if level not in pages.LEVELS:
            raise StarterError(f"LEVEL is '{level}', expected guided or open")
        files = tree(kind, level if kind == "starter" else "guided")
        write(files, path)
    except (StarterError, tasks.TasksError, markers.MarkerError) as error:
        sys.exit(str(error))
    except OSError as error:
        sys.exit(f"{error.filename}: {error.strerror}; nothing was written")
    print(f"{kind}: {len(files)} files in {path}")


if __name__ == "__main__":
    main(sys.argv[1:])
