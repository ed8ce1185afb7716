#!/usr/bin/python3
"""The picture of the web page in lab/page/README.md: picture.py PAGE OUT.png"""
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/browsers"))
from browser import Browser  # noqa: E402

run = ("#scene=forces&side=25&camera=-1.1_0.25_0.85&run=0_method_verlet~"
       "0_step_0.5~0_compare_implicit-euler_8~38_end")
with Browser(1200, 860) as browser:
    browser.open(f"file://{pathlib.Path(sys.argv[1]).resolve()}{run}")
    browser.wait("page.calls === 38 && !page.isWaiting && !page.dirty", 300)
    browser.value("new Promise(done => setTimeout(done, 500))")
    browser.screenshot(sys.argv[2])
