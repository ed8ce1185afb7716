#!/usr/bin/python3
"""The picture of the web page in lab/page/README.md: picture.py PAGE OUT.png"""
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/browsers"))
from browser import Browser  # noqa: E402

run = ("#scene=forces&side=25&camera=-1.1_0.25_1.1&run=0_method_verlet~"
       "0_drag_0.003~0_step_0.3~0_race_rk4_symplectic-euler_xpbd~13_end")
with Browser(1200, 860) as browser:
    browser.open(f"file://{pathlib.Path(sys.argv[1]).resolve()}{run}")
    browser.wait("page.calls === 13 && !page.isWaiting && !page.dirty", 300)
    browser.wait("""doors.every(d => new Set(d.button.firstChild.getContext(
      '2d').getImageData(0, 0, 144, 100).data).size > 20)""")
    browser.screenshot(sys.argv[2])
