"""Names that a submission gives to what the assignment leaves open.

cloth.hpp takes them as macros, and knows the usual names without any.
"""

import re

import submission

GRAPH = re.compile(r"\busing\s+(\w+)\s*=\s*Graph\s*<"
                   r"|\btypedef\s+Graph\s*<[^;]*>\s*(\w+)\s*;")
USUAL_GRAPH = re.compile(r"\bGraphType\s*[=;]")
CLASS = re.compile(r"\b(?:struct|class)\s+(\w+)[^;{}()]*\{")
# The base of the first of these that has one.
BASES = {
    "KIT_FORCE_BASE": re.compile(
        r"\b(?:Gravity|MassSpring|Damping)Force\s*(?:final\s*)?:"
        r"\s*(?:public\s+)?(\w+)\s*\{"),
    "KIT_CONSTRAINT_BASE": re.compile(
        r"\b(?:Pin|Plane|Sphere)Constraint\s*(?:final\s*)?:"
        r"\s*(?:public\s+)?(\w+)\s*\{"),
}
CALL = re.compile(r"\boperator\s*\(\s*\)\s*\(")
REMOVAL = re.compile(r"\bremove_node\s*\(")
PROGRAM = {"mass_spring.hpp", "mass_spring.cpp"}
INCLUDED = re.compile(r'#\s*include\s*["<]mass_spring\.hpp[">]')
# What cloth.hpp looks for in any case.
USUAL = {"ZeroForce", "Force", "ZeroConstraint", "Constraint",
         "TearConstraint"}


def body(text, start):
    """What stands between a brace and its partner."""
    depth = 0
    for brace in re.finditer(r"[{}]", text[start:]):
        depth += 1 if brace[0] == "{" else -1
        if depth == 0:
            return text[start:start + brace.end()]
    return text[start:]


def needs_program(parts):
    """Is the cloth of main() all that there is? So it is where no function
    builds it, and where the program does not include the header."""
    return PROGRAM <= parts.keys() and (
        "build_cloth" not in "".join(parts.values())
        or not INCLUDED.search(parts["mass_spring.cpp"]))


def defines(files):
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
    tearing = [match[1] for match in CLASS.finditer(text)
               if CALL.search(inside := body(text, match.end() - 1))
               and REMOVAL.search(inside)]
    # Who changed the constraint of section 6 has no other.
    for name in sorted(tearing, key=lambda name: name == "SphereConstraint"):
        found.setdefault("KIT_TEAR", name)
    main = ("KIT_PROGRAM",) if needs_program(parts) else ()
    return main + tuple(f"{key}={name}" for key, name in sorted(found.items())
                        if name not in USUAL)
