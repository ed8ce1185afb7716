#!/usr/bin/python3
"""Test the site in a headless Chromium, and one figure in Firefox and WebKit,
where they are installed: test_site.py SITE [TEST]... The last line counts the
tests. Exit status: 0 all right, else 1."""
import html
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] /
                       "tools/browsers"))
from browser import run_tests  # noqa: E402
from engines import Firefox, WebKit  # noqa: E402

LARGEST = 2_000_000  # bytes
SITE = pathlib.Path(sys.argv[1]).resolve()
HTML = sorted(file for file in SITE.rglob("*.html"))
tests = []


def test(run):
    tests.append(run)


def open_page(b, name):
    b.open(f"{SITE.as_uri()}/{name}")


@test
def size_is_small(_):
    size = sum(file.stat().st_size for file in SITE.rglob("*")
               if file.is_file())
    assert size < LARGEST, f"{size} bytes, expected less than {LARGEST}"


@test
def nothing_comes_from_elsewhere(_):
    """No page, style or script names a resource of another host."""
    resource = re.compile(r"<(?:script|img|iframe|source)\b[^>]*\bsrc=\"?"
                          r"https?:|<link\b[^>]*\bhref=\"?https?:|"
                          r"url\([\"']?https?:|"
                          r"@import|\bfetch\(|importScripts")
    for file in SITE.rglob("*"):
        if file.suffix in (".html", ".css", ".js"):
            found = resource.search(file.read_text())
            assert not found, f"{file}: asks for {found}"


@test
def links_resolve(_):
    ids = {file: set(re.findall(r'\bid="([^"]+)"', file.read_text()))
           for file in HTML}
    count = 0
    for file in HTML:
        for url in re.findall(r'<a\b[^>]*\bhref="([^"]*)"', file.read_text()):
            if re.match("https?:", url):
                continue
            count += 1
            path, _, anchor = html.unescape(url).partition("#")
            target = (file.parent / path).resolve() if path else file
            assert target.is_file(), f"{file}: {url} is not there"
            if (anchor and target.suffix == ".html"
                    and not anchor.startswith("scene=")):
                assert anchor in ids[target], f"{file}: {url} is no section"
    assert count > 500, f"only {count} links"


@test
def pages_fit_and_say_nothing(b):
    """Pages of 320 pixels do not scroll sideways, what is wider than they are
    is scrolled by keys, too, and hides no sign of a list; they have a title and
    a language, and every picture has words and is there."""
    for file in HTML:
        b.resize(360, 740)
        b.open(file.as_uri())
        b.wait("[...document.images].every(i => !i.src || "
               "i.loading === 'lazy' && !i.complete || i.naturalWidth > 0)",
               120)
        for what, expression in (
                ("scrolls without keys, or hides the sign of a list",
                 """[...document.querySelectorAll('main *')]
                 .filter(e => getComputedStyle(e).overflowX === 'auto' && (
                   e.scrollWidth > e.clientWidth && e.tabIndex < 0 ||
                   e.matches('li') && getComputedStyle(e).listStylePosition !==
                     'inside')).map(e => e.outerHTML.slice(0, 80))"""),
                ("has high rows",
                 """[...document.querySelectorAll('.wide:not(.list) tr')]
                 .filter(r => r.offsetHeight > 240).map(r => r.innerText)"""),
                ("has pictures without words",
                 """[...document.images].filter(i => !i.alt).map(
                 i => i.src.slice(0, 80))"""),
                ("asks another host for",
                 """performance.getEntriesByType('resource').map(
                 e => e.name).filter(n => !/^(file|blob|data):/.test(n))""")):
            found = b.value(expression)
            assert not found, f"{file}: {what}: {found}"
        assert b.value("document.title && document.documentElement.lang === "
                       "'en'"), f"{file}: title, lang"
        b.resize(320, 740)
        wide = b.value("document.documentElement.scrollWidth")
        assert wide <= 320, f"{file}: {wide} pixels wide at 320"
        assert not b.faults, f"{file}: {b.faults}"


@test
def search_finds_sections(b):
    """By keys, and on a phone, of a page in a folder."""
    for phone in (False, True):
        if phone:
            b.resize(360, 740, touch=True)
        open_page(b, "docs/site/explode.html")
        b.key("/", text="/")
        b.wait("sections")
        for words, expected in (("no such wordz", "No sections"),
                                ("cuthill mcke", r"\d sections?")):
            b.value(f"input.value = '{words}', look()")
            said = b.value("told.textContent")
            assert re.fullmatch(expected, said), f"{words}: {said}"
        b.value("input.value = 'checkpoint signal', look()")
        width = b.value("document.documentElement.scrollWidth")
        assert width <= (360 if phone else 1280), f"{width} pixels wide"
        b.key("ArrowDown")
        said = b.value("document.activeElement.textContent")
        assert said.startswith("The laboratory - Output files"), said
        b.key("ArrowUp"), b.key("Enter")
        b.wait("location.href.endsWith('lab/index.html#output-files-"
               "signals-and-checkpoints')")


@test
def figures_move(b):
    """Each, once it is seen; and not by itself if the person prefers that."""
    time = "document.querySelectorAll('.live .busy')[{}].textContent"
    count = 0
    for file in HTML:
        if 'class="live"' not in file.read_text():
            continue
        b.open(file.as_uri())
        for k in range(b.value("document.querySelectorAll('.live').length")):
            count += 1
            b.value(f"document.querySelectorAll('.live')[{k}]"
                    ".scrollIntoView({block: 'center'})")
            b.wait(f"/t = (?!0.000)/.test({time.format(k)})", 120)
        assert not b.faults, f"{file}: {b.faults}"
    b.prefer(still=True)
    open_page(b, "index.html")
    b.wait(f"{time.format(0)} === 't = 0.000 s'", 120)
    assert b.value("document.querySelector('.play').textContent") == "Play"
    assert count > 10, f"only {count} figures"


@test
def a_mistake_that_fails_at_once_is_seen(b):
    """The steps before it fails, and the words that say why."""
    open_page(b, "course/5.1.html")
    b.value("all = document.querySelector('.live'), all.scrollIntoView(),"
            " of = name => all.querySelector(name).textContent, 0")
    b.wait("/t = (?!0.000)/.test(of('.busy'))", 120)
    b.value("[...all.querySelectorAll('.switch button')].find("
            "e => e.textContent === 'no mass').click()")
    b.wait("/t = 0.00[1-6] s, [0-9]+ times slower/.test(of('.busy'))")
    b.wait("of('.name ~ .name').includes('diverged at 0.007 s')")
    assert "625 g" in b.value("of('.says')"), "no words say why"


@test
def beyond_the_limit_it_explodes(b):
    """And below it does not: the mass, the chain, the cloth."""
    open_page(b, "docs/site/explode.html")
    for k in range(3):
        b.value(f"all = document.querySelectorAll('.explode')[{k}],"
                "all.scrollIntoView(), it = all.explosion, 0")
        now = "it.figure.cloths[0].readings"
        b.wait(f"{now}?.time > 0.3", 300)
        assert b.value(f"{now}.gainAt < 0 && it.omega < 1.001 * 2 / it.limit"
                       " && it.omega > 1 / it.limit"), k
        b.value("it.slider.value = 1.3, it.slider.oninput()")
        b.wait(f"{now}?.gainAt >= 0", 300)
        assert "larger" in b.value("it.words.textContent"), k


@test
def figures_can_be_framed(b):
    b.resize(640, 400)
    open_page(b, "embed.html?scene=3.2-mistakes&controls=none")
    b.wait("/t = (?!0.000)/.test(document.querySelector('.busy').textContent)",
           120)
    assert b.value("document.querySelector('.tools').offsetHeight") == 0
    assert b.value("document.documentElement.scrollHeight") == 400
    open_page(b, "embed.html?scene=nothing")
    assert "there are drag" in b.value("document.body.innerText")


def a_figure_runs(b):
    """It moves, and its switch shows the right code."""
    open_page(b, "course/3.2.html")
    b.value("all = document.querySelectorAll('.live')[1],"
            "all.scrollIntoView({block: 'center'})")
    b.wait("/t = (?!0.000)/.test(all.querySelector('.busy').textContent)", 120)
    b.value("all.querySelector('.switch button').click()")
    shown = b.value("[all.querySelector('.name').textContent, [...document."
                    "querySelectorAll('.edit')].every(e => e.hidden)]")
    assert shown == ["right", True], shown


def main():
    engines = [one for one in (Firefox, WebKit) if not one.missing()]
    if len(engines) < 2:
        print("skipped: a figure in Firefox or WebKit: not installed")
    failed = run_tests([a_figure_runs], sys.argv[2:], engines)
    return failed + run_tests(tests, sys.argv[2:]) != 0


if __name__ == "__main__":
    sys.exit(main())
