"""Firefox and WebKit with the interface of browser.py, in windows of an Xvfb:
need firefox-esr and webkit2gtk-driver."""
import json
import os
import pathlib
import shutil
import socket
import subprocess
import tempfile
import time
from typing import Any

from selenium import webdriver
from selenium.common.exceptions import WebDriverException
from selenium.webdriver.webkitgtk.options import Options

from browser import Browser, Skipped

KEYS = {"Tab": "\ue004", "ArrowLeft": "\ue012", "ArrowUp": "\ue013",
        "ArrowRight": "\ue014", "ArrowDown": "\ue015", "Escape": "\ue00c"}
# An expression, and what the page complained of meanwhile.
SCRIPT = """const [expression, done] = arguments;
window.eval(`if (!self.said) {
  self.said = [], console.error = words => said.push(String(words));
  addEventListener('error', e => said.push(e.message));
}`);
window.eval(`(async () => JSON.stringify(await (${expression})))()`).then(
  text => done([text, null, window.said.splice(0)]),
  error => done([null, String(error), window.said.splice(0)]));"""


class Windowed(Browser):
    """One page. Use it in a with statement; lengths in CSS pixels."""
    programs: tuple[str, ...] = ()

    @classmethod
    def missing(cls) -> list[str]:
        """The programs that it needs and that are not here."""
        return [name for name in ("Xvfb", *cls.programs)
                if not shutil.which(name)]

    def __init__(self, width: int = 1280, height: int = 800) -> None:
        end, number = os.pipe()
        self.screen = subprocess.Popen(
            ["Xvfb", "-displayfd", str(number), "-screen", "0",
             "1600x1200x24"], pass_fds=[number],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(number)
        with os.fdopen(end) as told:
            os.environ["DISPLAY"] = ":" + told.readline().strip()
        self.found, self.size = [], (width, height)
        self.start()
        self.driver.set_script_timeout(900)
        self.driver.get("about:blank")
        self.resize(width, height)

    def start(self) -> None:
        """Make self.driver."""
        raise NotImplementedError

    def close(self) -> None:
        try:
            self.driver.quit()
        finally:
            self.screen.terminate()
            self.screen.wait(60)

    def as_new(self) -> None:
        self.faults.clear()
        self.resize(*self.size)

    @property
    def faults(self) -> list[str]:
        return self.found

    def resize(self, width: int, height: int, touch: bool = False) -> None:
        if touch:
            raise Skipped("a screen that is touched")
        # A window is larger than its page.
        left, above = self.value(
            "[outerWidth - innerWidth, outerHeight - innerHeight]")
        self.driver.set_window_rect(0, 0, width + left, height + above)
        self.wait(f"innerWidth === {width} && innerHeight === {height}")

    def prefer(self, dark: bool = False, still: bool = False,
               forced: bool = False) -> None:
        raise Skipped("what the person prefers")

    def value(self, expression: str) -> Any:
        text, error, said = self.driver.execute_async_script(SCRIPT, expression)
        self.found += said
        if error:
            raise RuntimeError(f"{expression}: {error}")
        return None if text is None else json.loads(text)

    def wait(self, expression: str, seconds: float = 60) -> None:
        # A processor that draws by itself is slower here than in Chromium.
        super().wait(expression, 5 * seconds)

    def screenshot(self, file: str | pathlib.Path) -> None:
        """Pictures are of Chromium."""

    def _act(self, kind, *actions):
        self.driver.execute("actions", {"actions": [
            {"type": kind, "id": kind, "actions": list(actions)}]})

    def key(self, key: str, code: str = "", text: str = "") -> None:
        value = KEYS.get(key, key)
        self._act("key", {"type": "keyDown", "value": value},
                  {"type": "keyUp", "value": value})

    def mouse(self, kind: str, x: float, y: float) -> None:
        actions = [{"type": "pointerMove", "x": round(x), "y": round(y)}]
        if kind != "mouseMoved":
            press = "pointerDown" if kind == "mousePressed" else "pointerUp"
            actions.append({"type": press, "button": 0})
        self._act("pointer", *actions)


class WebKit(Windowed):
    """One page. Use it in a with statement; lengths in CSS pixels."""
    programs = "WebKitWebDriver",

    def start(self) -> None:
        self.driver = webdriver.WebKitGTK(options=Options(), keep_alive=True)

    def wheel(self, x: float, y: float, down: float) -> None:
        raise Skipped("a wheel")


class Marionette:
    """Carries out Selenium's commands by Firefox's own protocol, as geckodriver
    does, which Debian does not have."""
    NAMES = {"newSession": "NewSession", "get": "Navigate",
             "setTimeouts": "SetTimeouts", "setWindowRect": "SetWindowRect",
             "w3cExecuteScriptAsync": "ExecuteAsyncScript",
             "actions": "PerformActions"}
    _commands = NAMES

    def __init__(self, port: int) -> None:
        self.file = socket.create_connection(
            ("127.0.0.1", port), timeout=900).makefile("rwb")
        self.read()

    def read(self) -> Any:
        """The next message, behind its length and a colon."""
        size = b""
        while (digit := self.file.read(1)) != b":":
            size += digit
        return json.loads(self.file.read(int(size)))

    def execute(self, command: str, values: dict) -> dict:
        """The answer to a command of Selenium."""
        # These are for geckodriver itself.
        values = {name: value for name, value in values.items()
                  if name not in ("sessionId", "capabilities")}
        message = json.dumps(
            [0, 1, "WebDriver:" + self.NAMES[command], values]).encode()
        self.file.write(b"%d:%s" % (len(message), message))
        self.file.flush()
        _, _, error, result = self.read()
        if error:
            raise WebDriverException(f"{error['error']}: {error['message']}")
        return result


class Firefox(Windowed):
    """One page. Use it in a with statement; lengths in CSS pixels."""
    programs = "firefox-esr",

    def start(self) -> None:
        self.folder = tempfile.mkdtemp(prefix="page.")
        pathlib.Path(self.folder, "user.js").write_text("".join(
            f'user_pref("{name}", {value});\n' for name, value in (
                ("marionette.port", 0), ("webgl.force-enabled", "true"),
                ("ui.prefersReducedMotion", 0),
                ("focusmanager.testmode", "true"))))
        self.process = subprocess.Popen(
            ["firefox-esr", "--no-remote", "--profile", self.folder,
             "--marionette"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        port = pathlib.Path(self.folder, "MarionetteActivePort")
        end = time.monotonic() + 300
        while not port.exists() or not port.read_text():
            if time.monotonic() > end:
                raise TimeoutError("the browser does not start")
            time.sleep(0.05)
        self.driver = webdriver.Remote(Marionette(int(port.read_text())),
                                       options=webdriver.FirefoxOptions())

    def close(self) -> None:
        self.process.terminate()
        self.process.wait(60)
        shutil.rmtree(self.folder, ignore_errors=True)
        self.screen.terminate()
        self.screen.wait(60)

    def wheel(self, x: float, y: float, down: float) -> None:
        self._act("wheel", {"type": "scroll", "x": round(x), "y": round(y),
                            "deltaX": 0, "deltaY": down})
