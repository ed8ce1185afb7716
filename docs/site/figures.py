"""The live figures of the site: for each picture of course/pictures/draw.py
the cloths that it shows, and for each mistake the lines that it changes."""
import difflib
import json
import pathlib
import re
import shutil
import sys
import textwrap
from typing import Any

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "course" / room)
                for room in ("pictures", "kit", "web")]
import draw  # noqa: E402
import markers  # noqa: E402
import mistakes  # noqa: E402
import web  # noqa: E402

RIGHT = ("", "damped")  # what draw.py calls correct
LOOP = 4  # [s], how long a figure takes until it starts again
LINES = 9  # of code beside a figure
# explode.md: the code of 3.2 with its step [s] and speed, and the highest
# frequency [1/s] that the springs can have.
EXPLOSIONS = {
    "mass": {"chain": 2, "dt": 0.1, "highest": 200 ** 0.5},
    "chain": {"chain": 9, "dt": 0.025, "highest": 59.7, "speed": 0.5},
    "cloth": {"dt": 0.002, "highest": (8 * 100 * 625) ** 0.5, "speed": 0.4}}
for scene in EXPLOSIONS.values():
    scene |= {"wasm": ["right"], "stage": "problem1"}


def scenes() -> dict[str, dict[str, Any]]:
    """Each figure: its name, the page that it stands on, its cloths (the names
    of draw.py, the correct one first), its stage, and of each cloth its speed
    and its end [s]. What fails before the others have moved has its own."""
    found = {"docs/pictures/page.png": {
        "name": "drag", "page": "README.md", "cloths": ["damped"],
        "stage": "forces", "times": [[1, 8]]}}
    for name, panels in draw.PICTURES.items():
        page = "course/" + name.split("-")[0] + ".md"
        cloths = list(dict.fromkeys(mistake for mistake, *_ in panels))
        right = [c for c in cloths if c in RIGHT] or [""]
        wrong = [c for c in cloths if c not in RIGHT]
        drawn = {cloth: times[-1] for cloth, _, times, _ in panels}
        last = max(0.8, 1.3 * max(drawn.values()))
        ends = [last for _ in right] + [
            2.5 * drawn[c] if 5 * drawn[c] < last else last for c in wrong]
        found[f"course/pictures/{name}.png"] = {
            "name": name, "page": page, "cloths": right + wrong,
            "stage": panels[0][1],
            "times": [[float(f"{min(1, end / LOOP):.2g}"), round(end, 4)]
                      for end in ends]}
    return found


SCENES = scenes()


def scene_of(picture: str) -> dict[str, Any] | None:
    return SCENES.get(picture)


def title(cloth: str, scene: dict[str, Any]) -> str:
    """What the switch calls a cloth."""
    if all(c in RIGHT for c in scene["cloths"]):
        return cloth or "undamped"
    return "right" if cloth == scene["cloths"][0] else cloth


def diff(old: str, new: str) -> list[str]:
    """The lines that differ in the sources with two mistakes, with their
    neighbours if these are few."""
    out = []
    for file in markers.SOURCES:
        text = markers.solution(markers.path_of(file).read_text(), file)
        before, after = (mistakes.with_picture(text, file, mistake).splitlines()
                         for mistake in (old, new))
        lines = difflib.unified_diff(before, after, n=1, lineterm="")
        out += [line for line in list(lines)[2:]
                if line[1:].strip() and not line.startswith("@@")]
    return out


def changed(cloth: str) -> str:
    """What has to change in the code of a mistake to make it right, some of
    which is compared with drag: as lines of a diff."""
    lines = min((diff(cloth, right) for right in RIGHT[::-1]), key=len)
    if len(lines) > LINES:
        lines = [line for line in lines if line[0] != " "]
    body = textwrap.dedent("\n".join(line[1:] for line in lines)).split("\n")
    return "\n".join(f"{line[0]} {text}" for line, text in zip(lines, body))


def with_code(source: str, text: str) -> str:
    """The Markdown of a page, and after each picture of mistakes their
    code."""
    def add(match):
        scene = SCENES["course/" + match[1]]
        if source != scene["page"]:
            return match[0]
        out = match[0]
        for cloth in scene["cloths"][1:]:
            out += (f'\n\n<div class="edit" data-of="{scene["name"]}" '
                    f'data-name="{cloth}">\n\nThe mistake, {cloth} (-), '
                    "and the right code (+):\n\n"
                    f"```diff\n{changed(cloth)}\n```\n\n"
                    "</div>")
        return out
    return re.sub(r"!\[[^]]*\]\((pictures/[\w.-]*-mistakes\.png)\)", add, text)


def palette() -> str:
    """The colors of the figures, which are those of the site."""
    look = (ROOT / "course/web/look.css").read_text()
    rules = re.findall(r".*?\n}\n.*?\n}\n", look, re.S)[0]
    return rules.replace(".look {", ":root {")


def write(built: pathlib.Path, out: pathlib.Path) -> None:
    """The figures that are shown, from the folder where all are built, and
    scenes.js, which says what each shows. Code with a mistake is written as
    what it changes: in a tenth of the bytes."""
    out.mkdir(parents=True)
    shutil.copy(built / "figure.js", out)
    modules = {cloth: web.module_of((built / f"{web.slug(cloth)}.js")
                                    .read_text())
               for cloth in {c for scene in SCENES.values()
                             for c in scene["cloths"]} | set(RIGHT)}
    for cloth, wasm in modules.items():
        ways = [f"'{web.packed(wasm)}'"]
        for base in RIGHT[:RIGHT.index(cloth)] if cloth in RIGHT else RIGHT:
            ways.append(f"'{web.packed(web.changed(wasm, modules[base]))}', "
                        f"'{web.slug(base)}'")
        (out / f"{web.slug(cloth)}.js").write_text(
            f"figure.add('{web.slug(cloth)}', {min(ways, key=len)});\n")
    options = {scene["name"]: {
        "wasm": [web.slug(c) for c in scene["cloths"]],
        "names": [title(c, scene) for c in scene["cloths"]],
        "says": [mistakes.shows(c) for c in scene["cloths"]],
        "stage": scene["stage"], "times": scene["times"],
        "beside": True} for scene in SCENES.values()} | EXPLOSIONS
    (out / "scenes.js").write_text(
        "self.scenes = " + json.dumps(options, indent=1) + ";\n")
