"""Pictures of the site: photographs as WebP; charts packed into their page,
where site.js unpacks them."""
import base64
import gzip
import pathlib
import re
import subprocess


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
    text = source.read_text()
    width, height = re.findall(r'viewBox="0 0 ([\d.]+) ([\d.]+)"', text)[0]
    packed = base64.b64encode(
        gzip.compress(text.encode(), 9, mtime=0)).decode()
    return (f'<img class="chart" width="{width}" height="{height}" '
            f'{attributes} data-gz="{packed}">')
