"""The chart to look at first: a scene and the error that is wanted say which
method, and what it costs. Counted work decides, so no noise does."""
from __future__ import annotations

import itertools
import re
import textwrap
from collections import Counter
import pathlib
from typing import Any

from panels import DARK, GRAY, Picture, digits, styles
from results import TRUSTED, Run, Table, cheapest, runs, tied

KINDS = (("linear", ("chain", "curtain")),
         ("cloth in motion", ("grid1-short", "grid1", "grid0", "large")),
         ("stiff cloth", ("stiff", "mixed", "graded", "settles")),
         ("contact", ("drape", "slide", "tear")))
WANTED = [10.0 ** -k for k in range(2, 10)]  # [m]
ROUGH = 1e-3  # the smallest of the errors that a title calls rough [m]
LEFT, CELL, ROW = 164, 79, 58  # [pixels]
SHORT = {"symplectic-euler": "symp. euler",
         "mollified-impulse": "impulse",
         "implicit-euler": "impl. euler"}


def times(run: Run) -> str:
    """The least and the median time of a run, as 1.2-1.5 ms or 380-490 us."""
    scale, unit = (1e3, "ms") if run.median >= 1e-3 else (1e6, "us")
    low, high = (f"{float(f'{scale * t:.2g}'):g}"
                 for t in (run.seconds, run.median))
    return f"{low}{'-' + high if high != low else ''} {unit}"


def lighter(color: str, share: float = 0.7) -> str:
    """A color mixed with so much white."""
    parts = [int(color[k:k + 2], 16) for k in (1, 3, 5)]
    return "#" + "".join(f"{round(c + (255 - c) * share):02x}" for c in parts)


def work(run: Run) -> float:
    return run.work


def decision(csv: pathlib.Path, out: pathlib.Path) -> None:
    """A row for a scene, a column for an error; neighbors with one answer
    share a cell, whose color is that of the method."""
    table, look = Table(csv), styles()
    known = {row["scene"]: runs(table.where(scene=row["scene"]))
             for row in table.rows}
    answers = {scene: answers_of(some) for scene, some in known.items()}
    kinds = [(kind, [s for s in scenes if s in known])
             for kind, scenes in KINDS]
    kinds = [(kind, scenes) for kind, scenes in kinds if scenes]
    height = 164 + ROW * sum(len(s) for _, s in kinds) + 22 * len(kinds)
    picture = Picture(out, LEFT + CELL * len(WANTED) + 4, height,
                      message(answers), "", "")
    for line, words in enumerate((
            "A color: the method that keeps this error with the least work, as "
            "do all of its finer runs; in it, that work and its time.",
            "A band below: another method within 10 % of that work. Work: "
            "force evaluations, and solves by their instructions.")):
        picture.text(20, height - 42 - 15 * line, words, 11)
    y = height - 92
    picture.text(LEFT - 10, y + 8, "wanted error [m]:", 12, DARK, "right")
    for k, wanted in enumerate(WANTED):
        picture.text(LEFT + CELL * (k + 0.5), y + 8, digits(wanted), 12, DARK,
                     "center")
    for kind, scenes in kinds:
        y -= 22
        picture.text(20, y + 7, kind, 11, DARK, bold=True)
        for scene in scenes:
            y -= ROW
            about = table.note("scene " + scene).split(";")[0]
            picture.text(20, y + ROW - 12, scene, 11, DARK)
            # A number stays with its unit.
            about = re.sub(r"(\d) (s|N/m)\b", "\\1\u00a0\\2", about)
            for line, words in enumerate(textwrap.wrap(about, 21)):
                picture.text(20, y + ROW - 26 - 13 * line, words, 11, GRAY)
            cells(picture, y, known[scene], answers[scene], look)
    for line, words in enumerate((
            "Error: RMS of the positions; of settles and with contact, of "
            "center of mass and energy as a height.",
            "Time: the least of seven runs, and the median. "
            + table.footer(), table.note("besides"))):
        picture.text(20, 40 - 15 * line, words, 11)
    picture.finish()


def answers_of(some: list[Run]) -> list[Any]:
    """The run of least work for each wanted error; None below the
    reference's."""
    return [cheapest(wanted, some, work)
            if wanted >= TRUSTED * some[0].floor else None
            for wanted in WANTED]


def message(answers: dict[str, list[Any]]) -> str:
    """What to take, for three questions: the method that answers most."""
    words = []
    for what, contact, fits in (
            ("to 1 mm", False, lambda e: e > 0.99 * ROUGH),
            ("finer", False, lambda e: e < 0.99 * ROUGH),
            ("with contact", True, lambda e: True)):
        chosen = [run.method for kind, scenes in KINDS
                  if (kind == "contact") == contact for scene in scenes
                  for wanted, run in zip(WANTED, answers.get(scene, []))
                  if run and fits(wanted)]
        if chosen:
            words.append(f"{what} {Counter(chosen).most_common(1)[0][0]}")
    return "Least work: " + ", ".join(words)


def cells(picture: Picture, y: float, some: list[Run],
          answers: list[Any], look: dict[str, tuple[str, str]]) -> None:
    """A row of the table: the name of a method where its color begins."""
    keys = [(run, tied(wanted, some, work) if run else [])
            for wanted, run in zip(WANTED, answers)]
    left = LEFT
    for run, group in itertools.groupby(answers, lambda r: r and r.method):
        right = left + CELL * len(list(group))
        if run:
            picture.box(left + 0.5, y + 2, right - 0.5, y + ROW - 2,
                        lighter(look[run][0]))
        picture.text((left + right) / 2, y + ROW - (15 if run else ROW / 2),
                     SHORT.get(run, run) if run else "unknown"
                     if right - left <= 2 * CELL else
                     "below the reference's error", 11,
                     "#111111" if run else GRAY, "center", bold=bool(run))
        left = right
    left = LEFT
    for (run, others), group in itertools.groupby(keys):
        right = left + CELL * len(list(group))
        if run:
            picture.box(left - 0.5, y + 2, left + 0.5, y + ROW - 22, "white")
            for k, other in enumerate(others):
                share = (right - left - 1) / len(others)
                picture.box(left + 0.5 + k * share, y + 2,
                            left + 0.5 + (k + 1) * share, y + 8,
                            lighter(look[other][0], 0.3))
            for line, words in enumerate((f"{run.work:,.0f}", times(run))):
                picture.text((left + right) / 2, y + ROW - 29 - 13 * line,
                             words, 11, "#111111", "center")
        left = right
