"""Pictures of the site: photographs as WebP; charts in fewer bytes, packed
into their page, where site.js unpacks them."""
import base64
import gzip
import pathlib
import re
import subprocess
import xml.etree.ElementTree as ET

SVG = "http://www.w3.org/2000/svg"
ET.register_namespace("", SVG)
ET.register_namespace("xlink", "http://www.w3.org/1999/xlink")
# What an element has from those around it, and what it is outside of all.
INHERITED = {"fill": "black", "stroke": "none", "stroke-width": "1",
             "stroke-linecap": "butt", "stroke-linejoin": "miter",
             "stroke-dasharray": "none", "font-family": "", "font-size": "",
             "text-anchor": "start"}


def write(source: pathlib.Path, target: pathlib.Path) -> None:
    """A picture, or one frame of a film."""
    target.parent.mkdir(parents=True, exist_ok=True)
    middle = ["-ss", "1.4"] if source.suffix == ".gif" else []
    subprocess.run(
        ["ffmpeg", "-v", "error", "-y", *middle, "-i", source, "-frames:v",
         "1", "-vf", "scale='min(640,iw)':-1", "-quality", "40", target],
        check=True, timeout=300, stdin=subprocess.DEVNULL)


def element(source: pathlib.Path, attributes: str) -> str:
    """The element of a chart: an SVG file."""
    tree = ET.parse(source).getroot()
    slim(tree, INHERITED)
    text = ET.tostring(tree, encoding="unicode")
    used = set(re.findall(r'href="#(\w+)"', text))
    for part in tree.findall(f"{{{SVG}}}g/{{{SVG}}}defs"):
        for child in list(part):
            if child.get("id") not in used:
                part.remove(child)
    text = ET.tostring(tree, encoding="unicode")
    _, _, width, height = tree.attrib["viewBox"].split()
    packed = base64.b64encode(
        gzip.compress(text.encode(), 9, mtime=0)).decode()
    return (f'<img class="chart" width="{width}" height="{height}" '
            f'{attributes} data-gz="{packed}">')


def slim(element: ET.Element, around: dict[str, str]) -> None:
    """Write it in fewer characters: nothing that it inherits anyway, lengths
    in tenths of a pixel, paths by what each point adds to the one before."""
    if element.tag.endswith(("}defs", "}style")):
        return
    around = dict(around)
    for name, value in list(element.attrib.items()):
        value = re.sub(r"rgb\(\s*(\d+),\s*(\d+),\s*(\d+)\)", lambda m:
                       "#%02x%02x%02x" % tuple(map(int, m.groups())), value)
        if name in ("transform", "points"):
            value = re.sub(r"-?\d+\.\d+", lambda m: short(float(m[0])), value)
        element.set(name, path(value) if name == "d" else value.strip())
        if name in INHERITED:
            if around[name] == value:
                del element.attrib[name]
            around[name] = value
        elif name == "class":
            del element.attrib[name]
    if not element.tag.endswith(("}text", "}tspan")):
        element.text = (element.text or "").strip()
    for child in list(element):
        slim(child, around)
        if not child.tag.endswith("}tspan"):
            child.tail = ""
        if child.tag == f"{{{SVG}}}g" and not len(child):
            element.remove(child)


def path(text: str) -> str:
    """The same path, with relative lines."""
    if set(re.findall("[A-Za-z]", text)) - set("MLz"):
        return text
    out, at, start, command, last = "", (0.0, 0.0), (0.0, 0.0), "", ""
    words = iter(re.findall(r"[A-Za-z]|-?[\d.]+", text))
    for word in words:
        if word.isalpha():
            command = word
            if word == "z":
                out, at, last = out + "z", start, "z"
                continue
            word = next(words)
        to = round(float(word), 1), round(float(next(words)), 1)
        x, y = short(to[0] - at[0]), short(to[1] - at[1])
        if command == "M":
            out += f"M{short(to[0])} {short(to[1])}"
            start, command, last = to, "L", "M"
        elif y == "0":
            out, last = f"{out}h{x}", "h"
        elif x == "0":
            out, last = f"{out}v{y}", "v"
        else:
            first = "l" if last != "l" else "" if x[0] == "-" else " "
            out, last = f"{out}{first}{x}{'' if y[0] == '-' else ' '}{y}", "l"
        at = to
    return out


def short(number: float) -> str:
    text = f"{number:.1f}".removesuffix(".0")
    return "0" if text == "-0" else re.sub(r"^(-?)0\.", r"\1.", text)
