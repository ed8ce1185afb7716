"""Tests of what the suite computes: limits, choices and figures, on made-up
runs with a known answer: python3 lab/advice/test_suite.py"""
import itertools
import math
import pathlib
import sys
import tempfile
import unittest
import unittest.mock

import questions
import suite
import trials

WIDTHS = [2 ** (k / 4) / 45 for k in range(6, -1, -1)]


class Limits(unittest.TestCase):
    def test_exact_for_each_order(self):
        for order in (0.5, 1, 2):
            answers = [[3 + 2 * h ** order, -h ** order] for h in WIDTHS]
            right, doubt = trials.extrapolate(WIDTHS, answers)
            self.assertAlmostEqual(right[0], 3)
            self.assertAlmostEqual(right[1], 0)
            self.assertLess(doubt, 1e-9)

    def test_finer_grids_keep_the_shape_of_cells(self):
        root = math.sqrt(2)
        self.assertEqual(trials.finer(((4, 6),), root), ((6, 9),))
        self.assertEqual(trials.finer(((10, 5), (5, 5)), root),
                         ((14, 7), (7, 7)))
        self.assertIsNone(trials.finer(((3, 2),), root))
        self.assertEqual(trials.finer(((3, 2),), 2), ((6, 4),))


def row(**changes):
    """A scene that is answered as well as can be."""
    return {k: str(v) for k, v in (dict.fromkeys(suite.COLUMNS, "") | dict(
        kind="pulled", tolerance=1, outcome="advised", predicted=0.5,
        uncertainty=0.1, real=0.45, half=0.4, next=0.4, twice=0.2,
        truth_error=0, work=100, best_work=100, best_error=0.9, own_work=1e9,
        advice_work=5e8)
        | changes).items()}


def missed(figures):
    return suite.missed(figures, {k: v[0] for k, v in suite.GOALS.items()})


class Figures(unittest.TestCase):
    def figures(self, *rows):
        return suite.rates([*rows] + [row()] * (100 - len(rows)))

    def test_each_goal_is_reached_and_can_be_missed(self):
        self.assertEqual(missed(self.figures()), [])
        bad = {
            "met": row(real=1.01), "robust": row(twice=1.01),
            "unbeaten": row(over_alone=1.6),
            "cheap": row(work=151), "fair": row(work=301),
            "within": row(real=0.7),
            "advised": row(outcome="refused"),
            "contradicted": row(outcome="refused", best_error=0.5),
            "price": row(advice_work=1.1e9)}
        self.assertEqual(set(bad), set(suite.GOALS))
        for goal, one in bad.items():
            with self.subTest(goal):
                self.assertIn(goal, missed(self.figures(*[one] * 60)))

    def test_a_run_that_fails_is_not_robust(self):
        f = self.figures(row(half="inf"), row(next="inf"))
        self.assertAlmostEqual(f["robust"], 98)
        f = self.figures(row(next=""))  # there is no such grid
        self.assertAlmostEqual(f["robust"], 100)


class Made(trials.Scene):
    """A scene whose runs are made up: error 1/n + 1/m^2 + (dt/limit)^2/100, and
    1/100 of the last by pefrl; limit 1/max(n, m)."""

    def __init__(self):
        super(trials.Scene, self).__init__("pulled")
        self.sides, self.cells = [(1, 1)], [(9, 9)]
        self.t_end = 8

    def start(self, cells):
        return [9.], 0, 1 / max(cells[0])

    def at(self, cells, method, steps):
        (n, m), = cells
        step = self.t_end / steps / self.start(cells)[2]
        if step > 1 and method == "verlet":
            return None
        error = 1 / n + 1 / m ** 2 + step ** 2 / (
            10000 if method == "pefrl" else 100)
        calls = steps * trials.EVALUATIONS.get(method, 99)
        return [error], 4 * n * m * calls, None


class Search(unittest.TestCase):
    def test_finds_the_cheapest_of_all(self):
        """Each side has its own grid: 8 by 6 cells in place of 8 by 8."""
        for tolerance in (0.4, 0.18, 0.1, 0.06, 0.035):
            s = Made()
            best = s.search([0.], tolerance, 1)
            assert best
            work, error, _ = best
            self.assertLessEqual(error, tolerance)
            least = math.inf
            for n, m in itertools.product(trials.LADDER, repeat=2):
                for method, share in trials.STEPS[:11]:
                    choice = ((n, m),), method, math.ceil(
                        8 * max(n, m) / share - 1e-9)
                    t = s.at(*choice)
                    if t and t[0][0] <= tolerance and 1 / 9 < m / n < 9 and (
                            s.robust(*choice, [0.], tolerance)):
                        least = min(least, t[1])
            self.assertEqual(work, least)

    def test_a_choice_by_accident_is_not_robust(self):
        """It meets the tolerance; the next grid doesn't."""
        s = Made()
        plain = s.at
        with unittest.mock.patch.object(s, "at", lambda cells, *rest: (
                ([0.], 1, None) if cells == ((2, 2),)
                else plain(cells, *rest))):
            best = s.search([0.], 0.18, 1)
        assert best
        self.assertGreater(best[0], 1)


FAKE = """#!{python} -SE
import math, sys
words = dict(zip(sys.argv[1:], sys.argv[2:] + ['']))
n, m = (int(k) - 1 for k in words['--sheet'].split()[-2:])
t_end = float(words['--t-end'])
if '--advise' in words:
    print({advice!r})
    sys.exit()
dt = 1e-3 if words['--dt'] == 'auto' else float(words['--dt'])
x = 0 if t_end < 1e-6 else 1 + 1 / (n * m) + 100 * dt ** 2
print((n + 1) * (m + 1), 'nodes,', 4 * n * m, 'edges')
print(f'dt = 1 s: 60 % of the stability limit ({{0.2 / n}} s, verlet)')
print('energy 1 J = 0.5 kinetic + 0.5 elastic')
print('work:', math.ceil(t_end / dt - 1e-9), 'force evaluations')
print('com:', x, '0 0 m at t = 1 s')
"""


class Judge(unittest.TestCase):
    """Of a ./cloth that answers 1 + 1/cells + 100 dt^2 [m]."""

    def setUp(self):
        self.seed = next(
            k for k in range(0, 1000, 3) for s in [questions.draw(k)]
            if (s.kind, s.measure) == ("undamped", "com") and s.share > 0.08)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def fake(self, advice):
        fake = self.folder / "fake"
        fake.write_text(FAKE.format(python=sys.executable, advice=advice))
        fake.chmod(0o755)
        return fake

    def advice(self, answer):
        return ("advice: 121 nodes, verlet, dt 0.01 s: error of com 0.02 m +- "
                "0.004 m (asked: 0.05 m)\n"
                "  ./cloth --sheet 'nodes 11 11' --t-end 1 --dt 0.01 --method "
                f"verlet\n  com by this run: {answer} 0 0 m\n\n"
                "the pilots took 1 s, 3e+07 spring evaluations of 4e+07")

    def test_of_an_advised_run(self):
        r = suite.judge(self.seed, self.fake(self.advice(1.02)), [])
        assert r
        self.assertEqual(
            [r[k] for k in ("outcome", "work", "advice_work", "predicted",
                            "uncertainty")],
            ["advised", 40000, "3e+07", "0.02", "0.004"])
        for name, error in (("real", 0.02), ("half", 0.0125), ("twice", 0.005),
                            ("next", 1 / 196 + 0.005)):
            self.assertAlmostEqual(float(r[name]), error, 3)
        self.assertLess(r["best_work"], r["work"])
        self.assertLessEqual(float(r["best_error"]), float(r["tolerance"]))

    def test_of_a_refusal(self):
        r = suite.judge(self.seed, self.fake("no advice: the budget ended"), [])
        assert r
        self.assertEqual((r["outcome"], r["real"]), ("refused", ""))
        self.assertGreater(r["best_work"], 0)
        self.assertEqual(suite.rates([r])["contradicted"], 100)


if __name__ == "__main__":
    unittest.main()
