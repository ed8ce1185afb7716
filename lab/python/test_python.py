"""Tests of the module mass_spring: python3 -m pytest lab/python

They find it by PYTHONPATH, else in build/python."""
import os
import pathlib
import re
import signal
import sys
import threading
from typing import Any

import numpy as np
import pytest

root = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, os.environ.get("PYTHONPATH") or str(root / "build/python"))
import mass_spring  # noqa: E402

PAIR: list[list[float]] = [[0, 0, 0], [1, 0, 0]]


def oscillator(**changes):
    """A mass of 1 kg on a spring of rest length 0: x = cos(3 t)."""
    given: dict[str, Any] = {"k": 9.0, "L": 0.0, "mass": 1.0, "fixed": [0],
                             "gravity": 0.0, **changes}
    return mass_spring.Net(PAIR, [[0, 1]], **given)


def test_the_version_is_that_of_the_changelog():
    text = (root / "docs/CHANGELOG.md").read_text("utf-8")
    assert f"\n## {mass_spring.__version__}\n" in text


def test_positions_are_those_of_an_oscillator():
    r = oscillator().run("pefrl", 2.0, 0.001, every=0.5)
    assert r.t == pytest.approx([0, 0.5, 1, 1.5, 2])
    assert r.x[:, 1, 0] == pytest.approx(np.cos(3 * r.t), abs=1e-9)
    assert r.v[:, 1, 0] == pytest.approx(-3 * np.sin(3 * r.t), abs=1e-8)
    assert r.energy == pytest.approx(4.5, abs=1e-9)
    assert (r.status, r.why) == (0, None)


def test_limit_and_failure():
    net = oscillator()
    assert net.limit("verlet") == pytest.approx(2 / 3)
    assert net.limit("implicit-euler") == np.inf
    assert net.run("verlet", 50.0, 0.1).status == 0
    r = net.run("verlet", 50.0, 0.68)
    assert r.status == 3 and r.why.kind == "diverged" and r.why.node == 1
    assert 0 < r.why.time < 50 and r.why.dt == 0.68
    method, dt = r.why.cure
    assert net.run(method, 50.0, dt).status == 0
    assert np.isfinite(r.x).all() and "stability limit" in r.why.cause


def test_a_smaller_tolerance_takes_more_forces():
    coarse, fine = (oscillator().run("rkn64", 2.0, "auto", atol=atol)
                    for atol in (1e-3, 1e-9))
    assert coarse.work < fine.work
    assert fine.x[-1, 1, 0] == pytest.approx(np.cos(6), abs=1e-7)


def test_drag_and_velocity():
    net = mass_spring.Net([[0.0, 0, 0]], np.empty((0, 2), int), mass=2.0,
                          v=[[1.0, 0, 0]], drag=0.5, gravity=0.0)
    assert net.run("rk4", 4.0, 0.01).v[-1, 0, 0] == pytest.approx(np.exp(-1))


def test_one_method_for_each_name():
    all_methods = {m.name: m for m in mass_spring.methods()}
    assert all_methods["rk4"].order == 4 and all_methods["rk4"].forces == 4
    assert all_methods["verlet"].limit == 2.0
    assert all(m.fails_when for m in all_methods.values())


def test_force_is_that_of_springs_weight_and_drag():
    net = oscillator(gravity=2.0, drag=0.5)
    f = net.force([[0.0, 0, 0], [0, 0, 2]], [[0.0, 0, 0], [4, 0, 0]])
    assert f == pytest.approx(np.array([[0, 0, 18 - 2], [-2, 0, -18 - 2]]))


def test_rest_is_where_a_mass_hangs_with_its_frequencies():
    r = oscillator(k=50, L=1, mass=2, gravity=10).rest()
    assert r.x == pytest.approx(np.array([[0, 0, 0], [0, 0, -1.4]]), abs=1e-9)
    assert r.residual <= 1e-10 * r.load and r.load == 20 and r.factors > 0
    assert r.stable and (r.growing, r.loose) == ([], [])
    assert r.frequencies == pytest.approx(
        np.sqrt([10 / 1.4, 10 / 1.4, 25]) / (2 * np.pi))
    assert r.pins == [("held by the net", pytest.approx([0, 0, -40], abs=1e-8))]
    assert r.force == pytest.approx(
        np.array([[0, 0, -40], [0, 0, 0]]), abs=1e-8)
    assert "stable: the smallest eigenvalue is 7.14286 1/s^2" in str(r)


def test_a_slack_cable_and_a_load():
    net = mass_spring.Net(
        np.array([[0, 0, 0], [0, 0, -1], [0, 0, -1.5]]), [[0, 1], [1, 2]],
        k=50, L=1, mass=1, fixed=[0, 2], gravity=0, cables=[0, 1], load=[
            [0, 0, 0], [0, 0, -10], [0, 0, 0]])
    r = net.rest()
    assert r.slack == [[1, 2]]
    assert r.x[1] == pytest.approx([0, 0, -1.2])
    assert r.force[0] == pytest.approx([0, 0, -10])
    with pytest.raises(ValueError, match=r"^cables\[0\] is 2, expected a "):
        mass_spring.Net([[0, 0, 0], [1, 0, 0]], [[0, 1]], cables=[2])


def test_rest_names_what_does_not_stay_and_refuses_what_moves():
    r = mass_spring.Net([[0, 0, 0], [0, 0, 1]], [[0, 1]], fixed=[0]).rest()
    assert (r.stable, r.growing, r.loose) == (False, [1], [])
    r = oscillator(L=1).rest()
    assert (r.stable, r.growing, r.loose) == (False, [], [1])
    with pytest.raises(RuntimeError, match="^no rest: nothing holds node 0, "
                       "which falls without end$"):
        oscillator(fixed=[], gravity=10).rest()
    curtain = mass_spring.scene(str(root / "data/scenes/curtain.toml"))
    with pytest.raises(ValueError, match="^rest cannot be that of moving pins"):
        curtain.rest()
    with pytest.raises(ValueError, match=": nodes is missing: expected files"):
        mass_spring.scene(root / "data/scenes/tear.toml")


def test_scene_runs_as_the_program_does():
    s = mass_spring.scene(str(root / "data/scenes/curtain.toml"))
    r = s.run(t_end=0.2)
    assert r.status == 0 and r.x.shape == (2,) + s.x.shape
    assert r.t == pytest.approx([0, 0.2])
    assert r.x[0] == pytest.approx(s.x) and r.x[1].min() < s.x.min() - 1e-4


def test_changes_of_a_scene_and_its_energy(tmp_path):
    file = tmp_path / "s.toml"
    text = "sheet = 'nodes 2 1'\npin = 'x 0'\nt-end = 1\nmethod = 'verlet'\n"
    file.write_text(text + "at = ['0.5 unpin 0']\n")
    falls = mass_spring.scene(str(file)).run(every=0.5)
    assert falls.x[1, 0, 2] == 0 and falls.x[2, 0, 2] < -0.5
    with pytest.raises(ValueError, match="at has unpin, which is of one"):
        mass_spring.scene(str(file)).advise()
    file.write_text(text + "at = ['0.5 unpinn 0']\n")
    with pytest.raises(ValueError, match="did you mean unpin"):
        mass_spring.scene(str(file))
    r = oscillator().run("forward-euler", 10.0, 0.01)
    assert (r.status, r.why.kind) == (3, "energy")
    assert "has added" in r.why.cause and r.why.cure and r.x.shape[0] == 2


def test_advice():
    s = mass_spring.scene(str(root / "data/scenes/curtain.toml"))
    a = s.advise(tolerance=0.05)
    assert not a.refusal and a.error < 0.05 and a.tolerance == 0.05
    assert a.scene.run().status == 0
    assert a.method in str(a)


def test_a_spring_from_both_ends_counts_once():
    with pytest.warns(UserWarning, match="1 spring is listed from both ends"):
        net = mass_spring.Net(PAIR, [[0, 1], [1, 0]], k=50.0, gravity=0.0)
    x = np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0]])
    assert net.force(x, np.zeros((2, 3)))[1, 0] == -100


@pytest.mark.parametrize("changes, message", [
    ({"x": [[0.0, 0], [1, 0]]}, r"x has shape (2, 2), expected (n, 3)"),
    ({"x": [[0.0, 0, 0], [np.nan, 0, 0]]}, "x[1] is not finite"),
    ({"edges": [[0, 2]]}, "edges[0] is (0, 2), expected two different nodes"),
    ({"edges": [[1, 1]]}, "edges[0] is (1, 1)"),
    ({"k": [-1.0]}, "k[0] is -1, expected a number of at least 0"),
    ({"k": [1.0, 2.0]}, "k has shape (2,), expected a number or (1,)"),
    ({"mass": [1.0, 0.0]}, "mass[1] is 0, expected a number above 0"),
    ({"fixed": [2]}, "fixed[0] is 2, expected a node, 0 to 1"),
    ({"v": [[0.0, 0, 0]]}, "v has shape (1, 3), expected (2, 3)"),
])
def test_a_wrong_array_is_named(changes, message):
    arguments: dict[str, Any] = {"x": PAIR, "edges": [[0, 1]], **changes}
    with pytest.raises(ValueError, match=re.escape(message)):
        mass_spring.Net(**arguments)


@pytest.mark.parametrize("arguments, message", [
    (("verlt", 1.0), "verlet"),
    (("verlet", -1.0), "t-end is -1"),
    (("verlet", 1.0, "soon"), "dt is soon"),
    (("verlet", 1.0, 2.0), "dt is 2, expected at most t-end"),
])
def test_a_wrong_argument_of_a_run_is_named(arguments, message):
    with pytest.raises(ValueError, match=message):
        oscillator().run(*arguments)
    with pytest.raises(ValueError, match="no/scene.toml"):
        mass_spring.scene("no/scene.toml")
    for atol in (0.0, -1.0, np.nan, np.inf):
        with pytest.raises(ValueError, match="^atol"):
            oscillator().run("rkn64", 1.0, "auto", atol=atol)


def test_control_c_ends_a_run_that_lets_other_threads_work():
    net = oscillator()
    threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        net.run("verlet", 1e9, 1e-3)
    assert net.run("verlet", 1.0, 1e-3).status == 0  # and the next one runs


def test_examples_of_the_page(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    page = (root / "docs/python.md").read_text()
    names: dict[str, Any] = {}
    for code in re.findall(r"```python\n(.*?)```", page, re.S):
        exec(code, names)
    said = capsys.readouterr().out
    assert "stability limit" in said and "stable: the smallest" in said
    assert "order 2.00" in said
    assert all((tmp_path / name).stat().st_size
               for name in ("rest.png", "work_precision.png"))
    forces = dict(re.findall(r"(\S+) +(\d+) forces, error", said))
    assert int(forces["rkn64"]) < int(forces["RK45"])


@pytest.mark.parametrize("fixed, held", [
    ([True, False], [0]), (np.array([False, True]), [1]), ({1}, [1]),
    ([False, False], []), ((), []), ([], []), (np.array([1], np.uint8), [1]),
    (np.array([0, 9, 1])[::2], [0, 1])])
def test_nodes_are_numbers_or_a_mask(fixed, held):
    net = mass_spring.Net(PAIR, [[0, 1]], fixed=fixed)
    x = net.run("verlet", 0.1, 0.01).x
    assert [i for i in (0, 1) if (x[0, i] == x[-1, i]).all()] == held


@pytest.mark.parametrize("name, values", [
    ("k", ["soft", 1j, True, None, np.nan]), ("L", [[np.inf], ["a"]]),
    ("mass", [[1, 2, 3], pathlib.Path(".")]), ("v", [[[0, 0, 1j]] * 2]),
    ("drag", [-1, "x", np.inf]), ("gravity", [np.nan, [0, np.inf, 0],
                                                   [1, 2]]),
    ("edges", [[[0.0, 1.0]], [[True, False]], [["a", "b"]], [[0, 1, 1]], None]),
    ("fixed", [[True], [0.0], [1 + 0j], ["0"], [[0]], "0", None, [-1],
               [np.nan], 0])])
def test_what_can_not_be_used_is_refused_by_name(name, values):
    for value in values:
        given: dict[str, Any] = {"x": PAIR, "edges": [[0, 1]], name: value}
        with pytest.raises((TypeError, ValueError), match="^" + name):
            mass_spring.Net(**given)


def test_gravity_acts_down_or_along_its_vector():
    down = [0, 0, -9.81]
    cases: list[tuple[Any, list]] = [
        (9.81, down), (-9.81, down), ([3, -4, 0], [3, -4, 0])]
    for g, a in cases:
        net = mass_spring.Net(PAIR, [[0, 1]], mass=2.0, gravity=g)
        assert net.force(net.x, 0 * net.x) == pytest.approx(
            2 * np.array([a, a]))


def test_a_run_goes_on_with_the_rest_lengths_of_the_net():
    net = mass_spring.Net(PAIR, [[0, 1]], fixed=[0], k=50.0)
    whole = net.run("verlet", 1.0, 0.001)
    x, v = net.x, np.zeros((2, 3))
    for _ in range(20):
        r = net.run("verlet", 0.05, 0.001, x0=x, v0=v)
        x, v = r.x[-1], r.v[-1]
    assert x == pytest.approx(whole.x[-1], abs=1e-12)
    scene = mass_spring.scene(str(root / "data/scenes/curtain.toml"))
    with pytest.raises(ValueError, match="x0 is of a scene from a file"):
        scene.run(x0=scene.x)
    with pytest.raises(ValueError, match="a Net has one grid"):
        net.advise()


def caught():
    text = pathlib.Path("/proc/self/status").read_text("ascii")
    return re.search(r"^SigCgt:\t(\w+)$", text, re.M)[1]  # type: ignore


@pytest.mark.skipif(not pathlib.Path("/proc/self/status").exists(),
                    reason="no /proc")
def test_ctrl_c_ends_all_runs_of_all_threads():
    net, before, ended = oscillator(), caught(), []

    def long():
        try:
            net.run("verlet", 1e9, 0.001)
        except KeyboardInterrupt:
            ended.append(True)

    threads = [threading.Thread(target=long) for _ in range(4)]
    with pytest.raises(KeyboardInterrupt):
        for one in threads:
            one.start()
        while caught() == before:
            pass
        os.kill(os.getpid(), signal.SIGINT)
        while True:     # a join() that is interrupted ends before its thread
            pass
    for one in threads:
        one.join()
    assert len(ended) == 4 and caught() == before
    assert net.run("verlet", 0.01, 0.001).steps == 10
    with pytest.raises(KeyboardInterrupt):
        os.kill(os.getpid(), signal.SIGINT)


def test_a_forked_child_runs():
    """Its parent has run by many threads, which the child has not."""
    x = np.stack(np.meshgrid(np.arange(120.), np.arange(120.), [0.]),
                 -1).reshape(-1, 3)
    net = mass_spring.Net(x, [[i, i + 1] for i in range(len(x) - 1)])
    expected = net.run("verlet", 0.1, 0.01).x
    child = os.fork()
    if child == 0:
        signal.alarm(100)
        same = (net.run("verlet", 0.1, 0.01).x == expected).all()
        os._exit(0 if same else 1)
    assert os.waitpid(child, 0)[1] == 0
