"""Names that a submission gives to what the assignment leaves open.

cloth.hpp takes them as macros, and knows the usual names without any.
"""

import bisect
import re
from collections.abc import Iterator

import submission

# No gap of more than so many characters is looked through: else a line of
# 1 MB takes hours.
GAP = r"\s{0,100}"
GRAPH = re.compile(rf"\busing\s{GAP}(\w+){GAP}={GAP}Graph{GAP}<"
                   rf"|\btypedef\s{GAP}Graph{GAP}<[^;]{{0,300}}>"
                   rf"{GAP}(\w+){GAP};")
USUAL_GRAPH = re.compile(rf"\bGraphType{GAP}[=;]")
CLASS = re.compile(r"\b(?:struct|class)\s{1,100}(\w+)[^;{}()]{0,200}\{")
# The base of the first of these that has one.
BASE = rf"{GAP}(?:final{GAP})?:{GAP}(?:public\s{GAP})?(\w+){GAP}\{{"
BASES = {
    "KIT_FORCE_BASE": re.compile(
        rf"\b(?:Gravity|MassSpring|Damping)Force{BASE}"),
    "KIT_CONSTRAINT_BASE": re.compile(
        rf"\b(?:Pin|Plane|Sphere)Constraint{BASE}"),
}
NAMESPACE = re.compile(rf"\bnamespace\s{GAP}\w+{GAP}\{{")
CALL = re.compile(rf"\boperator{GAP}\({GAP}\){GAP}\(")
# A TearConstraint by another name.
NAMED_TEAR = re.compile(r"\b(?:using|typedef)\b[^;]{0,300}\bTearConstraint\b")
REMOVAL = re.compile(rf"\bremove_node{GAP}\(")
PROGRAM = {"mass_spring.hpp", "mass_spring.cpp"}
INCLUDED = re.compile(r'#\s*include\s*["<]mass_spring\.hpp[">]')
# The stages of main(), the last one first: the grader asks it for numbers.
STAGES = ("tear", "problem1", "diagonals", "forces", "constraints")
# Names that cloth.hpp always looks for.
USUAL = {"ZeroForce", "Force", "ZeroConstraint", "Constraint",
         "TearConstraint"}


def bodies(text: str) -> dict[int, int]:
    """{where a brace stands: the place behind its partner}"""
    open_ones, ends = [], {}
    for brace in re.finditer(r"[{}]", text):
        if brace[0] == "{":
            open_ones.append(brace.start())
        elif open_ones:
            ends[open_ones.pop()] = brace.end()
    return ends


def tearing(text: str) -> Iterator[str]:
    """The classes that are called and remove nodes."""
    ends = bodies(text)
    calls = [match.start() for match in CALL.finditer(text)]
    removals = [match.start() for match in REMOVAL.finditer(text)]

    def any_in(places, start, end):
        at = bisect.bisect(places, start)
        return at < len(places) and places[at] < end

    for match in CLASS.finditer(text):
        start = match.end() - 1
        end = ends.get(start, len(text))
        if any_in(calls, start, end) and any_in(removals, start, end):
            yield match[1]


def needs_program(parts: dict[str, str]) -> bool:
    """Is the cloth of main() all that there is? So it is where no function
    builds it, and where the program does not include the header."""
    return PROGRAM <= parts.keys() and (
        "build_cloth" not in "".join(parts.values())
        or not INCLUDED.search(parts["mass_spring.cpp"]))


def has_stages(parts: dict[str, str]) -> bool:
    """Is the program made from our starter, with all stages in one main()?"""
    return (PROGRAM <= parts.keys() and not needs_program(parts)
            and re.search(r"\bSTAGE\b", parts["mass_spring.cpp"]) is not None)


def defines(files: dict[str, bytes]) -> tuple[str, ...]:
    """-D words without their -D."""
    parts = {}
    for name in sorted(PROGRAM & files.keys(), reverse=True):    # header first
        parts[name] = submission.without_comments(
            files[name].decode("utf-8", "replace"))
    text = "\n".join(parts.values())
    found = {}
    graph = GRAPH.search(text)
    if graph and not USUAL_GRAPH.search(text):
        found["KIT_GRAPH"] = graph[1] or graph[2]
    for key, pattern in BASES.items():
        if base := pattern.search(text):
            found[key] = base[1]
    # A submission that replaced the constraint of section 6 has only that.
    if not NAMED_TEAR.search(text):
        for name in sorted(tearing(text),
                           key=lambda name: name == "SphereConstraint"):
            found.setdefault("KIT_TEAR", name)
    main: tuple[str, ...] = (
        ("KIT_PROGRAM",) if needs_program(parts) else ())
    if has_stages(parts):
        main += ("KIT_STAGES",)
    if NAMESPACE.search(text):
        main += ("KIT_NAMESPACES",)
    return main + tuple(f"{key}={name}" for key, name in sorted(found.items())
                        if name not in USUAL)
