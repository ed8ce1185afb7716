"""Tests of what charts say: who is the fastest at an error, in the bars of
work and precision and in the cells of the decision chart; their colors:
python3 lab/charts/test_charts.py"""
import math
import random
import re
import unittest
from dataclasses import replace
from itertools import chain, combinations

import decision
import panels
import peers
from results import (COARSE, ROOT, TRUSTED, Run, Table, cheapest,
                     runs, tied, winners)

FLOOR = 1e-12


def run(method, error, seconds, evaluations=0, share=0.5):
    """A run; one that takes longer has more force evaluations."""
    return Run(method, 0.01, 0, share, evaluations or seconds, seconds, error,
               FLOOR, True)


def seconds(some):
    return some.seconds


def some_runs(source):
    """Random runs of three methods, the errors not always falling."""
    found = []
    for method in ("a", "b", "c"):
        error, cost = 10 ** source.uniform(-3, -1), source.uniform(1, 5)
        for _ in range(source.randint(1, 8)):
            found.append(run(method, error, cost,
                             share=source.choice((0.3, 0.9, 1, 1.9))))
            error *= 10 ** source.uniform(-1, 0.1)
            cost *= source.uniform(1.2, 2)
    return found


def by_the_rule(error, some):
    """The method that cheapest() names, found by its words in turn."""
    fit = []
    for one in some:
        finer = [r for r in some if r.method == one.method and r.share <= 1 and
                 r.seconds >= one.seconds]
        if one.share <= 1:
            kept = max([r.error for r in finer] + [TRUSTED * FLOOR])
            if kept <= error:
                fit.append((kept, one))
    if not fit:
        return None
    least = min(r.seconds for _, r in fit)
    return min((kept, r.method) for kept, r in fit
               if least >= 0.9 * r.seconds)[1]


def winner_at(error, segments):
    return next(m for m, start, end in segments if start >= error >= end)


class Rule(unittest.TestCase):
    def test_a_run_keeps_its_own_error_and_no_smaller_one(self):
        some = [run("a", 1e-3, 1), run("b", 1e-5, 5)]
        self.assertEqual(cheapest(1e-3, some, seconds).method, "a")
        self.assertEqual(cheapest(0.999e-3, some, seconds).method, "b")
        self.assertIsNone(cheapest(0.999e-5, some, seconds))

    def test_within_ten_percent_the_most_exact_one(self):
        for cost, wins in ((1.11, "b"), (1.12, "a")):
            some = [run("a", 1e-3, 1), run("b", 1e-5, cost)]
            self.assertEqual(cheapest(1e-2, some, seconds).method, wins)

    def test_finer_runs_must_keep_it_too(self):
        some = [run("a", 1e-6, 1), run("a", 1e-4, 2), run("b", 1e-5, 9)]
        self.assertEqual(cheapest(1e-4, some, seconds).method, "a")
        self.assertEqual(cheapest(0.99e-4, some, seconds).method, "b")

    def test_none_beyond_the_largest_stable_step(self):
        for share, wins in ((1, "a"), (1.01, "b")):
            some = [run("a", 1e-3, 1, share=share), run("b", 1e-3, 2)]
            self.assertEqual(cheapest(1e-2, some, seconds).method, wins)

    def test_bars_follow_the_rule_at_every_error(self):
        for seed in range(200):
            some = some_runs(random.Random(seed))
            segments = winners(some, seconds)
            if not segments:
                self.assertIsNone(by_the_rule(COARSE, some))
                continue
            for (_, _, end), (_, start, _) in zip(segments, segments[1:]):
                self.assertEqual(end, start)
            top, last = segments[0][1], segments[-1][2]
            for k in range(101):
                error = min(top, max(last, top * (last / top) ** (k / 100)))
                self.assertEqual(winner_at(error, segments),
                                 by_the_rule(error, some), (seed, error))

    def test_no_bar_without_a_stable_run(self):
        self.assertEqual(winners([run("a", 1e-3, 1, share=2)], seconds), [])


class Measured(unittest.TestCase):
    """What the charts say of work_precision.csv."""
    scenes: dict = {}

    @classmethod
    def setUpClass(cls):
        table = Table("lab/charts/results/work_precision.csv")
        cls.scenes = {scene: runs(table.where(scene=scene))
                      for scene in dict.fromkeys(r["scene"]
                                                 for r in table.rows)}

    def test_cells_follow_the_rule_of_the_bars_by_work(self):
        compared = 0
        for scene, some in self.scenes.items():
            segments = winners(some, decision.work)
            for wanted, chosen in zip(decision.WANTED,
                                      decision.answers_of(some)):
                if chosen and segments[0][1] >= wanted:
                    self.assertEqual(winner_at(wanted, segments),
                                     chosen.method, (scene, wanted))
                    compared += 1
        self.assertGreater(compared, 40)

    def test_noise_of_time_changes_no_cell(self):
        source = random.Random(1)
        for some in self.scenes.values():
            noisy = [replace(r, seconds=r.seconds * source.uniform(0.5, 2))
                     for r in some]
            for a, b in zip(decision.answers_of(some),
                            decision.answers_of(noisy)):
                self.assertEqual(a and (a.method, a.dt), b and (b.method, b.dt))

    def test_ties_are_named(self):
        some = [run("a", 1e-3, 100), run("b", 1e-4, 109), run("c", 1e-4, 120)]
        self.assertEqual(cheapest(1e-2, some, seconds).method, "b")
        self.assertEqual(tied(1e-2, some, seconds), ["a"])
        self.assertEqual(tied(2e-4, some, seconds), ["c"])
        self.assertEqual(tied(1e-5, some, seconds), [])


class Libraries(unittest.TestCase):
    """Ours costs error^-1/2, the library's a power of its own."""
    OURS = [run("a", 1e-3, 1), run("a", 1e-5, 10)]

    def test_where_a_library_leads_most(self):
        theirs = [run("gsl-b", 1e-3, 1.2), run("gsl-b", 1e-5, 5)]
        share, error, method = peers.advantage(self.OURS + theirs, seconds)
        self.assertEqual(method, "gsl-b")
        self.assertLess(abs(math.log10(error / 1e-5)), 0.06)
        self.assertAlmostEqual(share, 0.5, delta=0.01)

    def test_a_library_that_never_leads(self):
        theirs = [run("gsl-b", 1e-3, 1.01), run("gsl-b", 1e-5, 10.1)]
        self.assertEqual(peers.advantage(self.OURS + theirs, seconds)[0], 0)

    def test_a_library_is_its_best_method_where_it_reaches_the_error(self):
        theirs = [run("cvode-b", 1e-3, 4), run("arkode-c", 1e-3, 2),
                  run("arkode-c", 1e-5, 30), run("gsl-d", 1e-3, 3)]
        for error, wanted in ((1e-3, {"SUNDIALS": 2, "GSL": 3}),
                              (1e-5, {"SUNDIALS": 3})):
            found = peers.factors(error, self.OURS + theirs, seconds)
            self.assertEqual(found.keys(), wanted.keys())
            for who, factor in wanted.items():
                self.assertAlmostEqual(found[who], factor, places=6)

    def test_a_run_without_a_time_has_no_curve_of_time(self):
        theirs = [run("gsl-b", error, 0, 9) for error in (1e-3, 1e-5)]
        self.assertEqual(peers.factors(1e-4, self.OURS + theirs, seconds), {})


class Pictures(unittest.TestCase):
    pictures: dict[str, str] = {}

    @classmethod
    def setUpClass(cls):
        found = chain(ROOT.glob("lab/*/results/**/*.svg"),
                      ROOT.glob("course/pictures/*.svg"))
        cls.pictures = {path.name: path.read_text() for path in found}

    def test_texts_have_11_pixels_where_a_picture_has_800(self):
        self.assertGreater(len(self.pictures), 10)
        for name, svg in self.pictures.items():
            width = float(re.findall('viewBox="0 0 ([0-9.]+)', svg)[0])
            least = min(map(float, re.findall(
                r'font: (?:bold |700 )?([0-9.]+)px', svg)))
            self.assertGreaterEqual(least * 800, 11 * width, name)

    def test_no_picture_is_dated_or_without_a_dark_mode(self):
        for name, svg in self.pictures.items():
            self.assertNotIn("dc:date", svg, name)
            self.assertIn("prefers-color-scheme: dark", svg, name)


def luminance(color):
    """[red, green, blue], linear."""
    parts = (int(color[k:k + 2], 16) / 255 for k in (1, 3, 5))
    return [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4
            for c in parts]


# How who lacks a kind of cones sees linear red, green and blue: Machado,
# Oliveira, Fernandes 2009, https://doi.org/10.1109/TVCG.2009.113.
SIGHT = {"normal": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
         "protan": ((0.152286, 1.052583, -0.204868),
                    (0.114503, 0.786281, 0.099216),
                    (-0.003882, -0.048116, 1.051998)),
         "deutan": ((0.367322, 0.860646, -0.227968),
                    (0.280085, 0.672501, 0.047413),
                    (-0.01182, 0.04294, 0.968881))}


def seen(color, sight):
    """CIE L*a*b* of a color."""
    r, g, b = (min(1, max(0, sum(map(math.prod, zip(row, luminance(color))))))
               for row in SIGHT[sight])
    x, y, z = (t ** (1 / 3) if t > 0.008856 else 7.787 * t + 4 / 29 for t in (
        (0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.95047,
        0.2126 * r + 0.7152 * g + 0.0722 * b,
        (0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.08883))
    return 116 * y - 16, 500 * (x - y), 200 * (y - z)


class Colors(unittest.TestCase):
    """Of the methods' cards: distances in L*a*b*; 2 is just seen."""
    LOOK = panels.styles()

    def apart(self, one, other, sight):
        return math.dist(*(seen(self.LOOK[m][0], sight)
                           for m in (one, other)))

    def test_all_differ(self):
        for pair in combinations(self.LOOK, 2):
            self.assertGreater(self.apart(*pair, "normal"), 20, pair)

    def test_those_of_a_dash_differ_for_the_color_blind(self):
        for one, other in combinations(self.LOOK, 2):
            if self.LOOK[one][1] == self.LOOK[other][1]:
                for sight in SIGHT:
                    self.assertGreater(self.apart(one, other, sight), 15,
                                       (one, other, sight))

    def test_all_can_be_read_on_white(self):
        for method, (color, family) in self.LOOK.items():
            r, g, b = luminance(color)
            light = 0.2126 * r + 0.7152 * g + 0.0722 * b
            self.assertGreater(1.05 / (light + 0.05), 3, method)
            self.assertIn(family, panels.DASHES)


if __name__ == "__main__":
    unittest.main()
