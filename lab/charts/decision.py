"""The chart to look at first: a scene and the error that is wanted say which
method, which step, and how long a run takes."""
import re
import textwrap
from collections import Counter

from panels import DARK, GRAY, Picture, styles
from results import RULE, TRUSTED, Table, cheapest, contenders, runs

KINDS = (("linear", ("chain", "curtain")),
         ("cloth in free motion", ("grid1-short", "grid1", "grid0")),
         ("stiff cloth", ("stiff",)),
         ("contact", ("drape", "tear")))
WANTED = [10.0 ** -k for k in range(2, 10)]  # [m]
LEFT, CELL, ROW = 224, 96, 54  # [pixels]


def milliseconds(seconds):
    """0.00123 as 1.2 ms."""
    return f"{float(f'{1e3 * seconds:.2g}'):g} ms"


def plain(value):
    """1e-5, not 1e-05."""
    return f"{value:.0e}".replace("e-0", "e-")


def lighter(color, share=0.72):
    """A color mixed with so much white."""
    parts = [int(color[k:k + 2], 16) for k in (1, 3, 5)]
    return "#" + "".join(f"{round(c + (255 - c) * share):02x}" for c in parts)


def decision(csv, out):
    """A row for a scene, a column for an error; neighbors with one answer
    share a cell."""
    table, look = Table(csv), styles()
    known = {row["scene"]: runs(table.where(scene=row["scene"]))
             for row in table.rows}
    answers = {scene: answers_of(some) for scene, some in known.items()}
    kinds = [(kind, [s for s in scenes if s in known])
             for kind, scenes in KINDS]
    kinds = [(kind, scenes) for kind, scenes in kinds if scenes]
    height = 120 + ROW * sum(len(s) for _, s in kinds) + 12 * len(kinds)
    picture = Picture(
        out, LEFT + CELL * len(WANTED) + 8, height, message(answers),
        "", table.footer())
    picture.text(20, height - 42, f"A cell: {RULE}.", 11)
    y = height - 84
    picture.text(LEFT - 10, y + 12, "wanted error [m]:", 11, DARK, "right")
    for k, wanted in enumerate(WANTED):
        picture.text(LEFT + CELL * (k + 0.5), y + 12, plain(wanted), 12,
                     DARK, "center")
    for kind, scenes in kinds:
        y -= 12
        for scene in scenes:
            y -= ROW
            about = table.note("scene " + scene).split(";")[0]
            picture.text(20, y + 38, f"{kind}: {scene}", 11, DARK)
            # A number stays with its unit.
            about = re.sub(r"(\d) (s|N/m)\b", "\\1\u00a0\\2", about)
            for line, words in enumerate(textwrap.wrap(about, 38)):
                picture.text(20, y + 23 - 12 * line, words, 9, GRAY)
            cells(picture, y, answers[scene], look)
    picture.text(20, 14, "Error: RMS of the positions; with contact, of "
                 "center of mass and energy as a height.", 10)
    picture.say("unset border", "unset tics", "set xrange [0:1]",
                "set yrange [0:1]", "plot NaN")
    picture.finish()


def answers_of(some):
    """The cheapest run for each wanted error; None below the reference's."""
    return [cheapest(wanted, contenders(some), lambda run: run.seconds)
            if wanted >= TRUSTED * some[0].floor else None
            for wanted in WANTED]


def message(answers):
    """The method that answers most often, without contact and with it."""
    words = []
    for contact in (False, True):
        chosen = [run.method for kind, scenes in KINDS
                  if (kind == "contact") == contact for scene in scenes
                  for run in answers.get(scene, []) if run]
        if chosen:
            method, count = Counter(chosen).most_common(1)[0]
            words.append(f"{method}{'' if words else ' is the cheapest'} for "
                         f"{count} of the {len(chosen)} errors "
                         f"{'with' if contact else 'without'} contact")
    return ", ".join(words)


def cells(picture, y, answers, look):
    """A row of the table."""
    first = 0
    while first < len(WANTED):
        end = first
        while end < len(WANTED) and answers[end] == answers[first]:
            end += 1
        x0, x1 = LEFT + CELL * first, LEFT + CELL * end
        run, first = answers[first], end
        if not run:
            picture.text((x0 + x1) / 2, y + ROW / 2,
                         "below the reference's error"
                         if x1 - x0 > CELL else "unknown", 9, "#aaaaaa",
                         "center")
            continue
        picture.box(x0 + 1, y + 2, x1 - 1, y + ROW - 2,
                    lighter(look[run.method][0],
                            0.88 if look[run.method][2] == "implicit" else 0.7))
        step = (f"step {milliseconds(run.dt)}" if run.dt
                else f"tolerance {plain(run.tolerance)} m")
        for line, words in enumerate((f"{{/:Bold {run.method}}}", step,
                                      f"run {milliseconds(run.seconds)}")):
            picture.text((x0 + x1) / 2, y + 41 - 14 * line, words, 9,
                         "#111111", "center")
