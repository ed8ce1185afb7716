#!/usr/bin/env python3
"""Make one file of the page: assemble.py WASM OUT. What index.html names by
src or href (of scripts, several) is written into it, the WebAssembly packed, so
that the page needs no server: a browser lets a page that is opened as a file
load no other."""
import base64
import gzip
import pathlib
import re
import sys

room = pathlib.Path(__file__).parent


def script(match: re.Match[str]) -> str:
    attributes, name = match.groups()
    if name == "cloth.wasm.gz":
        wasm = pathlib.Path(sys.argv[1]).read_bytes()
        packed = gzip.compress(wasm, 9, mtime=0)
        text = base64.b64encode(packed).decode()
    else:
        text = "\n".join((room / part).read_text() for part in name.split())
    return f"<script{attributes}>{text}</script>"


html = (room / "index.html").read_text()
html = re.sub(r'<link rel="stylesheet" href="([^"]+)">', lambda match:
              f"<style>\n{(room / match[1]).read_text()}</style>", html)
html = re.sub(r'<script([^>]*?) src="([^"]+)"></script>', script, html)
pathlib.Path(sys.argv[2]).write_text(html)
