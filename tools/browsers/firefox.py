"""Firefox with the interface of browser.py, driven by WebDriver BiDi over a web
socket: needs firefox-esr, which draws WebGL in a window alone, so Xvfb, and
python3-websocket. https://w3c.github.io/webdriver-bidi"""
import base64
import json
import pathlib
import re
import shutil
import subprocess
import tempfile
from typing import Any

import websocket

from browser import Browser, Skipped

KEYS = {"Tab": "\ue004", "ArrowLeft": "\ue012", "ArrowUp": "\ue013",
        "ArrowRight": "\ue014", "ArrowDown": "\ue015", "Escape": "\ue00c"}


class Firefox(Browser):
    """One page. Use it in a with statement; lengths in CSS pixels."""
    programs: tuple[str, ...] = "firefox-esr", "xvfb-run", "xdotool"

    @classmethod
    def missing(cls) -> list[str]:
        """The programs that it needs and that are not here."""
        return [name for name in cls.programs if not shutil.which(name)]

    def __init__(self, width: int = 1280, height: int = 800) -> None:
        self.folder = tempfile.mkdtemp(prefix="page.")
        pathlib.Path(self.folder, "user.js").write_text(
            'user_pref("webgl.force-enabled", true);\n'
            'user_pref("ui.prefersReducedMotion", 0);\n')
        said = pathlib.Path(self.folder, "said")
        with said.open("w") as out:
            self.process = subprocess.Popen(
                ["xvfb-run", "-a", "bash", "-c", 'env >"$1/env"; exec '
                 'firefox-esr --no-remote --profile "$1" '
                 '--remote-debugging-port 0', "bash", self.folder],
                stdout=subprocess.DEVNULL, stderr=out)
        found = r"WebDriver BiDi listening on (ws://\S+)"
        self._until(lambda: re.search(found, said.read_text()), 300,
                    "the browser does not start")
        self.socket = websocket.create_connection(
            re.findall(found, said.read_text())[0] + "/session", timeout=900,
            suppress_origin=True)
        self.count, self.session, self.faults = 0, None, []
        self.send("session.new", capabilities={})
        self.send("session.subscribe", events=["log.entryAdded"])
        tree = self.send("browsingContext.getTree")
        self.context = tree["contexts"][0]["context"]
        self.size = width, height
        self.resize(width, height)
        self._until(self._focused, 300, "the page has no focus")

    def _focused(self):
        """Does the page have the focus, and not the line of the address? Only
        a click of a real mouse moves it."""
        words = pathlib.Path(self.folder, "env").read_text().splitlines()
        subprocess.run(["xdotool", "mousemove", "500", "500", "click", "1"],
                       env=dict(w.split("=", 1) for w in words if "=" in w),
                       timeout=300)
        return self.value("document.hasFocus()")

    def close(self) -> None:
        try:
            self.send("browser.close")
            self.socket.close()
            self.process.wait(60)
        except (OSError, RuntimeError, websocket.WebSocketException,
                subprocess.TimeoutExpired):
            self.process.kill()
        shutil.rmtree(self.folder, ignore_errors=True)

    def as_new(self) -> None:
        self.faults = []
        self.resize(*self.size)

    def wait(self, expression: str, seconds: float = 60) -> None:
        # A processor that draws by itself is slower here than in Chromium.
        super().wait(expression, 5 * seconds)

    def _listen(self, event):
        values = event.get("params", {})
        if event.get("method") == "log.entryAdded" and \
                values["level"] == "error":
            self.faults.append(values["text"])
        if event.get("type") == "error":
            event["error"] = event["error"] + ": " + event["message"]

    def resize(self, width: int, height: int, touch: bool = False) -> None:
        if touch:
            raise Skipped("a screen that is touched")
        self.send("browsingContext.setViewport", context=self.context,
                  viewport={"width": width, "height": height})

    def prefer(self, dark: bool = False, still: bool = False,
               forced: bool = False) -> None:
        raise Skipped("what the person prefers")

    def open(self, address: str) -> None:
        for url in ("about:blank", address):
            self.send("browsingContext.navigate", context=self.context,
                      url=url, wait="complete")

    def value(self, expression: str) -> Any:
        answer = self.send(
            "script.evaluate", target={"context": self.context},
            awaitPromise=True, expression="(async () => JSON.stringify("
            f"await ({expression})))()")
        if answer["type"] != "success":
            raise RuntimeError(f"{expression}: {answer['exceptionDetails']}")
        text = answer["result"].get("value")
        return None if text is None else json.loads(text)

    def screenshot(self, file: str | pathlib.Path) -> None:
        data = self.send("browsingContext.captureScreenshot",
                         context=self.context)["data"]
        file = pathlib.Path(file)
        file.with_name("firefox-" + file.name).write_bytes(
            base64.b64decode(data))

    def _act(self, kind, name, *actions, **more):
        self.send("input.performActions", context=self.context, actions=[
            {"type": kind, "id": name, "actions": list(actions), **more}])

    def key(self, key: str, code: str = "", text: str = "") -> None:
        value = KEYS.get(key, key)
        self._act("key", "keys", {"type": "keyDown", "value": value},
                  {"type": "keyUp", "value": value})

    def mouse(self, kind: str, x: float, y: float) -> None:
        actions = [{"type": "pointerMove", "x": round(x), "y": round(y)}]
        if kind != "mouseMoved":
            press = "pointerDown" if kind == "mousePressed" else "pointerUp"
            actions.append({"type": press, "button": 0})
        self._act("pointer", "mouse", *actions)

    def wheel(self, x: float, y: float, down: float) -> None:
        self._act("wheel", "wheel", {"type": "scroll", "x": x, "y": y,
                                     "deltaX": 0, "deltaY": down})
