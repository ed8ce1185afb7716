#!/usr/bin/env python3
"""Make one file of the page: assemble.py WASM OUT. What index.html names by
src or href is written into it, the WebAssembly packed, so that the page needs
no server: a browser lets a page that is opened as a file load no other."""
import base64
import gzip
import pathlib
import re
import sys

room = pathlib.Path(__file__).parent


def script(match):
    attributes, name = match.groups()
    if name == "cloth.wasm.gz":
        wasm = pathlib.Path(sys.argv[1]).read_bytes()
        packed = gzip.compress(wasm, 9, mtime=0)
        text = base64.b64encode(packed).decode()
    else:
        text = (room / name).read_text()
    return f"<script{attributes}>{text}</script>"


html = (room / "index.html").read_text()
html = html.replace('<link rel="stylesheet" href="style.css">',
                    "<style>\n" + (room / "style.css").read_text() + "</style>")
html = re.sub(r'<script([^>]*?) src="([^"]+)"></script>', script, html)
pathlib.Path(sys.argv[2]).write_text(html)
