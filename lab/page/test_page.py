#!/usr/bin/python3
"""What the web page does, in a headless Chromium, and in Firefox and WebKit,
where they are installed: test_page.py BUILD [TEST]..., where
BUILD/page/index.html and BUILD/page_positions are. It is opened as a file. The
pictures that Chromium writes, BUILD/page-*.png, are to be looked at."""
import pathlib
import struct
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/browsers"))
from browser import Browser, run_tests  # noqa: E402
from engines import Firefox, WebKit  # noqa: E402

build = pathlib.Path(sys.argv[1])
address = "file://" + str((build / "page/index.html").resolve())
tests = []


def test(run):
    tests.append(run)


def opened(browser, hash=""):
    """The page as it is opened, with a frame drawn."""
    browser.open(address + hash)
    browser.wait("page.frames > 0 && page.readings && page.sides.length")
    return browser


def time_of(b):
    return b.value("page.readings.main.time")


def choose(b, name, value):
    b.value(f"$('{name}').value = '{value}', "
            f"$('{name}').dispatchEvent(new Event('change'))")


def slide(b, name, value):
    b.value(f"$('{name}').value = 1000 * sliders.{name}.place({value}), "
            f"$('{name}').dispatchEvent(new Event('input'))")


def point_of(b, node, side=0):
    return b.value(f"[...page.sides[{side}].points.slice({4 * node},"
                   f" {4 * node + 3})]")


def pause(b):
    if b.value("page.playing"):
        b.click(".play")
    b.wait("!page.isWaiting")
    assert not b.value("page.playing")


@test
def same_bits_as_the_native_program(b):
    """After 1000 steps on grid1, of every method."""
    names = [m["name"] for m in opened(b).value("page.about.methods")]
    assert len(names) >= 6
    pause(b)
    ours, asked = [], []
    for name in names:
        # Forward Euler has no stable step.
        share = 0.02 if name == "forward-euler" else 0.5
        b.value(f"page.positions = null, Object.assign(page.settings, "
                f"{{method: '{name}', share: {share}, drag: 0}}), page.start(),"
                " page.worker.postMessage(['positions', 1000])")
        b.wait("page.positions", 300)
        assert b.value("page.positions.broken") == "", name
        ours.append(b.bytes_of("page.positions.all"))
        asked += [name, repr(b.value("page.positions.dt"))]
    native = subprocess.run(
        [build / "page_positions", "data/scenes/forces.toml", "data/grid1",
         "1000", *asked], check=True, capture_output=True).stdout
    size = 625 * 3 * 8
    assert len(native) == size * len(names)
    for k, name in enumerate(names):
        theirs = native[k * size:(k + 1) * size]
        a, c = (struct.unpack(f"<{size // 8}d", x) for x in (ours[k], theirs))
        worst = max(abs(x - y) for x, y in zip(a, c))
        assert ours[k] == theirs, f"{name}: another by up to {worst} m"


@test
def it_runs_steps_pauses_and_restarts(b):
    opened(b)
    before = time_of(b)
    b.wait(f"page.readings.main.time > {before} + 0.02")
    pause(b)
    steps = b.value("page.readings.main.steps")
    b.click(".step")
    b.wait(f"page.readings.main.steps === {steps} + 1")
    b.key("n", text="n")
    b.wait(f"page.readings.main.steps === {steps} + 2")
    b.click(".restart")
    b.wait(f"page.readings.main.steps < {steps} && page.playing")


@test
def a_node_that_is_dragged_follows(b):
    opened(b)
    pause(b)
    node = 624  # the corner opposite to that of node 0
    x, y = b.place_of(node)
    b.mouse("mousePressed", x, y)
    b.wait("page.hand.grabbed")
    held = b.value("page.hand.grabbed.node")
    before = point_of(b, held)
    b.value("page.setPlaying(true)")
    for k in range(1, 9):
        b.mouse("mouseMoved", x + 15 * k, y - 10 * k)
    b.wait("page.readings.grabbed")
    target = b.value("page.hand.grabbed.target")
    gap = "Math.hypot(...[0, 1, 2].map(k => page.sides[0].points[" + \
        f"{4 * held} + k] - [{','.join(map(str, target))}][k]))"
    start = sum((p - q) ** 2 for p, q in zip(before, target)) ** 0.5
    assert start > 0.05
    b.wait(f"{gap} < {0.7 * start}")  # where the springs hold it
    b.screenshot(build / "page-grab.png")
    b.mouse("mouseReleased", x + 120, y - 80)
    b.wait("!page.readings.grabbed")


@test
def a_stroke_cuts_and_a_click_pins(b):
    opened(b)
    pause(b)
    before = b.value("page.readings.edges")
    b.click("[data-tool=cut]")
    (x0, y0), (x1, y1) = b.place_of(300), b.place_of(324)
    assert abs(x0 - x1) + abs(y0 - y1) > 60
    b.stroke((x0, y0), (x1, y1))
    b.wait(f"page.readings.edges < {before} - 20")
    assert b.value("page.readings.nodes") == 625
    b.click("[data-tool=pin]")
    pins = b.value("page.sides[0].pins.length")
    assert pins == 2
    x, y = b.place_of(624)
    b.mouse("mousePressed", x, y), b.mouse("mouseReleased", x, y)
    b.wait("page.sides[0].pins.length === 3")
    b.mouse("mousePressed", x, y), b.mouse("mouseReleased", x, y)
    b.wait("page.sides[0].pins.length === 2")


@test
def it_turns_and_zooms(b):
    opened(b)
    pause(b)
    b.click("[data-tool=turn]")
    yaw, zoom = b.value("[page.view.camera.yaw, page.view.camera.zoom]")
    b.mouse("mousePressed", 400, 300), b.mouse("mouseMoved", 480, 300)
    b.mouse("mouseReleased", 480, 300)
    assert abs(b.value("page.view.camera.yaw") - (yaw - 0.64)) < 1e-9
    b.wheel(400, 300, -200)
    b.wait(f"page.view.camera.zoom > 1.2 * {zoom}")


@test
def every_scene_runs(b):
    opened(b)
    scenes = b.value(
        "page.about.scenes.filter(s => !s.fails).map(s => s.name)")
    assert len(scenes) == 9
    for k, scene in enumerate(scenes):
        choose(b, "scene", scene)
        b.wait(f"page.settings.scene === '{scene}' && !page.isWaiting &&"
               " page.readings.main.time > 0.01 && page.calls > 0", 120)
        assert b.value("page.failed") is False
        b.screenshot(build / f"page-scene-{k}.png")


@test
def sliders_change_what_runs(b):
    opened(b)
    pause(b)
    dt = b.value("page.readings.main.dt")
    slide(b, "share", 0.25)
    b.wait(f"Math.abs(page.readings.main.dt / {dt} - 0.5) < 0.02")
    # omega grows as the root of K: the limit falls as it.
    limit = b.value("page.readings.main.safe")
    slide(b, "stiffness", 400)
    b.wait(f"Math.abs(page.readings.main.safe / {limit} - 0.5) < 0.01")
    # The step stays, so dt / limit is twice as large; and red beyond 1.
    b.wait("Math.abs(page.settings.share / 0.5 - 1) < 0.02")
    slide(b, "stiffness", 10000)
    b.wait("page.settings.share > 2 &&"
           " $('share').parentElement.classList.contains('beyond')")
    slide(b, "stiffness", 100)
    # A cloth that nothing pulls stays where it is.
    b.click(".restart")
    slide(b, "gravity", 0)
    b.wait("page.readings.main.time > 0.1")
    slide(b, "drag", 0.1)
    slide(b, "gravity", 9.81)
    b.wait("page.readings.main.kinetic > 0.01")


def fail_by_stiffness(b):
    """@return the time of the last good state"""
    b.wait("page.readings.main.time > 0.1")
    slide(b, "stiffness", 10000)
    b.wait("page.failed", 120)
    return time_of(b)


@test
def a_failure_is_seen_explained_and_cured(b):
    """A larger K lowers the limit: dt / limit is red at once."""
    good = fail_by_stiffness(opened(b))
    share = b.value("page.readings.main.dt / page.readings.main.unit")
    assert share > 4, share
    assert abs(b.value("page.settings.share") / share - 1) < 0.01
    assert b.value("$('share').parentElement.classList.contains('beyond')")
    b.wait("page.beyond?.moves && page.why && "
           "page.find('.busy').textContent.includes('times slower')", 120)
    moved = """(frames => frames.map(f => Math.max(...f.points.map((a, i) =>
      i % 4 < 3 ? Math.abs(a - frames[0].points[i]) : 0))))
      (page.beyond.frames)"""
    way = b.value(moved)
    assert way[0] == 0 and way == sorted(way) and way[-1] > 0.5, way
    # What moves is in the picture, seen obliquely: 15 % of it, and its ring.
    b.screenshot(build / "page-failure.png")
    node = b.value("page.sides[0].failedNode")
    x, y = b.place_of(node)
    box = b.value("(b => [b.left, b.top, b.right, b.bottom])"
                  "(page.canvas.getBoundingClientRect())")
    assert box[0] < x < box[2] and box[1] < y < box[3]
    (x0, y0), (x1, y1), (x2, y2) = (b.place_of(n) for n in (0, 24, 600))
    area = abs((x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0))
    assert area > 0.15 * (box[2] - box[0]) * (box[3] - box[1])
    # The words are beside the cloth.
    assert b.value("page.find('.fault').getBoundingClientRect().top") >= box[3]
    words = b.value("page.find('.fault').textContent")
    assert "times the stability limit" in words, words
    assert "works" in words and "--" not in words, words
    assert b.value("page.find('.play').textContent") == "Replay"
    b.click(".play")
    b.wait("page.beyond.from")
    assert b.value("page.failed")
    cure = b.value("page.cure")
    assert cure["method"] == "verlet" and 0 < cure["share"] < 1.3
    assert b.value("page.find('.cure').textContent") == \
        "Apply the cure: dt / limit " + \
        b.value("shortNumber(page.cure.share)")
    b.click(".cure")
    b.wait(f"!page.failed && page.readings.main.time > {good} + 0.02", 120)
    assert abs(b.value("page.readings.main.dt / page.readings.main.unit")
               / cure["share"] - 1) < 1e-9
    assert b.value("page.find('.fault').hidden && page.playing")
    assert b.value("page.view.camera.pitch") == 0.25  # as before


@test
def a_change_goes_on_from_the_last_good_state(b):
    good = fail_by_stiffness(opened(b))
    assert good > 0.1
    slide(b, "stiffness", 100)
    b.wait("!page.failed && page.playing")
    first = b.value(f"plots.energy.times.filter(t => t <= {good}).length")
    b.wait(f"page.readings.main.time > {good} + 0.05")
    assert first > 1 and b.value("plots.energy.times.length") > first
    # One that fails at once stops again, with a reason.
    slide(b, "stiffness", 10000)
    b.wait("page.failed", 120)
    slide(b, "stiffness", 9000)
    b.wait("page.failed && !page.playing && page.why", 120)
    assert time_of(b) > good


@test
def ways_to_break_it_fail_as_their_files_say(b):
    failing = opened(b).value(
        "page.about.scenes.filter(s => s.fails).map(s => s.name)")
    assert len(failing) == 8, failing
    for name, method in (("drag", "symplectic-euler"), ("xpbd", "xpbd")):
        choose(b, "scene", name)
        b.wait("page.failed", 300)
        assert b.value("page.settings.method") == method
        assert b.value("$('method').value") == method
        if name == "drag":  # the cure of ./cloth, whose trial is 5 s long
            b.wait("page.cure?.method === 'verlet'", 120)
            assert "to t = 5 s" in b.value("page.find('.fault').innerText")
    choose(b, "scene", "tunnel")
    b.wait("/would have tunnelled.*a step of 2.5 ms/.test("
           "page.find('.says').innerText)", 120)
    choose(b, "scene", "forces")
    b.wait("!page.failed && page.readings.main.method === 'verlet'")
    assert b.value("page.find('.says').hidden")
    assert b.value("page.settings.share") == 0.5


def try_task(b, number):
    b.value(f"tasks[{number}].tick.click()")
    b.value("$('answers').firstChild.click()")
    b.wait("!page.isWaiting && page.calls > 0 && page.asked >= 0")


def is_done(b, number, says):
    b.wait("$('answers').textContent === 'Next'", 300)
    words = b.value("$('task').innerText")
    assert says in words, words
    assert b.value(f"tasks[{number}].tick.innerText") == "\u2713"


@test
def tasks_are_answered_by_their_runs(b):
    b.resize(640, 480)  # quickly drawn
    opened(b)
    for number, says in ((0, "No: It explodes"), (1, "Right: It holds"),
                         (4, "No: half"), (5, "Right: It holds"),
                         (6, "No: It explodes"), (8, "No: It explodes"),
                         (9, "Right: verlet")):
        try_task(b, number)
        is_done(b, number, says)
    deeds: list[tuple[int, list[str]]] = [
        (3, ["'share', 1.18"]), (7, ["'share', 4.6"]), (10, ["'share', 1.18"])]
    for number, changes in deeds:
        try_task(b, number)
        for change in changes:
            b.value(f"change({change})")
        b.click(".restart")
        is_done(b, number, "Done")
    # What misses is told, and can be tried again.
    try_task(b, 7)
    b.wait("/slower. Choose another step/.test($('task').innerText)", 120)
    # Another scene in the middle of a guess.
    try_task(b, 1)
    choose(b, "scene", "drape")
    b.wait("$('answers').children.length === 2")


@test
def tasks_of_the_hand(b):
    opened(b)
    try_task(b, 2)
    pause(b)
    x, y = b.place_of(624)
    b.mouse("mousePressed", x, y)
    b.wait("page.hand.grabbed")
    b.value("page.setPlaying(true)")
    for k in range(1, 9):
        b.mouse("mouseMoved", x + 20 * k, y + 20 * k)
    is_done(b, 2, "Done")
    b.mouse("mouseReleased", x + 160, y + 160)
    try_task(b, 11)
    pause(b)
    assert b.value("page.tool") == "cut"
    y = b.place_of(12)[1] + b.place_of(612)[1]
    b.stroke((20, y / 2), (920, y / 2))
    b.wait("page.readings.tornEdges > 20")
    is_done(b, 11, "Done")


@test
def doors_show_what_they_open(b):
    opened(b)
    drawn = ("doors.every(d => new Set(d.button.firstChild.getContext('2d')"
             ".getImageData(0, 0, 144, 100).data).size > 20)")
    b.wait(drawn, 120)
    assert b.value("page.find('.hint').innerText") == "Drag me"
    for title, expected in (
            ("Cut", "page.tool === 'cut' && page.settings.scene === 'curtain'"),
            ("Race", "page.sides.length === 4"),
            ("Break it", "page.failed"),
            ("Your step", "page.find('.says').innerText.includes('make try')")):
        b.value(f"doors.find(d => d.title === '{title}').button.click()")
        b.wait(f"{expected} && !page.isWaiting", 120)
    assert not b.value("page.find('.hint')")


@test
def the_address_keeps_the_scene(b):
    """For a reload, for Back, and for a link pasted into an open page."""
    opened(b)
    choose(b, "scene", "drape")
    choose(b, "method", "rk4")
    b.wait("location.hash.includes('rk4')")
    choose(b, "scene", "rip")
    b.wait("page.readings && !page.isWaiting")
    b.value("history.back()")
    b.wait("page.settings.scene === 'drape' && page.settings.method === 'rk4'")
    b.value("location.hash = '#scene=tear&run=0_step_0.25~3_end'")
    b.wait("page.settings.scene === 'tear' && page.calls >= 3")


@test
def the_first_scene_comes_to_rest(b):
    opened(b)
    pause(b)
    b.value("page.start(startLines(), 12000)")
    b.wait("page.calls === 12000", 300)
    assert b.value("page.readings.main.kinetic") < 1e-3


@test
def nothing_moves_by_itself_if_so_preferred(b):
    b.prefer(still=True)
    opened(b)
    assert b.value("page.playing") is False
    choose(b, "scene", "drape")
    b.wait("page.readings.nodes && !page.isWaiting")
    assert b.value("page.playing") is False and b.value("page.calls") == 0
    b.click(".play")
    b.wait("page.readings.main.time > 0.05")


# The smallest contrast of a text to what is behind it, by WCAG 2.
contrast = """(() => {
  const channels = color => color.match(/[\\d.]+/g).map(Number);
  const light = color => {
    const [r, g, b] = channels(color).slice(0, 3).map(c => c / 255).map(
      c => c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const behind = e => {
    for (; e; e = e.parentElement) {
      const color = getComputedStyle(e).backgroundColor;
      if (channels(color).length < 4 || channels(color)[3] > 0) return color;
    }
    return 'rgb(255, 255, 255)';
  };
  const all = [...document.querySelectorAll('body *')].filter(e =>
    e.offsetParent && [...e.childNodes].some(n => n.nodeType === 3 &&
      n.textContent.trim())).map(e => {
    const [a, b] = [light(getComputedStyle(e).color), light(behind(e))];
    return [(Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05),
      e.id || e.textContent.trim()];
  });
  return [all.length, ...all.sort((a, b) => a[0] - b[0])[0]];
})()"""


@test
def text_can_be_read(b):
    for dark in (False, True):
        b.prefer(dark=dark)
        opened(b)
        choose(b, "rival0", "rk4")
        b.wait("page.sides.length === 2")
        slide(b, "share", 3)
        b.wait("page.failed", 120)
        b.wait("page.why", 300)
        count, least, where = b.value(contrast)
        assert count > 40 and least >= 4.5, (dark, count, least, where)
        b.screenshot(build / f"page-{'dark' if dark else 'light'}.png")


@test
def colors_of_the_person_keep_tools_and_curves_apart(b):
    b.prefer(forced=True)
    opened(b)
    back = ("[...document.querySelectorAll('[data-tool]')].map("
            "e => getComputedStyle(e).backgroundColor)")
    grab, cut = b.value(back)[:2]
    assert grab != cut
    b.wait("!!$('energy-title').querySelector('b')")
    curves = b.value("[...$('energy-title').querySelectorAll('b')].map("
                     "e => getComputedStyle(e).color + e.textContent)")
    assert len(set(curves)) == 4, curves
    assert len(set(b.value("dashes.map(d => d[1].join())"))) == 4
    b.screenshot(build / "page-forced.png")


@test
def everything_has_a_name(b):
    opened(b)
    choose(b, "rival0", "rk4")
    b.wait("page.sides.length === 2 && $('distance').ariaLabel")
    nameless = b.value("""[...document.querySelectorAll(
      'canvas, button, select, input, section, aside, fieldset > *')].filter(
      e => e.offsetParent && !(e.ariaHidden || e.ariaLabel ||
        e.labels?.length || e.title ||
        e.textContent.trim() || e.matches('section:not([id])')))
      .map(e => e.id || e.outerHTML)""")
    assert not nameless, nameless
    assert b.value("page.canvas.getAttribute('role')") == "application"
    assert not b.value("page.canvas.hasAttribute('aria-pressed')")
    label = b.value("$('energy').ariaLabel")
    assert "verlet" in label and "J" in label, label


@test
def a_frame_around_what_has_the_focus_is_for_keys(b):
    opened(b)
    b.key("Tab")
    assert b.value("document.activeElement.matches(':focus-visible')")
    x, y = b.place_of(624)
    for at in (".step", "canvas"):
        if at == "canvas":
            b.mouse("mousePressed", x, y), b.mouse("mouseReleased", x, y)
        else:
            b.click(at)
        assert b.value("document.activeElement.matches(':focus-visible')") \
            is False, at
    assert b.value("document.activeElement === page.canvas")
    assert b.value("page.find('.cross').hidden")


@test
def it_fits_small_screens(b):
    for width in (320, 360, 820):
        b.resize(width, 640, touch=True)
        opened(b)
        slide(b, "share", 3)
        b.wait("page.failed", 120)
        b.wait("page.why", 300)
        assert b.value("document.documentElement.scrollWidth") <= width
        wide = b.value("""[...document.querySelectorAll(
          'button, select, input, .fault, output')].filter(
            e => e.offsetParent).map(e =>
            [e.id || e.textContent, e.getBoundingClientRect()]).filter(
            ([, r]) => r.left < 0 || r.right > innerWidth + 0.5)
            .map(([id]) => id)""")
        assert not wide, (width, wide)
        b.screenshot(build / f"page-{width}.png")


@test
def a_step_that_can_not_be_made_is_told_and_the_page_goes_on(b):
    opened(b, "#scene=forces&side=5&run=0_method_tr-bdf2~"
           "0_stiffness_100000~0_step_1000~0_end")
    b.wait("page.failed && page.why", 120)
    words = b.value("page.find('.fault').innerText")
    assert "Newton's method is at a residual" in words, words
    choose(b, "method", "verlet")
    slide(b, "share", 0.3)
    b.wait("!page.failed && page.readings.main.method === 'verlet' &&"
           " page.readings.main.time > 0.1")


@test
def methods_race_at_equal_work(b):
    opened(b)
    slide(b, "share", 0.3)
    for k, name in enumerate(("symplectic-euler", "rk4", "xpbd")):
        choose(b, f"rival{k}", name)
        b.wait(f"page.sides.length === {k + 2} &&"
               f" page.settings.rivals.length === {k + 1}")
    b.wait("page.readings.main.time > 0.3", 120)
    r = b.value("page.readings")
    assert [a["method"] for a in r["rivals"]] == ["symplectic-euler", "rk4",
                                                  "xpbd"]
    for rival in r["rivals"]:
        assert abs(rival["time"] - r["main"]["time"]) < 1e-9
        assert abs(rival["work"] / r["main"]["work"] - 1) < 0.1, rival
    # Symplectic Euler is of order 1, Verlet of order 2.
    assert 0 < r["error"] < r["rivals"][0]["error"]
    assert b.value("plots.distance.times.length") > 3
    # No reading of the run before, which had no other beside it.
    assert b.value("plots.energy.rows.every(row => row.length === 4)")
    assert b.value("plots.energy.times[0]") < 0.05
    labels = b.value("[...document.querySelectorAll('.name small')].map("
                     "e => e.innerText)")
    assert all("error" in words and "work" in words for words in labels), \
        labels
    b.screenshot(build / "page-race.png")
    for _ in range(3):
        choose(b, "rival0", "")
    b.wait("page.sides.length === 1")


def look_back(b, at):
    b.value(f"$('time').value = {at},"
            " $('time').dispatchEvent(new Event('input'))")
    b.wait("!page.isWaiting && !page.wanted")


@test
def an_earlier_state_is_shown_and_the_run_goes_on_from_it(b):
    opened(b)
    b.wait("page.readings.main.time > 0.3 && page.timeline.states.length > 7")
    good = fail_by_stiffness(b)
    b.wait("page.beyond && page.why", 120)
    last = b.value("page.timeline.states.length") - 1
    kept = ("(s => [s.calls, [...s.sides[0].points]])"
            "(page.timeline.states[4])")
    before = b.value(kept)
    look_back(b, 4)
    assert b.value("[...page.sides[0].points]") == before[1]
    time = time_of(b)
    assert 0 < time < good
    assert b.value("$('time').ariaValueText") == f"{time:.2f} s"
    assert b.value("page.find('.play').innerText") == "Play"
    look_back(b, last)  # the failure again
    assert b.value("page.find('.play').innerText") == "Replay"
    assert time_of(b) == good
    # From there, with what was asked until then: the same bits, no failure.
    look_back(b, 4)
    b.click(".step")
    b.wait(f"page.calls === {before[0]} + 1 && !page.failed")
    assert b.value(kept) == before
    b.wait("page.settings.stiffness === 100")
    b.click(".play")
    b.wait(f"page.readings.main.time > {good}", 120)
    assert not b.value("page.failed")
    # A change is made in the state that is shown.
    pause(b)
    look_back(b, 2)
    time = time_of(b)
    b.value("change('gravity', 3)")
    b.wait("page.readings.parameters.gravity === 3")
    assert time_of(b) == time
    # However long it runs, few are kept, of all the run.
    b.value("page.timeline.clear(), Array.from({length: 5000}, (_, k) =>"
            " page.timeline.add({...page.timeline.last, sides: page.sides,"
            " readings: page.readings, calls: k}))")
    calls = b.value("page.timeline.states.map(s => s.calls)")
    assert 300 <= len(calls) <= 600 and calls[0] == 0 and calls[-1] == 4999
    gaps = {q - p for p, q in zip(calls, calls[1:-1])}
    assert gaps == {16}, gaps


@test
def pictures_and_films_are_saved(b):
    opened(b)
    b.value("window.saved = {}, save = (blob, ending) => blob.arrayBuffer()"
            ".then(a => saved[ending] = new Uint8Array(a))")
    b.click("#picture")
    b.wait("saved.png")
    (build / "page-saved.png").write_bytes(b.bytes_of("saved.png"))
    if not b.value("!!self.MediaRecorder"):
        b.click("#film")
        assert "cannot record" in b.value("page.find('.says').innerText")
        return
    start = b.value("page.frames")
    b.click("#film")
    b.wait(f"page.frames > {start} + 20")
    b.click("#film")
    refused = "page.find('.says').innerText.includes('cannot record')"
    b.wait(f"saved.mp4 || saved.webm || {refused}")
    if b.value(refused):
        return
    film = build / "page-saved.film"
    film.write_bytes(b.bytes_of("saved.mp4 ?? saved.webm"))
    told = subprocess.run(
        ["ffprobe", "-v", "error", "-count_frames", "-show_entries",
         "stream=width,height,nb_read_frames", "-of", "csv=p=0", film],
        check=True, capture_output=True, text=True).stdout
    width, height, count = map(int, told.split(","))
    assert (width, height) == (940, b.value("page.canvas.clientHeight & ~1")
                               + 30) and count > 5, told
    assert b.value("$('film').innerText") == "Film"


@test
def it_describes_itself(b):
    opened(b)
    b.wait("page.readings.main.time > 0.1")
    pause(b)
    words = b.value("$('spoken').textContent")
    assert "verlet, at 0." in words and "joules" in words, words
    slide(b, "share", 3)
    b.click(".play")
    b.wait("page.failed && $('spoken').textContent.includes('it failed')", 120)


@test
def a_link_shows_the_same_picture_twice(b):
    opened(b)
    slide(b, "stiffness", 60)
    choose(b, "rival0", "symplectic-euler")
    b.wait("page.readings.main.time > 0.15 && page.sides.length === 2", 120)
    pause(b)
    x, y = b.place_of(624)
    b.mouse("mousePressed", x, y)
    b.mouse("mouseMoved", x + 40, y - 60), b.mouse("mouseReleased", x + 40, y)
    b.click(".step")
    b.wait("!page.isWaiting && !page.wanted && !page.stepping")
    b.click("#link")
    b.wait("location.hash.includes('_grab_')")
    hash, calls = b.value("location.hash"), b.value("page.calls")
    assert "run=0_method_verlet" in hash and "_grab_" in hash, hash
    before = b.value("[...page.sides[0].points]")
    pictures = []
    for k in range(2):
        opened(b, hash)
        b.wait(f"page.calls === {calls} && !page.isWaiting && !page.dirty", 120)
        after = b.value("[...page.sides[0].points]")
        assert after == before, max(
            abs(p - q) for p, q in zip(after, before))
        pictures.append(b.value("(page.view.draw(page.sides, page.theme, null),"
                                " page.canvas.toDataURL())"))
    assert pictures[0] == pictures[1]
    assert abs(b.value("page.settings.stiffness") - 60) < 2
    b.screenshot(build / "page-link.png")


@test
def a_link_of_nonsense_is_a_page_all_the_same(b):
    for hash in ("#%E0%A4%A", "#scene=x&side=y&method=%%&share=-5&steps=1e9x",
                 "#run=2_method_77~3_method_0.5~3_method_-1~20_end",
                 "#run=3_compare_99_0.5~4_compare_-2_1~5_compare~20_end",
                 "#run=3_step_-1~3_step_0~4_stiffness_0~5_gravity_1e300~20_end",
                 "#run=1_cut_1_2_3~2_pin_-1~3_pin_9999999~4_nothing~20_end",
                 "#run=3_grab_999999_1_1_1~4_grab~5_move_1~20_end",
                 "#run=0_gravitas_3~1e300_restart~1_gravity_1e300~x~20_end",
                 "#run=0_break~1_scene_0~2_move_1_2", "#run=0_scene_0~9_end",
                 "#side=3.7&camera=1e9_1_1", "#camera=0_99_-5"):
        opened(b, hash)
        b.value("page.setPlaying(true)")
        b.wait("page.readings.main.time > 0.03")
        assert b.value("page.failed") is False, hash
    assert b.value("[page.view.camera.pitch, page.view.camera.zoom]") == [1.5,
                                                                          0.2]
    # It says so if that makes another run.
    for last, hidden in (("1e300_release", False), ("3_release", True)):
        opened(b, f"#run=0_step_0.5~{last}~20_end")
        b.wait("page.calls >= 20")
        assert b.value("page.find('.says').hidden") is hidden


@test
def a_link_of_a_long_run_can_be_left(b):
    """Hours of steps: on the way, another run is made at once."""
    b.open(address + "#side=100&run=0_method_implicit-euler~"
           "0_step_0.5~1000000_end")
    b.wait("page.find('.busy').textContent.startsWith('repeating the link')")
    b.click(".restart")
    b.wait("page.readings && page.frames > 0 && page.playing")
    assert b.value("page.calls") < 1000


@test
def large_systems_are_factored(b):
    """By Eigen's order, which takes 32 bytes a row of the stack."""
    opened(b, "#side=50&run=0_method_implicit-euler~0_step_20~0_end")
    b.wait("page.readings.main.steps > 3", 120)
    assert b.value("page.failed") is False


@test
def a_keyboard_is_enough(b):
    opened(b)
    pause(b)
    b.value("page.canvas.focus()")
    yaw = b.value("page.view.camera.yaw")
    b.key("ArrowLeft")
    assert b.value("page.view.camera.yaw") != yaw
    zoom = b.value("page.view.camera.zoom")
    b.key("+", text="+")
    assert b.value("page.view.camera.zoom") > zoom
    b.key("g", text="g")
    b.wait("page.readings.grabbed")
    assert b.value("Object.is(rounded(-1e-5), 0)")
    z = b.value("page.hand.grabbed.target[2]")
    b.key("ArrowUp")
    assert b.value("page.hand.grabbed.target[2]") > z
    b.key("g", text="g")
    b.wait("!page.readings.grabbed")
    edges = b.value("page.readings.edges")
    b.key("x", text="x")
    b.wait(f"page.readings.edges < {edges}")
    b.key("p", text="p")
    b.wait("page.sides[0].pins.length === 3")
    b.key(" ", code="Space", text=" ")
    b.wait("page.playing")
    # Tab reaches each control.
    reached = set()
    for _ in range(60):
        b.key("Tab")
        reached.add(b.value("document.activeElement.id ||"
                            " document.activeElement.className"))
    missing = {"play", "step", "restart", "grab", "cut", "pin", "turn", "scene",
               "side", "method", "share", "stiffness", "drag", "gravity",
               "speed", "rival0", "link"} - reached
    assert not missing, missing


@test
def it_works_on_a_phone(b):
    b.resize(360, 640, touch=True)
    opened(b)
    small = b.value("""[...document.querySelectorAll('button, select, input')]
      .filter(e => e.offsetParent && e.getBoundingClientRect().height < 44)
      .map(e => e.id || e.dataset.tool)""")
    assert not small, small
    pause(b)
    x, y = b.place_of(624)
    b.touch("touchStart", (x, y))
    b.touch("touchMove", (x - 10, y - 30))
    b.wait("page.readings.grabbed")
    b.screenshot(build / "page-phone.png")
    b.touch("touchEnd")
    b.wait("!page.readings.grabbed")
    zoom = b.value("page.view.camera.zoom")
    b.touch("touchStart", (150, 100), (200, 150))
    b.touch("touchMove", (120, 70), (230, 180))
    b.touch("touchEnd")
    assert b.value("page.view.camera.zoom") > 1.5 * zoom
    b.prefer(dark=True)
    b.value("page.view.camera.zoom = 1, page.setPlaying(true)")
    choose(b, "rival0", "implicit-midpoint")
    b.wait("page.sides.length === 2 && page.readings.main.time > 0.05", 120)
    b.screenshot(build / "page-phone-dark.png")


def without_webgl():
    with Browser(flags=("--disable-3d-apis",)) as b:
        b.open(address)
        b.wait("document.querySelector('#fallback img').naturalWidth > 0")
        b.wait("$('panel').offsetHeight === 0")
        assert "WebGL" in b.value("$('fallback').innerText")
        assert not b.faults, b.faults
        b.screenshot(build / "page-fallback.png")


def main():
    size = sum(f.stat().st_size for f in (build / "page").iterdir())
    assert size <= 1_000_000, f"{size} bytes"
    print(f"  {size} bytes")
    engines: list[type[Browser]] = [Browser]
    for other in (Firefox, WebKit):
        if missing := other.missing():
            print(f"skipped: the page in {other.__name__}: missing:", *missing)
        else:
            engines.append(other)
    if not sys.argv[2:]:
        without_webgl()
    return run_tests(tests, sys.argv[2:], engines) != 0


if __name__ == "__main__":
    sys.exit(main())
