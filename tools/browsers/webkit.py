"""WebKit with the interface of browser.py, driven by WebDriver: needs
webkit2gtk-driver, and Xvfb for its window. https://www.w3.org/TR/webdriver2"""
import json
import os
import pathlib
import signal
import socket
import subprocess
import urllib.request
from typing import Any

from firefox import Firefox, Skipped

# An expression, and what the page complained of meanwhile.
SCRIPT = """const done = arguments[0];
if (!self.said) {
  self.said = [], console.error = words => said.push(String(words));
  addEventListener('error', e => said.push(e.message));
}
(async () => JSON.stringify(await (%s)))().then(
  text => done([text, null, said.splice(0)]),
  error => done([null, String(error), said.splice(0)]));"""


class WebKit(Firefox):
    """One page. Use it in a with statement; lengths in CSS pixels."""
    programs = "WebKitWebDriver", "xvfb-run"

    def __init__(self, width: int = 1280, height: int = 800) -> None:
        with socket.create_server(("127.0.0.1", 0)) as free:
            port = free.getsockname()[1]
        self.root, self.faults = f"http://127.0.0.1:{port}/session", []
        self.context, self.size = None, (width, height)
        self.process = subprocess.Popen(
            ["xvfb-run", "-a", "-s", "-screen 0 1600x1200x24",
             "WebKitWebDriver", f"--port={port}"], start_new_session=True,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self._until(self._starts, 300, "the browser does not start")
        self.send("/timeouts", script=900_000)
        self.resize(width, height)

    def _starts(self):
        try:
            self.root += "/" + self.send("", capabilities={})["sessionId"]
            return True
        except OSError:
            return False

    def send(self, path: str, /, **values: Any) -> Any:
        path = path.replace("input.performActions", "/actions")
        with urllib.request.urlopen(
                self.root + path, json.dumps(values).encode(), 900) as answer:
            return json.load(answer)["value"]

    def close(self) -> None:
        os.killpg(self.process.pid, signal.SIGTERM)
        self.process.wait(60)

    def resize(self, width: int, height: int, touch: bool = False) -> None:
        if touch:
            raise Skipped("a screen that is touched")
        # A window is larger than its page.
        left, above = self.value(
            "[outerWidth - innerWidth, outerHeight - innerHeight]")
        self.send("/window/rect", width=width + left, height=height + above)
        self.wait(f"innerWidth === {width} && innerHeight === {height}")

    def wheel(self, x: float, y: float, down: float) -> None:
        raise Skipped("a wheel")

    def open(self, address: str) -> None:
        for url in ("about:blank", address):
            self.send("/url", url=url)

    def value(self, expression: str) -> Any:
        text, error, said = self.send("/execute/async", args=[],
                                      script=SCRIPT % expression)
        self.faults += said
        if error:
            raise RuntimeError(f"{expression}: {error}")
        return None if text is None else json.loads(text)

    def screenshot(self, file: str | pathlib.Path) -> None:
        """Pictures are of the others."""
