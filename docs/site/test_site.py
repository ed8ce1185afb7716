#!/usr/bin/python3
"""Test the site in a headless Chromium, and one figure in Firefox and WebKit,
where they are installed: test_site.py SITE. The last line counts the tests.
Exit status: 0 all right, else 1."""
import html
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] /
                       "tools/browsers"))
from browser import Browser  # noqa: E402
from engines import Firefox, WebKit  # noqa: E402

LARGEST = 2_000_000  # bytes
SITE = pathlib.Path(sys.argv[1]).resolve()
HTML = sorted(file for file in SITE.rglob("*.html"))
faults = []


def expect(holds, words):
    if not holds:
        faults.append(words)


def size_is_small():
    size = sum(file.stat().st_size for file in SITE.rglob("*")
               if file.is_file())
    expect(size < LARGEST, f"{SITE}: {size} bytes, expected less than "
           f"{LARGEST}")


def nothing_comes_from_elsewhere():
    """No page, style or script names a resource of another host."""
    resource = re.compile(r"<(?:script|img|iframe|source)\b[^>]*\bsrc=\"?"
                          r"https?:|<link\b[^>]*\bhref=\"?https?:|"
                          r"url\([\"']?https?:|"
                          r"@import|\bfetch\(|importScripts")
    for file in SITE.rglob("*"):
        if file.suffix in (".html", ".css", ".js"):
            found = resource.search(file.read_text())
            expect(not found, f"{file}: asks for {found and found[0]}")


def links_resolve():
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
            expect(target.is_file(), f"{file}: {url} is not there")
            if (anchor and target.suffix == ".html" and target.is_file()
                    and not anchor.startswith("scene=")):
                expect(anchor in ids[target], f"{file}: {url} is no section")
    expect(count > 500, f"only {count} links")


def pages_fit_and_say_nothing():
    """Pages of 320 pixels do not scroll sideways, what is wider than they are
    is scrolled by keys, too, and hides no sign of a list; they have a title and
    a language, and every picture has words and is there."""
    with Browser(360, 740) as browser:
        for file in HTML:
            browser.open(file.as_uri())
            browser.wait("[...document.images].every(i => !i.src || "
                         "i.loading === 'lazy' && !i.complete || "
                         "i.naturalWidth > 0)", 120)
            hidden = browser.value("""[...document.querySelectorAll('main *')]
              .filter(e => getComputedStyle(e).overflowX === 'auto' && (
                e.scrollWidth > e.clientWidth && e.tabIndex < 0 ||
                e.matches('li') && getComputedStyle(e).listStylePosition !==
                  'inside')).map(e => e.outerHTML.slice(0, 80))""")
            expect(not hidden, f"{file}: scrolls without keys, or hides the "
                   f"sign of a list: {hidden}")
            high = browser.value("""[...document.querySelectorAll(
              '.wide:not(.list) tr')].filter(r => r.offsetHeight > 240).map(
              r => r.innerText)""")
            expect(not high, f"{file}: high rows: {high}")
            browser.resize(320, 740)
            wide = browser.value("document.documentElement.scrollWidth")
            expect(wide <= 320, f"{file}: {wide} pixels wide at 320")
            browser.resize(360, 740)
            expect(browser.value("document.title && document.documentElement"
                                 ".lang === 'en'"), f"{file}: title, lang")
            bare = browser.value("[...document.images].filter("
                                 "i => !i.alt).map(i => i.src.slice(0, 80))")
            expect(not bare, f"{file}: no words for {bare}")
            expect(not browser.faults, f"{file}: {browser.faults}")
            browser.faults.clear()
            asked = browser.value("""performance.getEntriesByType('resource')
              .map(e => e.name).filter(n => !/^(file|blob|data):/.test(n))""")
            expect(not asked, f"{file}: asked for {asked}")


def search_finds_sections():
    """By keys, and on a phone, of a page in a folder."""
    with Browser(1280, 800) as browser:
        for phone in (False, True):
            if phone:
                browser.resize(360, 740, touch=True)
            browser.open((SITE / "docs/site/explode.html").as_uri())
            browser.key("/", text="/")
            browser.wait("sections")
            for words, expected in (("no such wordz", "No sections"),
                                    ("cuthill mcke", r"\d sections?")):
                browser.value(f"input.value = '{words}', look()")
                said = browser.value("told.textContent")
                expect(re.fullmatch(expected, said), f"{words}: {said}")
            browser.value("input.value = 'checkpoint signal', look()")
            width = browser.value("document.documentElement.scrollWidth")
            expect(width <= (360 if phone else 1280), f"{width} pixels wide")
            browser.key("ArrowDown")
            said = browser.value("document.activeElement.textContent")
            expect(said.startswith("The laboratory - Output files"), said)
            browser.key("ArrowUp"), browser.key("Enter")
            browser.wait("location.href.endsWith('lab/index.html#output-files-"
                         "signals-and-checkpoints')")
        expect(not browser.faults, str(browser.faults))


def figures_move():
    """Each, once it is seen; and not by itself if the person prefers that."""
    time = "document.querySelectorAll('.live .busy')[{}].textContent"
    pages = [file for file in HTML if 'class="live"' in file.read_text()]
    count = 0
    with Browser(1280, 800) as browser:
        for file in pages:
            browser.open(file.as_uri())
            for k in range(browser.value(
                    "document.querySelectorAll('.live').length")):
                count += 1
                browser.value(f"document.querySelectorAll('.live')[{k}]"
                              ".scrollIntoView({block: 'center'})")
                moves = (f"/t = (?!0.000)/.test({time.format(k)})")
                browser.wait(moves, 120)
            expect(not browser.faults, f"{file}: {browser.faults}")
            browser.faults.clear()
        browser.prefer(still=True)
        browser.open((SITE / "index.html").as_uri())
        browser.wait(f"{time.format(0)} === 't = 0.000 s'", 120)
        expect(browser.value("document.querySelector('.play').textContent")
               == "Play", "it moves by itself, whatever the person prefers")
    expect(count > 10, f"only {count} figures")


def a_mistake_that_fails_at_once_is_seen():
    """The steps before it fails, and the words that say why."""
    with Browser(1280, 800) as browser:
        browser.open((SITE / "course/5.1.html").as_uri())
        browser.value("all = document.querySelector('.live'),"
                      "all.scrollIntoView(), of = name =>"
                      " all.querySelector(name).textContent, 0")
        browser.wait("/t = (?!0.000)/.test(of('.busy'))", 120)
        browser.value("[...all.querySelectorAll('.switch button')].find("
                      "e => e.textContent === 'no mass').click()")
        browser.wait("/t = 0.00[1-6] s, [0-9]+ times slower/.test(of('.busy'))")
        browser.wait("of('.name ~ .name').includes('diverged at 0.007 s')")
        expect("625 g" in browser.value("of('.says')"), "no words say why")


def beyond_the_limit_it_explodes():
    """And below it does not: the mass, the chain, the cloth."""
    with Browser(1280, 800) as browser:
        browser.open((SITE / "docs/site/explode.html").as_uri())
        for k in range(3):
            browser.value(f"all = document.querySelectorAll('.explode')[{k}],"
                          "all.scrollIntoView(), it = all.explosion, 0")
            now = "it.figure.cloths[0].readings"
            browser.wait(f"{now}?.time > 0.3", 300)
            expect(browser.value(f"{now}.gainAt < 0 && it.omega < 1.001 * "
                                 "2 / it.limit && it.omega > 1 / it.limit"),
                   f"{k}: below the limit it explodes, or omega is wrong")
            browser.value("it.slider.value = 1.3, it.slider.oninput()")
            browser.wait(f"{now}?.gainAt >= 0", 300)
            expect("larger" in browser.value("it.words.textContent"),
                   f"{k}: beyond the limit its words are those of below")
        expect(not browser.faults, str(browser.faults))


def figures_can_be_framed():
    with Browser(640, 400) as browser:
        address = (SITE / "embed.html").as_uri()
        browser.open(f"{address}?scene=3.2-mistakes&controls=none")
        browser.wait("/t = (?!0.000)/.test(document.querySelector('.busy')"
                     ".textContent)", 120)
        expect(browser.value("document.querySelector('.tools').offsetHeight")
               == 0, "controls=none shows controls")
        expect(browser.value("document.documentElement.scrollHeight") == 400,
               "a figure is higher than its frame")
        browser.open(f"{address}?scene=nothing")
        expect("there are drag" in browser.value("document.body.innerText"),
               "an unknown scene is not named")
        expect(not browser.faults, str(browser.faults))


def other_engines_run_a_figure():
    """It moves, its switch shows the right code, and nothing complains."""
    for engine in (Firefox, WebKit):
        if missing := engine.missing():
            print(f"skipped: a figure in {engine.__name__}: missing:", *missing)
            continue
        with engine(1000, 800) as browser:
            browser.open((SITE / "course/3.2.html").as_uri())
            browser.value("all = document.querySelectorAll('.live')[1],"
                          "all.scrollIntoView({block: 'center'})")
            browser.wait("/t = (?!0.000)/.test(all.querySelector('.busy')"
                         ".textContent)", 120)
            browser.value("all.querySelector('.switch button').click()")
            shown = browser.value(
                "[all.querySelector('.name').textContent, [...document."
                "querySelectorAll('.edit')].every(e => e.hidden)]")
            expect(shown == ["right", True], f"{engine.__name__}: {shown}")
            expect(not browser.faults, f"{engine.__name__}: {browser.faults}")


TESTS = (size_is_small, nothing_comes_from_elsewhere, links_resolve,
         pages_fit_and_say_nothing,
         search_finds_sections, figures_move,
         a_mistake_that_fails_at_once_is_seen, beyond_the_limit_it_explodes,
         figures_can_be_framed, other_engines_run_a_figure)
bad = 0
for test in TESTS:
    faults = []
    try:
        test()
    except Exception as error:  # of the browser, too: a test that fails
        faults.append(f"{type(error).__name__}: {error}")
    bad += bool(faults)
    print("ok  " if not faults else "FAIL", test.__name__, flush=True)
    for words in faults:
        print("     ", words)
print(f"{len(TESTS) - bad} passed, {bad} failed")
sys.exit(bad > 0)
