#!/usr/bin/env python3
"""Make the site: make_site.py OUT APP FIGURES. A page for each Markdown file of
contents.py, with its pictures, beside the laboratory's page (the folder APP)
and the figures (the folder FIGURES). Needs pandoc and ffmpeg: make page-deps.

    REPOSITORY=https://github.com/OWNER/NAME   where links to files lead that
    are no pages; without it they are text. ADDRESS=https://...: of the site.

Exit status: 0 done, 1 a page names what is not there (FILE:LINE says it), 2 a
tool is missing."""
import base64
import concurrent.futures
import gzip
import html
import json
import os
import pathlib
import posixpath
import re
import shutil
import string
import subprocess
import sys

import charts
import figures
import pages as course_pages
import tasks
from contents import CONTENTS, LEFT_OUT

ROOM = pathlib.Path(__file__).resolve().parent
ROOT = ROOM.parents[1]
REPOSITORY = os.environ.get("REPOSITORY", "").rstrip("/")
ADDRESS = os.environ.get("ADDRESS", "").rstrip("/")
PICTURES = (".png", ".gif")
COURSE = tasks.load()
# The pages in order: those of Markdown or code, and those of the site alone.
PAGES = [page for _, group in CONTENTS for page in group]
SOURCES = [page for page in PAGES if isinstance(page, str)]
Entry = str | tuple[str, str]
Pages = dict[str, "Page"]


def file_of(page: Entry) -> str:
    """The file of the site for a page."""
    if not isinstance(page, str):
        return page[0]
    if page.endswith(".md"):
        return page.replace("README.md", "index.md")[:-3] + ".html"
    return page + ".html"


def relative(target: str, page: Entry) -> str:
    """The link from a page to a file of the site."""
    return posixpath.relpath(target, posixpath.dirname(file_of(page)) or ".")


class Page:
    """One page of the site. After read(): its title, its first words, the HTML
    of its body, and in faults what it names that is not there."""

    def __init__(self, source: str) -> None:
        self.source, self.faults = source, list[str]()
        self.anchors: list[tuple[str, str, str]] = []
        self.pictures: list[str] = []
        self.text = (ROOT / source).read_text()
        if source.startswith("course/"):
            self.text = course_pages.translated(
                source.removeprefix("course/"), self.text, COURSE)

    def at(self, url: str, words: str) -> str:
        """Words on what stands at a link or a picture: FILE:LINE: words."""
        line = self.text.count("\n", 0, max(self.text.find(url), 0)) + 1
        return f"{self.source}:{line}: {words}"

    def read(self) -> "Page":
        text = self.text
        if not self.source.endswith(".md"):
            text = f"# {self.source}\n\n```\n{text.rstrip()}\n```\n"
        text = re.sub(r"^( *)```math\n(.*?)\n *```$", displayed, text,
                      flags=re.M | re.S)
        # How the repository is built is of no use to who reads the site.
        text = re.sub(r"<!-- repository -->.*?<!-- /repository -->", "", text,
                      flags=re.S)
        text = course_pages.filled(figures.with_code(self.source, text), COURSE,
                                   hints=True)
        body = subprocess.run(
            ["pandoc", "-f", "gfm+tex_math_dollars", "-t", "html", "--mathml",
             "--wrap=preserve", "--fail-if-warnings"], input=text, text=True,
            check=True, timeout=300, stdout=subprocess.PIPE).stdout
        self.body = self.rewritten(body)
        self.ids = set(re.findall(r'\bid="([^"]+)"', self.body))
        self.title = words_of(
            re.findall(r"<h1[^>]*>(.*?)</h1>", body, re.S)[0])
        first = re.search(r"</h1>.*?<p>([^<].*?)</p>", body, re.S)
        self.about = words_of(first[1] if first else self.title)
        return self

    def rewritten(self, body: str) -> str:
        # Each line of code had an id and an anchor; each formula its TeX.
        body = re.sub(r'<span id="cb[^"]*"><a [^>]*></a>(.*?)</span>$', r"\1",
                      body, flags=re.M)
        body = re.sub(r' id="cb\d+"', "", body)
        body = re.sub(r"<annotation.*?</annotation>|</?semantics>"
                      r"| xmlns=\"[^\"]*\"", "", body, flags=re.S)
        body = re.sub(r"<!--.*?-->\n*", "", body, flags=re.S)
        body = body.replace("<th></th>", "<td></td>")
        body = re.sub(r'<math display="inline">.*?</math>', level, body,
                      flags=re.S)
        body = re.sub(r' class="(header|odd|even|uri)"|</t[dhr]>|</tbody>'
                      r'|</thead>|</li>| form="(prefix|postfix)"', "", body)
        body = body.replace("<table>", '<div class="wide"><table>').replace(
            "</table>", "</table></div>")
        body = re.sub(r'<a href="([^"]*)"', self.link, body)
        body = re.sub(r'<img src="([^"]*)"([^>]*)>', self.image, body)
        return re.sub(r"<p>((?:<a[^>]*>)?<img [^>]*data-scene=\"([^\"]*)\".*?)"
                      "</p>", r'<div class="live" data-scene="\2">\1</div>',
                      body, flags=re.S)

    def path_of(self, url: str) -> str:
        return posixpath.normpath(posixpath.join(
            posixpath.dirname(self.source), url))

    def link(self, match: re.Match[str]) -> str:
        url = html.unescape(match[1])
        if re.match(r"https?:", url):
            return match[0]
        name, _, anchor = url.partition("#")
        path = self.path_of(name) if name else self.source
        if anchor.startswith("scene="):  # a run of the laboratory's page
            return (f'<a href="{relative("page/index.html", self.source)}'
                    f'#{html.escape(anchor)}"')
        if path.startswith("../../"):   # of the repository's host
            return (f'<a href="{REPOSITORY}/{path[6:]}"' if REPOSITORY
                    else "<a")
        if not (ROOT / path).exists():
            self.faults.append(self.at(url, f"{url} is not there"))
        if (ROOT / path).is_dir() and f"{path}/README.md" in SOURCES:
            path += "/README.md"
        if path in SOURCES:
            if anchor:
                self.anchors.append((url, path, anchor))
            to = relative(file_of(path), self.source) if name else ""
            return f'<a href="{to}{"#" + anchor if anchor else ""}"'
        if pathlib.Path(path).suffix in PICTURES:
            self.pictures.append(path)
            return f'<a href="{relative(shown(path), self.source)}"'
        kind = "tree" if (ROOT / path).is_dir() else "blob"
        return (f'<a href="{REPOSITORY}/{kind}/main/{path}"' if REPOSITORY
                else "<a")

    def image(self, match: re.Match[str]) -> str:
        url, rest = html.unescape(match[1]), match[2].replace("/", "").strip()
        path = self.path_of(url)
        if not (ROOT / path).is_file():
            self.faults.append(self.at(url, f"{url} is not there"))
            return ""
        if 'alt="' not in rest:
            rest += ' alt=""'
        scene = figures.scene_of(path)
        if scene and self.source in ("README.md", scene["page"]):
            rest += f' data-scene="{scene["name"]}"'
        if path.endswith(".svg"):
            return charts.element(ROOT / path, rest)
        self.pictures.append(path)
        return (f'<img src="{relative(shown(path), self.source)}" '
                f'loading="lazy" {rest}>')

    def place(self) -> tuple[Entry | None, Entry | None]:
        """Where it stands: what comes before and after it."""
        at = PAGES.index(self.source)
        return (PAGES[at - 1] if at else None,
                PAGES[at + 1] if at + 1 < len(PAGES) else None)


def displayed(match: re.Match[str]) -> str:
    """A formula as pandoc reads it, whose parentheses grow by themselves."""
    formula = re.sub(r"\\[bB]ig[lr]", "", match[2])
    if re.search(r"\\\\$", formula, re.M):
        formula = rf"\begin{{gathered}}{formula}\end{{gathered}}"
    return f"{match[1]}$${formula}$$"


def level(match: re.Match[str]) -> str:
    """A formula in the text: its parentheses grow around fractions alone."""
    return match[0] if "<mfrac" in match[0] else match[0].replace(
        'stretchy="true"', 'stretchy="false"')


def words_of(markup: str) -> str:
    return html.unescape(" ".join(re.sub(r"<[^>]*>", "", markup).split()))


def shown(path: str) -> str:
    """The file of the site for a picture."""
    return re.sub(r"\.(png|gif)$", ".webp", path)


def contents(pages: Pages, current: Page) -> str:
    """The list of contents, and below the current page its sections. Of other
    groups than its own a page lists the names; the first page lists all."""
    out = []
    for group, entries in CONTENTS:
        to = relative(file_of(entries[0]), current.source)
        if current.source not in entries + ["README.md"]:
            out.append(f'<p><a href="{to}">{group}</a></p>')
            continue
        out.append(f"<p>{group}</p><ul>")
        for entry in entries:
            to = relative(file_of(entry), current.source)
            here = ' aria-current="page"' * (entry == current.source)
            out.append(f'<li><a href="{to}"{here}>{title_of(pages, entry)}</a>')
            if here:
                parts = re.findall(r'<h2 id="([^"]*)">(.*?)</h2>',
                                   current.body, re.S)
                out.append("".join(
                    ["<ul>"] + [f'<li><a href="#{name}">{words}</a>'
                                for name, words in parts] + ["</ul>"]))
        out.append("</ul>")
    return "\n".join(out)


def title_of(pages: Pages, entry: Entry) -> str:
    return html.escape(pages[entry].title if isinstance(entry, str)
                       else entry[1], quote=False)


def beside(pages: Pages, page: Page) -> str:
    """The links to the page before and the page after."""
    out = ""
    for entry, kind, sign in zip(page.place(), ("prev", "next"),
                                 ("&larr; {}", "{} &rarr;")):
        if entry:
            out += (f'<a rel="{kind}" href="'
                    f'{relative(file_of(entry), page.source)}">'
                    + sign.format(title_of(pages, entry)) + "</a>\n")
    return out


def og(name: str, value: str) -> str:
    """What another program shows of a link to a page."""
    return f'<meta property="og:{name}" content="{html.escape(value)}">\n'


def home(body: str) -> str:
    """The body of the first page: the cloth is what one sees first."""
    lead, entries = ((ROOM / name).read_text()
                     for name in ("home.html", "entries.html"))
    body = body.replace("</h1>", "</h1>\n" + lead, 1)
    return re.sub(r'(<div class="live".*?</div>)', rf"\1\n{entries}", body,
                  count=1, flags=re.S)


def filled(template: str, pages: Pages, page: Page) -> str:
    top = relative(".", page.source)
    explodes = 'class="explode"' in page.body
    scripts = ["figures/figure.js", "figures/scenes.js"] * (
        explodes or 'class="live"' in page.body) + ["explode.js"] * explodes
    title = page.title + " - mass_spring" * (page.source != "README.md")
    meta = "".join(
        og(name, value) for name, value in (
            ("type", "article"), ("title", title), ("description", page.about),
            ("url", ADDRESS and f"{ADDRESS}/{file_of(page.source)}"),
            ("image", ADDRESS and f"{ADDRESS}/docs/pictures/page.webp"))
        if value)
    return string.Template(template).substitute(
        title=html.escape(title), about=html.escape(page.about), meta=meta,
        top=top, contents=contents(pages, page),
        body=home(page.body) if page.source == "README.md" else page.body,
        beside=beside(pages, page),
        repository=f'<a href="{REPOSITORY}">Repository</a>' if REPOSITORY
        else "", scripts="\n".join(f'<script src="{top}/{name}"></script>'
                                  for name in [*scripts, "site.js"]))


def link_home(file: pathlib.Path) -> None:
    """On the laboratory's page: links to the course and the repository, and
    what another program shows of the page."""
    links = '<p><a href="../index.html">The course and the laboratory</a>'
    if REPOSITORY:
        links += f'; <a href="{REPOSITORY}">the code</a>'
    text = file.read_text().replace("<!-- links -->", links + ".</p>")
    if ADDRESS:
        text = text.replace("<title>", og("url", f"{ADDRESS}/page/index.html")
                            + og("image", f"{ADDRESS}/docs/pictures/page.webp")
                            + "<title>", 1)
    file.write_text(text)


def index(pages: Pages) -> str:
    """A script with the sections of all pages, packed, in which site.js
    searches: their file, title and words."""
    sections = []
    for source, page in pages.items():
        parts = re.split(r'<h[1-3] id="([^"]*)">(.*?)</h[1-3]>', page.body,
                         flags=re.S)
        for anchor, head, body in zip(parts[1::3], parts[2::3], parts[3::3]):
            title = dict.fromkeys([page.title, words_of(head)])
            words = re.findall(r"[a-z_]\w{2,19}", words_of(re.sub(
                r"<(math|img).*?(</math>|>)", "", body, flags=re.S)).lower())
            sections.append([f"{file_of(source)}#{anchor}", " - ".join(title),
                             " ".join(sorted(set(words)))])
    packed = gzip.compress(json.dumps(sections).encode(), 9, mtime=0)
    return f"self.sections = '{base64.b64encode(packed).decode()}';\n"


def faults_of(pages: Pages) -> list[str]:
    faults = [words for page in pages.values() for words in page.faults]
    faults += [page.at(url, f"{path} has no section #{anchor}")
               for page in pages.values() for url, path, anchor in page.anchors
               if anchor not in pages[path].ids]
    tracked = subprocess.run(["git", "ls-files", "*.md"], cwd=ROOT, check=True,
                             stdout=subprocess.PIPE, text=True).stdout.split()
    return faults + [f"{path}:1: is in no group of docs/site/contents.py"
                     for path in tracked if path not in SOURCES + LEFT_OUT]


def main(out_name: str, app: str, figures_name: str) -> None:
    for tool in ("pandoc", "ffmpeg"):
        if not shutil.which(tool):
            sys.exit(f"make site: {tool} is missing; this installs it: "
                     "make page-deps")
    out, built = pathlib.Path(out_name), pathlib.Path(figures_name)
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        pages = dict(zip(SOURCES, pool.map(lambda s: Page(s).read(), SOURCES)))
        if faults := faults_of(pages):
            sys.exit("\n".join(sorted(set(faults))))
        shutil.rmtree(out, ignore_errors=True)
        template = (ROOM / "page.html").read_text()
        for source, page in pages.items():
            file = out / file_of(source)
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(filled(template, pages, page))
        pictures = {path for page in pages.values() for path in page.pictures}
        list(pool.map(lambda path: charts.write(ROOT / path, out / shown(path)),
                      sorted(pictures)))
    shutil.copytree(app, out / "page")
    link_home(out / "page/index.html")
    figures.write(built, out / "figures")
    (out / "site.css").write_text(figures.palette()
                                  + (ROOM / "site.css").read_text())
    for name in ("site.js", "explode.js", "embed.html"):
        shutil.copy(ROOM / name, out)
    (out / "sections.js").write_text(index(pages))
    (out / ".nojekyll").touch()
    sizes = [file.stat().st_size for file in out.rglob("*") if file.is_file()]
    print(f"{out}/index.html: {len(sizes)} files, {sum(sizes)} bytes")


if __name__ == "__main__":
    main(*sys.argv[1:])
