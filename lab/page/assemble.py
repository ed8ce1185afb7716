#!/usr/bin/env python3
"""Make one file of the page: assemble.py WASM OUT, with the WebAssembly
packed."""
import pathlib
import sys

ROOM = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(ROOM.parents[1] / "course/web"))
import web  # noqa: E402

wasm = pathlib.Path(sys.argv[1]).read_bytes()
pathlib.Path(sys.argv[2]).write_text(
    web.inlined(ROOM / "index.html", {"cloth.wasm.gz": web.packed(wasm)}))
