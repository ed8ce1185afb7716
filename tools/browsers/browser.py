"""A headless Chromium, driven by Selenium: needs chromium-driver and
python3-selenium (tools/deps.sh browser)."""
import base64
import os
import pathlib
import sys
import time
import traceback
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.remote.remote_connection import RemoteConnection

RemoteConnection.set_timeout(900)


class Skipped(Exception):
    """A browser has no way to do this."""


class Browser:
    """One page. Use it in a with statement; lengths in CSS pixels."""
    driver: Any

    def __init__(self, width: int = 1280, height: int = 800,
                 flags: Iterable[str] = ()) -> None:
        options = webdriver.ChromeOptions()
        for flag in ("--headless=new", "--no-sandbox", "--hide-scrollbars",
                     "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                     *flags):
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(
            service=Service("/usr/bin/chromedriver"), options=options)
        self.found: list[str] = []
        self.size = width, height
        self.resize(width, height)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self) -> None:
        self.driver.quit()

    def as_new(self) -> None:
        """For the next test, as it was at first."""
        self.faults.clear()
        self.resize(*self.size)
        self.prefer()

    @property
    def faults(self) -> list[str]:
        """What the page complained of."""
        self.found += [entry["message"] for entry in
                       self.driver.get_log("browser")
                       if entry["level"] == "SEVERE" or
                       (entry["level"], entry["source"]) ==
                       ("WARNING", "console-api")]
        return self.found

    def send(self, method: str, /, **values: Any) -> Any:
        """The answer to a command of Chromium's own protocol."""
        return self.driver.execute_cdp_cmd(method, values)

    def resize(self, width: int, height: int, touch: bool = False) -> None:
        self.send("Emulation.setDeviceMetricsOverride", width=width,
                  height=height, deviceScaleFactor=1, mobile=touch)
        self.send("Emulation.setTouchEmulationEnabled", enabled=touch)

    def prefer(self, dark: bool = False, still: bool = False,
               forced: bool = False) -> None:
        """What the person prefers: colors, no motion, colors of their own."""
        chosen = {"prefers-color-scheme": "dark" if dark else "light",
                  "prefers-reduced-motion": "reduce" if still else "",
                  "forced-colors": "active" if forced else "none"}
        self.send("Emulation.setEmulatedMedia", features=[
            {"name": name, "value": value} for name, value in chosen.items()])

    def open(self, address: str) -> None:
        """Another page, also if only what is behind # is another."""
        self.driver.get("about:blank")
        self.driver.get(address)

    def value(self, expression: str) -> Any:
        """What an expression of JavaScript is; it is waited for."""
        answer = self.send("Runtime.evaluate", expression=expression,
                           returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(f"{expression}: {answer['exceptionDetails']}")
        result = answer["result"]
        if "unserializableValue" in result:  # NaN, Infinity, -0
            return float(result["unserializableValue"])
        return result.get("value")

    def bytes_of(self, array: str) -> bytes:
        """The bytes of an array of numbers, given as an expression."""
        return base64.b64decode(self.value(
            "(bytes => { let s = ''; for (const c of bytes) s +="
            " String.fromCharCode(c); return btoa(s); })"
            f"(new Uint8Array(({array}).buffer))"))

    def wait(self, expression: str, seconds: float = 60) -> None:
        end = time.monotonic() + seconds
        while not self.value(expression):
            if time.monotonic() > end:
                raise TimeoutError(f"never: {expression}")
            time.sleep(0.05)

    def screenshot(self, file: str | pathlib.Path) -> None:
        self.driver.save_screenshot(str(file))

    def key(self, key: str, code: str = "", text: str = "") -> None:
        for kind in ("keyDown", "keyUp"):
            values = {"text": text} if text and kind == "keyDown" else {}
            self.send("Input.dispatchKeyEvent", type=kind, key=key,
                      code=code or key, **values)

    def mouse(self, kind: str, x: float, y: float) -> None:
        """kind: mousePressed, mouseMoved, mouseReleased"""
        self.send("Input.dispatchMouseEvent", type=kind, x=x, y=y,
                  button="left", buttons=int(kind != "mouseReleased"),
                  clickCount=1)

    def click(self, selector: str) -> None:
        x, y = self.value(
            "(box => [box.x + box.width / 2, box.y + box.height / 2])("
            f"(e => (e.scrollIntoView({{block: 'nearest'}}), e))"
            f"(document.querySelector('{selector}')).getBoundingClientRect())")
        self.mouse("mousePressed", x, y)
        self.mouse("mouseReleased", x, y)

    def stroke(self, start: Sequence[float], end: Sequence[float]) -> None:
        """Press, draw a straight line in ten moves, release."""
        (x0, y0), (x1, y1) = start, end
        self.mouse("mousePressed", x0, y0)
        for k in range(1, 11):
            self.mouse("mouseMoved", x0 + (x1 - x0) * k / 10,
                       y0 + (y1 - y0) * k / 10)
        self.mouse("mouseReleased", x1, y1)

    def wheel(self, x: float, y: float, down: float) -> None:
        self.send("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y,
                  deltaX=0, deltaY=down)

    def touch(self, kind: str, *points: Sequence[float]) -> None:
        """kind: touchStart, touchMove, touchEnd; points: (x, y)"""
        self.send("Input.dispatchTouchEvent", type=kind, touchPoints=[
            {"x": x, "y": y, "id": k} for k, (x, y) in enumerate(points)])

    def place_of(self, node: int, side: int = 0) -> list[float]:
        """Where a node of the cloth of `page`, a Picture, is on the screen."""
        return self.value(f"""(() => {{
          const box = page.canvas.getBoundingClientRect();
          const width = box.width / page.sides.length, {{camera}} = page.view;
          const [x, y] = camera.place(camera.frame(width / box.height),
            page.sides[{side}].points.subarray({4 * node}, {4 * node + 3}));
          return [box.left + {side} * width + (x + 1) / 2 * width,
                  box.top + (1 - y) / 2 * box.height]; }})()""")


def run_tests(tests: Iterable[Callable[[Browser], object]],
              names: Sequence[str],
              engines: Iterable[type[Browser]] = (Browser,)) -> int:
    """Run tests, or those of these names, in each engine, with a line for
    each; only one in $EVERY, from number $FIRST on, and four times as many in
    the first engine. What a page complains of is a fault.
    Returns how many failed."""
    count = failed = 0
    every, turn = (int(os.environ.get(n, 1)) for n in ("EVERY", "FIRST"))
    for place, engine in enumerate(engines):
        b: Browser | None = None
        each = every if place else max(1, every // 4)
        for number, run in enumerate(tests):
            if names and run.__name__ not in names:
                continue
            if not names and (number - turn) % each:
                continue
            name = f"{run.__name__} {engine.__name__}"
            start = time.monotonic()
            try:
                b = b or engine()
                b.as_new()
                run(b)
                faults = b.faults + b.value(
                    "typeof page === 'object' && page.errors || []")
                assert not faults, faults
                print(f"ok {name} {time.monotonic() - start:.0f} s", flush=True)
            except Skipped as what:
                print(f"skipped {name}: {what}")
                continue
            except Exception:
                failed += 1
                print("FAIL", name)
                traceback.print_exc(file=sys.stdout)
                if b:
                    b.close()
                b = None
            count += 1
        if b:
            b.close()
    print(f"{count - failed} passed, {failed} failed")
    return failed
