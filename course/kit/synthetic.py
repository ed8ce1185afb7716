"""Make a class of clones:  python3 course/kit/synthetic.py DIR NUMBER [HW]

Students are right, wrong, late, empty, hostile, and move their tags, by turns;
the same NUMBER gives the same repositories. The deadline that they know is DUE.
"""

import pathlib
import sys

import child
import dates
import kit_check

DUE = "2026-03-08 01:30 -0800"
WRONG = "remove_node(it) is written anew and forgets the edges"
STEP = "a step: half a kick, a drift, half a kick"  # right, with more forces
TOUCH = "/tmp/kit-cheat"
CHEAT = ("#include <cstdlib>\n"
         f'static const int x = std::system("touch {TOUCH}");\n')


def contents() -> dict[str, dict[str, str]]:
    """{what: files} of those that differ."""
    cases = kit_check.Cases()
    wrong = {case.name: case.files for case in
             (*cases.wrong("graph"), *cases.wrong("step"))}
    graph = {"Graph.hpp": cases.solution["Graph.hpp"]}
    return {"right": cases.solution, "starter": {
                "Graph.hpp": cases.base("starter")["Graph.hpp"]},
            "wrong": {"Graph.hpp": wrong[f"graph: {WRONG}"]["Graph.hpp"]},
            "half": graph | {"mine.hpp": wrong[f"step: {STEP}"]["mine.hpp"]},
            "broken": {"Graph.hpp": graph["Graph.hpp"] + "}\n"},
            "cheat": {"Graph.hpp": graph["Graph.hpp"] + CHEAT},
            "empty": {"notes.txt": "nothing yet\n"}}


# What; seconds from the deadline to the commit, and to an annotated tag (None:
# a lightweight one, "": none); the zone of the student's clock.
KINDS = [
    ("right", -3600, -60, "-0800"),
    ("wrong", 0, 0, "+0000"),
    ("right", 1, None, "-0800"),            # late by a second
    ("empty", -9000, -9000, "-0800"),
    ("right", -9000, 86399, "+0545"),       # the last second of a day's delay
    ("starter", -86400, -86400, "-0800"),
    ("cheat", -60, None, "+1400"),
    ("right", -60, "", "-0800"),            # handed in nothing
    ("half", -60, 86401, "-1200"),       # a day and a second
    ("broken", -60, -120, "-0800"),         # a tag from before its commit
    ("right", -7200, None, "+0530"),
    ("link", -60, -60, "-0800"),            # Graph.hpp is a symbolic link
]


def stream(what: str, files: dict[str, str], committed: int,
           tagged: int | str | None, zone: str, tag: str) -> str:
    """The repository as git fast-import reads it."""
    def data(text):
        return f"data {len(text.encode())}\n{text}\n"

    def person(role, seconds):
        return f"{role} A Student <a@b> {seconds} {zone}\n"

    parts = ["commit refs/heads/main\n", person("committer", committed),
             data("my homework")]
    for name, text in files.items():
        parts += [f"M 100644 inline {name}\n", data(text)]
    if what == "link":
        parts += ["M 120000 inline Graph.hpp\n", data("/etc/passwd")]
    if tagged is None:
        parts.append(f"reset refs/tags/{tag}\nfrom refs/heads/main\n\n")
    elif tagged != "":
        parts += [f"tag {tag}\nfrom refs/heads/main\n",
                  person("tagger", tagged), data("")]
    return "".join(parts)


def make(folder: str | pathlib.Path, number: int, tag: str = "hw2") -> None:
    folder, due = pathlib.Path(folder), int(dates.deadline(DUE).timestamp())
    files = contents()
    for student in range(number):
        what, commit, tagged, zone = KINDS[student % len(KINDS)]
        there = folder / f"student{student:03}"
        there.mkdir(parents=True)
        child.run(["git", "init", "-q", there], check=True)
        child.run(["git", "-C", there, "fast-import", "--quiet"], check=True,
                  text=True, input=stream(
                      what, files.get(what, {}), due + commit,
                      due + tagged if isinstance(tagged, int) else tagged,
                      zone, tag))
        if what in ("cheat", "link"):   # hostile settings, too
            for name in ("core.fsmonitor", "core.pager", "gpg.program",
                         "filter.x.smudge"):
                child.run(["git", "-C", there, "config", name,
                           f"touch {TOUCH}"], check=True)
            child.run(["git", "-C", there, "config", "log.showSignature",
                       "true"], check=True)


if __name__ == "__main__":
    make(sys.argv[1], int(sys.argv[2]), *sys.argv[3:])
