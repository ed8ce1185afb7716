"""Charts of panels by family: time against error, energy against time. Who is
cheapest at an error stands in a bar along the lower edge."""
import math

from panels import (BEHIND, DARK, GRAY, LETTER, Axis, Curve, Panel, Picture,
                    styles)
from results import (RULE, TRUSTED, Table, believed, by_method, contenders,
                     runs, winners)

FAMILIES = (("splitting", "splitting methods"),
            ("runge-kutta", "Runge-Kutta and Runge-Kutta-Nystroem"),
            ("implicit", "implicit and position-based"))
NORMS = {"rms position": "RMS error of the positions [m]",
         "center of mass and energy/(M g)":
         "error of center of mass and energy/(M g) [m]"}
STRIP = 20  # height of the bar of winners [pixels]
NARROW = 0.1  # what a title passes over [decades]


def digits(value):
    """1.34e-5 as 1.3e-5, 2e-3 as 2e-3."""
    return f"{float(f'{value:.1e}'):g}" if value >= 1 else (
        f"{value:.1e}".replace(".0e", "e").replace("e-0", "e-"))


def decades(low, high):
    """Tics at every other power of ten, and no others."""
    tics = range(math.ceil(math.log10(low)), math.floor(math.log10(high)) + 1)
    return "set xtics (" + ", ".join(
        f"'10^{{{k}}}' 1e{k}" for k in tics if k % 2 == 0) + ")"


def merged(of):
    """{method: runs} without methods that are another's double, and {method:
    label} that names them: with one step for all springs respa is verlet."""
    kept, labels = {}, {}
    for method, some in of.items():
        errors = {r.evaluations: r.error for r in some if r.ok}
        twin = next((m for m in kept if method == "respa" and 1 < sum(
            errors.get(r.evaluations) == r.error for r in kept[m])), None)
        if twin:
            labels[twin] += " = " + method
        else:
            kept[method], labels[method] = some, method
    return kept, labels


def curve_of(method, some, cost, style, label, x, coarsest):
    """Of one method's runs; failed ones stand left of the coarsest error, at
    the cost that they would have had. A run beyond the largest stable step
    that ended well is apart."""
    ok = believed(some)
    largest = [r for r in ok if 0 < r.share <= 1][:1]
    stable, beyond = ([(max(r.error, x.hi), cost(r)) for r in ok
                       if r.error < coarsest and (r.share > 1) == unstable]
                      for unstable in (False, True))
    rings = [(r.error, cost(r)) for r in largest]
    each = [cost(r) / r.evaluations for r in ok]
    failed = [(coarsest, r.evaluations * sum(each) / len(each))
              for r in some if not r.ok and each and x.lo > coarsest]
    return Curve(method, stable, style[0], style[1], label, rings, failed,
                 beyond)


def strip(picture, panel, segments, color_of):
    """The winners along the lower edge of a panel: (method, from, to). A name
    that has no room in its segment stands above it, if it has room there."""
    y, free, named = panel.bottom, [panel.left] * 2, set()
    for method, start, end in segments:
        x0 = max(panel.pixel((start, panel.y.lo))[0], panel.left)
        x1 = min(panel.pixel((end, panel.y.lo))[0], panel.right)
        if x1 <= x0:
            continue
        color, own = color_of(method)
        picture.box(x0 + 0.5, y + 2, max(x1 - 0.5, x0 + 1), y + STRIP - 4,
                    color, "front")
        half = len(method) * LETTER / 2
        middle = min(max((x0 + x1) / 2, panel.left + half),
                     panel.right - half)
        if own and 2 * half < x1 - x0:
            picture.text(middle, y + STRIP / 2 - 1, method, 10, "white",
                         "center", "noenhanced")
            named.add(method)
            continue
        row = next((k for k, at in enumerate(free) if middle - half >= at), 2)
        if own and row < 2 and x1 - x0 > 4 and method not in named:
            named.add(method)
            at = y + STRIP + 4 + 12 * row
            picture.text(middle, at, method, 10, color, "center",
                         "noenhanced")
            free[row] = middle + half
            panel.keep_free.append((middle - half, at - 6, middle + half,
                                    at + 6))


def orders(picture, panel, y):
    """Slope triangles of orders 1, 2, 4, 6 from the height y [pixels] on in
    the lower right corner, where no method can be: exact and cheap."""
    per_x = (panel.right - panel.left) / abs(math.log10(panel.x.hi /
                                                       panel.x.lo))
    per_y = (panel.top - panel.bottom) / math.log10(panel.y.hi / panel.y.lo)
    decades = min(0.45, 12 / per_x)
    x = panel.right - 6 * decades * per_x - 8
    top = y + decades * per_y
    for order in (1, 2, 4, 6):
        at = x + order * decades * per_x
        picture.line(x, y, at, top)
        picture.text(at, top + 7, str(order), 10, GRAY, "center")
    picture.line(x, y, x, top)
    picture.line(x, top, x + 6 * decades * per_x, top)
    picture.text(x + 6 * decades * per_x, y + 2, "order", 10, GRAY, "right")
    panel.keep_free.append((x - 4, y, panel.right, top + 14))


def row_of_panels(picture, groups, box, x, y, segments, color_of):
    """Panels in a row, cost against error, each to be drawn before the next
    one: groups is (title, curves, curves behind) for each; box the pixels
    left, bottom, right, top of all."""
    left, bottom, right, top = box
    gap = 14
    width = (right - left - gap * (len(groups) - 1)) / len(groups)
    for k, (title, curves, behind) in enumerate(groups):
        at = round(left + k * (width + gap))
        panel = Panel(at, bottom, round(at + width), top, x, y, title, curves,
                      behind)
        panel.keep_free.append((panel.left, panel.bottom, panel.right,
                                panel.bottom + STRIP))
        strip(picture, panel, segments,
              lambda m, own={c.name for c in curves}: color_of(m, own))
        yield panel


def message(segments):
    """Who is cheapest where, in words: of two methods, the widest segments."""
    wide = []
    for method, start, end in segments:
        if wide and wide[-1][0] == method:
            wide[-1][2] = end
        elif start / end >= 10 ** NARROW:
            wide.append([method, start, end])
    if not wide:
        return "No run is stable and above the reference's own error"
    if len(wide) == 1:
        return f"{wide[0][0]} is the cheapest at every error"
    most = sorted(wide, key=lambda s: s[2] / s[1])
    other = next(s for s in most if s[0] != most[0][0])
    words = []
    for segment in sorted((most[0], other), key=lambda s: -s[1]):
        method, start, end = segment
        words.append(f"{method} above {digits(end)} m" if segment == wide[0]
                     else f"{method} below {digits(start)} m"
                     if segment == wide[-1]
                     else f"{method} from {digits(start)} to {digits(end)} m")
    return f"Cheapest: {', '.join(words)}"


def failed_band(picture, panel, coarsest):
    """Failed runs stand left of every error: a column for a method."""
    edge = panel.pixel((coarsest, panel.y.lo))[0]
    picture.box(panel.left, panel.bottom, edge, panel.top, "#f6eeee")
    some = [c for c in panel.curves if c.failed]
    for line, words in enumerate(("failed",) if some else ("none", "failed")):
        picture.text((panel.left + edge) / 2, panel.top - 8 - 12 * line,
                     words, 10, "#aa4444", "center")
    panel.keep_free.append((panel.left, panel.bottom, edge, panel.top))
    for k, curve in enumerate(some):
        x = panel.x.lo * (coarsest / panel.x.lo) ** ((k + 0.5) / len(some))
        curve.failed = [(x, y) for _, y in curve.failed]


def work_precision(csv, out, scene):
    """Time against error for one scene, a panel for a family; some of its
    runs are believed."""
    table = Table(csv)
    some = runs(table.where(scene=scene))
    look = styles()
    of, labels = merged(by_method(some))
    floor, norm = some[0].floor, table.where(scene=scene)[0]["norm"]

    def seconds(run):
        return run.seconds
    good = believed([r for r in some if r.method in of])
    coarsest = 10 ** math.ceil(math.log10(min(
        max(r.error for r in good), 1)) + 0.1)
    x = Axis(coarsest * (coarsest / TRUSTED / floor) ** 0.16, TRUSTED * floor)
    least, most = (f(map(seconds, good)) for f in (min, max))
    y = Axis(least / 5, most * 2)
    curves = {m: curve_of(m, of[m], seconds, look[m], labels[m], x,
                          coarsest)
              for m in of}
    curves = {m: c for m, c in curves.items() if c.points}
    groups = []
    for family, title in FAMILIES:
        own = [c for m, c in curves.items()
               if look[m][2] == family]
        groups.append((title, own,
                       [c for c in curves.values() if c not in own]))
    segments = winners(contenders(some), seconds)
    about = table.note("scene " + scene).split("; error")[0]
    about = about.replace("; exact", "; against the exact solution")
    picture = Picture(out, 1000, 548, message(segments), "", table.footer())
    picture.text(20, 506, f"{scene}: {about}", 12, GRAY, more="noenhanced")
    picture.text(20, 487, "Lower is cheaper, further right more exact. Ring: "
                 "largest stable step; hollow, dotted: beyond it, where a run "
                 "ends well by luck. Gray curves: the other panels' methods.",
                 10, DARK)
    picture.text(20, 472, f"Bar at the bottom: {RULE}; gray: of another "
                 "panel.", 10, DARK)
    panels = row_of_panels(
        picture, groups, (72, 80, 930, 434), x, y, segments,
        lambda m, own: (look[m][0], True) if m in own else (BEHIND, False))
    picture.say(decades(x.hi, coarsest))
    # The same in force evaluations: what one of Verlet's takes.
    verlet = [r for r in of.get("verlet", []) if r.ok]
    each = min((r.seconds / r.evaluations for r in verlet), default=0)
    single = Table(csv.parent / "float_floor.csv").note(
        f"single precision floor {scene}") if (
            csv.parent / "float_floor.csv").exists() else ""
    for k, panel in enumerate(panels):
        low = max(box[3] for box in panel.keep_free) + 8
        failed_band(picture, panel, coarsest)
        nowhere(picture, panel, coarsest, [
            (m, of[m], look[m][0]) for m in of
            if look[m][2] == FAMILIES[k][0] and not any(r.ok for r in of[m])])
        orders(picture, panel, low)
        if single and float(single.split()[0]) > x.hi:
            at = panel.pixel((float(single.split()[0]), panel.y.lo))[0]
            picture.line(at, low, at, panel.top, "#999999", 1, 3)
            picture.text(at + 6, low + 4, "floats end here", 10, "#888888",
                         "left", "rotate by 90")
            panel.keep_free.append((at, low, at + 12, low + 100))
        settings = ["set format y ''", "unset ylabel", "unset y2tics",
                    "unset y2label", f"set xlabel '{NORMS[norm]}' "
                    "offset 0, 0.2"]
        if k == 0:
            settings[:2] = ["set format y '10^{%T}'",
                            "set ylabel 'time of a run [s]' offset 1, 0"]
            notes = ["verlet = respa: one step for all springs."]
            if "energy" in norm:
                notes.append("energy/(M g): the height to which it lifts "
                             "the cloth.")
            if "verlet = respa" not in labels.values():
                del notes[0]
            picture.text(20, 14, " ".join(notes), 10, DARK)
        elif k == len(groups) - 1 and each:
            settings += [
                f"set y2range [{y.lo / each:.6g}:{y.hi / each:.6g}]",
                "set logscale y2", "set y2tics out scale 0.5",
                "set format y2 '10^{%T}'",
                "set y2label 'in force evaluations of verlet' offset -1, 0"]
        picture.draw(panel, *settings)
    picture.finish()


def nowhere(picture, panel, coarsest, methods):
    """(method, runs, color) of methods that have no curve, in words."""
    x, y = panel.pixel((coarsest, panel.y.hi))
    for method, some, color in methods:
        finest = digits(min(r.dt for r in some))
        for text in (f"{method}: no step", f"down to {finest} s succeeded"):
            y -= 13
            picture.text(x + 8, y + 5, text, 10, color, more="noenhanced")
            panel.keep_free.append((x, y, x + 8 + LETTER * len(text), y + 12))


def energy(csv, out):
    """How far the energy has been off so far against time, a panel for a
    family."""
    table = Table(csv)
    look = styles()
    curves, worst = {}, {}
    for row in table.rows:
        m, t, off = row["method"], float(row["t"]), abs(float(row["energy"]))
        color, marker, _ = look[m]
        c = curves.setdefault(m, Curve(m, [], color, 0, m))
        if off > 0 and (not c.points or off > 1.05 * c.points[-1][1]):
            c.points.append((t, min(off, 20)))
        c.end, worst[m] = t, max(worst.get(m, 0), off)
        if row["status"] != "ok":
            c.label = m + " diverges"
    for c in curves.values():
        c.points.append((c.end, c.points[-1][1]))
    if {"respa", "verlet"} <= curves.keys() and (
            curves["respa"].points == curves["verlet"].points):
        del curves["respa"]
        curves["verlet"].label = "verlet = respa"
    about, _, rest = table.note("scene").partition("; ")
    words = []
    for who, pick, how, chosen in (
            ("splitting methods", max, " at most",
             lambda m: look[m][2] == "splitting"),
            ("rk4", max, "", lambda m: m == "rk4"),
            ("implicit ones and xpbd", min, " or more",
             lambda m: look[m][2] == "implicit")):
        off = [worst[m] for m in worst if chosen(m)]
        if off:
            words.append(f"{who} {pick(off):.2g} J{how}")
    picture = Picture(out, 1000, 456, "Energy error: " + ", ".join(words),
                      f"{about}: the true energy stays at 0 J. A curve: the "
                      "largest distance from it up to that time.",
                      table.footer())
    picture.text(20, 30, rest, 10)
    x, y = Axis(0, 6.8, False), Axis(1e-6, 300)  # names stand behind the end
    picture.say("set xtics 0, 1, 5")
    for k, (family, title) in enumerate(FAMILIES):
        own = [c for m, c in curves.items() if look[m][2] == family]
        panel = Panel(80 + 305 * k, 96, 375 + 305 * k, 376, x, y, title, own,
                      [c for c in curves.values() if c not in own],
                      at_end=True)
        picture.draw(panel, "set xlabel 'time [s]'", *(
            ["set format y '10^{%T}'", "set ylabel "
             "'largest error of the energy so far [J]'"]
            if k == 0 else ["set format y ''", "unset ylabel"]))
    picture.finish()
